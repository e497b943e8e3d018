#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <string>
#include <utility>

#include <Eigen/Dense>
#include <fmt/format.h>
#include <opencv2/calib3d.hpp>
#include <opencv2/core/eigen.hpp>
#include <opencv2/imgproc.hpp>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/grey.hpp>
#include <samewhere/core/median.hpp>
#include <samewhere/core/random.hpp>
#include <samewhere/geometry/calibration.hpp>
#include <samewhere/geometry/camera.hpp>

namespace samewhere::geometry {
namespace {

using core::InputError;

constexpr double kDegrees_per_rad = 180.0 / std::numbers::pi;
constexpr std::size_t kMinViews = 3;

[[noreturn]] void fail_alike(double largest_rad) {
  throw InputError(
      fmt::format("calibration: the board is turned by {:.1f} degrees at most from picture to "
                  "picture, expected "
                  "at least 10: tilt it differently before the camera",
                  largest_rad * kDegrees_per_rad));
}

// The largest angle between the planes of two boards. Turning within the plane tells nothing.
double largest_tilt_rad(const std::vector<cv::Mat>& turns) {
  std::vector<cv::Vec3d> normals;
  for (const cv::Mat& turn : turns) {
    cv::Matx33d camera_from_board;
    cv::Rodrigues(turn, camera_from_board);
    normals.emplace_back(camera_from_board.col(2).val);
  }
  double min_cosine = 1.0;
  for (const cv::Vec3d& a : normals) {
    for (const cv::Vec3d& b : normals) min_cosine = std::min(min_cosine, std::abs(a.dot(b)));
  }
  return std::acos(std::min(min_cosine, 1.0));
}

// As much around a corner as shows no other one.
int half_window_px(const Board& board, const std::vector<cv::Point2f>& corners) {
  double nearest_px = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < corners.size(); ++i) {
    if (i % static_cast<std::size_t>(board.num_columns) == 0) continue;  // from row to row
    nearest_px = std::min(nearest_px, cv::norm(corners[i] - corners[i - 1]));
  }
  constexpr double kShare = 0.35;
  return static_cast<int>(std::clamp(kShare * nearest_px, 2.0, 8.0));
}

// All that cv::calibrateCamera finds.
struct Fit {
  cv::Matx33d k = cv::Matx33d::eye();
  cv::Mat distortion;
  std::vector<cv::Mat> turns;
  std::vector<cv::Mat> shifts;
  cv::Mat view_rmse_px;
  double rmse_px = 0.0;
};

Fit fit_camera(const std::vector<cv::Point3f>& board,
               const std::vector<std::vector<cv::Point2f>>& views, const cv::Size& size_px) {
  const std::vector<std::vector<cv::Point3f>> boards(views.size(), board);
  Fit fit;
  try {
    fit.rmse_px =
        cv::calibrateCamera(boards, views, size_px, fit.k, fit.distortion, fit.turns, fit.shifts,
                            cv::noArray(), cv::noArray(), fit.view_rmse_px, cv::CALIB_FIX_K3);
  } catch (const cv::Exception&) {
    fail_alike(0.0);  // equations that determine nothing
  }
  return fit;
}

constexpr Eigen::Index kNumPose = 6;        // turn and shift of a board
constexpr Eigen::Index kNumIntrinsics = 8;  // fx fy cx cy k1 k2 p1 p2

// How the corners of one view move with the intrinsics, fx and fy by their share, beyond what
// another pose of its board would explain as well.
Eigen::MatrixXd effect_of_intrinsics(const Fit& fit, const std::vector<cv::Point3f>& board,
                                     std::size_t view) {
  std::vector<cv::Point2f> unused;
  cv::Mat columns;
  cv::projectPoints(board, fit.turns[view], fit.shifts[view], fit.k, fit.distortion, unused,
                    columns);
  Eigen::MatrixXd jacobian;
  cv::cv2eigen(columns, jacobian);
  const Eigen::MatrixXd pose = jacobian.leftCols(kNumPose).colwise().normalized();
  Eigen::MatrixXd intrinsics = jacobian.middleCols(kNumPose, kNumIntrinsics);
  intrinsics.col(0) *= fit.k(0, 0);
  intrinsics.col(1) *= fit.k(1, 1);
  return intrinsics - pose * pose.colPivHouseholderQr().solve(intrinsics);
}

// The standard deviation of fx or fy, the larger share of it. That of cv::calibrateCamera is of no
// use here: it inverts by pseudo-inverse, which takes what the views do not tell for well known.
double focal_sd_ratio(const Fit& fit, const std::vector<cv::Point3f>& board) {
  const auto num_rows = static_cast<Eigen::Index>(2 * board.size());
  const auto num_views = static_cast<Eigen::Index>(fit.turns.size());
  Eigen::MatrixXd effect(num_views * num_rows, kNumIntrinsics);
  for (Eigen::Index i = 0; i < num_views; ++i) {
    effect.middleRows(i * num_rows, num_rows) =
        effect_of_intrinsics(fit, board, static_cast<std::size_t>(i));
  }
  const Eigen::VectorXd scale = effect.colwise().norm();
  effect *= scale.cwiseInverse().asDiagonal();
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(effect);
  const Eigen::MatrixXd r = qr.matrixQR().topRows(kNumIntrinsics).triangularView<Eigen::Upper>();
  const Eigen::MatrixXd root_covariance = r.inverse();
  // No detector is better than this on paper that is not quite flat, however well the model fits.
  constexpr double kMinCorner_px = 0.1;
  const auto num_spare = static_cast<double>(num_views * (num_rows - kNumPose) - kNumIntrinsics);
  const double corner_px =
      std::max(fit.rmse_px * std::sqrt(static_cast<double>(num_views * num_rows) / 2.0 / num_spare),
               kMinCorner_px);
  return corner_px * std::max(root_covariance.row(0).norm() / scale(0),
                              root_covariance.row(1).norm() / scale(1));
}

// Twelve boards tilted by 10 degrees tell the focal lengths to 0.7 %, three by 20 degrees to 2 %;
// twelve that face the camera to no better than 25 %, whatever noise makes of them. NaN is refused.
void require_known_focal_lengths(const core::PinholeRadtan& camera, double sd_ratio) {
  constexpr double kMaxRatio = 0.03;
  if (sd_ratio <= kMaxRatio) return;
  const std::string known =
      sd_ratio < 1.0 ? fmt::format("to {:.1f} % only", 100.0 * sd_ratio) : "not at all";
  throw InputError(
      fmt::format("calibration: the boards tell the focal lengths (fx {:.1f}, fy {:.1f} px) {}, "
                  "expected to {:.0f} % or better: tilt the board by 20 degrees and more, "
                  "differently in each picture",
                  camera.fx_px, camera.fy_px, known, 100.0 * kMaxRatio));
}

void require_plausible_view(const core::PinholeRadtan& camera) {
  const double view_rad = horizontal_field_of_view_rad(camera);
  if (view_rad >= kMinFieldOfView_rad && view_rad <= kMaxFieldOfView_rad) return;
  throw InputError(
      fmt::format("calibration: found a horizontal field of view of {:.1f} degrees (fx {:.1f} px, "
                  "pictures {} px wide), expected {:.0f} to {:.0f}",
                  view_rad * kDegrees_per_rad, camera.fx_px, camera.width_px,
                  kMinFieldOfView_rad * kDegrees_per_rad, kMaxFieldOfView_rad * kDegrees_per_rad));
}

core::PinholeRadtan camera_of(const cv::Matx33d& k, const cv::Mat& distortion,
                              const cv::Size& size_px) {
  return {.width_px = size_px.width,
          .height_px = size_px.height,
          .fx_px = k(0, 0),
          .fy_px = k(1, 1),
          .cx_px = k(0, 2),
          .cy_px = k(1, 2),
          .k1 = distortion.at<double>(0),
          .k2 = distortion.at<double>(1),
          .p1 = distortion.at<double>(2),
          .p2 = distortion.at<double>(3)};
}

}  // namespace

