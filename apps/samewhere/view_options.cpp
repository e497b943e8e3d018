#include "view_options.hpp"

#include <samewhere/core/program.hpp>
#include <samewhere/view/access.hpp>
#include <samewhere/view/place.hpp>

namespace samewhere::app {

void add_page_options(CLI::App& command, PageOptions& options, CLI::Option* view) {
  CLI::Option* at = command.add_option(
      "--at", options.place,
      "where the page is: PORT or ADDRESS:PORT, by default port 8080 of this machine, or a free "
      "one");
  CLI::Option* token =
      command
          .add_option("--token", options.token,
                      "secret that the page is asked for; without it, where other machines reach "
                      "the page, a random one")
          ->check(view::token_error);
  if (view == nullptr) return;
  at->needs(view);
  token->needs(view);
}

void add_view_options(CLI::App& command, ViewOptions& options, const std::string& help) {
  add_page_options(command, options.page, command.add_flag("--view", options.is_wanted, help));
}

void print_view_url(const std::string& url) { core::note("look at " + url); }

std::unique_ptr<view::LiveView> open_live_view(const ViewOptions& options) {
  if (!options.is_wanted) return nullptr;
  auto viewer = std::make_unique<view::LiveView>(view::parse_place(options.page.place, "--at"),
                                                 options.page.token);
  print_view_url(viewer->url());
  return viewer;
}

}  // namespace samewhere::app
