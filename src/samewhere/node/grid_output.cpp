#include <cmath>
#include <variant>

#include <samewhere/node/grid_output.hpp>

namespace samewhere::node {

GridOutput::GridOutput(const Settings& settings, const core::Camera& camera, Publisher& publisher)
    : depths_(settings.dense, camera),
      period_s_(settings.period_s),
      thread_(settings.dense, settings.has_thread, publisher) {}

void GridOutput::take_frame(double stamp_s, const cv::Mat& depth_m) {
  depths_.take_frame(stamp_s, depth_m);
}

void GridOutput::take_event(const Event& event) {
  if (const auto* inserted = std::get_if<KeyframeInserted>(&event.what))
    depths_.take_keyframe(*inserted);
  if (std::holds_alternative<MapDiscarded>(event.what)) depths_.clear();
}

void GridOutput::make_if_due(const messages::Header& header,
                             const std::shared_ptr<const Map>& map) {
  if (depths_.all().empty() || map->version() == version_told_) return;
  const double stamp_s = messages::seconds(header.stamp);
  const double since_s = stamp_s - told_s_.value_or(-INFINITY);
  if (since_s >= 0.0 && since_s < period_s_) return;
  told_s_ = stamp_s;
  version_told_ = map->version();
  thread_.make({header, map, depths_.all()});
}

void GridOutput::clear() {
  depths_.clear();
  told_s_.reset();
  version_told_ = 0;
}

}  // namespace samewhere::node
