#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <samewhere/input/test_recording.hpp>

namespace samewhere::input {
namespace {

using core::PlaceTruth;
using testing::HasSubstr;

class PlaceSets : public Open {
 protected:
  void write_numbered(const std::string& pattern, int first, int last) {
    for (int i = first; i <= last; ++i) write_image(fmt::format(fmt::runtime(pattern), i));
  }
  static std::string text_matrix(int num_rows, int distance) {
    std::string text;
    for (int row = 0; row < num_rows; ++row) {
      for (int column = 0; column < num_rows; ++column)
        text += std::string(row - column == distance ? "1" : "0") +
                (column + 1 < num_rows ? "," : "\n");
    }
    return text;
  }
};

TEST_F(PlaceSets, Lip6HasOnePictureASecondAndAMatrix) {
  write_numbered("Images/lip6kennedy_bigdoubleloop_{:06}.jpg", 0, 3);
  folder_.write("Lip6IndoorGroundTruth.txt", text_matrix(4, 2));
  const auto source = open();
  EXPECT_EQ(source->info().format, "Lip6");
  EXPECT_DOUBLE_EQ(source->info().frame_rate_hz, 1.0);
  ASSERT_TRUE(source->truth().places);
  EXPECT_EQ(source->truth().places->at(3, 1), PlaceTruth::kSame);
  EXPECT_EQ(source->truth().places->at(3, 0), PlaceTruth::kDifferent);
  config_.truth_tolerance_frames = 1;
  EXPECT_EQ(open()->truth().places->at(3, 0), PlaceTruth::kSame);
}

TEST_F(PlaceSets, NewCollegeHasTheMatrixInMasksAndImagesOfBothSides) {
  write_numbered("Images/{:04}.jpg", 1, 6);
  folder_.write("ImageCollectionCoordinates.txt", "1 2\n");
  folder_.write("masks/NewCollegeTextFormat.txt", text_matrix(6, 4));
  const auto source = open();
  EXPECT_EQ(source->info().format, "FAB-MAP");
  EXPECT_EQ(source->info().num_frames, 6);
  EXPECT_EQ(source->truth().places->at(5, 1), PlaceTruth::kSame);
}

TEST_F(PlaceSets, ImagesOfOneSideTakeItsRows) {
  for (const char* name : {"Images/0001.jpg", "Images/0003.jpg", "Images/0005.jpg"})
    write_image(name);
  folder_.write("NewCollegeTextFormat.txt", text_matrix(6, 4));
  ASSERT_TRUE(open()->truth().places);
  EXPECT_EQ(open()->truth().places->at(2, 0), PlaceTruth::kSame);
}

TEST_F(PlaceSets, AMatrixOfAnotherSizeIsWarnedOf) {
  write_numbered("Images/{:04}.jpg", 1, 5);
  folder_.write("CityCentreTextFormat.txt", text_matrix(4, 2));
  EXPECT_THAT(said_on_opening(), HasSubstr("CityCentreTextFormat.txt: is 4 x 4, expected 5 x 5"));
  EXPECT_FALSE(open()->truth().places);
}

TEST_F(PlaceSets, WithoutAMatrixTheImagesRemain) {
  write_numbered("Images/{:04}.jpg", 1, 3);
  EXPECT_EQ(open()->info().num_frames, 3);
  EXPECT_FALSE(open()->truth().places);
}

TEST_F(PlaceSets, ACutMatlabFileIsWarnedOf) {
  write_numbered("Images/{:04}.jpg", 1, 3);
  folder_.write("CityCentreGroundTruth.mat", "MATLAB 5.0 MAT-file");
  EXPECT_THAT(said_on_opening(), HasSubstr("CityCentreGroundTruth.mat: "));
  EXPECT_EQ(open()->info().num_frames, 3);
}

TEST_F(PlaceSets, TraversesOfGardensPointFollowEachOther) {
  write_numbered("day_left/Image{:03}.jpg", 0, 9);
  write_numbered("night_right/Image{:03}.jpg", 0, 9);
  const auto source = open();
  EXPECT_EQ(source->info().format, "GardensPoint");
  ASSERT_EQ(source->info().num_frames, 20);
  const core::PlaceTruthMatrix places = *source->truth().places;
  EXPECT_EQ(places.at(13, 3), PlaceTruth::kSame);
  EXPECT_EQ(places.at(13, 4), PlaceTruth::kNear);
  EXPECT_EQ(places.at(19, 0), PlaceTruth::kDifferent);
  config_.truth_tolerance_frames = 2;
  EXPECT_EQ(open()->truth().places->at(13, 5), PlaceTruth::kSame);
  EXPECT_EQ(open()->truth().places->at(10, 9), PlaceTruth::kDifferent);  // ends do not touch
  EXPECT_EQ(read_all()[10].name, "night_right/Image000.jpg");
}

TEST_F(PlaceSets, AMissingImageOfATraverseMovesNoOther) {
  write_numbered("day_left/Image{:03}.jpg", 0, 9);
  write_numbered("day_right/Image{:03}.jpg", 1, 9);
  EXPECT_EQ(open()->truth().places->at(10, 1), PlaceTruth::kSame);
}

TEST_F(PlaceSets, OneTraverseIsAFolderOfImages) {
  write_numbered("day_left/Image{:03}.jpg", 0, 2);
  EXPECT_THAT(complaint_on_opening(), HasSubstr("holds no known recording"));
}

}  // namespace
}  // namespace samewhere::input
