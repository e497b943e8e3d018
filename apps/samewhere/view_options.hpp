#pragma once

#include <memory>
#include <string>

#include <CLI/CLI.hpp>

#include <samewhere/view/live_view.hpp>

// Of `samewhere` and `samewhere-dds`.

namespace samewhere::app {

// Where a page is served: --at and --token.
struct PageOptions {
  std::string place = "any";
  std::string token;
};

struct ViewOptions {
  bool is_wanted = false;  // --view
  PageOptions page;
};

// With `view`, they need that option.
void add_page_options(CLI::App& command, PageOptions& options, CLI::Option* view = nullptr);
// --view and the options of its page; `help` is that of --view.
void add_view_options(CLI::App& command, ViewOptions& options, const std::string& help);

// Tells on stderr where to look.
void print_view_url(const std::string& url);

// Nothing if none is wanted. Throws InputError if the place cannot be served.
std::unique_ptr<view::LiveView> open_live_view(const ViewOptions& options);

}  // namespace samewhere::app
