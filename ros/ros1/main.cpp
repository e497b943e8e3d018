// samewhere_node: SLAM as a node of ROS 1. Private parameters: map, localize, trajectory, profile,
// map_file; view (true, PORT or ADDRESS:PORT) and view_token; SECTION/KEY for each setting.

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <ros/ros.h>

#include "message_traits.hpp"
#include <samewhere/core/errors.hpp>
#include <samewhere/core/interrupt.hpp>
#include <samewhere/core/program.hpp>
#include <samewhere/node/inputs.hpp>
#include <samewhere/node/node_thread.hpp>
#include <samewhere/node/topics.hpp>
#include <samewhere/node/trajectory_file.hpp>
#include <samewhere/view/access.hpp>
#include <samewhere/view/live_view.hpp>

namespace samewhere::ros1 {
namespace {

std::string text_of(XmlRpc::XmlRpcValue& value) {
  switch (value.getType()) {
    case XmlRpc::XmlRpcValue::TypeBoolean:
      return static_cast<bool>(value) ? "true" : "false";
    case XmlRpc::XmlRpcValue::TypeInt:
      return fmt::format("{}", static_cast<int>(value));
    case XmlRpc::XmlRpcValue::TypeDouble:
      return fmt::format("{}", static_cast<double>(value));
    case XmlRpc::XmlRpcValue::TypeString:
      return static_cast<std::string>(value);
    default:
      throw core::InputError("a parameter is a list; settings are single values");
  }
}

// Parameters SECTION/KEY as "SECTION.KEY=VALUE".
void add_assignments(XmlRpc::XmlRpcValue& section, const std::string& path,
                     std::vector<std::string>& assignments) {
  for (auto& [key, value] : section) {
    if (value.getType() == XmlRpc::XmlRpcValue::TypeStruct) {
      add_assignments(value, path + key + ".", assignments);
    } else if (!path.empty()) {
      assignments.push_back(path + key + "=" + text_of(value));
    }
  }
}

std::vector<std::string> assignments_of(const ros::NodeHandle& own) {
  std::vector<std::string> assignments;
  XmlRpc::XmlRpcValue all;
  if (own.getParam(own.getNamespace(), all) && all.getType() == XmlRpc::XmlRpcValue::TypeStruct)
    add_assignments(all, "", assignments);
  return assignments;
}

class RosPublisher final : public node::Publisher {
 public:
  explicit RosPublisher(ros::NodeHandle& handle)
      : transforms_(advertise<messages::TFMessage>(handle, node::kTransformsTopic)),
        pose_(advertise<messages::PoseWithCovarianceStamped>(handle, node::kPoseTopic)),
        path_(advertise<messages::Path>(handle, node::kPathTopic)),
        landmarks_(advertise<messages::PointCloud2>(handle, node::kLandmarksTopic)),
        grid_(advertise<messages::OccupancyGrid>(handle, node::kGridTopic)),
        diagnostics_(advertise<messages::DiagnosticArray>(handle, node::kDiagnosticsTopic)),
        status_(advertise<messages::String>(handle, node::kStatusTopic)) {}

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
    ROS_INFO("%s", message.data.c_str());
    publish(status_, message);
  }

 private:
  template <class M>
  static ros::Publisher advertise(ros::NodeHandle& handle, const node::NodeTopic& topic) {
    return handle.advertise<M>(std::string(topic.name),
                               static_cast<std::uint32_t>(topic.quality.depth),
                               topic.quality.is_kept);
  }
  template <class M>
  static void publish(const ros::Publisher& publisher, const M& message) {
    if (ros::ok()) publisher.publish(message);
  }

