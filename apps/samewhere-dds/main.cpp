// samewhere-dds: the node of a robot with ROS 2, without ROS 2. `samewhere dds` starts it.

#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "graph.hpp"
#include "view_options.hpp"
#include <samewhere/core/errors.hpp>
#include <samewhere/core/interrupt.hpp>
#include <samewhere/core/program.hpp>
#include <samewhere/core/terminal.hpp>
#include <samewhere/messages/idl.hpp>
#include <samewhere/node/inputs.hpp>
#include <samewhere/node/node_thread.hpp>
#include <samewhere/node/topics.hpp>
#include <samewhere/node/trajectory_file.hpp>

namespace samewhere::dds_node {
namespace {

constexpr const char* kExamples =
    "Examples:\n"
    "  samewhere dds --remap image:=/camera/image_raw --remap camera_info:=/camera/camera_info\n"
    "  samewhere dds --set node.cameras=depth --remap image:=/camera/color/image_raw\n"
    "      --remap camera_info:=/camera/color/camera_info\n"
    "      --remap depth:=/camera/aligned_depth_to_color/image_raw\n"
    "  samewhere dds --map building.sw --localize --trajectory run.tum\n"
    "  samewhere dds --view --at 0.0.0.0:8080  watched in a browser, from other machines with a\n"
    "      token\n"
    "Commands, std_msgs/String on samewhere/command: save_map FILE, load_map FILE, localize FILE,\n"
    "reset, pause, resume. Answers are in /diagnostics.";

struct Job {
  std::vector<std::string> assignments;
  std::vector<std::string> remappings;
  std::string node_namespace;
  int domain = 0;
  std::string trajectory;
  Options options;
  bool is_localizing = false;
  app::ViewOptions view;
  bool lists_settings = false;
  bool prints_idl = false;
};

class GraphPublisher final : public node::Publisher {
 public:
  GraphPublisher(Graph& graph, const node::TopicNames& names)
      : graph_(graph),
        transforms_(advertise<messages::TFMessage>(names, node::kTransformsTopic)),
        pose_(advertise<messages::PoseWithCovarianceStamped>(names, node::kPoseTopic)),
        path_(advertise<messages::Path>(names, node::kPathTopic)),
        landmarks_(advertise<messages::PointCloud2>(names, node::kLandmarksTopic)),
        grid_(advertise<messages::OccupancyGrid>(names, node::kGridTopic)),
        diagnostics_(advertise<messages::DiagnosticArray>(names, node::kDiagnosticsTopic)),
        status_(advertise<messages::String>(names, node::kStatusTopic)) {}

  void transforms(const messages::TFMessage& message) override { publish(transforms_, message); }
  void pose(const messages::PoseWithCovarianceStamped& message) override {
    publish(pose_, message);
  }
  void path(const messages::Path& message) override { publish(path_, message); }
  void landmarks(const messages::PointCloud2& message) override { publish(landmarks_, message); }
  void grid(const messages::OccupancyGrid& message) override { publish(grid_, message); }
  void diagnostics(const messages::DiagnosticArray& message) override {
    publish(diagnostics_, message);
  }
  void status(const messages::String& message) override {
    spdlog::info("{}", message.data);
    publish(status_, message);
  }

 private:
  template <class Message>
  int advertise(const node::TopicNames& names, const node::NodeTopic& topic) {
    return graph_.advertise(names.name_of(topic.name), messages::type_of<Message>(), topic.quality);
  }
  template <class Message>
  void publish(int writer, const Message& message) {
    graph_.publish(writer, messages::write_message(message, messages::Layout::kCdr));
  }

  Graph& graph_;
  int transforms_;
  int pose_;
  int path_;
  int landmarks_;
  int grid_;
  int diagnostics_;
  int status_;
};

void subscribe(Graph& graph, const node::TopicNames& names, const node::Config& config,
               node::NodeThread& node) {
  node::subscribe_to_inputs(config, [&]<class Message>(const node::Input<Message>& input) {
    const auto receive = [&node, incoming_from = input.incoming_from](std::string_view cdr) {
      node.post(incoming_from(messages::read_message<Message>(cdr, messages::Layout::kCdr)));
    };
    const std::string name = std::string(input.topic.name).append(input.subtopic);
    graph.subscribe(names.name_of(name), messages::type_of<Message>(), input.topic.quality,
                    receive);
  });
}

int work(const Job& job) {
  const auto [config, settings] = node::config_from(job.assignments);
  Options options = job.options;
  options.settings = settings;
  options.map_use = job.is_localizing ? MapUse::kLocalize : MapUse::kExtend;
  core::catch_interrupts();
  const std::unique_ptr<view::LiveView> viewer = app::open_live_view(job.view);
  const node::TopicNames names(job.node_namespace, job.remappings);
  Graph graph(job.domain);
  GraphPublisher publisher(graph, names);
  node::NodeThread node(config, options, publisher, viewer.get());
  subscribe(graph, names, config, node);
  constexpr double kTick_s = 0.5;
  while (!core::is_interrupted()) {
    graph.spin(kTick_s);
    node.post(node::Tick{});
  }
  const std::vector<StampedPose> poses = node.finish();
  if (!job.trajectory.empty()) node::write_trajectory(job.trajectory, poses);
  return core::kDone;
}

int run(int argc, char** argv) {
  CLI::App app("SLAM as a node of a ROS 2 graph, through DDS, without an installed ROS 2",
               "samewhere dds");
  Job job;
  app.add_option("--set", job.assignments,
                 "node.KEY=VALUE (--settings lists them) or a setting of SLAM, SECTION.KEY=VALUE");
  app.add_option("--remap", job.remappings,
                 "topic FROM:=TO; image, camera_info, depth, right/image, right/camera_info, odom, "
                 "/tf, /tf_static, samewhere/pose ...");
  app.add_option("--namespace", job.node_namespace, "of the topics without a leading slash");
  app.add_option("--domain", job.domain, "DDS domain")
      ->envname("ROS_DOMAIN_ID")
      ->check(CLI::Range(0, 232));
  app.add_option("--profile", job.options.profile, "of the settings")->capture_default_str();
  app.add_option("--map", job.options.map, "a saved map to begin in")->check(CLI::ExistingFile);
  app.add_flag("--localize", job.is_localizing, "the map of --map stays as it is");
  app.add_option("--trajectory", job.trajectory, "TUM file written at the end");
  app::add_view_options(app, job.view, "show the node in a browser");
  app.add_flag("--settings", job.lists_settings, "print the settings of the node and end");
  app.add_flag("--idl", job.prints_idl, "print the types of all messages as IDL and end");
  app.footer(kExamples);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);
    return core::complain("samewhere", fmt::format("{} (see samewhere dds --help)", error.what()),
                          core::kBadInput);
  }
  if (job.lists_settings) {
    core::print("{}", node::config_table());
  } else if (job.prints_idl) {
    core::print("{}", messages::idl_of(messages::message_types()));
  } else {
    return work(job);
  }
  return core::kDone;
}

}  // namespace
}  // namespace samewhere::dds_node

int main(int argc, char** argv) {
  using namespace samewhere;
  return core::run_program("samewhere", [&] { return dds_node::run(argc, argv); });
}
