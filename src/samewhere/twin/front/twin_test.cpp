#include <cmath>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/features2d.hpp>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/interrupt.hpp>
#include <samewhere/core/stage_thread.hpp>
#include <samewhere/geometry/camera.hpp>
#include <samewhere/twin/front/camera.hpp>
#include <samewhere/twin/front/studio.hpp>
#include <samewhere/twin/front/twin.hpp>
#include <samewhere/twin/render/test_pictures.hpp>

namespace samewhere::twin {
namespace {

std::vector<core::Frame> render(const std::string& spec, const Config& config) {
  std::vector<core::Frame> frames;
  const auto source = open_twin(spec, config);
  while (auto frame = source->next()) frames.push_back(std::move(*frame));
  return frames;
}

double grey_at(const cv::Mat& picture, const Eigen::Vector2d& pixel) {
  const auto& bgr = picture.at<cv::Vec3b>(static_cast<int>(std::lround(pixel.y())),
                                          static_cast<int>(std::lround(pixel.x())));
  return (bgr[0] + bgr[1] + bgr[2]) / 3.0;
}

bool is_inside(const Eigen::Vector2d& pixel, const cv::Mat& picture) {
  return pixel.x() >= 0.0 && pixel.y() >= 0.0 && pixel.x() <= picture.cols - 1.0 &&
         pixel.y() <= picture.rows - 1.0;
}

// What pixels of one frame say about another, by exact depth and pose.
struct Agreement {
  int num_compared = 0;
  int num_depths_agree = 0;
  double grey_difference = 0.0;  // mean, where the depths agree
};

Agreement compare(const core::Frame& from, const core::Frame& to,
                  const core::Rigid3& to_from_from) {
  const core::Camera& camera = from.rig->cameras.front();
  Agreement agreement;
  for (int y = 4; y < from.depth_m->rows; y += 7) {
    for (int x = 4; x < from.depth_m->cols; x += 7) {
      const Eigen::Vector3d bearing = geometry::bearing(camera, {x, y});
      const Eigen::Vector3d in_from = bearing / bearing.z() * from.depth_m->at<float>(y, x);
      const Eigen::Vector3d in_to = to_from_from * in_from;
      const auto pixel = geometry::project(camera, in_to);
      if (!pixel || !is_inside(*pixel, *to.depth_m)) continue;
      const double seen_m = to.depth_m->at<float>(static_cast<int>(std::lround(pixel->y())),
                                                  static_cast<int>(std::lround(pixel->x())));
      ++agreement.num_compared;
      if (std::abs(seen_m - in_to.z()) > 0.02 * in_to.z()) continue;
      ++agreement.num_depths_agree;
      agreement.grey_difference +=
          std::abs(grey_at(from.images[0], {x, y}) - grey_at(to.images[0], *pixel));
    }
  }
  agreement.grey_difference /= std::max(1, agreement.num_depths_agree);
  return agreement;
}

TEST(Twin, TheSameSeedGivesTheSameBytesOnAnyNumberOfThreadsAndAnotherSeedDoesNot) {
  ASSERT_EQ(unsetenv("SAMEWHERE_CACHE"), 0);  // all are to be rendered
  const auto first = render("twin:office-loop?seed=3", {.num_frames = 2, .num_workers = 1});
  const auto again = render("twin:office-loop?seed=3", {.num_frames = 2, .num_workers = 3});
  const auto other = render("twin:office-loop?seed=4", {.num_frames = 2});
  ASSERT_EQ(first.size(), 2U);
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_TRUE(is_same(first[i].images[0], again[i].images[0]));
    EXPECT_TRUE(is_same(*first[i].depth_m, *again[i].depth_m));
    EXPECT_FALSE(is_same(first[i].images[0], other[i].images[0]));
  }
}

TEST(Twin, FramesAreNumberedStampedAndCalibrated) {
  const auto source = open_twin("twin:office-loop?seed=3", {.num_frames = 3});
  const core::SourceInfo info = source->info();
  EXPECT_EQ(info.name, "office-loop-seed3");
  EXPECT_EQ(info.format, "twin building");
  EXPECT_EQ(info.num_frames, 3);
  EXPECT_TRUE(info.has_depth);
  EXPECT_TRUE(info.is_calibrated);
  const core::Trajectory truth = source->truth().trajectory;
  ASSERT_EQ(truth.size(), 3U);
  for (std::uint64_t i = 0; i < 3; ++i) {
    const auto frame = source->next();
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->id, core::FrameId(i));
    EXPECT_EQ(frame->stamp_s, truth[i].stamp_s);
    EXPECT_EQ(frame->images.size(), 1U);
    EXPECT_EQ(frame->images[0].type(), CV_8UC3);
    EXPECT_EQ(frame->images[0].size(), cv::Size(640, 480));
    EXPECT_EQ(frame->depth_m->size(), cv::Size(640, 480));
    EXPECT_EQ(frame->depth_m->type(), CV_32F);
    EXPECT_TRUE(frame->rig->is_calibrated());
  }
  EXPECT_FALSE(source->next());
}

