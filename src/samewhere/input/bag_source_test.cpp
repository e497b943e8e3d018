#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <samewhere/bags/bag.hpp>
#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>
#include <samewhere/input/bag_poses.hpp>
#include <samewhere/input/bag_source.hpp>
#include <samewhere/input/test_folder.hpp>

namespace samewhere::input {
namespace {

using core::InputError;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

// A bag that is written message by message.
class WrittenBag {
 public:
  explicit WrittenBag(const std::filesystem::path& path)
      : path_(path), bag_(bags::make_bag(path, bags::BagFormat::kMcap, bags::Compression::kNone)) {}

  WrittenBag& color(double stamp_s, int size_px = 8, const char* frame = "camera") {
    return picture(color_, "/camera/image_raw", stamp_s, size_px, frame, "mono8");
  }
  WrittenBag& depth(double stamp_s) {
    return picture(depth_, "/camera/depth/image", stamp_s, 8, "camera", "16UC1");
  }
  WrittenBag& right(double stamp_s) {
    return picture(right_, "/right/image_raw", stamp_s, 8, "right_camera", "mono8");
  }
  WrittenBag& info(const char* topic = "/camera/camera_info", std::uint32_t width = 8) {
    messages::CameraInfo info;
    info.width = width;
    info.height = 8;
    info.distortion_model = "plumb_bob";
    info.d = {0, 0, 0, 0, 0};
    info.k = {8, 0, 3.5, 0, 8, 3.5, 0, 0, 1};
    info.p = {8, 0, 3.5, 0, 0, 8, 3.5, 0, 0, 0, 1, 0};
    bag_->write_message(bag_->add_topic<messages::CameraInfo>(topic), 0, info);
    return *this;
  }
  WrittenBag& pose(double stamp_s, double x_m, const char* child) {
    if (odometry_ < 0) odometry_ = bag_->add_topic<messages::Odometry>("/odom");
    messages::Odometry odometry;
    odometry.header.stamp = messages::time_of(stamp_s);
    odometry.child_frame_id = child;
    odometry.pose.pose.position.x = x_m;
    bag_->write_message(odometry_, time_ns(stamp_s), odometry);
    return *this;
  }
  WrittenBag& fixed(const char* parent, const char* child, double x_m) {
    messages::TransformStamped transform;
    transform.header.frame_id = parent;
    transform.child_frame_id = child;
    transform.transform.translation.x = x_m;
    bag_->write_message(bag_->add_topic<messages::TFMessage>("/tf_static", true), 0,
                        messages::TFMessage{{transform}});
    return *this;
  }
  void finish() { bag_->finish(); }
  const std::filesystem::path& path() const { return path_; }

 private:
  static std::int64_t time_ns(double stamp_s) {
    return messages::nanoseconds(messages::time_of(stamp_s));
  }

  WrittenBag& picture(int& topic, const char* name, double stamp_s, int size_px, const char* frame,
                      const char* encoding) {
    if (topic < 0) topic = bag_->add_topic<messages::Image>(name);
    messages::Image image;
    image.header = {.stamp = messages::time_of(stamp_s), .frame_id = frame};
    image.encoding = encoding;
    image.width = image.height = static_cast<std::uint32_t>(size_px);
    const std::uint32_t bytes_per_pixel = image.encoding == "mono8" ? 1 : 2;
    image.step = image.width * bytes_per_pixel;
    image.data.assign(image.step * image.height, 1);
    // recorded in the order of the calls
    bag_->write_message(topic, ++num_messages_ * 1000, image);
    return *this;
  }

