#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <samewhere/core/stage_thread.hpp>
#include <samewhere/library/test_walk.hpp>
#include <samewhere/slam.hpp>

namespace samewhere::library {
namespace {

using testing::HasSubstr;

class BadUse : public testing::Test {
 protected:
  BadUse() : slam_(test_walk().calibration, {.settings = test_settings()}) {
    slam_.track(test_walk().at(0));
  }

  // Refused with one line; the session goes on.
  void expect_refused(const Frame& frame, const std::string& words) {
    try {
      slam_.track(frame);
      ADD_FAILURE() << "was taken: " << words;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr(words));
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    }
    const Tracked next = slam_.track(test_walk().at(1));
    EXPECT_EQ(next.frame, 1U);
    EXPECT_TRUE(next.has_pose());
  }

  Slam slam_;
  Frame frame_ = test_walk().at(1);
};

TEST_F(BadUse, AFrameWithoutImageIsRefused) {
  frame_.images.clear();
  expect_refused(frame_, "frame 1: 0 images; expected 1, one per camera");
}

TEST_F(BadUse, AnImageWithoutDataIsRefused) {
  frame_.images[0].data = nullptr;
  expect_refused(frame_, "image 0: has no data");
}

TEST_F(BadUse, AnImageOfAnotherSizeIsRefused) {
  frame_.images[0].width_px /= 2;
  expect_refused(frame_, "320 x 480 pixels; expected 640 x 480 as in the calibration");
}

TEST_F(BadUse, AStrideShorterThanARowIsRefused) {
  frame_.images[0].stride_bytes = 640;
  expect_refused(frame_, "stride of 640 bytes; expected at least 1920");
}

TEST_F(BadUse, AnImageOfDepthIsRefused) {
  frame_.images[0].format = PixelFormat::kDepth16;
  expect_refused(frame_, "format depth16; expected gray8");
}

TEST_F(BadUse, DepthOfAnotherSizeIsRefused) {
  frame_.depth->height_px = 100;
  expect_refused(frame_, "depth: 640 x 100 pixels; expected 640 x 480");
}

TEST_F(BadUse, AStampThatDoesNotRiseIsRefused) {
  frame_.stamp_s = test_walk().at(0).stamp_s;
  expect_refused(frame_, "expected a later one than");
}

TEST_F(BadUse, AStampThatIsNoNumberIsRefused) {
  frame_.stamp_s = std::numeric_limits<double>::quiet_NaN();
  expect_refused(frame_, "stamp nan s; expected a number");
}

TEST_F(BadUse, NoFrameComesAfterFinish) {
  EXPECT_THROW(slam_.trajectory(), UsageError) << "before finish()";
  slam_.finish();
  EXPECT_NO_THROW(slam_.finish());
  EXPECT_THROW(slam_.track(frame_), UsageError);
  EXPECT_EQ(slam_.trajectory().size(), 1U);
  slam_.reset();
  EXPECT_NO_THROW(slam_.track(frame_));
}

TEST_F(BadUse, ASecondCallMeanwhileIsRefused) {
  Options options{.settings = test_settings()};
  Slam* inner = nullptr;
  std::string message;
  options.on_event = [&](const Event&) {
    // as another thread would, while track() is in progress
    core::WorkerThread other([&] {
      try {
        inner->track(test_walk().at(1));
      } catch (const UsageError& error) {
        message = error.what();
      }
    });
    other.join();
  };
  Slam slam(test_walk().calibration, options);
  inner = &slam;
  slam.track(test_walk().at(0));
  EXPECT_THAT(message, HasSubstr("track(): another call of this session is in progress"));
  EXPECT_EQ(slam.track(test_walk().at(1)).frame, 1U) << "the session goes on";
}

TEST(BadOptions, AreRefusedWithOneLine) {
  const Calibration good = test_walk().calibration;
  EXPECT_THROW(Slam(good, {.profile = "none"}), InputError);
  EXPECT_THROW(Slam(good, {.settings = {"map.no_such_key=1"}}), InputError);
  EXPECT_THROW(Slam(good, {.threads = false, .never_wait = true}), InputError);
  EXPECT_THROW(Slam(good, {.map = "/no/such/map.sw"}), InputError);
  EXPECT_THROW(Slam(good, {.settings = {"odometry.file=a.tum"}}), InputError);
  EXPECT_THROW(Slam(Calibration{}), InputError);
  Calibration bad = good;
  bad.cameras[0].fx_px = -1.0;
  EXPECT_THROW(Slam{bad}, InputError);
  bad = good;
  bad.cameras[0].body_from_camera.translation().x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(Slam{bad}, InputError);
}

}  // namespace
}  // namespace samewhere::library
