#include <cmath>
#include <numbers>

#include <samewhere/geometry/camera.hpp>
#include <samewhere/twin/places.hpp>

namespace samewhere::twin {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;

constexpr int kNowhere = -1;

// A raster over the plane z = 1 in front of a camera, where looking up a point needs no distortion.
class Raster {
 public:
  explicit Raster(const core::Camera& camera) {
    constexpr float kMargin = 0.01F;
    const core::PinholeRadtan& c = geometry::pinhole(camera);
    for (const double x : {-0.5, c.width_px - 0.5}) {
      for (const double y : {-0.5, c.height_px - 0.5}) {
        const Eigen::Vector2d corner = geometry::bearing(camera, {x, y}).hnormalized();
        half_size_ = half_size_.cwiseMax(corner.cwiseAbs().cast<float>());
      }
    }
    half_size_.array() += kMargin;
    num_columns_ = static_cast<int>(2.0F * half_size_.x() * kCellsPerUnit);
    num_rows_ = static_cast<int>(2.0F * half_size_.y() * kCellsPerUnit);
  }

  int num_cells() const { return num_columns_ * num_rows_; }

  Vector2f centre_of(int cell) const {
    const int column = cell % num_columns_;
    const int row = cell / num_columns_;
    const Vector2f index(static_cast<float>(column), static_cast<float>(row));
    return (index.array() + 0.5F).matrix() / kCellsPerUnit - half_size_;
  }

  int cell_at(float x, float y) const {
    const float column = (x + half_size_.x()) * kCellsPerUnit;
    const float row = (y + half_size_.y()) * kCellsPerUnit;
    const bool is_inside = column >= 0.0F && row >= 0.0F &&
                           column < static_cast<float>(num_columns_) &&
                           row < static_cast<float>(num_rows_);
    return is_inside ? static_cast<int>(row) * num_columns_ + static_cast<int>(column) : kNowhere;
  }

 private:
  static constexpr float kCellsPerUnit = 64.0F;
  Vector2f half_size_ = Vector2f::Zero();
  int num_columns_ = 0;
  int num_rows_ = 0;
};

struct SeenPoint {
  Vector3f in_world = Vector3f::Zero();
  int surface = kNowhere;
};

// What one frame sees: points to ask others about, and surfaces to answer with.
struct Sight {
  Eigen::Matrix3f camera_from_world;  // rotation
  Vector3f position = Vector3f::Zero();
  std::vector<SeenPoint> points;
  std::vector<int> surface_of_cell;  // of the raster; kNowhere outside of the picture
};

class Judge {
 public:
  Judge(const Building& building, const RayScene& rays, const core::Camera& camera)
      : building_(building), rays_(rays), raster_(camera), ask_(ask_directions(camera)) {
    const core::PinholeRadtan& c = geometry::pinhole(camera);
    for (int cell = 0; cell < raster_.num_cells(); ++cell) {
      const Vector2f centre = raster_.centre_of(cell);
      const auto pixel = geometry::project(camera, {centre.x(), centre.y(), 1.0});
      is_in_picture_.push_back(pixel && pixel->x() > -0.5 && pixel->y() > -0.5 &&
                               pixel->x() < c.width_px - 0.5 && pixel->y() < c.height_px - 0.5);
    }
  }

  Sight look(const core::Rigid3& world_from_camera) const {
    const Eigen::Matrix3f world_from_eye =
        world_from_camera.rotation.toRotationMatrix().cast<float>();
    Sight sight{.camera_from_world = world_from_eye.transpose(),
                .position = world_from_camera.translation.cast<float>()};
    for (const auto& direction : ask_) {
      const Ray ray{sight.position, world_from_eye * direction};
      const auto hit = rays_.first_hit(ray);
      if (hit) sight.points.push_back({ray.origin + hit->reach * ray.direction, hit->rectangle});
    }
    for (int cell = 0; cell < raster_.num_cells(); ++cell) {
      std::optional<Hit> hit;
      if (is_in_picture_[static_cast<std::size_t>(cell)]) {
        const Vector2f centre = raster_.centre_of(cell);
        hit = rays_.first_hit({sight.position, world_from_eye * centre.homogeneous()});
      }
      sight.surface_of_cell.push_back(hit ? hit->rectangle : kNowhere);
    }
    return sight;
  }

