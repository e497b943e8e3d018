#include <gtest/gtest.h>

#include <samewhere/map/test_map.hpp>
#include <samewhere/pipeline/passing_things.hpp>

namespace samewhere::pipeline {
namespace {

// A camera that stands still before points 2 to 6 m away.
class PassingThingsTest : public testing::Test {
 protected:
  // A depth picture in which all is so far away; unknown if 0.
  static core::Frame picture(double stamp_s, double depth_m) {
    core::Frame frame;
    frame.stamp_s = stamp_s;
    frame.rig = features::test_rig();
    frame.depth_m = cv::Mat(480, 640, CV_32F, cv::Scalar(depth_m));
    return frame;
  }
  core::FramePose pose(double stamp_s) const {
    return {.stamp_s = stamp_s, .is_measured = true, .reference_keyframe = map_.keyframes[0].id};
  }
  void see(double stamp_s, double depth_m) {
    things_.see(picture(stamp_s, depth_m), pose(stamp_s));
  }
  std::vector<int> shown_at(double stamp_s) const {
    features::View view = view_;
    view.stamp_s = stamp_s;
    return things_.shown_in(view, pose(stamp_s), map_);
  }

  features::TestWorld world_ = features::test_world(1);
  features::View view_ = features::test_view(world_, 0, {});
  scene::MapVersion map_ = map::test_map(world_, 1);
  PassingThings things_;
};

TEST_F(PassingThingsTest, WhereTheViewWentThroughSomethingHasCome) {
  EXPECT_TRUE(shown_at(1.0).empty()) << "nothing was seen yet";
  see(0.5, 9.0);
  EXPECT_GT(shown_at(1.0).size(), 0.8 * view_.features->size());
}

TEST_F(PassingThingsTest, WhereItEndedOrIsUnknownNothingIsMoving) {
  see(0.2, 1.5);
  see(0.6, 0.0);
  EXPECT_TRUE(shown_at(1.0).empty());
}

TEST_F(PassingThingsTest, OnePictureOfTheLastSecondIsEnough) {
  see(0.1, 9.0);
  see(0.2, 1.5);  // too soon after the last: not taken
  for (const double stamp_s : {0.4, 0.7, 1.0}) see(stamp_s, 1.5);
  EXPECT_FALSE(shown_at(1.1).empty());
  see(1.3, 1.5);
  EXPECT_TRUE(shown_at(1.3).empty()) << "four pictures are kept";
}

TEST_F(PassingThingsTest, WhatWasSeenLongAgoTellsNothing) {
  see(0.5, 9.0);
  EXPECT_FALSE(shown_at(1.5).empty());
  EXPECT_TRUE(shown_at(1.6).empty());
}

TEST_F(PassingThingsTest, OfAMapThatIsGivenUpNothingIsKept) {
  see(0.5, 9.0);
  things_.forget();
  EXPECT_TRUE(shown_at(1.0).empty());
}

TEST_F(PassingThingsTest, AFrameWithoutDepthTellsNothing) {
  core::Frame frame = picture(0.5, 9.0);
  frame.depth_m.reset();
  things_.see(frame, pose(0.5));
  EXPECT_TRUE(shown_at(1.0).empty());
}

}  // namespace
}  // namespace samewhere::pipeline
