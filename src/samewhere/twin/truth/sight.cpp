#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include <samewhere/geometry/camera.hpp>
#include <samewhere/twin/truth/sight.hpp>

namespace samewhere::twin {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;

constexpr int kNothing = -1;
constexpr float kCellsPerUnit = 64.0F;  // 8 pixels of the twin camera

bool is_in_picture(const core::Camera& camera, const Vector2f& at) {
  const core::PinholeRadtan& c = geometry::pinhole(camera);
  const auto pixel = geometry::project(camera, {at.x(), at.y(), 1.0});
  return pixel && pixel->x() > -0.5 && pixel->y() > -0.5 && pixel->x() < c.width_px - 0.5 &&
         pixel->y() < c.height_px - 0.5;
}

std::vector<Vector3f> asking_directions(const core::Camera& camera) {
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

// In lengths of a ray that ends at a point: what surely stands before it, what is surely behind.
constexpr float kJustBefore = 0.96F;
constexpr float kJustBehind = 1.04F;

float tolerance_m(float depth_m) { return 0.05F + 0.04F * depth_m; }

bool looks_alike(const Material& a, const Material& b) {
  constexpr float kMaxOwnRatio = 0.5F;
  return a.finish == b.finish && a.number == b.number && a.pattern_seed == b.pattern_seed &&
         a.own_ratio <= kMaxOwnRatio && b.own_ratio <= kMaxOwnRatio;
}

// Whether the match can see anything that the query sees: cheap, and never wrongly no.
bool can_overlap(const Sight& query, const Sight& match) {
  if (query.points.empty() || match.reach_m.isEmpty()) return false;
  const float farthest_m =
      match.reach_m.exteriorDistance(match.viewpoint.position_m) + match.reach_m.diagonal().norm();
  const float margin_m = tolerance_m(farthest_m);
  return query.reach_m.squaredExteriorDistance(match.reach_m) <= margin_m * margin_m;
}

const Rectangle& rectangle_of(const Sight& sight, int surface) {
  return sight.building->rectangles[static_cast<std::size_t>(surface)];
}

// What the ray meets first of the surfaces around the cell. `own`, a surface at the ray's end, is
// not asked.
Hit first_around(const Sight& match, const SeenCell& cell, const Ray& ray, int own) {
  Hit first;
  const auto around = std::span(match.around)
                          .subspan(static_cast<std::size_t>(cell.first_around),
                                   static_cast<std::size_t>(cell.num_around));
  for (const int surface : around) {
    if (surface == kNothing || surface == own) continue;
    const auto reach = reach_of(ray, rectangle_of(match, surface));
    if (reach && (first.rectangle == kNothing || *reach < first.reach)) first = {surface, *reach};
  }
  return first;
}

// What the match sees on the way to a point, `ray` ending there; `own` is the point's surface if it
// is known to be there, else kNothing.
Hit hit_towards(const Sight& match, const SeenCell& cell, const Ray& ray, int own) {
  if (cell.num_around == 0) {
    if (cell.surface == kNothing) return {};
    if (cell.surface == own) return {own, 1.0F};
    return {cell.surface, reach_of_plane(ray, rectangle_of(match, cell.surface))};
  }
  const Hit first = first_around(match, cell, ray, own);
  if (first.rectangle != kNothing && first.reach < kJustBefore) return first;
  if (own != kNothing) return {own, 1.0F};
  if (first.rectangle != kNothing && first.reach < kJustBehind) return first;
  // a surface too narrow for the raster may stand before what is behind the point
  return match.rays->first_hit(ray).value_or(Hit{});
}

}  // namespace

Viewpoint viewpoint_of(const core::Rigid3& world_from_camera) {
  return {world_from_camera.rotation.conjugate().toRotationMatrix().cast<float>(),
          world_from_camera.translation.cast<float>()};
}

Eye::Eye(const core::Camera& camera) : camera_(camera) {
  constexpr float kMargin = 2.0F / kCellsPerUnit;  // every cell in the picture has neighbours
  const core::PinholeRadtan& c = geometry::pinhole(camera);
  for (const double x : {-0.5, c.width_px - 0.5}) {
    for (const double y : {-0.5, c.height_px - 0.5}) {
      const Eigen::Vector2d corner = geometry::bearing(camera, {x, y}).hnormalized();
      half_size_ = half_size_.cwiseMax(corner.cwiseAbs().cast<float>());
    }
  }
  half_size_.array() += kMargin;
  num_columns_ = static_cast<int>(std::ceil(2.0F * half_size_.x() * kCellsPerUnit));
  num_rows_ = static_cast<int>(std::ceil(2.0F * half_size_.y() * kCellsPerUnit));
  for (int cell = 0; cell < num_columns_ * num_rows_; ++cell) {
    parts_.push_back(part_of_picture(cell));
    if (parts_.back() == Part::kOutside) continue;
    cells_in_picture_.push_back(cell);
    directions_.emplace_back(at_of(cell, {0.5F, 0.5F}).homogeneous());
  }
  const std::vector<Vector3f> asking = asking_directions(camera);
  directions_.insert(directions_.end(), asking.begin(), asking.end());
}

Vector2f Eye::at_of(int cell, const Vector2f& in_cell) const {
  const int row = cell / num_columns_;
  const Vector2f index(static_cast<float>(cell % num_columns_), static_cast<float>(row));
  return (index + in_cell) / kCellsPerUnit - half_size_;
}

Eye::Part Eye::part_of_picture(int cell) const {
  constexpr int kNumPoints = 5;
  int num_inside = 0;
  for (const Vector2f& in_cell : {Vector2f(0.5F, 0.5F), Vector2f(0.0F, 0.0F), Vector2f(1.0F, 0.0F),
                                  Vector2f(0.0F, 1.0F), Vector2f(1.0F, 1.0F)}) {
    num_inside += is_in_picture(camera_, at_of(cell, in_cell)) ? 1 : 0;
  }
  if (num_inside == 0) return Part::kOutside;
  return num_inside == kNumPoints ? Part::kInside : Part::kRim;
}

Sight Eye::look(const core::Rigid3& world_from_camera, const Visit& visit) const {
  Sight sight{
      .building = visit.building, .rays = visit.rays, .viewpoint = viewpoint_of(world_from_camera)};
  sight.cells.resize(parts_.size());
  std::vector<Vector3f> directions(directions_.size());
  std::transform(directions_.begin(), directions_.end(), directions.begin(),
                 [&](const Vector3f& in_camera) -> Vector3f {
                   return sight.viewpoint.camera_from_world.transpose() * in_camera;
                 });
  std::vector<Hit> hits(directions.size());
  visit.rays->first_hits(sight.viewpoint.position_m, directions, hits);

  for (std::size_t i = 0; i < hits.size(); ++i) {
    const int surface = hits[i].rectangle;
    if (surface < 0) continue;
    const Vector3f point = sight.viewpoint.position_m + hits[i].reach * directions[i];
    sight.reach_m.extend(point);
    if (i < cells_in_picture_.size()) {
      sight.cells[static_cast<std::size_t>(cells_in_picture_[i])].surface = surface;
    } else {
      const Rectangle& r = visit.building->rectangles[static_cast<std::size_t>(surface)];
      sight.points.push_back({point, r.normal(), surface});
    }
  }
  list_around(sight);
  return sight;
}

std::array<std::size_t, 9> Eye::block_around(int cell) const {
  std::array<std::size_t, 9> block{};
  for (int i = 0; i < 9; ++i) {
    block[static_cast<std::size_t>(i)] =
        static_cast<std::size_t>(cell + (i / 3 - 1) * num_columns_ + i % 3 - 1);
  }
  return block;
}

void Eye::list_around(Sight& sight) const {
  for (const int cell : cells_in_picture_) {
    SeenCell& middle = sight.cells[static_cast<std::size_t>(cell)];
    middle.first_around = static_cast<int>(sight.around.size());
    const auto first = sight.around.end() - sight.around.begin();
    for (const std::size_t other : block_around(cell)) {
      const int surface = sight.cells[other].surface;
      const auto begin = sight.around.begin() + first;
      if (std::find(begin, sight.around.end(), surface) == sight.around.end()) {
        sight.around.push_back(surface);
      }
    }
    middle.num_around = static_cast<int>(sight.around.size()) - middle.first_around;
    if (middle.num_around > 1) continue;
    middle.num_around = 0;
    sight.around.resize(static_cast<std::size_t>(first));
  }
}

// The cell that holds a point of the picture.
std::optional<int> Eye::cell_at(const Vector2f& at) const {
  const Vector2f index = (at + half_size_) * kCellsPerUnit;
  const bool is_on_raster = index.x() >= 0.0F && index.y() >= 0.0F &&
                            index.x() < static_cast<float>(num_columns_) &&
                            index.y() < static_cast<float>(num_rows_);
  if (!is_on_raster) return std::nullopt;
  const int cell = static_cast<int>(index.y()) * num_columns_ + static_cast<int>(index.x());
  const Part part = parts_[static_cast<std::size_t>(cell)];
  const bool is_inside =
      part == Part::kInside || (part == Part::kRim && is_in_picture(camera_, at));
  return is_inside ? std::optional(cell) : std::nullopt;
}

// The surface that the match sees where the point is; kNothing if it does not see the point.
int Eye::surface_found(const Sight& match, const Viewpoint& viewpoint, const SeenPoint& point,
                       bool is_in_same_world) const {
  constexpr float kMinDepth_m = 0.05F;
  const Vector3f to_point = point.in_world_m - viewpoint.position_m;
  if (point.normal.dot(to_point) >= 0.0F) return kNothing;  // its back
  const Vector3f in_camera = viewpoint.camera_from_world * to_point;
  if (in_camera.z() < kMinDepth_m) return kNothing;
  const std::optional<int> cell = cell_at(in_camera.head<2>() / in_camera.z());
  if (!cell) return kNothing;
  const Ray ray{match.viewpoint.position_m,
                match.viewpoint.camera_from_world.transpose() * in_camera};
  const Hit hit = hit_towards(match, match.cells[static_cast<std::size_t>(*cell)], ray,
                              is_in_same_world ? point.surface : kNothing);
  if (hit.rectangle == kNothing) return kNothing;
  const float depth_error_m = std::abs(hit.reach - 1.0F) * in_camera.z();
  return depth_error_m <= tolerance_m(in_camera.z()) ? hit.rectangle : kNothing;
}

double Eye::overlap(const Sight& query, const Sight& match) const {
  if (!can_overlap(query, match)) return 0.0;
  const bool is_in_same_world = query.building == match.building;
  const auto num_shared =
      std::count_if(query.points.begin(), query.points.end(), [&](const SeenPoint& point) {
        return surface_found(match, match.viewpoint, point, is_in_same_world) != kNothing;
      });
  return static_cast<double>(num_shared) / static_cast<double>(query.points.size());
}

double Eye::alike(const Sight& query, const Sight& match, const Viewpoint& match_in_query,
                  double least) const {
  if (query.points.empty() || match.points.empty()) return 0.0;
  const auto num_points = static_cast<double>(query.points.size());
  const double max_unlike = (1.0 - least) * num_points;
  int num_unlike = 0;
  for (const SeenPoint& point : query.points) {
    const int found = surface_found(match, match_in_query, point, false);
    const bool is_alike =
        found != kNothing && looks_alike(rectangle_of(query, point.surface).material,
                                         rectangle_of(match, found).material);
    num_unlike += is_alike ? 0 : 1;
    if (num_unlike > max_unlike) return 0.0;
  }
  return 1.0 - num_unlike / num_points;
}

}  // namespace samewhere::twin
