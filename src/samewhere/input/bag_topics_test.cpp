#include <optional>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/input/bag_topics.hpp>

namespace samewhere::input {
namespace {

using ::testing::HasSubstr;

struct ListedTopics {
  std::vector<bags::Topic> topics;
  std::vector<std::optional<FirstImage>> first;

  ListedTopics& image(const char* name, const char* encoding, const char* frame = "camera") {
    topics.push_back({name, "sensor_msgs/Image", "cdr", "", 10});
    first.emplace_back(FirstImage{encoding, frame});
    return *this;
  }
  ListedTopics& compressed(const char* name, const char* format, const char* frame = "camera") {
    topics.push_back({name, "sensor_msgs/CompressedImage", "cdr", "", 10});
    first.emplace_back(FirstImage{format, frame});
    return *this;
  }
  ListedTopics& other(const char* name, const char* type) {
    topics.push_back({name, type, "cdr", "", 10});
    first.emplace_back();
    return *this;
  }
  BagTopics choose(const std::string& wanted = {}) const {
    return choose_topics("a.mcap", topics, first, wanted);
  }
  std::string name(int topic) const {
    return topic < 0 ? "" : topics[static_cast<std::size_t>(topic)].name;
  }
  std::string refusal(const std::string& wanted = {}) const {
    try {
      choose(wanted);
    } catch (const core::InputError& error) {
      return error.what();
    }
    return {};
  }
};

TEST(BagTopics, OfADepthCameraAreFound) {
  ListedTopics bag;
  bag.image("/camera/color/image_raw", "rgb8")
      .other("/camera/color/camera_info", "sensor_msgs/CameraInfo");
  bag.image("/camera/depth/image_rect_raw", "16UC1", "depth_optical_frame");
  bag.image("/camera/aligned_depth_to_color/image_raw", "16UC1");
  bag.image("/camera/infra1/image_rect_raw", "mono8", "infra")
      .compressed("/camera/color/image_raw/compressed", "rgb8; jpeg compressed bgr8");
  bag.other("/camera/imu", "sensor_msgs/Imu")
      .other("/odom", "nav_msgs/Odometry")
      .other("/tf", "tf2_msgs/TFMessage");
  const BagTopics chosen = bag.choose();
  EXPECT_EQ(bag.name(chosen.color), "/camera/color/image_raw");
  EXPECT_EQ(bag.name(chosen.camera_info), "/camera/color/camera_info");
  EXPECT_EQ(bag.name(chosen.depth), "/camera/aligned_depth_to_color/image_raw");
  EXPECT_EQ(bag.name(chosen.imu), "/camera/imu");
  EXPECT_EQ(bag.name(chosen.odometry), "/odom");
  EXPECT_EQ(chosen.right, -1);
  EXPECT_EQ(chosen.truth, -1);
}

TEST(BagTopics, OfAPairAreFoundLeftFirst) {
  ListedTopics bag;
  bag.image("/cam1/image_raw", "mono8", "right").image("/cam0/image_raw", "mono8", "left");
  bag.other("/cam0/camera_info", "sensor_msgs/CameraInfo")
      .other("/cam1/camera_info", "sensor_msgs/CameraInfo");
  bag.other("/vicon/body", "geometry_msgs/TransformStamped");
  const BagTopics chosen = bag.choose();
  EXPECT_EQ(bag.name(chosen.color), "/cam0/image_raw");
  EXPECT_EQ(bag.name(chosen.right), "/cam1/image_raw");
  EXPECT_EQ(bag.name(chosen.right_camera_info), "/cam1/camera_info");
  EXPECT_EQ(bag.name(chosen.truth), "/vicon/body");
}

TEST(BagTopics, DepthOfAnotherCameraIsNotUsedAndThatIsSaid) {
  ListedTopics bag;
  bag.image("/rgb/image", "bgr8", "rgb").image("/depth/image", "32FC1", "ir");
  const BagTopics chosen = bag.choose();
  EXPECT_EQ(chosen.depth, -1);
  ASSERT_EQ(chosen.notes.size(), 1U);
  EXPECT_THAT(chosen.notes[0], HasSubstr("--topics depth=/depth/image"));
  EXPECT_EQ(bag.name(bag.choose("depth=/depth/image").depth), "/depth/image");
}

TEST(BagTopics, ACompressedPictureIsUsedWhereThereIsNoOther) {
  ListedTopics bag;
  bag.compressed("/camera/image_raw/compressed", "jpeg")
      .other("/camera/camera_info", "sensor_msgs/CameraInfo");
  bag.compressed("/camera/depth/image/compressedDepth", "16UC1; compressedDepth");
  const BagTopics chosen = bag.choose();
  EXPECT_EQ(bag.name(chosen.color), "/camera/image_raw/compressed");
  EXPECT_EQ(bag.name(chosen.camera_info), "/camera/camera_info");
  EXPECT_EQ(bag.name(chosen.depth), "/camera/depth/image/compressedDepth");
}

TEST(BagTopics, SeveralAnswersAreListed) {
  ListedTopics bag;
  bag.image("/front/image", "bgr8").image("/back/image", "bgr8");
  EXPECT_THAT(bag.refusal(),
              HasSubstr("a.mcap: has several topics of pictures: /front/image, /back/image"));
  EXPECT_THAT(bag.refusal(), HasSubstr("--topics color=/front/image"));
  EXPECT_EQ(bag.name(bag.choose("color=/back/image").color), "/back/image");
  EXPECT_EQ(bag.name(bag.choose("image=/back/image, depth=none").color), "/back/image");
}

TEST(BagTopics, NamesThatCannotBeAreRefused) {
  ListedTopics bag;
  bag.image("/image", "bgr8").other("/text", "std_msgs/String").other("/json", "");
  EXPECT_THAT(bag.refusal("color=/imag"),
              HasSubstr("there is no such topic, expected one of /image"));
  EXPECT_THAT(bag.refusal("color=/text"), HasSubstr("that topic has std_msgs/String"));
  EXPECT_THAT(bag.refusal("color=/json"), HasSubstr("no schema"));
  EXPECT_THAT(bag.refusal("camera=/image"), HasSubstr("expected ROLE=TOPIC"));
  EXPECT_THAT(bag.refusal("/image"), HasSubstr("expected ROLE=TOPIC"));
  EXPECT_THAT(ListedTopics().other("/text", "std_msgs/String").refusal(),
              HasSubstr("has no pictures"));
}

TEST(BagTopics, GroundTruthIsNoOdometryUnlessItIsNamed) {
  ListedTopics bag;
  bag.other("/ground_truth/odometry", "nav_msgs/Odometry");
  EXPECT_THROW(choose_odometry("a.mcap", bag.topics, ""), core::InputError);
  EXPECT_EQ(choose_odometry("a.mcap", bag.topics, "odometry=/ground_truth/odometry"), 0);
  bag.other("/wheels", "nav_msgs/Odometry");
  EXPECT_EQ(choose_odometry("a.mcap", bag.topics, ""), 1);
}

TEST(BagTopics, OdometryIsTheOnlyOneOrTheNamedOne) {
  ListedTopics bag;
  bag.other("/wheels", "nav_msgs/Odometry").other("/visual", "nav_msgs/Odometry");
  EXPECT_THROW(choose_odometry("a.mcap", bag.topics, ""), core::InputError);
  EXPECT_EQ(choose_odometry("a.mcap", bag.topics, "odometry=/visual"), 1);
  bag.topics.pop_back();
  EXPECT_EQ(choose_odometry("a.mcap", bag.topics, ""), 0);
  bag.topics.pop_back();
  EXPECT_THROW(choose_odometry("a.mcap", bag.topics, ""), core::InputError);
}

}  // namespace
}  // namespace samewhere::input
