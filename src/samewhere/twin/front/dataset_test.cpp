#include <csignal>
#include <functional>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>
#include <samewhere/core/interrupt.hpp>
#include <samewhere/twin/front/dataset.hpp>
#include <samewhere/twin/front/test_source.hpp>

namespace samewhere::twin {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

// A source to which something happens in the middle.
class BreakingSource : public TestSource {
 public:
  explicit BreakingSource(std::function<void()> happen)
      : TestSource(5, 1, 1), happen_(std::move(happen)) {}

  std::optional<core::Frame> next() override {
    if (++num_asked_ == 3) happen_();
    return TestSource::next();
  }

 private:
  std::function<void()> happen_;
  int num_asked_ = 0;
};

class Dataset : public testing::Test {
 protected:
  Dataset() {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    root_ = std::filesystem::path(testing::TempDir()) /
            ("samewhere_dataset_" + std::string(test->name()) + "_" + std::to_string(getpid()));
    std::filesystem::create_directories(root_);
  }
  ~Dataset() override { std::filesystem::remove_all(root_); }

  std::filesystem::path target() const { return root_ / "walk"; }
  bool is_root_empty() const { return std::filesystem::is_empty(root_); }

  static std::string complaint(const std::function<void()>& action) {
    try {
      action();
    } catch (const core::InputError& error) {
      return error.what();
    }
    return "no error";
  }