  core::PlaceTruth judge(const Sight& a, const Sight& b) const {
    constexpr double kSame = 0.3;
    constexpr double kDifferent = 0.05;
    constexpr double kMaxTurn_rad = 0.25 * std::numbers::pi;
    const double a_by_b = overlap(a, b);
    const double b_by_a = overlap(b, a);
    if (a_by_b < kDifferent && b_by_a < kDifferent) return core::PlaceTruth::kDifferent;
    const float cos_turn = a.camera_from_world.row(2).dot(b.camera_from_world.row(2));
    const bool is_same = a_by_b >= kSame && b_by_a >= kSame && cos_turn >= std::cos(kMaxTurn_rad);
    return is_same ? core::PlaceTruth::kSame : core::PlaceTruth::kNear;
  }

 private:
  static std::vector<Vector3f> ask_directions(const core::Camera& camera) {
    constexpr int kNumColumns = 20;
    constexpr int kNumRows = 15;
    const core::PinholeRadtan& c = geometry::pinhole(camera);
    std::vector<Vector3f> directions;
    for (int row = 0; row < kNumRows; ++row) {
      for (int column = 0; column < kNumColumns; ++column) {
        const Eigen::Vector2d pixel((column + 0.5) * c.width_px / kNumColumns - 0.5,
                                    (row + 0.5) * c.height_px / kNumRows - 0.5);
        directions.push_back(geometry::bearing(camera, pixel).cast<float>());
      }
    }
    return directions;
  }

  // Share of what `query` sees that `match` sees too.
  double overlap(const Sight& query, const Sight& match) const {
    if (query.points.empty()) return 0.0;
    int num_shared = 0;
    for (const auto& point : query.points) num_shared += static_cast<int>(sees(match, point));
    return static_cast<double>(num_shared) / static_cast<double>(query.points.size());
  }

  bool sees(const Sight& sight, const SeenPoint& point) const {
    constexpr float kMinDepth_m = 0.05F;
    const Vector3f to_point = point.in_world - sight.position;
    const Vector3f in_camera = sight.camera_from_world * to_point;
    if (in_camera.z() < kMinDepth_m) return false;
    const int cell = raster_.cell_at(in_camera.x() / in_camera.z(), in_camera.y() / in_camera.z());
    if (cell == kNowhere) return false;
    const int surface = sight.surface_of_cell[static_cast<std::size_t>(cell)];
    if (surface == kNowhere) return false;
    if (surface == point.surface) return true;
    // how far away that surface is on the way to the point: on its plane, not at the cell's centre
    const Rectangle& r = building_.rectangles[static_cast<std::size_t>(surface)];
    const float ratio = reach_of_plane({sight.position, to_point}, r);
    return std::abs(ratio - 1.0F) * in_camera.z() <= 0.05F + 0.04F * in_camera.z();
  }

  const Building& building_;
  const RayScene& rays_;
  Raster raster_;
  std::vector<Vector3f> ask_;
  std::vector<bool> is_in_picture_;
};

}  // namespace

core::PlaceTruthMatrix places_of(const core::Trajectory& walk, const Building& building,
                                 const RayScene& rays, const core::Camera& camera) {
  const Judge judge(building, rays, camera);
  std::vector<Sight> sights;
  sights.reserve(walk.size());
  for (const auto& pose : walk) sights.push_back(judge.look(pose.world_from_camera));

  const std::size_t n = walk.size();
  core::PlaceTruthMatrix places{.num_frames = static_cast<int>(n),
                                .values = std::vector<core::PlaceTruth>(n * n)};
  for (std::size_t query = 0; query < n; ++query) {
    for (std::size_t match = 0; match <= query; ++match) {
      const core::PlaceTruth truth = judge.judge(sights[query], sights[match]);
      places.values[query * n + match] = truth;
      places.values[match * n + query] = truth;
    }
  }
  return places;
}

}  // namespace samewhere::twin