TEST(Twin, TruthIsMadeOnceAndTellsWhatTheInertialUnitDoes) {
  const Config config{.num_frames = 3};
  const auto walk =
      std::make_shared<const Walkthrough>(parse_spec("twin:office-loop?seed=3"), config);
  const core::Truth truth = open_twin(walk, config)->truth();
  EXPECT_EQ(&walk->truth(), &walk->truth());
  ASSERT_EQ(truth.inertial.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(truth.inertial[i].stamp_s, truth.trajectory[i].stamp_s);
    EXPECT_EQ(truth.inertial[i].velocity_m_s,
              walk->motion().velocity_m_s(truth.trajectory[i].stamp_s));
    EXPECT_GT(truth.inertial[i].accelerometer_bias_m_s2.norm(), 0.0);
  }
}

TEST(Twin, TheTruthCanBeInterrupted) {
  const Walkthrough walk(parse_spec("twin:office-loop?seed=3"), {.num_frames = 3});
  const auto refuse = [](int /*num_labelled*/, int /*num_pairs*/) {
    throw std::runtime_error("enough");
  };
  EXPECT_THROW(walk.truth(refuse), std::runtime_error);
  std::vector<std::pair<int, int>> heard;
  const WalkTruth& truth = walk.truth(
      [&](int num_labelled, int num_pairs) { heard.emplace_back(num_labelled, num_pairs); });
  EXPECT_EQ(heard, (std::vector<std::pair<int, int>>{{1, 6}, {3, 6}, {6, 6}}));
  EXPECT_EQ(truth.frames.size(), 3U);
  const Walkthrough other(parse_spec("twin:office-loop?seed=3"), {.num_frames = 3});
  core::catch_interrupts();
  std::raise(SIGINT);
  EXPECT_THROW(watched_truth(other), core::Interrupted);
  core::catch_interrupts();  // other tests go on
}

TEST(Twin, TheSettingsSayHowManyThreads) {
  EXPECT_EQ(num_threads({.num_workers = 3}), 3);
  EXPECT_EQ(num_threads({}), core::num_hardware_threads());
}

TEST(Twin, ABadSpecIsRefused) { EXPECT_THROW(open_twin("twin:castle", {}), core::InputError); }

