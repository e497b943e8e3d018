#include <algorithm>
#include <utility>

#include <samewhere/core/median.hpp>
#include <samewhere/geometry/camera.hpp>
#include <samewhere/map/mapper.hpp>
#include <samewhere/pipeline/view_evidence.hpp>

namespace samewhere::pipeline {
namespace {

// Of the distance to the visible landmarks. In a map with open loops one place exists twice, apart
// by the accumulated drift.
constexpr double kOnePlaceRatio = 0.25;
constexpr double kOnePlace_rad = 0.35;
// Change of distance, by this factor, at which a landmark still looks as it was described.
constexpr double kMaxDistanceRatio = 1.3;
// Of the visible landmarks of the hypothesis with most, in a view or a cell of it: with fewer, the
// map ends there.
constexpr double kMinComparableRatio = 0.5;
constexpr double kMargin_px = 8.0;  // no feature is detected closer to the image border
constexpr int kMinExpected = 30;    // landmarks from which a share is measured

bool is_inside(const Eigen::Vector2d& pixel, const cv::Size& size_px) {
  return pixel.x() > kMargin_px && pixel.y() > kMargin_px &&
         pixel.x() < size_px.width - kMargin_px && pixel.y() < size_px.height - kMargin_px;
}

// Of columns * rows.
std::size_t cell_of(const Eigen::Vector2d& pixel, const cv::Size& size_px) {
  const auto part = [](double at_px, int end_px, int parts) {
    return static_cast<int>(std::clamp(at_px / end_px * parts, 0.0, parts - 1.0));
  };
  const int row = part(pixel.y(), size_px.height, ViewEvidence::kRows);
  return static_cast<std::size_t>(row * ViewEvidence::kColumns +
                                  part(pixel.x(), size_px.width, ViewEvidence::kColumns));
}

// Calls visit(index, pixel) for each visible landmark.
template <typename Visit>
void for_each_visible(const scene::LocalMap& local_map, const features::View& view,
                      const core::Rigid3& reference_from_body, const Visit& visit) {
  const core::Rigid3 camera_from_reference =
      inverse(reference_from_body * view.rig->body_from_camera[0]);
  for (int i = 0; i < local_map.size(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    const Eigen::Vector3d point = camera_from_reference * local_map.points_in_reference[k];
    const double nearer = local_map.range_m[k] / point.norm();
    const bool looks_as_described = nearer < kMaxDistanceRatio && 1.0 / nearer < kMaxDistanceRatio;
    const auto pixel = geometry::project_undistorted(view.rig->cameras[0], point);
    if (looks_as_described && pixel && is_inside(*pixel, view.image_size_px)) visit(k, *pixel);
  }
}

// Of one view, for two places.
void add_view(const ViewEvidence& a, const ViewEvidence& b, ComparedCounts& sums) {
  ++sums.num_views;
  sums.a_in_all += a.total;
  sums.b_in_all += b.total;
  for (std::size_t i = 0; i < a.cells.size(); ++i) {
    if (!are_comparable(a.cells[i], b.cells[i])) continue;
    sums.a += a.cells[i];
    sums.b += b.cells[i];
  }
}

}  // namespace

Place place_of(const RelocalizedPose& pose) {
  return {pose.track.pose.reference_keyframe, pose.track.pose.reference_from_frame, false};
}

core::Rigid3 world_from_body(const scene::MapVersion& map, const Place& place) {
  return scene::world_from_body(map, place.keyframe) *
         place.keyframe_from_body.value_or(core::Rigid3{});
}

double median_distance(const RelocalizedPose& pose) {
  std::vector<double> distances;
  for (const auto& match : pose.track.matches) {
    const Eigen::Vector3d& point =
        pose.local_map.points_in_reference[static_cast<std::size_t>(match.first)];
    distances.push_back((point - pose.track.pose.reference_from_frame.translation).norm());
  }
  return core::median(std::move(distances)).value_or(0.0);
}

core::KeyframeId nearest_keyframe(const scene::MapVersion& map, const RelocalizedPose& pose) {
  std::vector<core::LandmarkId> seen;
  for (const auto& match : pose.track.matches)
    seen.push_back(pose.local_map.landmarks[static_cast<std::size_t>(match.first)]);
  return keyframe_showing_most(map, seen).value_or(pose.local_map.reference);
}

bool are_one_place(const scene::MapVersion& map, const Place& a, const Place& b, double distance) {
  const core::Rigid3 apart = inverse(world_from_body(map, a)) * world_from_body(map, b);
  return apart.translation.norm() <= kOnePlaceRatio * distance &&
         core::angle_rad(apart.rotation) <= kOnePlace_rad;
}

ViewEvidence measure_view(const features::View& view, const scene::MapVersion& map,
                          const Place& place, const RelocalizedPose* pose,
                          const map::Config& config) {
  ViewEvidence of_view{.frame = view.frame, .total = {}, .cells = {}};
  const auto at = [&](const Eigen::Vector2d& pixel) -> Counts& {
    return of_view.cells[cell_of(pixel, view.image_size_px)];
  };
  const auto count_visible = [&](const scene::LocalMap& local_map,
                                 const core::Rigid3& reference_from_body) {
    for_each_visible(local_map, view, reference_from_body,
                     [&](std::size_t, const Eigen::Vector2d& pixel) { ++at(pixel).num_visible; });
  };
  if (pose != nullptr) {
    count_visible(pose->local_map, pose->track.pose.reference_from_frame);
    for (const features::Match& match : pose->track.matches) {
      const auto feature = static_cast<std::size_t>(match.second);
      ++at(view.features->undistorted_px[feature].cast<double>()).num_inliers;
    }
  } else {
    const core::KeyframeId keyframe = holder_of(map, place.keyframe).keyframe;
    count_visible(map::local_map(map, keyframe, config),
                  inverse(scene::world_from_body(map, keyframe)) * world_from_body(map, place));
  }
  // an inlier may be nearer, or closer to the border, than a landmark that counts as visible
  for (Counts& of_cell : of_view.cells) {
    of_cell.num_visible = std::max(of_cell.num_visible, of_cell.num_inliers);
    of_view.total += of_cell;
  }
  return of_view;
}

InliersByCell inliers_by_cell(const features::View& view, const RelocalizedPose& pose) {
  InliersByCell cells;
  for (const features::Match& match : pose.track.matches) {
    const auto feature = static_cast<std::size_t>(match.second);
    const Eigen::Vector2d pixel = view.features->undistorted_px[feature].cast<double>();
    cells[cell_of(pixel, view.image_size_px)].push_back(
        pose.local_map.landmarks[static_cast<std::size_t>(match.first)]);
  }
  return cells;
}

bool are_comparable(const Counts& a, const Counts& b) {
  return std::min(a.num_visible, b.num_visible) >=
         kMinComparableRatio * std::max(a.num_visible, b.num_visible);
}

ComparedCounts compare(const std::vector<ViewEvidence>& a, const std::vector<ViewEvidence>& b) {
  ComparedCounts sums;
  auto of_a = a.rbegin();
  auto of_b = b.rbegin();
  while (of_a != a.rend() && of_b != b.rend()) {
    if (of_a->frame != of_b->frame) {
      of_a->frame < of_b->frame ? ++of_b : ++of_a;
      continue;
    }
    if (of_a->is_comparable && of_b->is_comparable) add_view(*of_a, *of_b, sums);
    ++of_a;
    ++of_b;
  }
  return sums;
}

std::optional<double> found_ratio_of_mapping(const scene::MapVersion& map,
                                             const scene::LocalMap& local_map) {
  const scene::Keyframe& shown = map.at(local_map.reference);
  std::vector<core::LandmarkId> observed = shown.slots;
  std::sort(observed.begin(), observed.end());
  Counts counts;
  for_each_visible(local_map, shown.view, {}, [&](std::size_t i, const Eigen::Vector2d&) {
    const core::LandmarkId id = local_map.landmarks[i];
    if (map.at(id).anchor == local_map.reference) return;
    ++counts.num_visible;
    counts.num_inliers += std::binary_search(observed.begin(), observed.end(), id) ? 1 : 0;
  });
  if (counts.num_visible < kMinExpected) return std::nullopt;
  return static_cast<double>(counts.num_inliers) / counts.num_visible;
}

}  // namespace samewhere::pipeline