  std::filesystem::path path_;
  std::unique_ptr<bags::BagWriter> bag_;
  int color_ = -1;
  int depth_ = -1;
  int right_ = -1;
  int odometry_ = -1;
  std::int64_t num_messages_ = 0;
};

struct GivenFrames {
  std::vector<double> stamps_s;
  std::vector<bool> have_depth;
  std::string error;
};

GivenFrames frames_of(const std::filesystem::path& path, const Config& config = {}) {
  GivenFrames given;
  const auto source = open_bag_source(path, config);
  try {
    while (const auto frame = source->next()) {
      given.stamps_s.push_back(frame->stamp_s);
      given.have_depth.push_back(frame->depth_m.has_value());
    }
  } catch (const InputError& error) {
    given.error = error.what();
  }
  return given;
}

TEST(BagSource, PicturesThatWereRecordedLateComeInTheOrderOfTheirStamps) {
  const TestFolder folder;
  WrittenBag bag(folder.at("a.mcap"));
  bag.color(0.1).color(0.3).color(0.2).color(0.2).color(0.4).finish();
  EXPECT_THAT(frames_of(bag.path()).stamps_s, ElementsAre(0.1, 0.2, 0.3, 0.4));
}

TEST(BagSource, DepthBelongsToTheNearestPictureInTime) {
  const TestFolder folder;
  WrittenBag bag(folder.at("a.mcap"));
  bag.depth(0.101)
      .color(0.1)
      .color(0.2)
      .depth(0.215)
      .color(0.21)
      .color(0.4)
      .depth(0.45)
      .color(0.5)
      .finish();
  const GivenFrames given = frames_of(bag.path());
  EXPECT_THAT(given.stamps_s, ElementsAre(0.1, 0.2, 0.21, 0.4, 0.5));
  EXPECT_THAT(given.have_depth, ElementsAre(true, false, true, false, false));
}

TEST(BagSource, WithoutDepthItIsNotRead) {
  const TestFolder folder;
  WrittenBag bag(folder.at("a.mcap"));
  bag.color(0.1).depth(0.1).color(0.2).depth(0.2).finish();
  Config config;
  config.depth = false;
  EXPECT_THAT(frames_of(bag.path(), config).have_depth, ElementsAre(false, false));
  EXPECT_FALSE(open_bag_source(bag.path(), config)->info().has_depth);
}

TEST(BagSource, TheCalibrationIsThatOfTheMessages) {
  const TestFolder folder;
  WrittenBag bag(folder.at("a.mcap"));
  bag.info().color(0.1).color(0.2).finish();
  const auto source = open_bag_source(bag.path(), {});
  EXPECT_TRUE(source->info().is_calibrated);
  EXPECT_EQ(source->info().num_frames, 2);
  EXPECT_NEAR(source->info().frame_rate_hz, 10.0, 1e-6);
  const auto frame = source->next();
  EXPECT_EQ(std::get<core::PinholeRadtan>(frame->rig->cameras[0]).fx_px, 8.0);
}

TEST(BagSource, ACalibrationOfOtherPicturesIsRefusedOrLeftOut) {
  const TestFolder folder;
  WrittenBag bag(folder.at("a.mcap"));
  bag.info("/camera/camera_info", 16).color(0.1).finish();
  EXPECT_THROW(open_bag_source(bag.path(), {}), InputError);
  Config config;
  config.needs_calibration = false;
  EXPECT_FALSE(open_bag_source(bag.path(), config)->info().is_calibrated);
}

TEST(BagSource, APairHangsTogetherByTransforms) {
  const TestFolder folder;
  WrittenBag bag(folder.at("a.mcap"));
  bag.info().info("/right/camera_info").fixed("camera", "right_camera", 0.1);
  bag.color(0.1).right(0.1).color(0.2).color(0.3).right(0.3).finish();
  Config config;
  config.topics = "color=/camera/image_raw right=/right/image_raw";
  const auto source = open_bag_source(bag.path(), config);
  EXPECT_EQ(source->info().num_cameras, 2);
  const auto frame = source->next();
  EXPECT_DOUBLE_EQ(frame->rig->body_from_camera[1].translation.x(), 0.1);
  EXPECT_THAT(frames_of(bag.path(), config).stamps_s, ElementsAre(0.1, 0.3))
      << "without a partner: left out";
}

TEST(BagSource, FaultsOfMessagesAreToldInOneLine) {
  const TestFolder folder;
  const auto error_of = [](WrittenBag& bag) {
    bag.finish();
    return frames_of(bag.path()).error;
  };
  WrittenBag sizes(folder.at("sizes.mcap"));
  EXPECT_THAT(error_of(sizes.color(0.1).color(0.2, 9).color(0.3)),
              HasSubstr("is 9 x 9 pixels, expected 8 x 8"));
  WrittenBag cameras(folder.at("cameras.mcap"));
  EXPECT_THAT(error_of(cameras.color(0.1).color(0.2, 8, "other").color(0.3)),
              HasSubstr("expected one camera on a topic"));
  WrittenBag clocks(folder.at("clocks.mcap"));
  for (int i = 0; i < 40; ++i) clocks.color(10.0 + i * 0.1);
  EXPECT_THAT(error_of(clocks.color(1.0).color(1.1)), HasSubstr("expected stamps that rise"));
}

TEST(BagSource, ACutFileGivesTheFramesBeforeAndSaysSo) {
  const TestFolder folder;
  WrittenBag bag(folder.at("a.mcap"));
  for (int i = 0; i < 20'000; ++i) bag.color(0.1 * i, 16);
  bag.finish();
  const std::string whole = core::read_file(bag.path());
  core::write_file(bag.path(), whole.substr(0, whole.size() * 9 / 10));
  const GivenFrames given = frames_of(bag.path());
  EXPECT_GT(given.stamps_s.size(), 1000U);
  EXPECT_LT(given.stamps_s.size(), 20'000U);
  EXPECT_THAT(given.error, HasSubstr("is cut or damaged at byte"));
}

TEST(BagOdometry, IsThatOfTheCamera) {
  const TestFolder folder;
  WrittenBag bag(folder.at("a.mcap"));
  bag.fixed("base_link", "camera", 0.5).color(0.1);
  bag.pose(0.1, 1.0, "base_link").pose(0.2, 2.0, "base_link").pose(0.2, 2.5, "base_link").finish();
  const OdometryRows rows = read_odometry(bag.path());
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_DOUBLE_EQ(rows[1].world_from_body.translation.x(), 2.5);
  EXPECT_FALSE(rows[1].covariance);
  EXPECT_THROW(read_odometry(bag.path(), "odometry=/none"), InputError);
}

}  // namespace
}  // namespace samewhere::input
