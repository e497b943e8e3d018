#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <samewhere/core/nanoseconds.hpp>
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
  EXPECT_DOUBLE_EQ(frames[1].stamp_s, core::in_whole_nanoseconds(2.0 / 30.0));
  EXPECT_DOUBLE_EQ(frames[2].stamp_s, core::in_whole_nanoseconds(10.0 / 30.0));
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
  EXPECT_DOUBLE_EQ(frames[2].stamp_s, core::in_whole_nanoseconds(2.0 / 30.0));
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
  EXPECT_THAT(said_on_opening(), AllOf(HasSubstr("2 rows, expected 3"), HasSubstr("goes on")));
  EXPECT_FALSE(open()->truth().places);
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

TEST_F(Images, AMissingImageOfAListIsLeftOutUnlessMostAre) {
  write_image("1.jpg");
  folder_.write("walk.txt", "# list\n1.jpg\n2.jpg\n");
  testing::internal::CaptureStdout();
  EXPECT_EQ(open_source(folder_.at("walk.txt"), config_)->info().num_frames, 1);
  EXPECT_THAT(testing::internal::GetCapturedStdout(),
              AllOf(HasSubstr("1 of 2 images are left out"), HasSubstr("walk.txt, line 3"),
                    HasSubstr("2.jpg does not exist")));
  folder_.write("walk.txt", "1.jpg\n2.jpg\n3.jpg\n");
  EXPECT_THAT(complaint([&] { open_source(folder_.at("walk.txt"), config_); }),
              AllOf(HasSubstr("walk.txt, line 2"), HasSubstr("2 of 3 images")));
}

TEST_F(Images, NamesThatBeginWithADotAreNoPictures) {
  for (const char* name : {"000000.png", "000001.png"}) write_image(name);
  folder_.write("._000000.png", "AppleDouble");
  folder_.write(".hidden.jpg", "");
  EXPECT_EQ(read_all().size(), 2U);
}

TEST_F(Images, NamesThatAreTimesGiveTheStamps) {
  for (const char* name : {"1611234567.99.png", "1611234568.2.png", "1611234568.05.png"})
    write_image(name);
  EXPECT_EQ(said_on_opening(), "");
  const std::vector<core::Frame> frames = read_all();
  ASSERT_EQ(frames.size(), 3U);
  EXPECT_EQ(frames[1].name, "1611234568.05.png");
  EXPECT_NEAR(frames[2].stamp_s, 1611234568.2, 1e-6);
}

TEST_F(Images, NumbersThatRiseByAnotherStepAreWarnedOf) {
  for (const char* name : {"071534123.png", "071534156.png", "071534189.png"}) write_image(name);
  EXPECT_THAT(said_on_opening(), HasSubstr("rise by 33"));
  const std::vector<core::Frame> frames = read_all();
  EXPECT_NEAR(frames[2].stamp_s - frames[0].stamp_s, 0.066, 1e-9);
}

TEST_F(Images, OtherFormatsAreReadWhereThereIsNeitherJpegNorPng) {
  for (const char* name : {"1.PGM", "2.pgm"})
    folder_.write(name, "P5\n32 24\n255\n" + std::string(32 * 24, '\x40'));
  folder_.write("same_place.pgm", std::string("P5 2 2 2 \1\0\1\1", 13));
  EXPECT_EQ(read_all().size(), 2U);
  EXPECT_TRUE(open()->truth().places);
  write_image("3.jpg");
  EXPECT_EQ(read_all().size(), 1U);
}

TEST_F(Images, ACalibrationThatDoesNotFitIsAWarningWhereNoneIsNeeded) {
  write_image("1.jpg");
  folder_.write("camera.txt", "500 0 320\n0 500 11\n0 0 1\n");
  EXPECT_THAT(said_on_opening(), HasSubstr("refused: "));
  config_.needs_calibration = false;
  EXPECT_THAT(said_on_opening(),
              AllOf(HasSubstr("wrong calibration"), HasSubstr("the calibration is not used")));
  EXPECT_FALSE(open()->info().is_calibrated);
  config_.camera = folder_.at("camera.txt").string();
  EXPECT_THAT(said_on_opening(), HasSubstr("refused: ")) << "one that was asked for";
}

class ColourAndDepth : public Open {
 protected:
  // Whether each frame has depth, as 0 and 1.
  std::string depths() {
    std::string found;
    for (const core::Frame& frame : read_all()) found += frame.depth_m ? '1' : '0';
    return found;
  }
};

TEST_F(ColourAndDepth, FoldersWithoutListsAreRead) {
  for (const char* name : {"0001.jpg", "0002.jpg"}) write_image(std::string("rgb/") + name);
  for (const char* name : {"0001.png", "0002.png"}) write_depth(std::string("depth/") + name);
  folder_.write("camera.txt", kCamera);
  const auto source = open();
  EXPECT_EQ(source->info().num_frames, 2);
  EXPECT_TRUE(source->info().has_depth);
  EXPECT_TRUE(source->info().is_calibrated);
  const std::vector<core::Frame> frames = read_all();
  EXPECT_DOUBLE_EQ(frames[1].stamp_s, core::in_whole_nanoseconds(2 / 30.0));
  EXPECT_FLOAT_EQ(frames[1].depth_m->at<float>(0, 0), 2.5F);
  std::filesystem::remove_all(folder_.at("depth"));
  EXPECT_FALSE(open()->info().has_depth);
}

TEST_F(ColourAndDepth, NumbersTimesOrPositionsMatchTheNames) {
  for (const char* name : {"color/rgb_0001.jpg", "color/rgb_0002.jpg"}) write_image(name);
  for (const char* name : {"depth/depth_0002.png", "depth/depth_0003.png"}) write_depth(name);
  EXPECT_EQ(depths(), "01");
  std::filesystem::remove_all(folder_.at("color"));
  std::filesystem::remove_all(folder_.at("depth"));
  for (const char* name : {"image/1305031102.175304.jpg", "image/1305031102.211214.jpg",
                           "image/1305031102.243211.jpg"})
    write_image(name);
  for (const char* name : {"depth/1305031102.194330.png", "depth/1305031102.226738.png"})
    write_depth(name);
  EXPECT_EQ(depths(), "110");
  std::filesystem::remove_all(folder_.at("image"));
  std::filesystem::remove_all(folder_.at("depth"));
  for (const char* name : {"images/a.jpg", "images/b.jpg"}) write_image(name);
  for (const char* name : {"depth/x.png", "depth/y.png"}) write_depth(name);
  folder_.write("camera.txt", kCamera);
  EXPECT_EQ(depths(), "11");
  write_depth("depth/z.png");
  EXPECT_THAT(complaint_on_opening(), HasSubstr("holds no depth image of a.jpg"));
}

TEST_F(Images, AFileThatIsNoListIsNamed) {
  folder_.write("empty.txt", "# nothing\n");
  EXPECT_THAT(complaint([&] { open_source(folder_.at("empty.txt"), config_); }),
              HasSubstr("lists no image"));
  write_image("1.jpg");
  EXPECT_THAT(complaint([&] { open_source(folder_.at("1.jpg"), config_); }),
              AllOf(HasSubstr("1.jpg"), HasSubstr("is one picture")));
}

}  // namespace
}  // namespace samewhere::input
