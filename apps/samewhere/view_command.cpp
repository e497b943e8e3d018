#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "commands.hpp"
#include "view_options.hpp"
#include <samewhere/core/channel.hpp>
#include <samewhere/core/interrupt.hpp>
#include <samewhere/view/finished_view.hpp>
#include <samewhere/view/place.hpp>

namespace samewhere::app {
namespace {

struct ViewCommand {
  std::vector<std::string> paths;
  PageOptions page;
};

void show(const ViewCommand& command) {
  const view::Place place = view::parse_place(command.page.place, "--at");
  const std::vector<std::filesystem::path> paths(command.paths.begin(), command.paths.end());
  const view::FinishedView viewer(paths, place, command.page.token);
  print_view_url(viewer.url());
  core::catch_interrupts();
  core::Channel<int> never(1);
  while (!core::is_interrupted()) never.is_open_for(0.1);
}

}  // namespace

void add_view_command(CLI::App& app) {
  auto command = std::make_shared<ViewCommand>();
  CLI::App* sub = app.add_subcommand(
      "view", "Show finished runs or map files in a browser, several side by side");
  sub->add_option("RUN", command->paths,
                  "folder that `samewhere run` or `samewhere loops` wrote, or a map file alone")
      ->required();
  add_page_options(*sub, command->page);
  sub->callback([command] { show(*command); });
  sub->footer(
      "Examples:\n"
      "  samewhere view runs/demo               its report; loops can be rejected or accepted by "
      "hand\n"
      "  samewhere view runs/monday runs/tuesday  two runs side by side\n"
      "  samewhere view runs/kitchen/map.sw     a map file alone\n"
      "  samewhere view runs/kitchen --at 0.0.0.0:8080  for other machines, with a token\n"
      "Ctrl-C ends it. A run that goes on: samewhere run SOURCE --view; there loops cannot be "
      "overridden,\nso that the results are the same with and without a page.");
}

}  // namespace samewhere::app
