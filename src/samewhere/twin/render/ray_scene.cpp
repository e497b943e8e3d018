#include <array>
#include <cmath>
#include <limits>

#include <samewhere/core/errors.hpp>
#include <samewhere/twin/render/embree.hpp>
#include <samewhere/twin/render/ray_scene.hpp>

namespace samewhere::twin {
namespace {

constexpr std::size_t kPacket = 8;

struct DeviceDeleter {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
};
struct SceneDeleter {
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};

// One thread: how the tree is built must not depend on how many there are.
RTCDevice new_device() {
  RTCDevice device = rtcNewDevice("threads=1,set_affinity=0");
  core::require(device != nullptr, "Embree gives a device");
  return device;
}

}  // namespace

bool can_render() { return true; }

struct RayScene::Impl {
  explicit Impl(const std::vector<Rectangle>& all)
      : rectangles(&all), device(new_device()), scene(rtcNewScene(device.get())) {
    rtcSetSceneFlags(scene.get(), RTC_SCENE_FLAG_ROBUST);
    RTCGeometry geometry = rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_QUAD);
    auto* const corners = static_cast<float*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), 4 * all.size()));
    auto* const indices = static_cast<unsigned*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT4, 4 * sizeof(unsigned), all.size()));
    core::require(corners != nullptr && indices != nullptr, "Embree gives memory for the surfaces");
    for (std::size_t i = 0; i < all.size(); ++i) {
      const Rectangle& r = all[i];
      const Eigen::Vector2f size = r.size_m;
      const std::array<Eigen::Vector3f, 4> around = {r.corner_m, r.at({size.x(), 0.0F}), r.at(size),
                                                     r.at({0.0F, size.y()})};
      for (std::size_t k = 0; k < around.size(); ++k) {
        Eigen::Map<Eigen::Vector3f>(corners + 3 * (4 * i + k)) = around[k];
        indices[4 * i + k] = static_cast<unsigned>(4 * i + k);
      }
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene.get(), geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene.get());
    core::require(rtcGetDeviceError(device.get()) == RTC_ERROR_NONE, "Embree builds its tree");
  }

  // Exactly where the plane is met: the tree's own answer, `found`, depends on the processor. Only
  // along a plane there is no better one.
  Hit hit(unsigned primitive, const Ray& ray, float found) const {
    constexpr float kAgreement = 1e-3F;
    if (primitive == RTC_INVALID_GEOMETRY_ID) return {};
    const float reach = reach_of_plane(ray, (*rectangles)[primitive]);
    const bool agrees = std::abs(reach - found) <= kAgreement * found;  // not if it is no number
    return {static_cast<int>(primitive), agrees ? reach : found};
  }

  const std::vector<Rectangle>* rectangles;
  std::unique_ptr<RTCDeviceTy, DeviceDeleter> device;
  std::unique_ptr<RTCSceneTy, SceneDeleter> scene;
};

RayScene::RayScene(const std::vector<Rectangle>& rectangles)
    : impl_(std::make_unique<Impl>(rectangles)) {}
RayScene::RayScene(RayScene&&) noexcept = default;
RayScene& RayScene::operator=(RayScene&&) noexcept = default;
RayScene::~RayScene() = default;

namespace {

RTCRay to_embree(const Ray& ray, float max_reach) {
  return {.org_x = ray.origin.x(),
          .org_y = ray.origin.y(),
          .org_z = ray.origin.z(),
          .tnear = kMinReach,
          .dir_x = ray.direction.x(),
          .dir_y = ray.direction.y(),
          .dir_z = ray.direction.z(),
          .time = 0.0F,
          .tfar = max_reach,
          .mask = ~0U,
          .id = 0,
          .flags = 0};
}

}  // namespace

std::optional<Hit> RayScene::first_hit(const Ray& ray) const {
  RTCRayHit asked{.ray = to_embree(ray, std::numeric_limits<float>::infinity()), .hit = {}};
  asked.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  asked.hit.primID = RTC_INVALID_GEOMETRY_ID;
  embree::intersect(impl_->scene.get(), asked);
  const Hit hit = impl_->hit(asked.hit.primID, ray, asked.ray.tfar);
  return hit.rectangle < 0 ? std::nullopt : std::optional(hit);
}

void RayScene::first_hits(const Eigen::Vector3f& origin,
                          std::span<const Eigen::Vector3f> directions, std::span<Hit> hits) const {
  for (std::size_t first = 0; first < directions.size(); first += kPacket) {
    const std::size_t count = std::min(kPacket, directions.size() - first);
    alignas(32) std::array<int, kPacket> valid{};
    RTCRayHit8 asked;  // NOLINT(cppcoreguidelines-pro-type-member-init): filled below
    for (std::size_t i = 0; i < kPacket; ++i) {
      const Eigen::Vector3f& direction = directions[first + std::min(i, count - 1)];
      valid[i] = i < count ? -1 : 0;
      asked.ray.org_x[i] = origin.x();
      asked.ray.org_y[i] = origin.y();
      asked.ray.org_z[i] = origin.z();
      asked.ray.dir_x[i] = direction.x();
      asked.ray.dir_y[i] = direction.y();
      asked.ray.dir_z[i] = direction.z();
      asked.ray.tnear[i] = kMinReach;
      asked.ray.tfar[i] = std::numeric_limits<float>::infinity();
      asked.ray.time[i] = 0.0F;
      asked.ray.mask[i] = ~0U;
      asked.ray.id[i] = 0;
      asked.ray.flags[i] = 0;
      asked.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
      asked.hit.primID[i] = RTC_INVALID_GEOMETRY_ID;
    }
    embree::intersect(valid.data(), impl_->scene.get(), asked);
    for (std::size_t i = 0; i < count; ++i) {
      hits[first + i] =
          impl_->hit(asked.hit.primID[i], {origin, directions[first + i]}, asked.ray.tfar[i]);
    }
  }
}

bool RayScene::is_blocked(const Ray& ray) const {
  constexpr float kShortOfTheEnd = 0.999F;  // what lies at the end does not block
  RTCRay asked = to_embree(ray, kShortOfTheEnd);
  embree::find_blocked(impl_->scene.get(), asked);
  return asked.tfar < 0.0F;
}

}  // namespace samewhere::twin
