#include <map>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/node/inputs.hpp>

namespace samewhere::node {
namespace {

using testing::ElementsAre;
using testing::IsSupersetOf;

std::vector<std::string> names_of(const Config& config) {
  std::vector<std::string> names;
  subscribe_to_inputs(config, [&](const auto& input) {
    names.push_back(std::string(input.topic.name).append(input.subtopic));
  });
  return names;
}

TEST(Inputs, AreThoseOfTheCameras) {
  EXPECT_THAT(names_of({.cameras = Cameras::kMono}),
              ElementsAre("image", "camera_info", "odom", "/tf_static", "samewhere/command"));
  EXPECT_THAT(names_of({.cameras = Cameras::kDepth, .is_compressed = true}),
              ElementsAre("image/compressed", "camera_info", "depth", "odom", "/tf_static",
                          "samewhere/command"));
  EXPECT_THAT(names_of({.cameras = Cameras::kStereo, .is_compressed = true}),
              IsSupersetOf({"image/compressed", "camera_info", "right/image/compressed",
                            "right/camera_info"}));
}

TEST(Inputs, TransformsThatMoveAreTakenForOdometryAlone) {
  EXPECT_THAT(names_of({.odometry_from_tf = true}), testing::Contains("/tf"));
  EXPECT_THAT(names_of({}), testing::Not(testing::Contains("/tf")));
}

TEST(Inputs, ImagesAloneAreReliableWhereThatIsAsked) {
  for (const bool is_reliable : {false, true}) {
    std::map<std::string, bool> reliable;
    subscribe_to_inputs({.cameras = Cameras::kDepth, .is_reliable = is_reliable},
                        [&](const auto& input) {
                          reliable[std::string(input.topic.name)] = input.topic.quality.is_reliable;
                        });
    EXPECT_EQ(reliable.at("image"), is_reliable);
    EXPECT_EQ(reliable.at("depth"), is_reliable);
    EXPECT_FALSE(reliable.at("camera_info"));
    EXPECT_TRUE(reliable.at("samewhere/command"));
  }
}

// What the node takes of each topic: the index in Incoming, and the stream.
template <class In, class Message>
In incoming(const Input<Message>& input, const Message& message = {}) {
  return std::get<In>(input.incoming_from(message));
}

TEST(Inputs, MessagesKeepTheirStreams) {
  std::map<std::string, Stream> streams;
  const auto subscribe = [&]<class Message>(const Input<Message>& input) {
    const std::string name = std::string(input.topic.name).append(input.subtopic);
    const Incoming in = input.incoming_from(Message{});
    if (const auto* image = std::get_if<ImageIn>(&in)) streams[name] = image->stream;
    if (const auto* info = std::get_if<CameraInfoIn>(&in)) streams[name] = info->stream;
  };
  const auto subscribe_but_commands = [&]<class Message>(const Input<Message>& input) {
    if constexpr (!std::is_same_v<Message, messages::String>) subscribe(input);
  };
  subscribe_to_inputs({.cameras = Cameras::kStereo}, subscribe_but_commands);
  subscribe_to_inputs({.cameras = Cameras::kDepth, .is_compressed = true}, subscribe_but_commands);
  EXPECT_EQ(streams, (std::map<std::string, Stream>{{"image", Stream::kFirst},
                                                    {"image/compressed", Stream::kFirst},
                                                    {"camera_info", Stream::kFirst},
                                                    {"depth", Stream::kSecond},
                                                    {"right/image", Stream::kSecond},
                                                    {"right/camera_info", Stream::kSecond}}));
}

TEST(Inputs, MessagesKeepTheirContent) {
  EXPECT_TRUE(incoming<TransformsIn>(transforms_input(kStaticTransformsTopic, true)).is_static);
  EXPECT_FALSE(incoming<TransformsIn>(transforms_input(kTransformsTopic, false)).is_static);
  const messages::Odometry odometry{.child_frame_id = "base"};
  EXPECT_EQ(incoming<OdometryIn>(odometry_input(), odometry).message.child_frame_id, "base");
  EXPECT_EQ(incoming<CommandIn>(command_input(), {"save_map a.sw"}).command.file, "a.sw");
  EXPECT_THROW(incoming<CommandIn>(command_input(), {"no command"}), core::InputError);
}

}  // namespace
}  // namespace samewhere::node
