#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <samewhere/input/place_matrix.hpp>
#include <samewhere/input/test_folder.hpp>

namespace samewhere::input {
namespace {

using core::PlaceTruth;
using core::PlaceTruthMatrix;
using testing::AllOf;
using testing::HasSubstr;

PlaceTruthMatrix diagonal_matrix(int num_frames) {
  PlaceTruthMatrix places{num_frames, {}};
  places.values.resize(static_cast<std::size_t>(num_frames) * num_frames, PlaceTruth::kDifferent);
  for (int i = 0; i < num_frames; ++i) places.values[i * num_frames + i] = PlaceTruth::kSame;
  return places;
}

class PlaceMatrix : public testing::Test {
 protected:
  std::string complaint_about(const std::string& text) {
    folder_.write("a_GroundTruth.txt", text);
    return complaint([this] { read_published_matrix(folder_.at("a_GroundTruth.txt")); });
  }

  static Recording recording_of(const std::vector<std::string>& names) {
    Recording recording;
    for (const std::string& name : names) recording.frames.push_back({name});
    return recording;
  }

  TestFolder folder_;
};

TEST_F(PlaceMatrix, EitherTriangleTellsBoth) {
  folder_.write("CityCentreTextFormat.txt", "0,0,2\n1,0,0\n0,0,0\n");
  const PlaceTruthMatrix places = read_published_matrix(folder_.at("CityCentreTextFormat.txt"));
  ASSERT_EQ(places.num_frames, 3);
  EXPECT_EQ(places.at(0, 1), PlaceTruth::kSame);
  EXPECT_EQ(places.at(1, 0), PlaceTruth::kSame);
  EXPECT_EQ(places.at(2, 0), PlaceTruth::kNear);
  EXPECT_EQ(places.at(2, 1), PlaceTruth::kDifferent);
}

TEST_F(PlaceMatrix, BlanksAndDecimalsSeparateValuesAsWell) {
  folder_.write("a_GroundTruth.txt", "# of a tool\n0.0 1.0000000e+00\r\n\r\n0\t0\r\n");
  EXPECT_EQ(read_published_matrix(folder_.at("a_GroundTruth.txt")).at(1, 0), PlaceTruth::kSame);
}

TEST_F(PlaceMatrix, OneThatIsNotSquareIsRefused) {
  EXPECT_THAT(complaint_about("0 1\n"), HasSubstr("1 rows of 2 columns, expected a square matrix"));
  EXPECT_THAT(complaint_about("0 1\n1 0\n0 0\n"), HasSubstr("line 3: is row 3, expected 2"));
  EXPECT_THAT(complaint_about("0 1\n1\n"), HasSubstr("line 2: has 1 columns, expected 2"));
  EXPECT_THAT(complaint_about(""), HasSubstr("0 rows of 0 columns"));
  EXPECT_THAT(complaint_about("0 x\n1 0\n"), HasSubstr("line 1: found 'x'"));
  EXPECT_THAT(complaint_about("0 3\n1 0\n"), HasSubstr("line 1: found the value 3"));
  std::string wide(2 * 20'001, '0');
  for (std::size_t i = 1; i < wide.size(); i += 2) wide[i] = ' ';
  EXPECT_THAT(complaint_about(wide), HasSubstr("more than 20000 columns"));
}

TEST_F(PlaceMatrix, TrajectoriesAreNotTakenForMatrices) {
  folder_.write("groundtruth.txt", "0 1\n1 0\n");
  folder_.write("stamped_groundtruth.txt", "1305031102.1 1 2 3 0 0 0 1\n");
  EXPECT_TRUE(published_matrix(folder_.root()).empty());
  EXPECT_FALSE(has_place_truth(folder_.root()));
  folder_.write("masks/CityCentreGroundTruth.mat", "");
  EXPECT_EQ(published_matrix(folder_.root()), folder_.at("masks/CityCentreGroundTruth.mat"));
  folder_.write("masks/CityCentreTextFormat.txt", "0,1\n1,0\n");
  EXPECT_EQ(published_matrix(folder_.root()), folder_.at("masks/CityCentreTextFormat.txt"));
  EXPECT_TRUE(has_place_truth(folder_.root()));
}

TEST_F(PlaceMatrix, ImagesOfOneCameraTakeTheRowsOfTheirNumbers) {
  PlaceTruthMatrix matrix = diagonal_matrix(6);
  matrix.values[4 * 6 + 2] = PlaceTruth::kSame;
  Recording left = recording_of({"0001.jpg", "0003.jpg", "0005.jpg"});
  set_places("truth.mat", matrix, left);
  EXPECT_EQ(left.truth.places->num_frames, 3);
  EXPECT_EQ(left.truth.places->at(2, 1), PlaceTruth::kSame);
  Recording right = recording_of({"0002.jpg", "0004.jpg", "0006.jpg"});
  set_places("truth.mat", matrix, right);
  EXPECT_EQ(right.truth.places->at(2, 1), PlaceTruth::kDifferent);
  Recording from_zero = recording_of({"000000.ppm", "000002.ppm", "000004.ppm", "000005.ppm"});
  set_places("truth.mat", matrix, from_zero);
  EXPECT_EQ(from_zero.truth.places->at(2, 1), PlaceTruth::kSame);
}

TEST_F(PlaceMatrix, RowsThatTheNamesDoNotSayAreRefused) {
  const PlaceTruthMatrix matrix = diagonal_matrix(6);
  const auto said = [&](const std::vector<std::string>& names) {
    Recording recording = recording_of(names);
    return complaint([&] { set_places("truth.mat", matrix, recording); });
  };
  EXPECT_THAT(said({"1.jpg", "2.jpg", "3.jpg"}),
              HasSubstr("images of one camera keep their numbers"));
  EXPECT_THAT(said({"a.jpg", "b.jpg"}),
              AllOf(HasSubstr("truth.mat: is 6 x 6, expected 2 x 2"), HasSubstr("a.jpg")));
  EXPECT_THAT(said({"1.jpg", "7.jpg"}), HasSubstr("7.jpg does not say its row"));
  EXPECT_THAT(said({"2.jpg", "1.jpg"}), HasSubstr("the names do not say the rows"));
}

TEST_F(PlaceMatrix, OfMoreImagesThanRowsEachKthIsAFrame) {
  const PlaceTruthMatrix matrix = diagonal_matrix(3);
  Recording recording = recording_of({"a", "b", "c", "d", "e", "f", "g"});
  set_places("truth.mat", matrix, recording);
  ASSERT_EQ(recording.frames.size(), 3U);
  EXPECT_EQ(recording.frames[1].name, "d");
  EXPECT_EQ(recording.frames[2].name, "g");
  Recording four = recording_of({"a", "b", "c", "d"});
  EXPECT_THAT(complaint([&] { set_places("truth.mat", matrix, four); }),
              AllOf(HasSubstr("is 3 x 3, expected 4 x 4"), HasSubstr("no whole number of images")));
}

TEST_F(PlaceMatrix, ToleranceWidensRowsAndStopsAtTheEnds) {
  PlaceTruthMatrix places = diagonal_matrix(6);
  widen(2, places);
  for (int row = 0; row < 6; ++row) {
    for (int column = 0; column < 6; ++column)
      EXPECT_EQ(places.at(row, column) == PlaceTruth::kSame, std::abs(row - column) <= 2);
  }
  PlaceTruthMatrix exact = diagonal_matrix(6);
  widen(0, exact);
  EXPECT_EQ(exact.values, diagonal_matrix(6).values);
}

TEST_F(PlaceMatrix, ABrokenOneIsWarnedOfAndLeftOut) {
  folder_.write("a_GroundTruth.txt", "0 1\n1 0\n0 0\n");
  Recording recording = recording_of({"1.jpg", "2.jpg"});
  testing::internal::CaptureStdout();
  add_published_places(folder_.root(), {}, recording);
  EXPECT_THAT(testing::internal::GetCapturedStdout(),
              AllOf(HasSubstr("a_GroundTruth.txt"), HasSubstr("the run goes on without it")));
  EXPECT_FALSE(recording.truth.places);
}

}  // namespace
}  // namespace samewhere::input