TEST(Twin, ARecordedMotionThatIsNoneIsRefusedByNameOfItsFile) {
  const std::string file = testing::TempDir() + "samewhere_recorded_walk.tum";
  std::filesystem::remove(file);
  const auto refusal = [&] {
    try {
      open_twin("twin:office-loop?seed=3", {.shake = file, .num_frames = 3});
    } catch (const core::InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_THAT(refusal(), testing::HasSubstr(file)) << "there is none";
  std::ofstream(file) << "1.0 0 0 0 0 0 0 1\n";
  EXPECT_EQ(refusal(),
            "twin.shake: " + file + ": found 1 poses over 0.0 s, expected 10 s at least");
}

TEST(Twin, TheCamerasDistortionCanBeUndone) {
  const core::Camera camera = kTwinCamera;
  double largest_shift_px = 0.0;
  for (int y = 0; y < 480; y += 13) {
    for (int x = 0; x < 640; x += 13) {
      const Eigen::Vector2d pixel(x, y);
      const auto back = geometry::project(camera, geometry::bearing(camera, pixel));
      ASSERT_TRUE(back);
      ASSERT_LT((*back - pixel).norm(), 1e-6) << x << ' ' << y;
      largest_shift_px =
          std::max(largest_shift_px, (geometry::undistort(camera, pixel) - pixel).norm());
    }
  }
  EXPECT_GT(largest_shift_px, 1.0) << "distortion is to be exercised";
}

// Depth, poses, camera model and pictures belong together: a point seen in one frame lies at the
// right depth in another, and looks the same there.
TEST(Twin, APointOfOneFrameIsFoundInAnother) {
  const auto source = open_twin("twin:office-loop?seed=3", {.ideal_depth = true, .num_frames = 7});
  const core::Trajectory walk = source->truth().trajectory;
  std::vector<core::Frame> frames;
  while (auto frame = source->next()) frames.push_back(std::move(*frame));
  const core::Rigid3 last_from_first =
      inverse(walk[6].world_from_camera) * walk[0].world_from_camera;
  const Agreement right = compare(frames[0], frames[6], last_from_first);
  EXPECT_GT(right.num_compared, 2000);
  EXPECT_GT(right.num_depths_agree, 0.95 * right.num_compared);
  EXPECT_LT(right.grey_difference, 10.0);
  // with the wrong pose they do not fit
  const Agreement wrong = compare(frames[0], frames[6], inverse(last_from_first));
  EXPECT_LT(wrong.num_depths_agree, 0.8 * wrong.num_compared);
  EXPECT_GT(wrong.grey_difference, 1.5 * right.grey_difference);
}

TEST(Twin, MeasuredDepthIsNearTheTruthWhereThereIsAny) {
  const auto ideal = render("twin:office-loop?seed=3", {.ideal_depth = true, .num_frames = 1});
  const auto measured = render("twin:office-loop?seed=3", {.num_frames = 1});
  EXPECT_TRUE(is_same(ideal[0].images[0], measured[0].images[0]));
  int num_measured = 0;
  double sum_squared = 0.0;
  for (int y = 0; y < 480; ++y) {
    for (int x = 0; x < 640; ++x) {
      const double truth_m = ideal[0].depth_m->at<float>(y, x);
      const double seen_m = measured[0].depth_m->at<float>(y, x);
      ASSERT_GT(truth_m, 0.0);
      if (seen_m == 0.0) continue;
      ASSERT_GT(truth_m, 0.3);
      ASSERT_LT(truth_m, 8.0);
      const double error = (seen_m - truth_m) / (truth_m * truth_m);
      ASSERT_LT(std::abs(error), 0.0015 * 3.5 + 0.002);
      ++num_measured;
      sum_squared += error * error;
    }
  }
  const double share = num_measured / (640.0 * 480.0);
  EXPECT_GT(share, 0.6);
  EXPECT_LT(share, 0.98);
  // noise of 0.0015 and steps of 1 / (43 * 8), uniform within
  const double expected = std::hypot(0.0015, 1.0 / (43.0 * 8.0) / std::sqrt(12.0));
  EXPECT_NEAR(std::sqrt(sum_squared / num_measured), expected, 0.15 * expected);
}

TEST(Twin, CornersAreSpreadOverThePicture) {
  constexpr int kCell_px = 80;
  for (const auto& frame : render("twin:office-loop?seed=6", {.num_frames = 2})) {
    cv::Mat channel;
    cv::extractChannel(frame.images[0], channel, 1);
    std::vector<cv::KeyPoint> corners;
    cv::FAST(channel, corners, 20);
    EXPECT_GT(corners.size(), 400U);
    EXPECT_LT(corners.size(), 2000U) << "a corridor, not white noise";
    std::vector<int> num_in_cell(48, 0);
    for (const auto& corner : corners) {
      ++num_in_cell[static_cast<std::size_t>(static_cast<int>(corner.pt.y) / kCell_px * 8 +
                                             static_cast<int>(corner.pt.x) / kCell_px)];
    }
    const auto num_filled =
        std::count_if(num_in_cell.begin(), num_in_cell.end(), [](int num) { return num >= 3; });
    EXPECT_GT(num_filled, 30) << "of 48 cells";
  }
}

}  // namespace
}  // namespace samewhere::twin
