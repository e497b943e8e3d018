// samewhere-dds: the node of a robot with ROS 2, without ROS 2. `samewhere dds` starts it.

#include <cstdlib>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "graph.hpp"
#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>
#include <samewhere/core/interrupt.hpp>
#include <samewhere/core/program.hpp>
#include <samewhere/core/terminal.hpp>
#include <samewhere/core/tum_file.hpp>
#include <samewhere/library/convert.hpp>
#include <samewhere/node/node_thread.hpp>
#include <samewhere/node/topics.hpp>

namespace samewhere::dds_node {
namespace {

constexpr const char* kExamples =
    "Examples:\n"
    "  samewhere dds --remap image:=/camera/image_raw --remap camera_info:=/camera/camera_info\n"
    "  samewhere dds --set node.cameras=depth --remap image:=/camera/color/image_raw\n"
    "      --remap camera_info:=/camera/color/camera_info\n"
    "      --remap depth:=/camera/aligned_depth_to_color/image_raw\n"
    "  samewhere dds --map building.sw --localize --trajectory run.tum\n"
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
  bool lists_settings = false;
};

class GraphPublisher final : public node::Publisher {
 public:
  GraphPublisher(Graph& graph, const node::TopicNames& names)
      : graph_(graph),
        transforms_(advertise<messages::TFMessage>(names, node::kTransformsTopic)),
        pose_(advertise<messages::PoseWithCovarianceStamped>(names, node::kPoseTopic)),
        path_(advertise<messages::Path>(names, node::kPathTopic)),
        landmarks_(advertise<messages::PointCloud2>(names, node::kLandmarksTopic)),
        diagnostics_(advertise<messages::DiagnosticArray>(names, node::kDiagnosticsTopic)),
        status_(advertise<messages::String>(names, node::kStatusTopic)) {}

  void transforms(const messages::TFMessage& message) override { publish(transforms_, message); }
  void pose(const messages::PoseWithCovarianceStamped& message) override {
    publish(pose_, message);
  }
  void path(const messages::Path& message) override { publish(path_, message); }
  void landmarks(const messages::PointCloud2& message) override { publish(landmarks_, message); }
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
  int diagnostics_;
  int status_;
};

// The subscriptions of a node.
class Inputs {
 public:
  Inputs(Graph& graph, const node::TopicNames& names, node::NodeThread& node)
      : graph_(graph), names_(names), node_(node) {}

  void subscribe(const node::Config& config) {
    is_reliable_ = config.is_reliable;
    images(node::kImageTopic, node::Stream::kFirst, config.is_compressed);
    infos(node::kCameraInfoTopic, node::Stream::kFirst);
    if (config.cameras == node::Cameras::kDepth)
      images(node::kDepthTopic, node::Stream::kSecond, false);
    if (config.cameras == node::Cameras::kStereo) {
      images(node::kRightImageTopic, node::Stream::kSecond, config.is_compressed);
      infos(node::kRightCameraInfoTopic, node::Stream::kSecond);
    }
    take<messages::Odometry>(
        names_.name_of(node::kOdometryTopic.name), node::kOdometryTopic.quality,
        [](messages::Odometry message) { return node::OdometryIn{std::move(message)}; });
    transforms(node::kStaticTransformsTopic, true);
    if (config.odometry_from_tf) transforms(node::kTransformsTopic, false);
    take<messages::String>(names_.name_of(node::kCommandTopic.name), node::kCommandTopic.quality,
                           [](const messages::String& message) {
                             return node::CommandIn{node::command_from(message.data), nullptr};
                           });
  }

 private:
  template <class Message, class Convert>
  void take(const std::string& name, const node::Quality& quality, const Convert& convert) {
    graph_.subscribe(
        name, messages::type_of<Message>(), quality, [this, convert](std::string_view cdr) {
          node_.post(convert(messages::read_message<Message>(cdr, messages::Layout::kCdr)));
        });
  }

  template <class Message>
  void image(const std::string& name, node::Quality quality, node::Stream stream) {
    quality.is_reliable = is_reliable_;
    take<Message>(name, quality, [stream](Message message) {
      return node::ImageIn{stream, std::move(message)};
    });
  }

  void images(const node::NodeTopic& topic, node::Stream stream, bool is_compressed) {
    if (is_compressed) {
      const std::string name = names_.name_of(std::string(topic.name) + "/compressed");
      return image<messages::CompressedImage>(name, topic.quality, stream);
    }
    image<messages::Image>(names_.name_of(topic.name), topic.quality, stream);
  }

  void infos(const node::NodeTopic& topic, node::Stream stream) {
    take<messages::CameraInfo>(names_.name_of(topic.name), topic.quality,
                               [stream](messages::CameraInfo message) {
                                 return node::CameraInfoIn{stream, std::move(message)};
                               });
  }

  void transforms(const node::NodeTopic& topic, bool is_static) {
    take<messages::TFMessage>(names_.name_of(topic.name), topic.quality,
                              [is_static](messages::TFMessage message) {
                                return node::TransformsIn{std::move(message), is_static};
                              });
  }

  Graph& graph_;
  const node::TopicNames& names_;
  node::NodeThread& node_;
  bool is_reliable_ = false;
};

int work(const Job& job) {
  const auto [config, settings] = node::config_from(job.assignments);
  Options options = job.options;
  options.settings = settings;
  options.map_use = job.is_localizing ? MapUse::kLocalize : MapUse::kExtend;
  core::catch_interrupts();
  const node::TopicNames names(job.node_namespace, job.remappings);
  Graph graph(job.domain);
  GraphPublisher publisher(graph, names);
  node::NodeThread node(config, options, publisher);
  Inputs inputs(graph, names, node);
  inputs.subscribe(config);
  constexpr double kTick_s = 0.5;
  while (!core::is_interrupted()) {
    graph.spin(kTick_s);
    node.post(node::Tick{});
  }
  const std::vector<StampedPose> poses = node.finish();
  if (job.trajectory.empty()) return core::kDone;
  core::Trajectory trajectory;
  for (const StampedPose& pose : poses)
    trajectory.push_back({pose.stamp_s, library::rigid_of(pose.map_from_camera)});
  core::write_file(job.trajectory, core::tum_text(trajectory));
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
  app.add_flag("--settings", job.lists_settings, "print the settings of the node and end");
  app.footer(kExamples);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);
    return core::complain("samewhere", fmt::format("{} (see samewhere dds --help)", error.what()),
                          core::kBadInput);
  }
  if (!job.lists_settings) return work(job);
  core::print("{}", node::config_table());
  return core::kDone;
}

}  // namespace
}  // namespace samewhere::dds_node

int main(int argc, char** argv) {
  using namespace samewhere;
  return core::run_program("samewhere", [&] { return dds_node::run(argc, argv); });
}
