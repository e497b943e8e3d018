#include "view_options.hpp"

#include <cctype>

#include <samewhere/core/program.hpp>
#include <samewhere/view/place.hpp>

namespace samewhere::app {
namespace {

constexpr std::size_t kMinToken = 8;

// Stands in an address without escapes.
std::string token_error(const std::string& token) {
  for (const char c : token) {
    const bool is_plain =
        std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '_' || c == '.';
    if (!is_plain) return "expected letters, digits, '-', '_' and '.'";
  }
  return token.size() < kMinToken ? "expected at least 8 characters" : "";
}

}  // namespace

CLI::Option* add_token_option(CLI::App& command, std::string& token) {
  return command
      .add_option("--view-token", token,
                  "secret that the page is asked for; without it, where other machines reach the "
                  "page, a random one")
      ->check(token_error);
}

void add_view_options(CLI::App& command, ViewOptions& options) {
  CLI::Option* view = command.add_flag(
      "--view{any}", options.place,
      "show the run in a browser while it goes on; --view=PORT or --view=ADDRESS:PORT, by default "
      "port 8080 of this machine, or a free one. The results are the same. The program ends when "
      "the page is closed");
  add_token_option(command, options.token)->needs(view);
}

void print_view_url(const std::string& url) { core::note("look at " + url); }

std::unique_ptr<view::LiveView> open_live_view(const ViewOptions& options) {
  if (options.place.empty()) return nullptr;
  auto viewer =
      std::make_unique<view::LiveView>(view::parse_place(options.place, "--view"), options.token);
  print_view_url(viewer->url());
  return viewer;
}

}  // namespace samewhere::app
