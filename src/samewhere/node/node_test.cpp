#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>
#include <samewhere/input/test_folder.hpp>
#include <samewhere/node/node.hpp>
#include <samewhere/node/node_thread.hpp>
#include <samewhere/node/test_messages.hpp>

namespace samewhere::node {
namespace {

using testing::Contains;
using testing::HasSubstr;

// What Slam gives for the same frames.
std::vector<Tracked> tracked_alone(const Pose& body_from_camera) {
  const library::TestWalk& walk = library::test_walk();
  Calibration calibration = walk.calibration;
  calibration.cameras[0].body_from_camera = body_from_camera;
  Slam slam(calibration, test_node_options());
  std::vector<Tracked> all;
  for (std::size_t i = 0; i < walk.frames.size(); ++i) {
    Frame frame = walk.at(i);
    frame.stamp_s = messages::seconds(messages::time_of(frame.stamp_s));
    all.push_back(slam.track(frame));
  }
  return all;
}

Pose pose_of_transform(const messages::TransformStamped& transform) {
  return *pose_from(transform.transform.translation, transform.transform.rotation);
}

Pose camera_on_mast() {
  Pose pose = body_from_optical();
  pose.translation() << 0.2, 0.05, 1.1;
  return pose;
}

std::string value_of(const messages::DiagnosticStatus& status, const std::string& key) {
  for (const messages::KeyValue& value : status.values)
    if (value.key == key) return value.value;
  return "";
}

std::string last_state(const TestPublisher& publisher, const std::string& key) {
  for (auto status = publisher.of_diagnostics.rbegin(); status != publisher.of_diagnostics.rend();
       ++status) {
    if (status->name == "samewhere: state") return value_of(*status, key);
  }
  return "";
}

TEST(Node, TransformsChainToThePoseThatSlamMeasures) {
  const MessageWalk walk;
  TestPublisher publisher;
  Node node(test_node_config(), test_node_options(), publisher);
  node.take(TransformsIn{transform_of("base_link", kCameraFrame, camera_on_mast()), true});
  play(node, walk);
  const std::vector<Tracked> expected = tracked_alone(camera_on_mast());
  ASSERT_EQ(publisher.of_transforms.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const auto& transforms = publisher.of_transforms[i].transforms;
    ASSERT_EQ(transforms.size(), 2U);
    EXPECT_EQ(transforms[0].header.frame_id, "map");
    EXPECT_EQ(transforms[0].child_frame_id, "odom");
    EXPECT_EQ(transforms[1].header.frame_id, "odom");
    EXPECT_EQ(transforms[1].child_frame_id, "base_link");
    EXPECT_NEAR(messages::seconds(transforms[1].header.stamp), walk.stamp_s(i), 1e-9);
    const Pose map_from_camera =
        pose_of_transform(transforms[0]) * pose_of_transform(transforms[1]) * camera_on_mast();
    EXPECT_LT((map_from_camera.matrix() - expected[i].map_from_camera().matrix()).norm(), 1e-9);
  }
  EXPECT_THAT(publisher.of_status, Contains("tracking"));
  EXPECT_EQ(node.counts().num_frames, walk.size());
  EXPECT_EQ(node.counts().num_refused, 0U);
}

// A rendered walk with a stereo pair.
class StereoWalk {
 public:
  StereoWalk() : walk_(library::read_walk(config())) {
    const core::Rig& rig = *walk_.frames[0].rig;
    const core::Rigid3 left_from_right =
        core::inverse(rig.body_from_camera[0]) * rig.body_from_camera[1];
    baseline_m_ = left_from_right.translation.x();
    right_ = library::camera_of(rig.cameras[1], walk_.frames[0].images[1].cols,
                                walk_.frames[0].images[1].rows);
  }

  CameraInfoIn info() const { return {Stream::kFirst, info_message(left())}; }
  CameraInfoIn right_info() const {
    CameraInfoIn in{Stream::kSecond, info_message(right_)};
    in.message.p[3] = -in.message.p[0] * baseline_m_;
    return in;
  }
  ImageIn image(std::size_t i) const { return image_in(Stream::kFirst, i); }
  ImageIn right_image(std::size_t i) const { return image_in(Stream::kSecond, i); }
  std::size_t size() const { return walk_.frames.size(); }

