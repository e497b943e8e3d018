#include <utility>

#include <fmt/format.h>

#include <samewhere/map/fuse.hpp>
#include <samewhere/pipeline/correction.hpp>
#include <samewhere/pipeline/soft_odometry.hpp>
#include <samewhere/pipeline/withdrawal.hpp>

namespace samewhere::pipeline {

Correction with_loop(const scene::MapVersion& map, const scene::LoopEdge& loop,
                     const Config& config, core::CandidateId overruled) {
  correct::Closing closing =
      correct::close_loop(with_soft_odometry(map, config, loop), loop, config.optimize, overruled);
  scene::MapVersion corrected = apply(map, closing.edit);
  if (!closing.withdrawn.empty()) corrected = with_places_parted(map, std::move(corrected), config);
  for (const auto& accepted : closing.accepted)
    for (const auto& edit : map::fuse_across(corrected, accepted, config.map, config.features))
      corrected = apply(std::move(corrected), edit);
  return {std::move(corrected), std::move(closing)};
}

std::string bent_by(const correct::OutlierLoop& bent, const Config& config) {
  return fmt::format("chi-square of its edge {:.1f}, above {:.1f}", bent.chi2,
                     config.optimize.loop_chi2);
}

}  // namespace samewhere::pipeline
