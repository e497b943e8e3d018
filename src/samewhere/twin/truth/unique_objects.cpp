#include <algorithm>
#include <array>
#include <cmath>

#include <samewhere/geometry/camera.hpp>
#include <samewhere/twin/truth/unique_objects.hpp>

namespace samewhere::twin {
namespace {

using Eigen::Vector2d;
using Eigen::Vector2f;
using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr float kMinSize_px = 20.0F;
constexpr int kNoRectangle = -1;

// Index of the largest rectangle of every unique object.
std::vector<int> front_of_objects(const Building& building) {
  std::vector<int> fronts(building.objects.size(), kNoRectangle);
  for (std::size_t i = 0; i < building.rectangles.size(); ++i) {
    const int object = building.rectangles[i].object;
    if (object < 0 || !building.objects[static_cast<std::size_t>(object)].is_unique) continue;
    int& front = fronts[static_cast<std::size_t>(object)];
    const auto area = [&](int r) {
      return building.rectangles[static_cast<std::size_t>(r)].size_m.prod();
    };
    if (front == kNoRectangle || area(static_cast<int>(i)) > area(front)) {
      front = static_cast<int>(i);
    }
  }
  return fronts;
}

bool is_same_thing(const Rectangle& a, const Rectangle& b) {
  constexpr float kMaxMoved_m = 0.05F;
  const Material& m = a.material;
  const Material& n = b.material;
  return (a.corner_m - b.corner_m).norm() <= kMaxMoved_m && m.finish == n.finish &&
         m.number == n.number && m.pattern_seed == n.pattern_seed &&
         m.own_pattern_seed == n.own_pattern_seed;
}

// Where a point is in the picture; nothing if it is not.
std::optional<Vector2d> pixel_in_picture(const core::Camera& camera, const Vector3d& in_camera) {
  const auto pixel = geometry::project(camera, in_camera);
  const core::PinholeRadtan& c = geometry::pinhole(camera);
  if (!pixel || pixel->x() < -0.5 || pixel->y() < -0.5 || pixel->x() > c.width_px - 0.5 ||
      pixel->y() > c.height_px - 0.5) {
    return std::nullopt;
  }
  // the distortion folds what is far outside back into the picture
  constexpr double kMinCosine = 0.9999;
  const bool is_there = geometry::bearing(camera, *pixel).dot(in_camera.normalized()) > kMinCosine;
  return is_there ? pixel : std::nullopt;
}

// The shortest side in the picture; 0 if a part lies outside or it is seen from behind.
float size_px(const core::Camera& camera, const core::Rigid3& camera_from_world,
              const Rectangle& r) {
  const Vector3d position_m = inverse(camera_from_world).translation;
  if (r.normal().dot(position_m.cast<float>() - r.corner_m) <= 0.0F) return 0.0F;
  const Vector2f size = r.size_m;
  const std::array<Vector2f, 4> corners = {Vector2f::Zero(), Vector2f(size.x(), 0.0F), size,
                                           Vector2f(0.0F, size.y())};
  std::array<Vector2d, 4> pixels;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vector3d in_world = r.at(corners[i]).cast<double>();
    const auto pixel = pixel_in_picture(camera, camera_from_world * in_world);
    if (!pixel) return 0.0F;
    pixels[i] = *pixel;
  }
  double shortest_px = (pixels[3] - pixels[0]).norm();
  for (std::size_t i = 0; i < 3; ++i) {
    shortest_px = std::min(shortest_px, (pixels[i + 1] - pixels[i]).norm());
  }
  return static_cast<float>(shortest_px);
}

// Asked at its middle and near its corners; parts of the same object do not hide it.
bool is_hidden(const Visit& visit, const Vector3f& position_m, const Rectangle& r) {
  constexpr float kInset = 0.1F;
  constexpr float kThin_m = 0.01F;  // a frame, a pane
  for (const Vector2f& at :
       {Vector2f(0.5F, 0.5F), Vector2f(kInset, kInset), Vector2f(1.0F - kInset, kInset),
        Vector2f(kInset, 1.0F - kInset), Vector2f(1.0F - kInset, 1.0F - kInset)}) {
    const Ray ray{position_m, r.at(at.cwiseProduct(r.size_m)) - position_m};
    const auto hit = visit.rays->first_hit(ray);
    if (!hit) continue;
    const bool is_own =
        visit.building->rectangles[static_cast<std::size_t>(hit->rectangle)].object == r.object;
    if (!is_own && (1.0F - hit->reach) * ray.direction.norm() > kThin_m) return true;
  }
  return false;
}

}  // namespace

UniqueObjects::UniqueObjects(const std::vector<Visit>& visits)
    : visits_(visits), fronts_(visits.size()) {
  for (std::size_t visit = 0; visit < visits.size(); ++visit) {
    const Building& building = *visits[visit].building;
    const std::vector<int> fronts = front_of_objects(building);
    for (std::size_t object = 0; object < fronts.size(); ++object) {
      if (fronts[object] == kNoRectangle) continue;
      add(static_cast<int>(visit), building.objects[object].name, fronts[object]);
    }
    std::sort(fronts_[visit].begin(), fronts_[visit].end(),
              [](const Front& a, const Front& b) { return a.id < b.id; });
  }
}

void UniqueObjects::add(int visit, const std::string& name, int rectangle_index) {
  Front front{.id = static_cast<int>(names_.size()), .rectangle = rectangle_index};
  for (int earlier = 0; earlier < visit; ++earlier) {
    for (const Front& known : fronts_[static_cast<std::size_t>(earlier)]) {
      if (names_[static_cast<std::size_t>(known.id)] == name &&
          is_same_thing(rectangle(earlier, known), rectangle(visit, front))) {
        front.id = known.id;
      }
    }
  }
  if (front.id == static_cast<int>(names_.size())) names_.push_back(name);
  fronts_[static_cast<std::size_t>(visit)].push_back(front);
}

const Rectangle& UniqueObjects::rectangle(int visit, const Front& front) const {
  return visits_[static_cast<std::size_t>(visit)]
      .building->rectangles[static_cast<std::size_t>(front.rectangle)];
}

std::vector<ShownObject> UniqueObjects::shown_to(const core::Camera& camera,
                                                 const core::Rigid3& world_from_camera,
                                                 int visit) const {
  const core::Rigid3 camera_from_world = inverse(world_from_camera);
  const Vector3f position_m = world_from_camera.translation.cast<float>();
  std::vector<ShownObject> shown;
  for (const Front& front : fronts_[static_cast<std::size_t>(visit)]) {
    const Rectangle& r = rectangle(visit, front);
    const float size = size_px(camera, camera_from_world, r);
    if (size < kMinSize_px || is_hidden(visits_[static_cast<std::size_t>(visit)], position_m, r)) {
      continue;
    }
    shown.push_back({front.id, size});
  }
  return shown;
}

std::optional<int> best_shared(const std::vector<ShownObject>& a,
                               const std::vector<ShownObject>& b) {
  std::optional<int> best;
  float best_px = 0.0F;
  for (auto i = a.begin(), k = b.begin(); i != a.end() && k != b.end();) {
    if (i->id == k->id) {
      const float smaller_px = std::min(i->size_px, k->size_px);
      if (smaller_px > best_px) {
        best = i->id;
        best_px = smaller_px;
      }
      ++i;
      ++k;
    } else {
      ++(i->id < k->id ? i : k);
    }
  }
  return best;
}

}  // namespace samewhere::twin