std::vector<cv::Point3f> corners_in_board(const Board& board) {
  std::vector<cv::Point3f> corners;
  for (int row = 0; row < board.num_rows; ++row) {
    for (int column = 0; column < board.num_columns; ++column) {
      corners.emplace_back(static_cast<float>(column * board.square_m),
                           static_cast<float>(row * board.square_m), 0.0F);
    }
  }
  return corners;
}

std::optional<std::vector<cv::Point2f>> find_board(const cv::Mat& image, const Board& board) {
  const cv::Mat grey = core::as_grey(image);
  std::vector<cv::Point2f> corners;
  if (!cv::findChessboardCornersSB(grey, {board.num_columns, board.num_rows}, corners,
                                   cv::CALIB_CB_NORMALIZE_IMAGE | cv::CALIB_CB_EXHAUSTIVE)) {
    return std::nullopt;
  }
  const int half_px = half_window_px(board, corners);
  const cv::TermCriteria until(cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 50, 1e-3);
  cv::cornerSubPix(grey, corners, {half_px, half_px}, {-1, -1}, until);
  return corners;
}

namespace {

using Corners = std::vector<cv::Point2f>;

// More than a detector errs; a view that errs less belongs to the camera.
constexpr double kMinError_px = 0.3;

std::vector<Corners> chosen(const std::vector<Corners>& views,
                            const std::vector<std::size_t>& which) {
  std::vector<Corners> some;
  for (const std::size_t view : which) some.push_back(views[view]);
  return some;
}

// Of each view, fitted to or not, with the pose that suits it best.
std::vector<double> errors_of_views_px(const Fit& fit, const std::vector<cv::Point3f>& board,
                                       const std::vector<Corners>& views) {
  std::vector<double> errors_px;
  for (const Corners& view : views) {
    cv::Mat turn;
    cv::Mat shift;
    cv::solvePnP(board, view, fit.k, fit.distortion, turn, shift);
    Corners projected;
    cv::projectPoints(board, turn, shift, fit.k, fit.distortion, projected);
    errors_px.push_back(cv::norm(projected, view) / std::sqrt(static_cast<double>(view.size())));
  }
  return errors_px;
}

// A few views by chance, ascending.
std::vector<std::size_t> drawn(std::size_t num_views, std::size_t count, core::Random& random) {
  std::vector<int> few =
      random.distinct_indices(static_cast<int>(count), static_cast<int>(num_views));
  std::sort(few.begin(), few.end());
  return {few.begin(), few.end()};
}

// The errors of all views under the camera of a few, of which half of all views err least (least
// median, Rousseeuw 1984). Empty: no few views make a camera.
std::vector<double> errors_by_least_median_px(const std::vector<cv::Point3f>& board,
                                              const std::vector<Corners>& views,
                                              const cv::Size& size_px) {
  constexpr int kNumDraws = 20;
  constexpr std::size_t kNumDrawn = 4;
  core::Random random(1);
  std::vector<double> best_px;
  for (int i = 0; i < kNumDraws; ++i) {
    const auto few = drawn(views.size(), std::min(kNumDrawn, views.size() - 1), random);
    try {
      const Fit fit = fit_camera(board, chosen(views, few), size_px);
      std::vector<double> errors_px = errors_of_views_px(fit, board, views);
      if (best_px.empty() || core::median(errors_px) < core::median(best_px))
        best_px = std::move(errors_px);
    } catch (const InputError&) {  // these few are alike
    } catch (const cv::Exception&) {
    }
  }
  return best_px;
}

std::vector<std::size_t> views_below(const std::vector<double>& errors_px, double limit_px) {
  std::vector<std::size_t> below;
  for (std::size_t i = 0; i < errors_px.size(); ++i) {
    if (errors_px[i] <= limit_px) below.push_back(i);
  }
  return below;
}

// The views of one camera: those that err by no more than several times the median. All of them if
// all err little or alike, or if fewer than two thirds agree.
std::vector<std::size_t> views_of_one_camera(const Fit& fit_to_all,
                                             const std::vector<cv::Point3f>& board,
                                             const std::vector<Corners>& views,
                                             const cv::Size& size_px) {
  constexpr double kManyTimes = 3.0;
  constexpr double kDetector_px = 0.15;  // errors of sound views, however many times their median
  constexpr double kEvenRatio = 1.3;     // noise alone makes views differ by less
  constexpr int kNumRounds = 3;
  std::vector<std::size_t> all(views.size());
  std::iota(all.begin(), all.end(), 0);
  const std::size_t num_needed = std::max(kMinViews, views.size() - views.size() / 3);
  const std::vector<double> fitted_px(fit_to_all.view_rmse_px.begin<double>(),
                                      fit_to_all.view_rmse_px.end<double>());
  const double worst_px = *std::max_element(fitted_px.begin(), fitted_px.end());
  const double median_px = core::median(fitted_px).value_or(worst_px);
  const bool is_even = worst_px <= kDetector_px || worst_px <= kEvenRatio * median_px;
  if (is_even || num_needed == views.size()) return all;
  std::vector<double> errors_px = errors_by_least_median_px(board, views, size_px);
  std::vector<std::size_t> sound;
  for (int round = 0; round < kNumRounds; ++round) {
    const double usual_px = core::median(errors_px).value_or(worst_px);
    sound = views_below(errors_px, std::max(kManyTimes * usual_px, kMinError_px));
    if (sound.size() < num_needed || sound.size() == views.size()) return all;
    errors_px = errors_of_views_px(fit_camera(board, chosen(views, sound), size_px), board, views);
  }
  return sound;
}

// The views that the camera is fitted to, and what is left out.
struct SoundFit {
  Fit fit;
  std::vector<std::size_t> used;
  std::vector<std::size_t> left_out;
};

SoundFit fit_to_sound_views(const std::vector<cv::Point3f>& board,
                            const std::vector<Corners>& views, const cv::Size& size_px) {
  SoundFit sound{fit_camera(board, views, size_px), {}, {}};
  sound.used = views_of_one_camera(sound.fit, board, views, size_px);
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (!std::binary_search(sound.used.begin(), sound.used.end(), i)) sound.left_out.push_back(i);
  }
  if (!sound.left_out.empty()) sound.fit = fit_camera(board, chosen(views, sound.used), size_px);
  return sound;
}

