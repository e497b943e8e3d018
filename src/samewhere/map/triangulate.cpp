#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>

#include <samewhere/features/hamming.hpp>
#include <samewhere/features/match_pair.hpp>
#include <samewhere/geometry/camera.hpp>
#include <samewhere/map/seen.hpp>
#include <samewhere/map/triangulate.hpp>

namespace samewhere::map {
namespace {

using features::Match;
using scene::Keyframe;

constexpr double kChiSquare95OfLine = 3.841;  // one degree of freedom
constexpr int kMaxOctaveStep = 2;

// Features that show no landmark; of those of the new keyframe only the ones without depth, which
// became none by themselves.
std::vector<int> free_features(const Keyframe& keyframe, bool with_depth) {
  std::vector<int> free;
  for (int i = 0; i < keyframe.view.features->size(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    const bool has_depth = keyframe.view.features->depth_m[k] > 0.0F;
    if (!keyframe.slots[k].is_valid() && (with_depth || !has_depth)) free.push_back(i);
  }
  return free;
}

Eigen::Matrix3d normalised_from_pixel(const core::Camera& camera) {
  return geometry::calibration_matrix(camera).inverse();
}

// Two keyframes and how they stand to each other: `first` is the neighbour, `second` the new one.
class Pair {
 public:
  Pair(const scene::MapVersion& map, const Keyframe& first, const Keyframe& second,
       const Config& config, const features::Config& features)
      : first_(first.view),
        second_(second.view),
        config_(config),
        features_(features),
        second_from_first_(camera_from_world(map, second) *
                           inverse(camera_from_world(map, first))) {}

  // Matches between free features, each used once; Match{first, second}.
  std::vector<Match> matches(const std::vector<int>& of_first,
                             const std::vector<int>& of_second) const {
    const Eigen::Matrix3d fundamental = normalised_from_pixel(second_.rig->cameras[0]).transpose() *
                                        core::skew(second_from_first_.translation) *
                                        second_from_first_.rotation.toRotationMatrix() *
                                        normalised_from_pixel(first_.rig->cameras[0]);
    const std::vector<Sought> sought = sought_of(of_first);
    std::vector<std::optional<Match>> holders(
        static_cast<std::size_t>(first_.features->size()));  // by feature of the neighbour
    for (const int i : of_second) {
      const Eigen::Vector3d line = fundamental.transpose() * pixel(second_, i).homogeneous();
      const auto match = best_on_line(line, i, sought);
      if (!match) continue;
      auto& holder = holders[static_cast<std::size_t>(match->first)];
      if (!holder || match->distance_bits < holder->distance_bits) holder = match;
    }
    std::vector<Match> matches;
    for (const auto& holder : holders) {
      if (holder) matches.push_back(*holder);
    }
    return matches;
  }

  // The point in the camera of the new keyframe, if both see it well.
  std::optional<Eigen::Vector3d> point(const Match& match) const {
    const Eigen::Vector3d ray_1 =
        second_from_first_.rotation *
        geometry::bearing_of_undistorted(first_.rig->cameras[0], pixel(first_, match.first));
    const Eigen::Vector3d ray_2 =
        geometry::bearing_of_undistorted(second_.rig->cameras[0], pixel(second_, match.second));
    const Eigen::Vector3d normal = ray_1.cross(ray_2);
    if (std::atan2(normal.norm(), ray_1.dot(ray_2)) < config_.min_parallax_rad) return std::nullopt;
    // the midpoint of the shortest line between the rays
    const Eigen::Vector3d& eye_1 = second_from_first_.translation;
    const double range_1 = ray_2.cross(eye_1).dot(normal) / normal.squaredNorm();
    const double range_2 = ray_1.cross(eye_1).dot(normal) / normal.squaredNorm();
    if (range_1 <= 0.0 || range_2 <= 0.0) return std::nullopt;
    const Eigen::Vector3d midpoint = 0.5 * (eye_1 + range_1 * ray_1 + range_2 * ray_2);
    const auto in_first =
        reproject(first_, match.first, inverse(second_from_first_) * midpoint, features_);
    const auto in_second = reproject(second_, match.second, midpoint, features_);
    const bool is_seen = is_inlier(in_first) && is_inlier(in_second);
    return is_seen && is_same_size(match, range_1, range_2) ? std::optional(midpoint)
                                                            : std::nullopt;
  }

 private:
  // A feature of the neighbour, with what each line asks of it worked out once.
  struct Sought {
    int feature = 0;
    Eigen::Vector3d pixel;              // homogeneous
    double max_squared_distance = 0.0;  // to its epipolar line, pixels
  };

  static Eigen::Vector2d pixel(const features::View& view, int i) {
    return view.features->undistorted_px[static_cast<std::size_t>(i)].cast<double>();
  }

  std::vector<Sought> sought_of(const std::vector<int>& of_first) const {
    std::vector<Sought> sought;
    sought.reserve(of_first.size());
    for (const int i : of_first) {
      const int octave = first_.features->octave[static_cast<std::size_t>(i)];
      const double sigma_px = std::pow(features_.scale_factor, octave);
      sought.push_back(
          {i, pixel(first_, i).homogeneous(), kChiSquare95OfLine * sigma_px * sigma_px});
    }
    return sought;
  }

  std::optional<Match> best_on_line(const Eigen::Vector3d& line, int feature,
                                    const std::vector<Sought>& sought) const {
    const cv::Mat& descriptors = first_.features->descriptors;
    const double length = line.head<2>().norm();
    Match best{-1, feature, 257};
    int second_bits = 257;
    for (const auto& other : sought) {
      const double distance_px = line.dot(other.pixel) / length;
      if (distance_px * distance_px > other.max_squared_distance) continue;
      const int bits = features::distance_bits(second_.features->descriptors.ptr(feature),
                                               descriptors.ptr(other.feature));
      if (bits < best.distance_bits) {
        second_bits = best.distance_bits;
        best.first = other.feature;
        best.distance_bits = bits;
      } else {
        second_bits = std::min(second_bits, bits);
      }
    }
    const bool is_clear = best.distance_bits <= features_.max_distance_bits &&
                          best.distance_bits <= features_.max_ratio * second_bits;
    return is_clear ? std::optional(best) : std::nullopt;
  }

  bool is_same_size(const Match& match, double range_1, double range_2) const {
    const int octave_1 = first_.features->octave[static_cast<std::size_t>(match.first)];
    const int octave_2 = second_.features->octave[static_cast<std::size_t>(match.second)];
    return std::abs(features::octave_at(octave_1, range_1, range_2, features_) - octave_2) <=
           kMaxOctaveStep;
  }

  const features::View& first_;
  const features::View& second_;
  const Config& config_;
  const features::Config& features_;
  core::Rigid3 second_from_first_;
};

// The most covisible keyframes. Without depth and with metric odometry also the last before this
// one: until they share landmarks, nothing else makes them neighbours.
std::vector<core::KeyframeId> partners_of(const scene::MapVersion& map, core::KeyframeId keyframe,
                                          const Config& config) {
  std::vector<core::KeyframeId> neighbours;
  const auto num_wanted = static_cast<std::size_t>(config.search_keyframes);
  for (const auto& covisible : covisible_keyframes(map, keyframe)) {
    if (covisible.num_shared < config.min_shared || neighbours.size() == num_wanted) break;
    neighbours.push_back(covisible.keyframe);
  }
  if (!map.has_metric_odometry || !is_without_depth(map)) return neighbours;
  auto parent = map.at(keyframe).odometry;
  for (; parent && neighbours.size() < num_wanted; parent = map.at(parent->parent).odometry) {
    const bool is_new =
        std::find(neighbours.begin(), neighbours.end(), parent->parent) == neighbours.end();
    if (is_new && is_live(map.at(parent->parent))) neighbours.push_back(parent->parent);
  }
  return neighbours;
}

}  // namespace

scene::Edit triangulate_landmarks(const scene::MapVersion& map, core::KeyframeId keyframe,
                                  const Config& config, const features::Config& features) {
  scene::Edit edit;
  const Keyframe& second = map.at(keyframe);
  std::vector<int> free = free_features(second, false);
  for (const core::KeyframeId neighbour : partners_of(map, keyframe, config)) {
    const Keyframe& first = map.at(neighbour);
    const Pair pair(map, first, second, config, features);
    for (const auto& match : pair.matches(free_features(first, true), free)) {
      const auto in_camera = pair.point(match);
      if (!in_camera) continue;
      scene::Landmark landmark;
      landmark.id = core::LandmarkId(map.landmarks.size() + edit.landmarks.size());
      landmark.anchor = keyframe;
      landmark.position_in_anchor = second.view.rig->body_from_camera[0] * *in_camera;
      landmark.rgb = second.view.features->rgb[static_cast<std::size_t>(match.second)];
      edit.sightings.push_back({landmark.id, {first.id, match.first}});
      edit.sightings.push_back({landmark.id, {keyframe, match.second}});
      edit.landmarks.push_back(std::move(landmark));
      std::erase(free, match.second);
    }
  }
  return edit;
}

}  // namespace samewhere::map