  std::filesystem::path root_;
};

TEST_F(Dataset, ATumFolderHoldsTheFilesOfTheFormat) {
  TestSource source(3, 1, 1);
  write_tum_folder(source, root_ / "walk/");
  EXPECT_FALSE(std::filesystem::exists(root_ / "walk.partial"));
  EXPECT_TRUE(std::filesystem::exists(target() / "rgb/2.066667.png"));
  EXPECT_TRUE(std::filesystem::exists(target() / "depth/2.133333.png"));
  EXPECT_THAT(core::read_file(target() / "rgb.txt"),
              AllOf(StartsWith("# color images\n# file: 'test-walk'\n# timestamp filename\n"),
                    HasSubstr("\n2.066667 rgb/2.066667.png\n")));
  EXPECT_THAT(core::read_file(target() / "depth.txt"), HasSubstr("2.133333 depth/2.133333.png\n"));
  EXPECT_THAT(core::read_file(target() / "accelerometer.txt"),
              AllOf(HasSubstr("# timestamp ax ay az\n"), HasSubstr("\n2.000000 ")));
  EXPECT_THAT(core::read_file(target() / "groundtruth.txt"),
              HasSubstr("# timestamp tx ty tz qx qy qz qw\n2.000000 "));
  EXPECT_TRUE(std::filesystem::exists(target() / "camera.txt"));
  EXPECT_THAT(core::read_file(target() / "same_place.pgm"),
              testing::Eq(std::string("P5\n3 3\n2\n\0\1\2\0\1\2\0\1\2", 18)));
  EXPECT_FALSE(std::filesystem::exists(target() / "loops.csv"));
}

TEST_F(Dataset, AEurocFolderHoldsTheFilesOfTheFormat) {
  TestSource source(3, 2, 1);
  write_euroc_folder(source, target());
  for (const char* name :
       {"body.yaml", "cam0/sensor.yaml", "cam1/sensor.yaml", "imu0/data.csv", "imu0/sensor.yaml",
        "cam1/data/2066666667.png", "state_groundtruth_estimate0/sensor.yaml"}) {
    EXPECT_TRUE(std::filesystem::exists(target() / "mav0" / name)) << name;
  }
  EXPECT_THAT(core::read_file(target() / "mav0/cam0/data.csv"),
              AllOf(StartsWith("#timestamp [ns],filename\n2000000000,2000000000.png\n"),
                    HasSubstr("\n2133333333,2133333333.png\n")));
  EXPECT_THAT(core::read_file(target() / "mav0/cam0/sensor.yaml"),
              AllOf(HasSubstr("\nrate_hz: 15\n"), HasSubstr("\nresolution: [40, 30]\n"),
                    HasSubstr("[0.05, -0.08, 0.0006, -0.0004]")));
}

TEST_F(Dataset, TruthIsWrittenAsTables) {
  TestSource source(2, 1, 1);
  SideTables tables;
  WalkTruth& truth = tables.truth;
  truth.frames = {{0, "corridor 1", 0}, {1, "a \"lab\", say", -1}};
  tables.wheels = {{0.02, 0.01, -0.001}};
  truth.loops = {{1, 0, 0.75, true, "door 12"}, {1, 0, 0.4, false, ""}};
  truth.overlap = {255, 10, 13, 255};
  write_tum_folder(source, target(), [&] { return tables; });
  EXPECT_EQ(core::read_file(target() / "frames.csv"),
            "frame,stamp_s,visit,room,floor\n0,2.000000000,0,corridor 1,0\n"
            "1,2.066666667,1,\"a \"\"lab\"\", say\",-1\n");
  EXPECT_EQ(core::read_file(target() / "loops.csv"),
            "query,match,overlap,confirmable,object\n1,0,0.7500,1,door 12\n1,0,0.4000,0,\n");
  EXPECT_EQ(core::read_file(target() / "aliased_pairs.csv"), "query,match,alike\n");
  EXPECT_EQ(core::read_file(target() / "wheels.csv"),
            "stamp_s,forward_m,turned_rad\n0.020000000,0.010000000,-0.001000000\n");
  EXPECT_EQ(core::read_file(target() / "overlap.pgm"), "P5\n2 2\n255\n\xff\x0a\x0d\xff");
}

TEST_F(Dataset, InertialTruthIsWrittenAsItIs) {
  TestSource source(3, 1, 1);
  write_euroc_folder(source, target());
  const core::InertialTruth second = source.truth().inertial[1];
  const Eigen::Vector3d& v = second.velocity_m_s;
  const Eigen::Vector3d& w = second.gyroscope_bias_rad_s;
  const Eigen::Vector3d& a = second.accelerometer_bias_m_s2;
  EXPECT_THAT(core::read_file(target() / "mav0/state_groundtruth_estimate0/data.csv"),
              HasSubstr(fmt::format(
                  ",{:.9f},{:.9f},{:.9f},{:.12f},{:.12f},{:.12f},{:.9f},{:.9f},{:.9f}\n2133333333,",
                  v.x(), v.y(), v.z(), w.x(), w.y(), w.z(), a.x(), a.y(), a.z())));
  EXPECT_THAT(core::read_file(target() / "mav0/state_groundtruth_estimate0/sensor.yaml"),
              HasSubstr("comment: exact\n"));
  EXPECT_THAT(core::read_file(target() / "mav0/imu0/sensor.yaml"),
              AllOf(HasSubstr("\ngyroscope_random_walk: 1.9e-05 "),
                    HasSubstr("\naccelerometer_random_walk: 0.003 ")));
}

TEST_F(Dataset, ANameThatWindsIsTheOneThatItLeadsTo) {
  TestSource first(2, 1, 1);
  EXPECT_THAT(complaint([&] { write_tum_folder(first, root_ / "new/.."); }),
              HasSubstr("is there already"));
  EXPECT_TRUE(is_root_empty());
  TestSource second(2, 1, 1);
  write_tum_folder(second, root_ / "new/../walk");
  EXPECT_TRUE(std::filesystem::exists(target() / "rgb.txt"));
}

TEST_F(Dataset, TablesAreAskedForOnceAndNotBeforeTheNameIsClaimed) {
  int num_asked = 0;
  const MakeTables tables = [&] {
    ++num_asked;
    return SideTables{.truth = {.frames = std::vector<FrameTruth>(2)}, .wheels = {}};
  };
  core::write_file(target(), "mine");
  bool is_source_asked = false;
  BreakingSource source([&] { is_source_asked = true; });
  EXPECT_THAT(complaint([&] { write_tum_folder(source, target(), tables); }),
              HasSubstr("is there already"));
  EXPECT_EQ(num_asked, 0);
  EXPECT_FALSE(is_source_asked);
  std::filesystem::remove(target());
  TestSource other(2, 1, 1);
  write_euroc_folder(other, target(), tables);
  EXPECT_EQ(num_asked, 1);
}

TEST_F(Dataset, WhatIsThereAlreadyIsNotTouched) {
  for (const char* taken : {"walk", "walk.partial"}) {
    core::write_file(root_ / taken, "mine");
    TestSource source(2, 1, 1);
    EXPECT_THAT(complaint([&] { write_tum_folder(source, target()); }), HasSubstr(taken));
    EXPECT_THAT(complaint([&] { write_euroc_folder(source, target()); }), HasSubstr(taken));
    EXPECT_EQ(core::read_file(root_ / taken), "mine");
    std::filesystem::remove(root_ / taken);
  }
  EXPECT_TRUE(is_root_empty());
}

TEST_F(Dataset, ABrokenSourceLeavesNothing) {
  const auto fail = [] { throw core::InputError("frame 2 is broken"); };
  BreakingSource first(fail);
  EXPECT_EQ(complaint([&] { write_tum_folder(first, target()); }), "frame 2 is broken");
  BreakingSource second(fail);
  EXPECT_EQ(complaint([&] { write_euroc_folder(second, target()); }), "frame 2 is broken");
  EXPECT_TRUE(is_root_empty());
}

TEST_F(Dataset, AFullDiskIsNamedAndLeavesNothing) {
  const FullDisk full;
  TestSource source(2, 1, 1);
  EXPECT_THAT(complaint([&] { write_tum_folder(source, target()); }),
              AllOf(HasSubstr("walk.partial/rgb/2.000000.png"), HasSubstr("cannot be written")));
  EXPECT_TRUE(is_root_empty());
}

TEST_F(Dataset, EurocNeedsACalibration) {
  TestSource source(2, 0, 1);
  EXPECT_THAT(complaint([&] { write_euroc_folder(source, target()); }),
              AllOf(HasSubstr("test-walk"), HasSubstr("calibrated cameras")));
  EXPECT_TRUE(is_root_empty());
  TestSource again(2, 0, 1);
  write_tum_folder(again, target());
  EXPECT_FALSE(std::filesystem::exists(target() / "camera.txt"));
}

TEST_F(Dataset, AnInterruptLeavesNothing) {
  core::catch_interrupts();
  BreakingSource source([] { std::raise(SIGINT); });
  EXPECT_THROW(write_tum_folder(source, target()), core::Interrupted);
  TestSource other(2, 1, 1);
  EXPECT_THROW(write_euroc_folder(other, target()), core::Interrupted);
  EXPECT_TRUE(is_root_empty());
  core::catch_interrupts();  // other tests go on
}

}  // namespace
}  // namespace samewhere::twin