// Each view's: of those that the camera is fitted to as fitted, of the others at their best.
std::vector<double> view_errors_px(const SoundFit& sound, const std::vector<cv::Point3f>& board,
                                   const std::vector<Corners>& views) {
  std::vector<double> errors_px(views.size());
  if (!sound.left_out.empty()) errors_px = errors_of_views_px(sound.fit, board, views);
  for (std::size_t i = 0; i < sound.used.size(); ++i)
    errors_px[sound.used[i]] = sound.fit.view_rmse_px.at<double>(static_cast<int>(i));
  return errors_px;
}

}  // namespace

Calibration calibrate(const Board& board, const std::vector<std::vector<cv::Point2f>>& views,
                      const cv::Size& size_px) {
  constexpr double kMinTilt_rad = 10.0 / kDegrees_per_rad;
  if (views.size() < kMinViews) {
    throw InputError(
        fmt::format("calibration: found the board of {} x {} inner corners in {} pictures, "
                    "expected at least {}",
                    board.num_columns, board.num_rows, views.size(), kMinViews));
  }
  const std::vector<cv::Point3f> corners = corners_in_board(board);
  const SoundFit sound = fit_to_sound_views(corners, views, size_px);
  const Fit& fit = sound.fit;
  const double tilt_rad = largest_tilt_rad(fit.turns);
  if (!std::isfinite(fit.rmse_px) || !(tilt_rad >= kMinTilt_rad)) fail_alike(tilt_rad);
  const core::PinholeRadtan camera = camera_of(fit.k, fit.distortion, size_px);
  const double sd_ratio = focal_sd_ratio(fit, corners);
  require_known_focal_lengths(camera, sd_ratio);
  require_plausible_view(camera);
  return {.camera = camera,
          .rmse_px = fit.rmse_px,
          .view_rmse_px = view_errors_px(sound, corners, views),
          .left_out = sound.left_out,
          .focal_sd_ratio = sd_ratio};
}

}  // namespace samewhere::geometry
