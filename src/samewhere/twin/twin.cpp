#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include <samewhere/core/random.hpp>
#include <samewhere/twin/camera.hpp>
#include <samewhere/twin/depth_sensor.hpp>
#include <samewhere/twin/office_loop.hpp>
#include <samewhere/twin/photograph.hpp>
#include <samewhere/twin/renderer.hpp>
#include <samewhere/twin/truth.hpp>
#include <samewhere/twin/twin.hpp>

namespace samewhere::twin {
namespace {

std::shared_ptr<const core::Rig> twin_rig() {
  return std::make_shared<core::Rig>(
      core::Rig{.cameras = {kTwinCamera}, .body_from_camera = {core::Rigid3{}}});
}

core::Trajectory first_poses(core::Trajectory walk, int num_frames) {
  if (num_frames > 0) walk.resize(std::min(walk.size(), static_cast<std::size_t>(num_frames)));
  return walk;
}

class TwinSource : public core::Source {
 public:
  TwinSource(const Spec& spec, const Config& config)
      : name_(fmt::format("{}-seed{}", spec.preset, spec.seed)),
        seed_(spec.seed),
        config_(config),
        rig_(twin_rig()),
        building_{.rectangles = office_loop_surfaces(spec.seed, spec.similarity)},
        rays_(building_.rectangles),
        walk_(first_poses(office_loop_walk(spec.seed), config.num_frames)) {}

  core::SourceInfo info() const override {
    return {.name = name_,
            .format = "twin building",
            .num_frames = static_cast<int>(walk_.size()),
            .has_depth = true,
            .is_calibrated = true,
            .frame_rate_hz = kFrameRate_hz};
  }

  std::optional<core::Frame> next() override {
    if (num_given_ == walk_.size()) return std::nullopt;
    if (!renderer_) renderer_.emplace(building_, rays_, rig_->cameras.front());
    const core::StampedPose& pose = walk_[num_given_];
    const View view = renderer_->render(pose.world_from_camera);
    core::Frame frame{.id = core::FrameId(num_given_),
                      .stamp_s = pose.stamp_s,
                      .name = fmt::format("{} frame {}", name_, num_given_),
                      .rig = rig_,
                      .images = {photograph(view.radiance, gain(pose.stamp_s),
                                            core::seed_of(seed_, "twin.picture", num_given_))}};
    frame.depth_m =
        config_.ideal_depth
            ? view.depth_m
            : measure_depth(view, building_, core::seed_of(seed_, "twin.depth", num_given_));
    ++num_given_;
    return frame;
  }

  core::Truth truth() const override {
    const Walk walk{.poses = walk_, .visit_of_frame = std::vector<int>(walk_.size(), 0)};
    return core_truth(walk_, truth_of(walk, {{&building_, &rays_}}, rig_->cameras.front()));
  }

 private:
  // Exposure over the usual one: follows the scene slowly, a little off in each frame.
  float gain(double stamp_s) const {
    core::Random random(core::seed_of(seed_, "twin.exposure", num_given_));
    constexpr double kUsual = 1.9;  // puts light walls at two thirds of the range
    const double slow = 0.05 * std::sin(2.0 * std::numbers::pi * 0.07 * stamp_s);
    return static_cast<float>(kUsual * (1.0 + slow + 0.008 * random.gaussian()));
  }

  std::string name_;
  std::uint64_t seed_;
  Config config_;
  std::shared_ptr<const core::Rig> rig_;
  Building building_;
  RayScene rays_;
  core::Trajectory walk_;
  std::optional<Renderer> renderer_;
  std::size_t num_given_ = 0;
};

}  // namespace

std::unique_ptr<core::Source> open_twin(const std::string& spec, const Config& config) {
  return std::make_unique<TwinSource>(parse_spec(spec), config);
}

}  // namespace samewhere::twin
