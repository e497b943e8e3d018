#include <utility>

#include <samewhere/core/errors.hpp>
#include <samewhere/pipeline/mapping_exchange.hpp>

namespace samewhere::pipeline {

MappingExchange::MappingExchange(MappingLink& link, int visible_after_frames,
                                 std::uint64_t num_keyframes)
    : link_(link),
      visible_after_frames_(static_cast<std::size_t>(visible_after_frames)),
      num_keyframes_(num_keyframes) {}

scene::MapVersion MappingExchange::initialize(ToMapping start) {
  core::require(!in_progress_, "a map does not begin while a keyframe is in progress");
  drop_places();
  link_.send(std::move(start));
  scene::MapVersion map = wait().map;
  keyframes_.clear();
  num_discarded_ = num_keyframes_;
  num_keyframes_ = map.keyframes.size();
  return map;
}

void MappingExchange::insert(scene::TrackedView tracked, const cv::Mat& image,
                             std::vector<core::FramePose> frames) {
  core::require(!in_progress_, "one keyframe is in progress at most");
  drop_places();
  const core::KeyframeId id(num_keyframes_++);
  const core::FrameId frame = tracked.view.frame;
  keyframes_.insert(frame);
  in_progress_ = {id, frame.index() + visible_after_frames_};
  link_.send(AddKeyframe{std::move(tracked), image, std::move(frames)});
}

bool MappingExchange::is_due(std::size_t num_frames) const {
  return in_progress_ && in_progress_->due_at_frame <= num_frames && may_receive();
}

MappingExchange::VisibleKeyframe MappingExchange::receive() {
  core::require(in_progress_.has_value(), "a keyframe is in progress");
  scene::MapVersion map = wait().map;
  return {std::exchange(in_progress_, std::nullopt)->id, std::move(map)};
}

MapAnswer MappingExchange::find_places(const features::View& view, const cv::Mat& image) {
  drop_places();
  link_.send(FindPlace{view, image});
  return wait();
}

void MappingExchange::ask_places(const features::View& view, const cv::Mat& image) {
  constexpr std::size_t kAnsweredAfterFrames = 4;
  core::require(!in_progress_ && !places_due_at_frame_, "one question is open at most");
  link_.send(FindPlace{view, image});
  places_due_at_frame_ = view.frame.index() + kAnsweredAfterFrames;
}

bool MappingExchange::are_places_due(std::size_t num_frames) const {
  return places_due_at_frame_ && *places_due_at_frame_ <= num_frames && may_receive();
}

MapAnswer MappingExchange::receive_places() {
  core::require(places_due_at_frame_.has_value(), "places were asked for");
  places_due_at_frame_.reset();
  return wait();
}

void MappingExchange::drop_places() {
  if (places_due_at_frame_) receive_places();
}

void MappingExchange::save(std::vector<core::FramePose> frames) {
  link_.send(SaveFrames{std::move(frames)});
}

void MappingExchange::finish(std::vector<core::FramePose> frames) {
  drop_places();
  link_.send(EndOfInput{std::move(frames)});
}

MapAnswer MappingExchange::wait() {
  const core::ScopedTimer timer(timings_, "wait for mapping");
  MapAnswer answer = link_.receive();
  rows_.insert(rows_.end(), answer.rows.begin(), answer.rows.end());
  return answer;
}

}  // namespace samewhere::pipeline
