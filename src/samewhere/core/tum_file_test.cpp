#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>
#include <samewhere/core/random.hpp>
#include <samewhere/core/tum_file.hpp>

namespace samewhere::core {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class TumFile : public testing::Test {
 protected:
  TumFile() {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    path_ = std::filesystem::path(testing::TempDir()) /
            (std::string("tum_file_") + test->name() + std::to_string(getpid()) + ".txt");
  }
  ~TumFile() override { std::filesystem::remove(path_); }

  Trajectory read(const std::string& text) {
    write_file(path_, text);
    return read_tum(path_);
  }

  // The message of the InputError, or "" if there is none.
  std::string complaint_about(const std::string& text) {
    try {
      read(text);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }

  std::filesystem::path path_;
};

TEST_F(TumFile, HeaderCommentsAndBlankLinesAreSkipped) {
  const Trajectory trajectory = read(
      "# ground truth trajectory\n# file: 'x.bag'\n# timestamp tx ty tz qx qy qz qw\n\n"
      "1305031225.9334 1.3357 0.6698 1.6180 0 0 0.6 0.8\r\n   \n"
      "1305031225.9434 1.3352 0.6704 1.6175 0.0 0.0 0.0 1.0");
  ASSERT_EQ(trajectory.size(), 2U);
  EXPECT_DOUBLE_EQ(trajectory[0].stamp_s, 1305031225.9334);
  EXPECT_EQ(trajectory[0].world_from_camera.translation, Eigen::Vector3d(1.3357, 0.6698, 1.6180));
  EXPECT_DOUBLE_EQ(trajectory[0].world_from_camera.rotation.z(), 0.6);
  EXPECT_DOUBLE_EQ(trajectory[0].world_from_camera.rotation.w(), 0.8);
}

TEST_F(TumFile, AQuaternionIsNormalised) {
  const Trajectory trajectory = read("0 0 0 0 0 3 0 4\n");
  EXPECT_DOUBLE_EQ(trajectory[0].world_from_camera.rotation.y(), 0.6);
  EXPECT_DOUBLE_EQ(trajectory[0].world_from_camera.rotation.w(), 0.8);
}

TEST_F(TumFile, WhatIsWrittenReadsBack) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Random random(seed);
    Trajectory written;
    for (int i = 0; i < 20; ++i) {
      Vector6d tangent;
      for (double& x : tangent) x = random.uniform(-3.0, 3.0);
      written.push_back({1e9 + i + random.uniform(), exp_r3so3(tangent)});
    }
    const Trajectory back = read(tum_text(written));
    ASSERT_EQ(back.size(), written.size());
    for (std::size_t i = 0; i < back.size(); ++i) {
      EXPECT_NEAR(back[i].stamp_s, written[i].stamp_s, 1e-6);
      const Rigid3 difference = inverse(written[i].world_from_camera) * back[i].world_from_camera;
      EXPECT_LT(log_r3so3(difference).norm(), 1e-8);
    }
  }
}

TEST_F(TumFile, TheTextHasFixedDecimals) {
  EXPECT_EQ(tum_text({{12.5, {Eigen::Quaterniond::Identity(), {1.0, 2.0, 1.0 / 3.0}}}}),
            "12.500000 1.000000000 2.000000000 0.333333333 0.000000000 0.000000000 0.000000000 "
            "1.000000000\n");
}

TEST_F(TumFile, AShortLineIsNamed) {
  EXPECT_THAT(complaint_about("# header\n0 0 0 0 0 0 0 1\n1 2 3\n"),
              AllOf(HasSubstr(path_.string() + ", line 3"), HasSubstr("3 values"),
                    HasSubstr("expected 8")));
}

TEST_F(TumFile, MoreColumnsAreRefusedOrSkipped) {
  const std::string text = "0 1 2 3 0 0 0 1 0.1 0.2\n1, 4, 5, 6, 0, 0, 0, 1, 0.1\n";
  EXPECT_THAT(complaint_about(text), HasSubstr("found 10 values, expected 8"));
  write_file(path_, text);
  const Trajectory trajectory = read_tum(path_, MoreColumns::kSkipped);
  ASSERT_EQ(trajectory.size(), 2U);
  EXPECT_EQ(trajectory[1].world_from_camera.translation, Eigen::Vector3d(4.0, 5.0, 6.0));
}

TEST_F(TumFile, WhatIsNoFiniteNumberIsNamed) {
  for (const char* word : {"nan", "NaN", "inf", "-inf", "1e999", "0x1p", "\x89PNG"}) {
    SCOPED_TRACE(word);
    EXPECT_THAT(complaint_about(std::string("0 0 0 ") + word + " 0 0 0 1\n"),
                AllOf(HasSubstr("line 1"), HasSubstr("expected a finite number")));
  }
}

TEST_F(TumFile, AZeroQuaternionIsRefused) {
  EXPECT_THAT(complaint_about("0 0 0 0 0 0 0 0\n"),
              AllOf(HasSubstr("line 1"), HasSubstr("expected a unit quaternion")));
}

TEST_F(TumFile, StampsThatDoNotRiseAreRefusedWithBothStamps) {
  EXPECT_THAT(complaint_about("2 0 0 0 0 0 0 1\n2 0 0 0 0 0 0 1\n"),
              AllOf(HasSubstr("line 2"), HasSubstr("2.000000 after 2.000000")));
  EXPECT_THAT(complaint_about("2 0 0 0 0 0 0 1\n1.5 0 0 0 0 0 0 1\n"),
              HasSubstr("1.500000 after 2.000000"));
}

TEST_F(TumFile, AMissingFileIsNamed) {
  try {
    read_tum(path_);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr(path_.string()));
  }
}

}  // namespace
}  // namespace samewhere::core
