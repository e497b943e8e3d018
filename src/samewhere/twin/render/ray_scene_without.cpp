// What stands for ray_scene.cpp in a build without Embree (-DSAMEWHERE_TWIN=OFF).
#include <samewhere/core/errors.hpp>
#include <samewhere/twin/render/ray_scene.hpp>

namespace samewhere::twin {

bool can_render() { return false; }

struct RayScene::Impl {};

RayScene::RayScene(const std::vector<Rectangle>& /*rectangles*/) {
  throw core::InputError("built without the rendered buildings (SAMEWHERE_TWIN=OFF)");
}
RayScene::RayScene(RayScene&&) noexcept = default;
RayScene& RayScene::operator=(RayScene&&) noexcept = default;
RayScene::~RayScene() = default;

std::optional<Hit> RayScene::first_hit(const Ray& /*ray*/) const { return std::nullopt; }

void RayScene::first_hits(const Eigen::Vector3f& /*origin*/,
                          std::span<const Eigen::Vector3f> /*directions*/,
                          std::span<Hit> /*hits*/) const {}

bool RayScene::is_blocked(const Ray& /*ray*/) const { return false; }

}  // namespace samewhere::twin
