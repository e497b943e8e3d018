#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <samewhere/input/test_recording.hpp>

namespace samewhere::input {
namespace {

using testing::AllOf;
using testing::HasSubstr;

TEST_F(Open, AMissingFolderIsNamed) {
  EXPECT_THAT(complaint([&] { open_source(folder_.root() / "gone", config_); }),
              AllOf(HasSubstr("gone"), HasSubstr("does not exist")));
}

TEST_F(Open, APathTooLongForTheSystemIsAnErrorNotACrash) {
  EXPECT_THAT(complaint([&] { open_source(std::string(5000, 'x'), config_); }),
              HasSubstr("does not exist"));
}

TEST_F(Open, APipeIsRefusedWithoutWaiting) {
  const std::filesystem::path pipe = folder_.at("list.txt");
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_THAT(complaint([&] { open_source(pipe, config_); }), HasSubstr("is a pipe"));
}

TEST_F(Open, AnEmptyFolderIsNamed) {
  EXPECT_THAT(complaint_on_opening(),
              AllOf(HasSubstr(folder_.root().string()), HasSubstr("the folder is empty")));
}

TEST_F(Open, AnUnknownLayoutSaysWhatWasLookedFor) {
  folder_.write("notes.md", "hello");
  EXPECT_THAT(complaint_on_opening(), AllOf(HasSubstr("rgb.txt"), HasSubstr("frame-*.color.png"),
                                            HasSubstr("K.txt"), HasSubstr("*.jpg")));
}

TEST_F(Open, ASceneOfSeveralSequencesAsksForOne) {
  folder_.write("seq-01/frame-000000.color.png", "");
  folder_.write("TestSplit.txt", "sequence1");
  EXPECT_THAT(complaint_on_opening(), AllOf(HasSubstr("several sequences"), HasSubstr("/seq-01")));
}

TEST_F(Open, SlipsInTheSettingsAreNamed) {
  write_image("1.jpg");
  config_.fps = 1e-300;
  EXPECT_THAT(complaint_on_opening(), HasSubstr("input.fps = 1e-300"));
  config_ = {};
  config_.depth_factor = 0.001;
  EXPECT_THAT(complaint_on_opening(), HasSubstr("input.depth_factor = 0.001"));
}

TEST_F(Open, ACameraFileOfTheUserReplacesTheFoldersOwn) {
  write_image("1.jpg");
  folder_.write("camera.txt", "broken");
  folder_.write("mine/camera.txt", kCamera);
  config_.camera = folder_.at("mine/camera.txt").string();
  const auto source = open();
  EXPECT_TRUE(source->info().is_calibrated);
  const auto frame = source->next();
  ASSERT_TRUE(frame);
  const auto& camera = std::get<core::PinholeRadtan>(frame->rig->cameras.at(0));
  EXPECT_EQ(camera.width_px, 32);
  EXPECT_EQ(camera.height_px, 24);
  EXPECT_EQ(camera.cx_px, 15.5);
  EXPECT_EQ(frame->rig->body_from_camera.size(), 1U);
  config_.camera = folder_.at("gone.txt").string();
  EXPECT_THAT(complaint_on_opening(), HasSubstr("gone.txt"));
}

TEST_F(Open, ACentreOutsideTheImageIsAWrongCalibration) {
  write_image("1.jpg");
  folder_.write("camera.txt", "500 0 320\n0 500 11\n0 0 1\n");
  EXPECT_THAT(complaint_on_opening(), AllOf(HasSubstr("camera.txt"), HasSubstr("wrong calibration"),
                                            HasSubstr("(320, 11)"), HasSubstr("32 x 24")));
}

}  // namespace
}  // namespace samewhere::input
