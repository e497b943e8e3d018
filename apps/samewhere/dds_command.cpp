#include "commands.hpp"
#include "start_program.hpp"

namespace samewhere::app {

void add_dds_command(CLI::App& app) {
  CLI::App* sub = app.add_subcommand(
      "dds", "SLAM as a node of a ROS 2 graph, through DDS, without an installed ROS 2");
  sub->set_help_flag();  // all that follows is for the node, --help too
  sub->prefix_command();
  sub->callback([sub] {
    start_program("samewhere-dds", sub->remaining(), "dds",
                  "it is built where Debian's cyclonedds-dev is installed");
  });
}

}  // namespace samewhere::app
