#pragma once

#include <memory>
#include <string>

#include <CLI/CLI.hpp>

#include <samewhere/view/live_view.hpp>

namespace samewhere::app {

// Where a viewer is served: --view[=PLACE] and --view-token.
struct ViewOptions {
  std::string place;  // empty: no viewer
  std::string token;
};

// --view-token.
CLI::Option* add_token_option(CLI::App& command, std::string& token);
void add_view_options(CLI::App& command, ViewOptions& options);

// Tells on stderr where to look.
void print_view_url(const std::string& url);

// Nothing if none is wanted. Throws InputError if the place cannot be served.
std::unique_ptr<view::LiveView> open_live_view(const ViewOptions& options);

}  // namespace samewhere::app
