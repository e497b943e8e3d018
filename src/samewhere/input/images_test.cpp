#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <samewhere/input/test_recording.hpp>

namespace samewhere::input {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class Images : public Open {};

TEST_F(Images, AnImageFolderIsReadInTheOrderOfItsNumbers) {
  for (const char* name : {"10.jpg", "2.jpg", "1.jpg"}) write_image(name);
  folder_.write("readme.txt", "not an image");
  const auto source = open();
  EXPECT_EQ(source->info().format, "images");
  EXPECT_EQ(source->info().name, folder_.root().filename().string());
  EXPECT_EQ(source->info().num_frames, 3);
  EXPECT_FALSE(source->info().is_calibrated);
  EXPECT_FALSE(source->info().has_depth);
  const std::vector<core::Frame> frames = read_all();
  ASSERT_EQ(frames.size(), 3U);
  EXPECT_EQ(frames[2].name, "10.jpg");
  EXPECT_EQ(frames[2].id, core::FrameId(2));
  EXPECT_DOUBLE_EQ(frames[1].stamp_s, 2.0 / 30.0);
  EXPECT_DOUBLE_EQ(frames[2].stamp_s, 10.0 / 30.0);
  EXPECT_FALSE(frames[0].depth_m);
  ASSERT_TRUE(frames[0].rig);
  EXPECT_FALSE(frames[0].rig->is_calibrated());
}

TEST_F(Images, NamesWithoutNumbersCountByPosition) {
  for (const char* name : {"door.jpg", "hall.png", "lamp7.jpg"}) write_image(name);
  config_.fps = 10.0;
  const std::vector<core::Frame> frames = read_all();
  ASSERT_EQ(frames.size(), 3U);
  EXPECT_DOUBLE_EQ(frames[0].stamp_s, 0.0);
  EXPECT_DOUBLE_EQ(frames[2].stamp_s, 0.2);
}

TEST_F(Images, NumbersThatStartAgainCountByPosition) {
  for (const char* name : {"a_1.jpg", "a_2.jpg", "b_1.jpg"}) write_image(name);
  const std::vector<core::Frame> frames = read_all();
  ASSERT_EQ(frames.size(), 3U);
  EXPECT_DOUBLE_EQ(frames[2].stamp_s, 2.0 / 30.0);
}

TEST_F(Images, AnImageOfAnotherSizeInTheMiddleIsNamed) {
  write_image("1.jpg");
  write_image("2.jpg", 40);
  write_image("3.jpg");
  EXPECT_THAT(complaint_on_reading(),
              AllOf(HasSubstr("2.jpg"), HasSubstr("40 x 24"), HasSubstr("expected 32 x 24")));
}

TEST_F(Images, AnImageCutInHalfIsNamed) {
  write_image("1.jpg");
  write_image("2.jpg");
  folder_.cut("2.jpg", 0.5);
  EXPECT_THAT(complaint_on_reading(), HasSubstr("2.jpg"));
  folder_.cut("1.jpg", 0.5);
  EXPECT_THAT(complaint_on_opening(), HasSubstr("1.jpg"));
}

TEST_F(Images, TruthBesideTheImagesIsRead) {
  for (const char* name : {"1.jpg", "2.jpg"}) write_image(name);
  folder_.write("groundtruth.tum", "0.5 1 2 3 0 0 0 1\n");
  folder_.write("same_place.txt", "0 0\n1 0\n");
  const core::Truth truth = open()->truth();
  ASSERT_EQ(truth.trajectory.size(), 1U);
  EXPECT_EQ(truth.trajectory[0].world_from_camera.translation.z(), 3.0);
  ASSERT_TRUE(truth.places);
  EXPECT_EQ(truth.places->at(1, 0), core::PlaceTruth::kSame);
  write_image("3.jpg");
  EXPECT_THAT(complaint_on_opening(), HasSubstr("2 rows, expected 3"));
}

TEST_F(Images, AListIsReadInItsOwnOrderAndMayNameAnImageTwice) {
  write_image("b/2.jpg");
  write_image("a/1.jpg");
  folder_.write("walk.txt", "# image floor\nb/2.jpg floor3 17\r\na/1.jpg\n\nb/2.jpg\n");
  config_.fps = 2.0;
  const auto source = open_source(folder_.at("walk.txt"), config_);
  EXPECT_EQ(source->info().name, "walk");
  EXPECT_EQ(source->info().format, "image list");
  EXPECT_EQ(source->info().num_frames, 3);
  EXPECT_EQ(source->next()->name, "b/2.jpg");
  EXPECT_EQ(source->next()->name, "a/1.jpg");
  EXPECT_DOUBLE_EQ(source->next()->stamp_s, 1.0);
  EXPECT_FALSE(source->next());
}

TEST_F(Images, AMissingImageOfAListIsNamedWithItsLine) {
  write_image("1.jpg");
  folder_.write("walk.txt", "# list\n1.jpg\n2.jpg\n");
  EXPECT_THAT(complaint([&] { open_source(folder_.at("walk.txt"), config_); }),
              AllOf(HasSubstr("walk.txt, line 3"), HasSubstr("2.jpg does not exist")));
}

TEST_F(Images, AFileThatIsNoListIsNamed) {
  folder_.write("empty.txt", "# nothing\n");
  EXPECT_THAT(complaint([&] { open_source(folder_.at("empty.txt"), config_); }),
              HasSubstr("lists no image"));
  write_image("1.jpg");
  EXPECT_THAT(complaint([&] { open_source(folder_.at("1.jpg"), config_); }),
              AllOf(HasSubstr("1.jpg"), HasSubstr("binary file")));
}

}  // namespace
}  // namespace samewhere::input