  // What Slam gives for the same frames.
  std::vector<Tracked> tracked_alone() const {
    Calibration calibration = walk_.calibration;
    calibration.has_depth = false;
    calibration.cameras[0].body_from_camera = body_from_optical();
    calibration.cameras.push_back(right_);
    calibration.cameras[1].body_from_camera = body_from_optical();
    calibration.cameras[1].body_from_camera.translate(Eigen::Vector3d(baseline_m_, 0, 0));
    Slam slam(calibration, test_node_options());
    std::vector<Tracked> all;
    for (std::size_t i = 0; i < walk_.frames.size(); ++i) {
      Frame frame = walk_.at(i);
      frame.stamp_s = messages::seconds(messages::time_of(frame.stamp_s));
      frame.images.push_back(
          library::TestWalk::view_of(walk_.frames[i].images[1], frame.images[0].format));
      all.push_back(slam.track(frame));
    }
    return all;
  }

 private:
  static pipeline::Config config() {
    constexpr int kNumFrames = 8;
    pipeline::Config config = library::test_config(kNumFrames);
    config.source = "twin:office-loop?seed=5&camera=stereo";
    return config;
  }
  const Camera& left() const { return walk_.calibration.cameras[0]; }
  ImageIn image_in(Stream stream, std::size_t i) const {
    const core::Frame& frame = walk_.frames[i];
    return {stream,
            image_message(frame.images[stream == Stream::kFirst ? 0 : 1], "bgr8", frame.stamp_s)};
  }

