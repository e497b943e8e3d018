#include <utility>

#include <fmt/format.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/describe/describer.hpp>
#include <samewhere/run/mapped_slam.hpp>

namespace samewhere::run {
namespace {

// A map made without depth has lengths of its own, which no sensor knows; one with depth grows by
// depth alone.
void require_same_depth(const MapPlan& plan, const scene::MapVersion& known,
                        pipeline::DepthFrom depth_from) {
  const bool has_map_depth = !scene::is_without_depth(known);
  const bool has_run_depth = depth_from == pipeline::DepthFrom::kSensor;
  if (has_run_depth && !has_map_depth) {
    throw core::InputError(plan.known.string() +
                           ": the map was made without depth and has no metric scale, but this run "
                           "has depth; expected a run without depth (--set input.depth=false)");
  }
  if (has_map_depth && !has_run_depth && !plan.is_known_fixed) {
    throw core::InputError(plan.known.string() +
                           ": the map was made with depth and this run has none, so that it "
                           "cannot extend the map; expected --localize");
  }
}

// The header may say so and the descriptors not.
void require_same_describer(const std::filesystem::path& map, const core::Descriptor& known,
                            const pipeline::Config& config) {
  const auto describer = describe::make_describer(config.describe);
  const core::Descriptor own = describer->describe(known.frame, cv::Mat::zeros(64, 64, CV_8U));
  if (known.describer_checksum == own.describer_checksum && known.unit.size() == own.unit.size())
    return;
  throw core::InputError(fmt::format(
      "{}: is damaged: its views are described by {} numbers, not by the {} of its describer",
      map.string(), known.unit.size(), own.unit.size()));
}

}  // namespace

MappedSlam::MappedSlam(const pipeline::Config& config, pipeline::DepthFrom depth_from,
                       const MapPlan& plan)
    : config_(config), plan_(plan), is_metric_(depth_from == pipeline::DepthFrom::kSensor) {
  const pipeline::KeepMap keep_map = [this](const auto& map, const pipeline::MapNews& news) {
    keep(map, news);
  };
  if (plan.known.empty()) {
    slam_.emplace(config, depth_from, keep_map);
    return;
  }
  using enum scene::MapAccess;
  known_ = scene::MapFile::open(plan.known, plan.is_known_fixed ? kRead : kExtend);
  const scene::StoredMap stored = known_->load();
  if (stored.map.keyframes.empty())
    throw core::InputError(plan.known.string() + ": is a map without a keyframe");
  require_same_depth(plan, stored.map, depth_from);
  is_metric_ = !scene::is_without_depth(stored.map);
  if (!stored.extras.descriptors.empty()) known_view_ = stored.extras.descriptors.front();
  slam_.emplace(config, stored,
                plan.is_known_fixed ? pipeline::Slam::Use::kLocalize : pipeline::Slam::Use::kExtend,
                keep_map);
}

void MappedSlam::follow(std::shared_ptr<const pipeline::OdometryPath> odometry) {
  slam_->follow(std::move(odometry));
  if (!known_) is_metric_ = true;
}

void MappedSlam::feed(core::Frame& frame) {
  frame.id = core::FrameId(frame.id.index(), slam_->session());
  if (known_) take_known(*frame.rig);
  begin();
  slam_->feed(frame);
}

std::optional<std::string> MappedSlam::finish() {
  slam_->finish();
  if (!saver_) return std::nullopt;
  const std::optional<std::string> error = saver_->error();
  saver_.reset();
  return error;
}

// Before mapping has a frame.
void MappedSlam::begin() {
  const auto begin = std::exchange(plan_.begin, {});
  if (!begin) return;
  const std::filesystem::path save = begin();
  if (plan_.known.empty() && !save.empty())
    saver_.emplace(save, config_, slam_->describer_checksum());
}

// Called in mapping's thread.
void MappedSlam::keep(const scene::MapVersion& map, const pipeline::MapNews& news) {
  for (const auto& thumbnail : news.thumbnails) thumbnails_[thumbnail.frame] = thumbnail.jpeg;
  if (saver_) saver_->save(map, news);
  if (plan_.watch) plan_.watch(map, news);
}

// The first frame says which camera it is.
void MappedSlam::take_known(const core::Rig& rig) {
  known_->require_same_settings(map_header(config_, rig, slam_->describer_checksum()));
  if (known_view_) require_same_describer(plan_.known, *known_view_, config_);
  if (!plan_.is_known_fixed) {
    known_->begin_writing();
    saver_.emplace(std::move(*known_));
  }
  known_.reset();
}

}  // namespace samewhere::run
