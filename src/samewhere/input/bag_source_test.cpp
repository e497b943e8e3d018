#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>

#include <samewhere/bags/bag.hpp>
#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>
#include <samewhere/input/bag_poses.hpp>
#include <samewhere/input/bag_source.hpp>
#include <samewhere/input/test_folder.hpp>

namespace samewhere::input {
namespace {

using core::InputError;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

messages::CameraInfo test_info() {
  messages::CameraInfo info;
  info.width = 8;
  info.height = 8;
  info.distortion_model = "plumb_bob";
  info.d = {0, 0, 0, 0, 0};
  info.k = {8, 0, 3.5, 0, 8, 3.5, 0, 0, 1};
  info.p = {8, 0, 3.5, 0, 0, 8, 3.5, 0, 0, 0, 1, 0};
  return info;
}

// Of a right camera 0.25 m beside the left, a quarter of a turn about the optical axis against it.
messages::CameraInfo right_info() {
  messages::CameraInfo info = test_info();
  info.r = {0, -1, 0, 1, 0, 0, 0, 0, 1};
  info.p[3] = -0.25 * info.p[0];
  return info;
}

// A bag that is written message by message.
class WrittenBag {
 public:
  explicit WrittenBag(const std::filesystem::path& path)
      : path_(path), bag_(bags::make_bag(path, bags::BagFormat::kMcap, bags::Compression::kNone)) {}

  WrittenBag& color(double stamp_s, int size_px = 8, const char* frame = "camera") {
    return picture("/camera/image_raw", stamp_s, size_px, frame, "mono8");
  }
  WrittenBag& depth(double stamp_s, int size_px = 8) {
    return picture("/camera/depth/image", stamp_s, size_px, "camera", "16UC1");
  }
  WrittenBag& right(double stamp_s, int size_px = 8) {
    return picture("/right/image_raw", stamp_s, size_px, "right_camera", "mono8");
  }
  WrittenBag& picture(const std::string& topic, double stamp_s, int size_px, const char* frame,
                      const char* encoding) {
    messages::Image image;
    image.header = {.stamp = messages::time_of(stamp_s), .frame_id = frame};
    image.encoding = encoding;
    image.width = image.height = static_cast<std::uint32_t>(size_px);
    const std::uint32_t bytes_per_pixel = image.encoding == "16UC1" ? 2 : 1;
    image.step = image.width * bytes_per_pixel;
    image.data.assign(std::size_t{image.step} * image.height, 1);
    return write(topic, image);
  }
  // As image_transport sends it: a PNG, behind twelve bytes where it is depth.
  WrittenBag& compressed(const std::string& topic, double stamp_s, const char* format,
                         const cv::Mat& content) {
    messages::CompressedImage image;
    image.header = {.stamp = messages::time_of(stamp_s), .frame_id = "camera"};
    image.format = format;
    EXPECT_TRUE(cv::imencode(".png", content, image.data));
    if (image.format.find("compressedDepth") != std::string::npos)
      image.data.insert(image.data.begin(), 12, 0);
    return write(topic, image);
  }
  WrittenBag& info(const char* topic = "/camera/camera_info", std::uint32_t width = 8) {
    messages::CameraInfo info = test_info();
    info.width = width;
    return write(topic, info);
  }
  WrittenBag& write_info(const char* topic, const messages::CameraInfo& info) {
    return write(topic, info);
  }
  WrittenBag& pose(double stamp_s, double x_m, const char* child) {
    messages::Odometry odometry;
    odometry.header.stamp = messages::time_of(stamp_s);
    odometry.child_frame_id = child;
    odometry.pose.pose.position.x = x_m;
    return write("/odom", odometry);
  }
  WrittenBag& fixed(const char* parent, const char* child, double x_m) {
    messages::TransformStamped transform;
    transform.header.frame_id = parent;
    transform.child_frame_id = child;
    transform.transform.translation.x = x_m;
    if (!topics_.contains("/tf_static"))
      topics_["/tf_static"] = bag_->add_topic<messages::TFMessage>("/tf_static", true);
    return write("/tf_static", messages::TFMessage{{transform}});
  }
  void finish() { bag_->finish(); }
  const std::filesystem::path& path() const { return path_; }

 private:
  // Recorded in the order of the calls.
  template <class Payload>
  WrittenBag& write(const std::string& topic, const Payload& payload) {
    if (!topics_.contains(topic)) topics_[topic] = bag_->add_topic<Payload>(topic);
    bag_->write_message(topics_[topic], ++num_messages_ * 1000, payload);
    return *this;
  }

