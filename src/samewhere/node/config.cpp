#include <samewhere/node/config.hpp>

namespace samewhere::node {
namespace {

struct Sections {
  Config node;
};

void visit_fields(Sections& sections, core::FieldVisitor& visit) {
  visit("node", sections.node, {.help = "node of a robot: images in, transforms and map out"});
}

}  // namespace

std::pair<Config, std::vector<std::string>> config_from(
    const std::vector<std::string>& assignments) {
  Sections sections;
  std::vector<std::string> of_slam;
  for (const std::string& assignment : assignments) {
    if (assignment.starts_with("node.")) {
      core::set_config(sections, assignment);
    } else {
      of_slam.push_back(assignment);
    }
  }
  return {sections.node, of_slam};
}

std::string config_table() { return core::config_as_table(Sections{}); }

}  // namespace samewhere::node