  library::TestWalk walk_;
  Camera right_;
  double baseline_m_ = 0.0;
};

TEST(Node, TracksAStereoPairAsSlamDoes) {
  const StereoWalk walk;
  TestPublisher publisher;
  Config config = test_node_config();
  config.cameras = Cameras::kStereo;
  Node node(config, test_node_options(), publisher);
  node.take(walk.info());
  node.take(walk.image(0));
  node.take(walk.right_image(0));
  EXPECT_EQ(publisher.of_status.back(), "waiting for right/camera_info");
  node.take(walk.right_info());
  for (std::size_t i = 1; i < walk.size(); ++i) {
    node.take(walk.right_image(i));  // the other order
    node.take(walk.image(i));
  }
  EXPECT_EQ(node.counts().num_frames, walk.size());
  EXPECT_EQ(node.counts().num_refused, 0U) << node.counts().last_refusal;
  EXPECT_EQ(last_state(publisher, "scale"), "metres");
  const std::vector<Tracked> expected = walk.tracked_alone();
  ASSERT_EQ(publisher.of_transforms.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    ASSERT_TRUE(expected[i].has_pose()) << i;
    const auto& transforms = publisher.of_transforms[i].transforms;
    const Pose map_from_camera =
        pose_of_transform(transforms[0]) * pose_of_transform(transforms[1]);
    EXPECT_LT((map_from_camera.matrix() - expected[i].map_from_camera().matrix()).norm(), 1e-6);
  }
}

messages::CompressedImage png_message(const input::TestFolder& folder, const ImageIn& in) {
  const auto& image = std::get<messages::Image>(in.message);
  const cv::Mat pixels(static_cast<int>(image.height), static_cast<int>(image.width), CV_8UC3,
                       const_cast<std::uint8_t*>(image.data.data()), image.step);
  folder.write_png("a.png", pixels);
  const std::string bytes = core::read_file(folder.at("a.png"));
  return {image.header, "bgr8; png compressed bgr8", {bytes.begin(), bytes.end()}};
}

TEST(Node, TracksCompressedImagesAsItTracksPlainOnes) {
  constexpr std::size_t kNumFrames = 12;
  const MessageWalk walk;
  const input::TestFolder folder;
  TestPublisher of_plain;
  TestPublisher of_compressed;
  Node plain(test_node_config(), test_node_options(), of_plain);
  Node compressed(test_node_config(), test_node_options(), of_compressed);
  plain.take(walk.info());
  compressed.take(walk.info());
  for (std::size_t i = 0; i < kNumFrames; ++i) {
    plain.take(walk.image(i));
    plain.take(walk.depth(i));
    compressed.take(ImageIn{Stream::kFirst, png_message(folder, walk.image(i))});
    compressed.take(walk.depth(i));
  }
  EXPECT_EQ(compressed.counts().num_frames, kNumFrames);
  EXPECT_EQ(of_compressed.of_status.back(), "tracking");
  ASSERT_EQ(of_plain.of_transforms.size(), kNumFrames);
  ASSERT_EQ(of_compressed.of_transforms.size(), kNumFrames);
  for (std::size_t i = 0; i < kNumFrames; ++i)
    EXPECT_EQ(messages::write_message(of_compressed.of_transforms[i], messages::Layout::kCdr),
              messages::write_message(of_plain.of_transforms[i], messages::Layout::kCdr));
}

TEST(Node, LateImagesAreDroppedAndAnEarlierClockNeedsAReset) {
  const MessageWalk walk;
  TestPublisher publisher;
  Node node(test_node_config(), test_node_options(), publisher);
  node.take(walk.info());
  const auto play_frame = [&](std::size_t i) {
    node.take(walk.image(i));
    node.take(walk.depth(i));
  };
  for (const std::size_t i : {0, 1, 2, 3}) play_frame(i);
  play_frame(2);
  EXPECT_EQ(node.counts().num_frames, 4U);
  EXPECT_EQ(node.counts().num_dropped, 2U);
  EXPECT_EQ(node.counts().num_refused, 0U);
  play_frame(walk.size() - 1);
  ASSERT_GT(walk.stamp_s(walk.size() - 1), walk.stamp_s(1) + 1.0);
  play_frame(0);
  EXPECT_EQ(node.counts().num_frames, 5U);
  EXPECT_EQ(node.counts().num_refused, 1U);
  EXPECT_THAT(node.counts().last_refusal, HasSubstr("expected a later one"));
  node.take(CommandIn{{CommandKind::kReset, {}}, nullptr});
  play_frame(1);
  EXPECT_EQ(node.counts().num_frames, 6U);
}

TEST(Node, WithoutStaticTransformsTheMapHasTheAxesOfARobot) {
  TestPublisher publisher;
  Node node(test_node_config(), test_node_options(), publisher);
  play(node, MessageWalk());
  ASSERT_FALSE(publisher.of_transforms.empty());
  const auto& first = publisher.of_transforms.front().transforms;
  EXPECT_EQ(first[1].child_frame_id, kCameraFrame);
  const Pose map_from_camera = pose_of_transform(first[0]) * pose_of_transform(first[1]);
  EXPECT_LT((map_from_camera.matrix() - body_from_optical().matrix()).norm(), 1e-9);
}

TEST(Node, TellsEveryLoopVerdictWithItsReason) {
  TestPublisher publisher;
  Node node(test_node_config(), test_node_options(), publisher);
  play(node, MessageWalk());
  const auto trajectory = node.finish();
  EXPECT_EQ(trajectory.size(), MessageWalk().size());
  int num_accepted = 0;
  int num_verdicts = 0;
  for (const auto& status : publisher.of_diagnostics) {
    if (status.name != "samewhere: loop candidate") continue;
    ++num_verdicts;
    EXPECT_NE(value_of(status, "query"), "");
    EXPECT_GT(status.message.size(), value_of(status, "decision").size()) << "has a reason";
    if (value_of(status, "decision") == "accepted") ++num_accepted;
  }
  EXPECT_GT(num_verdicts, 0);
  EXPECT_GT(num_accepted, 0);
}

TEST(Node, GivesPathAndLandmarksOfTheMap) {
  TestPublisher publisher;
  Node node(test_node_config(), test_node_options(), publisher);
  play(node, MessageWalk());
  ASSERT_FALSE(publisher.of_paths.empty());
  ASSERT_FALSE(publisher.of_landmarks.empty());
  EXPECT_GT(publisher.of_paths.back().poses.size(), 3U);
  const messages::PointCloud2& cloud = publisher.of_landmarks.back();
  EXPECT_EQ(cloud.header.frame_id, "map");
  EXPECT_GT(cloud.width, 50U);
  EXPECT_EQ(cloud.data.size(), std::size_t{cloud.width} * cloud.point_step);
  ASSERT_EQ(cloud.fields_of_point.size(), 4U);
  EXPECT_EQ(cloud.fields_of_point[3].offset, 12U);
}

TEST(Node, MessagesThatAreNotUsableDoNotStopIt) {
  const MessageWalk walk;
  TestPublisher publisher;
  Node node(test_node_config(), test_node_options(), publisher);
  node.take(CameraInfoIn{});
  messages::TFMessage broken = transform_of("a", "b", Pose::Identity());
  broken.transforms[0].transform.rotation.w = 0.0;
  node.take(TransformsIn{broken, true});
  node.take(OdometryIn{});
  node.take(walk.info());
  for (std::size_t i = 0; i < walk.size(); ++i) {
    ImageIn image = walk.image(i);
    auto& message = std::get<messages::Image>(image.message);
    if (i == 5) message.encoding = "no_such_encoding";
    if (i == 6) message.data.resize(10);
    if (i == 7) message.width = 0;
    if (i == 8) message.height /= 2;
    if (i == 9) image.message = messages::CompressedImage{.header = message.header};
    node.take(std::move(image));
    node.take(walk.depth(i));
  }
  constexpr std::uint64_t kNumBad = 8;
  EXPECT_EQ(node.counts().num_refused, kNumBad);
  EXPECT_EQ(node.counts().num_frames, walk.size() - 5);
  EXPECT_NE(node.counts().last_refusal, "");
  EXPECT_EQ(publisher.of_status.back(), "tracking");
}

TEST(Node, SaysWhatItWaitsFor) {
  const MessageWalk walk;
  TestPublisher publisher;
  Config config = test_node_config();
  config.tf_wait_s = 100.0;
  Node node(config, test_node_options(), publisher);
  EXPECT_EQ(publisher.of_status.back(), "waiting for images");
  node.take(walk.image(0));
  node.take(walk.depth(0));
  EXPECT_EQ(publisher.of_status.back(), "waiting for camera_info");
  node.take(walk.info());
  node.take(walk.image(1));
  node.take(walk.depth(1));
  EXPECT_THAT(publisher.of_status.back(), HasSubstr("waiting for /tf_static"));
  node.take(TransformsIn{transform_of("base_link", kCameraFrame, camera_on_mast()), true});
  node.take(walk.image(2));
  node.take(walk.depth(2));
  EXPECT_EQ(node.counts().num_frames, 3U);
}

TEST(Node, MeasuresTheFrameRateWhereItIsNotTold) {
  const MessageWalk walk;
  TestPublisher publisher;
  Config config = test_node_config();
  config.frame_rate_hz = 0.0;
  Node node(config, test_node_options(), publisher);
  node.take(walk.info());
  for (std::size_t i = 0; i < 10; ++i) {
    node.take(walk.image(i));
    node.take(walk.depth(i));
  }
  EXPECT_THAT(publisher.of_status, Contains("measuring the frame rate"));
  EXPECT_EQ(node.counts().num_frames, 10U);
  EXPECT_EQ(node.counts().num_dropped, 0U);
}

TEST(Node, CorrectsOdometryFromElsewhere) {
  const MessageWalk walk;
  TestPublisher publisher;
  Node node(test_node_config(), test_node_options(), publisher);
  node.take(TransformsIn{transform_of("base_link", kCameraFrame, camera_on_mast()), true});
  node.take(walk.info());
  for (std::size_t i = 0; i < 12; ++i) {
    messages::Odometry odometry{.header = {messages::time_of(walk.stamp_s(i)), "odom"},
                                .child_frame_id = "base_link"};
    odometry.pose.pose.position.x = 5.0 + static_cast<double>(i);
    if (i % 2 == 0) node.take(OdometryIn{odometry});
    node.take(walk.image(i));
    node.take(walk.depth(i));
    if (i % 2 == 1) node.take(OdometryIn{odometry});  // later than its image
  }
  ASSERT_EQ(publisher.of_transforms.size(), 12U);
  for (std::size_t i = 0; i < 12; ++i) {
    const auto& transforms = publisher.of_transforms[i].transforms;
    ASSERT_EQ(transforms.size(), 1U);
    EXPECT_EQ(transforms[0].child_frame_id, "odom");
    Pose odom_from_base = Pose::Identity();
    odom_from_base.translation().x() = 5.0 + static_cast<double>(i);
    const Pose map_from_base = pose_of_transform(transforms[0]) * odom_from_base;
    const auto& pose = publisher.of_poses[i].pose.pose;
    EXPECT_LT(
        (map_from_base.matrix() - pose_from(pose.position, pose.orientation)->matrix()).norm(),
        1e-9);
  }
}

TEST(Node, SavesLoadsLocalizesAndResets) {
  const MessageWalk walk;
  const input::TestFolder folder;
  const std::string map = folder.at("office.sw").string();
  TestPublisher publisher;
  Node node(test_node_config(), test_node_options(), publisher);
  const auto ask = [&](const std::string& text) {
    const auto answer = std::make_shared<core::Channel<Answer>>(1);
    node.take(CommandIn{command_from(text), answer});
    return *answer->receive();
  };
  EXPECT_FALSE(ask("save_map " + map).is_done) << "there is no map yet";
  play(node, walk);
  EXPECT_TRUE(ask("pause").is_done);
  EXPECT_TRUE(ask("resume").is_done);
  EXPECT_TRUE(ask("save_map " + map).is_done);
  EXPECT_FALSE(ask("save_map " + map).is_done) << "is there already";
  EXPECT_FALSE(ask("localize " + map + ".none").is_done);
  EXPECT_TRUE(ask("localize " + map).is_done);
  node.take(Tick{});
  play(node, walk);
  EXPECT_THAT(publisher.of_status, Contains("lost"));
  EXPECT_NE(publisher.of_status.back(), "lost") << "relocalized, if not confirmed so early";
  EXPECT_TRUE(ask("reset").is_done);
  play(node, walk);
  EXPECT_EQ(node.counts().num_frames, 3 * walk.size());
  EXPECT_EQ(last_state(publisher, "mapping"), "on");
}

TEST(Node, OdometryDoesNotJumpAtAReset) {
  const MessageWalk walk;
  TestPublisher publisher;
  Node node(test_node_config(), test_node_options(), publisher);
  play(node, walk);
  node.take(CommandIn{{CommandKind::kReset, {}}, nullptr});
  const std::size_t num_before = publisher.of_transforms.size();
  play(node, walk);
  const auto odom_from_base = [&](std::size_t i) {
    return pose_of_transform(publisher.of_transforms[i].transforms[1]);
  };
  EXPECT_LT((odom_from_base(num_before - 1).matrix() - odom_from_base(num_before).matrix()).norm(),
            1e-9);
}

TEST(Command, IsReadFromText) {
  EXPECT_EQ(command_from("save_map /tmp/a map.sw\n").file, "/tmp/a map.sw");
  EXPECT_EQ(command_from(" pause ").kind, CommandKind::kPause);
  for (const char* text : {"", "save_map", "reset now", "resume_all"})
    EXPECT_THROW(command_from(text), core::InputError) << text;
}

TEST(NodeThread, DropsImagesThatComeTooFastAndCountsThem) {
  const MessageWalk walk;
  TestPublisher publisher;
  Config config = test_node_config();
  config.queue_frames = 2;
  NodeThread node(config, test_node_options(), publisher);
  EXPECT_TRUE(node.post(walk.info()));
  for (std::size_t i = 0; i < walk.size(); ++i) {
    EXPECT_TRUE(node.post(walk.image(i)));
    EXPECT_TRUE(node.post(walk.depth(i)));
  }
  EXPECT_TRUE(node.ask({CommandKind::kPause, {}}).is_done);
  EXPECT_GE(node.finish().size(), 1U);
  EXPECT_NE(last_state(publisher, "images_dropped"), "0");
  EXPECT_FALSE(node.ask({CommandKind::kResume, {}}).is_done) << "the node has ended";
}

}  // namespace
}  // namespace samewhere::node