  std::filesystem::path path_;
  std::unique_ptr<bags::BagWriter> bag_;
  std::map<std::string, int> topics_;
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

TEST(BagSource, DepthMayBeginEarlierAndEndLaterThanThePictures) {
  const TestFolder folder;
  WrittenBag bag(folder.at("a.mcap"));
  for (int i = 0; i < 300; ++i) {
    bag.depth(0.01 * i);
    if (i == 100 || i == 200) bag.color(0.01 * i + 0.001);
  }
  bag.finish();
  const GivenFrames given = frames_of(bag.path());
  EXPECT_THAT(given.stamps_s, ElementsAre(1.001, 2.001));
  EXPECT_THAT(given.have_depth, ElementsAre(true, true));
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

// Left and right pictures on the topics of stereo_image_proc, with the frame of the left camera.
WrittenBag& write_pair(WrittenBag& bag, const std::string& name,
                       const messages::CameraInfo& of_right) {
  bag.write_info("/left/camera_info", test_info()).write_info("/right/camera_info", of_right);
  for (const double stamp_s : {0.1, 0.2}) {
    bag.picture("/left/" + name, stamp_s, 8, "camera", "mono8");
    bag.picture("/right/" + name, stamp_s, 8, "camera", "mono8");
  }
  bag.finish();
  return bag;
}

TEST(BagSource, ARawPairHangsTogetherByItsCalibrations) {
  const TestFolder folder;
  WrittenBag bag(folder.at("a.mcap"));
  const auto source = open_bag_source(write_pair(bag, "image_raw", right_info()).path(), {});
  ASSERT_EQ(source->info().num_cameras, 2);
  const auto frame = source->next();
  ASSERT_EQ(frame->images.size(), 2U);
  const core::Rigid3& left_from_right = frame->rig->body_from_camera[1];
  EXPECT_LT((left_from_right.translation - Eigen::Vector3d(0.25, 0, 0)).norm(), 1e-12);
  const Eigen::Vector3d x_in_left = left_from_right * Eigen::Vector3d(1, 0, 3);
  EXPECT_LT((x_in_left - Eigen::Vector3d(0.25, 1, 3)).norm(), 1e-12);
}

TEST(BagSource, ARectifiedPairIsApartAlongX) {
  const TestFolder folder;
  WrittenBag bag(folder.at("a.mcap"));
  const auto source = open_bag_source(write_pair(bag, "image_rect", right_info()).path(), {});
  ASSERT_EQ(source->info().num_cameras, 2);
  const core::Rigid3 left_from_right = source->next()->rig->body_from_camera[1];
  EXPECT_LT((left_from_right.translation - Eigen::Vector3d(0.25, 0, 0)).norm(), 1e-12);
  EXPECT_EQ(core::angle_rad(left_from_right.rotation), 0.0);
}

TEST(BagSource, APairWithoutADistanceIsOneCamera) {
  const TestFolder folder;
  WrittenBag bag(folder.at("a.mcap"));
  const auto source = open_bag_source(write_pair(bag, "image_raw", test_info()).path(), {});
  EXPECT_EQ(source->info().num_cameras, 1);
  EXPECT_EQ(source->next()->images.size(), 1U);
}

TEST(BagSource, CompressedPicturesAndDepthAreRead) {
  const TestFolder folder;
  WrittenBag bag(folder.at("a.mcap"));
  const cv::Mat color = picture(8, 8);
  const cv::Mat depth(8, 8, CV_16UC1, cv::Scalar(1500));
  bag.info()
      .compressed("/camera/image_raw/compressed", 0.1, "bgr8; png compressed bgr8", color)
      .compressed("/camera/depth/image/compressedDepth", 0.1, "16UC1; compressedDepth", depth)
      .finish();
  const auto source = open_bag_source(bag.path(), {});
  EXPECT_TRUE(source->info().is_calibrated);
  const auto frame = source->next();
  EXPECT_EQ(cv::norm(frame->images[0], color, cv::NORM_INF), 0.0);
  ASSERT_TRUE(frame->depth_m);
  EXPECT_EQ(frame->depth_m->at<float>(4, 4), 1.5F);
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
  WrittenBag depths(folder.at("depths.mcap"));
  EXPECT_THAT(error_of(depths.color(0.1).depth(0.1).color(0.2).depth(0.2, 9)),
              AllOf(HasSubstr("/camera/depth/image 0.2"), HasSubstr("is 9 x 9 pixels")));
  WrittenBag encodings(folder.at("encodings.mcap"));
  encodings.color(0.1).picture("/camera/image_raw", 0.2, 8, "camera", "jpeg2000");
  EXPECT_THAT(error_of(encodings), AllOf(HasSubstr("/camera/image_raw 0.2"),
                                         HasSubstr("has the encoding 'jpeg2000', expected one")));
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