  ros::Publisher transforms_;
  ros::Publisher pose_;
  ros::Publisher path_;
  ros::Publisher landmarks_;
  ros::Publisher grid_;
  ros::Publisher diagnostics_;
  ros::Publisher status_;
};

// The subscriptions of a node, which end with the subscribers.
std::vector<ros::Subscriber> subscribe(ros::NodeHandle& handle, const node::Config& config,
                                       node::NodeThread& node) {
  std::vector<ros::Subscriber> subscribers;
  node::subscribe_to_inputs(config, [&]<class M>(const node::Input<M>& input) {
    const boost::function<void(const boost::shared_ptr<const M>&)> receive =
        [&node, incoming_from = input.incoming_from](const boost::shared_ptr<const M>& message) {
          try {
            node.post(incoming_from(*message));
          } catch (const core::InputError& error) {
            ROS_WARN("%s", error.what());
          }
        };
    const std::string name = handle.resolveName(std::string(input.topic.name));
    subscribers.push_back(handle.subscribe<M>(
        name + std::string(input.subtopic), static_cast<std::uint32_t>(input.topic.quality.depth),
        receive, ros::VoidConstPtr(), ros::TransportHints().tcpNoDelay()));
  });
  return subscribers;
}

// save_map, load_map and localize take the file from the parameter ~map_file.
class Services {
 public:
  Services(ros::NodeHandle& own, node::NodeThread& node) : own_(own), node_(node) {
    offer("save_map", node::CommandKind::kSaveMap);
    offer("load_map", node::CommandKind::kLoadMap);
    offer("localize", node::CommandKind::kLocalize);
    offer("reset", node::CommandKind::kReset);
    using Request = ServiceRequest<SetBool>;
    using Response = ServiceResponse<SetBool>;
    servers_.push_back(own_.advertiseService<Request, Response>(
        "pause", [this](Request& request, Response& response) {
          const auto kind = request.data ? node::CommandKind::kPause : node::CommandKind::kResume;
          return answer(node_.ask({kind, {}}), response);
        }));
  }

 private:
  template <class Response>
  static bool answer(const node::Answer& answer, Response& response) {
    response.success = answer.is_done;
    response.message = answer.text;
    return true;
  }

  void offer(const std::string& name, node::CommandKind kind) {
    using Request = ServiceRequest<Trigger>;
    using Response = ServiceResponse<Trigger>;
    servers_.push_back(own_.advertiseService<Request, Response>(
        name, [this, kind](Request& /*request*/, Response& response) {
          std::string file;
          if (kind != node::CommandKind::kReset && !own_.getParam("map_file", file))
            return answer({false, "set the parameter ~map_file first"}, response);
          return answer(node_.ask({kind, file}), response);
        }));
  }

  ros::NodeHandle& own_;
  node::NodeThread& node_;
  std::vector<ros::ServiceServer> servers_;
};

// A parameter of any single type as text; empty: it is not set.
std::string own_text(const ros::NodeHandle& own, const std::string& name) {
  XmlRpc::XmlRpcValue value;
  return own.getParam(name, value) ? text_of(value) : "";
}

// Nothing if none is wanted.
std::unique_ptr<view::LiveView> open_view(const ros::NodeHandle& own) {
  const std::string place = own_text(own, "view");
  if (place.empty() || place == "false") return nullptr;
  const std::string token = own_text(own, "view_token");
  const std::string error = token.empty() ? "" : view::token_error(token);
  if (!error.empty()) throw core::InputError("~view_token: " + error);
  auto viewer = std::make_unique<view::LiveView>(
      view::parse_place(place == "true" ? "any" : place, "~view"), token);
  core::note("look at " + viewer->url());
  return viewer;
}

int run() {
  ros::NodeHandle handle;
  ros::NodeHandle own("~");
  const auto [config, settings] = node::config_from(assignments_of(own));
  const std::string map = own.param<std::string>("map", "");
  const Options options{
      .profile = own.param<std::string>("profile", "default"),
      .settings = settings,
      .map = map,
      .map_use = own.param("localize", false) ? MapUse::kLocalize : MapUse::kExtend};
  core::catch_interrupts();
  const std::unique_ptr<view::LiveView> viewer = open_view(own);
  RosPublisher publisher(handle);
  node::NodeThread node(config, options, publisher, viewer.get());
  const std::vector<ros::Subscriber> subscribers = subscribe(handle, config, node);
  const Services services(own, node);
  constexpr std::uint32_t kThreads = 2;  // a service waits for its answer while images come
  ros::AsyncSpinner spinner(kThreads);
  spinner.start();
  constexpr double kTick_s = 0.5;
  while (ros::ok() && !core::is_interrupted()) {
    ros::WallDuration(kTick_s).sleep();
    node.post(node::Tick{});
  }
  spinner.stop();
  const std::vector<StampedPose> poses = node.finish();
  const std::string trajectory = own.param<std::string>("trajectory", "");
  if (!trajectory.empty()) node::write_trajectory(trajectory, poses);
  ros::shutdown();
  return core::kDone;
}

}  // namespace
}  // namespace samewhere::ros1

int main(int argc, char** argv) {
  using namespace samewhere;
  return core::run_program("samewhere", [&] {
    ros::init(argc, argv, "samewhere", ros::init_options::NoSigintHandler);
    return ros1::run();
  });
}
