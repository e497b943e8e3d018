#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <samewhere/core/random.hpp>
#include <samewhere/input/test_folder.hpp>
#include <samewhere/input/truth_file.hpp>

namespace samewhere::input {
namespace {

using core::PlaceTruth;
using testing::AllOf;
using testing::HasSubstr;

class TruthFile : public testing::Test {
 protected:
  std::string complaint_about(const std::string& name, const std::string& content) {
    folder_.write(name, content);
    testing::internal::CaptureStdout();
    const core::Truth truth = read_truth(folder_.root(), 2);
    EXPECT_FALSE(truth.places);
    return testing::internal::GetCapturedStdout();
  }

  TestFolder folder_;
};

TEST_F(TruthFile, AFolderWithoutTruthHasNone) {
  const core::Truth truth = read_truth(folder_.root(), 3);
  EXPECT_TRUE(truth.trajectory.empty());
  EXPECT_FALSE(truth.places.has_value());
}

TEST_F(TruthFile, APgmTellsSameNearAndDifferentByRowAndColumn) {
  folder_.write("same_place.pgm", std::string("P5\n# comment\n2 2\n2\n\1\2\0\1", 23));
  const core::Truth truth = read_truth(folder_.root(), 2);
  ASSERT_TRUE(truth.places);
  EXPECT_EQ(truth.places->num_frames, 2);
  EXPECT_EQ(truth.places->at(0, 0), PlaceTruth::kSame);
  EXPECT_EQ(truth.places->at(0, 1), PlaceTruth::kNear);
  EXPECT_EQ(truth.places->at(1, 0), PlaceTruth::kDifferent);
  EXPECT_EQ(truth.places->at(1, 1), PlaceTruth::kSame);
}

TEST_F(TruthFile, AValueThatLooksLikeWhiteSpaceIsData) {
  EXPECT_THAT(complaint_about("same_place.pgm", "P5 2 2 255\n\n\n\n\n"),
              HasSubstr("found the value 10"));
}

TEST_F(TruthFile, ATextMatrixTellsSameAndDifferent) {
  folder_.write("same_place.txt", "0 0\n1 0\n");
  const core::Truth truth = read_truth(folder_.root(), 2);
  ASSERT_TRUE(truth.places);
  EXPECT_EQ(truth.places->at(1, 0), PlaceTruth::kSame);
  EXPECT_EQ(truth.places->at(0, 1), PlaceTruth::kDifferent);
}

TEST_F(TruthFile, AMatrixOfAnotherSizeIsLeftOut) {
  EXPECT_THAT(complaint_about("same_place.txt", "0 0\n1 0\n0 0\n"),
              AllOf(HasSubstr("same_place.txt"), HasSubstr("3 rows, expected 2")));
  EXPECT_THAT(complaint_about("same_place.txt", "0 0\n1\n"),
              AllOf(HasSubstr("line 2"), HasSubstr("1 columns, expected 2")));
  EXPECT_THAT(complaint_about("same_place.pgm", "P5\n1 1\n2\n\1"),
              AllOf(HasSubstr("same_place.pgm"), HasSubstr("1 x 1"), HasSubstr("expected 2 x 2")));
}

TEST_F(TruthFile, ABrokenMatrixIsLeftOut) {
  EXPECT_THAT(complaint_about("same_place.txt", "0 0\n3 0\n"),
              AllOf(HasSubstr("line 2"), HasSubstr("found the value 3")));
  EXPECT_THAT(complaint_about("same_place.txt", "0 0\nx 0\n"), HasSubstr("'x'"));
  EXPECT_THAT(complaint_about("same_place.pgm", "P2\n2 2\n2\n0 0 0 0"),
              HasSubstr("not a binary PGM"));
  EXPECT_THAT(complaint_about("same_place.pgm", "P5\n2 two\n"), HasSubstr("header is broken"));
  EXPECT_THAT(complaint_about("same_place.pgm", "P5\n2 2\n2\n\1\1\1"),
              HasSubstr("holds 3 values, expected 4"));
  EXPECT_THAT(complaint_about("same_place.pgm", "P5\n2 2\n2\n\1\1\1\1\1"),
              HasSubstr("holds 5 values, expected 4"));
}

TEST_F(TruthFile, AnyRigidTransformComesBackFromItsRows) {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    core::Random random(seed);
    core::Vector6d tangent;
    for (double& x : tangent) x = random.uniform(-3.0, 3.0);
    const core::Rigid3 pose = core::exp_r3so3(tangent);
    const Eigen::Matrix4d columns = pose.matrix().transpose();  // Eigen stores by column
    const std::vector<double> rows(columns.data(), columns.data() + 16);
    const core::Rigid3 back = rigid_from_rows({"here", {}}, rows);
    EXPECT_LT(core::log_r3so3(core::inverse(pose) * back).norm(), 1e-9) << "seed " << seed;
  }
}

TEST_F(TruthFile, AMatrixThatScalesMirrorsOrProjectsIsRefused) {
  const auto refusal = [](const std::vector<double>& rows) {
    return complaint([&] { rigid_from_rows({"p.txt, line 7", {}}, rows); });
  };
  const auto is_refused = AllOf(HasSubstr("p.txt, line 7"), HasSubstr("no rigid transform"));
  EXPECT_THAT(refusal({1.1, 0, 0, 0, 0, 1.1, 0, 0, 0, 0, 1.1, 0, 0, 0, 0, 1}), is_refused);
  EXPECT_THAT(refusal({-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}), is_refused);
  EXPECT_THAT(refusal({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 1, 1}), is_refused);
  EXPECT_THAT(refusal(std::vector<double>(16, 0.0)), is_refused);
}

TEST_F(TruthFile, AliasedPairsAreReadAndAFrameThatIsNotThereIsNamed) {
  folder_.write("aliased_pairs.csv", "query,match,alike\n2,1,0.5\n1,0,0.4\n");
  const core::Truth truth = read_truth(folder_.root(), 3);
  ASSERT_EQ(truth.aliased_pairs.size(), 2U);
  EXPECT_EQ(truth.aliased_pairs[0].query, 1);
  EXPECT_EQ(truth.aliased_pairs[1].match, 1);
  for (const char* line : {"3,1,0.5", "1,1,0.5", "1,-1,0.5", "1.5,0,0.5", "2"}) {
    folder_.write("aliased_pairs.csv", std::string("query,match,alike\n") + line + "\n");
    testing::internal::CaptureStdout();
    EXPECT_TRUE(read_truth(folder_.root(), 3).aliased_pairs.empty());
    EXPECT_THAT(testing::internal::GetCapturedStdout(), HasSubstr("aliased_pairs.csv, line 2"))
        << line;
  }
}

}  // namespace
}  // namespace samewhere::input
