#include <cmath>
#include <utility>

#include <samewhere/core/errors.hpp>
#include <samewhere/node/pairing.hpp>

namespace samewhere::node {
namespace {

// Older than this, an image is of another recording.
constexpr double kMaxStepBack_s = 1.0;

Picture taken_from(std::deque<Picture>& pictures) {
  Picture picture = std::move(pictures.front());
  pictures.pop_front();
  return picture;
}

}  // namespace

Pairing::Pairing(bool has_second, double tolerance_s, std::size_t capacity)
    : has_second_(has_second), tolerance_s_(tolerance_s), capacity_(capacity) {
  core::require(capacity > 0, "a Pairing holds at least one image per stream");
}

void Pairing::add_first(Picture picture) { add(first_, std::move(picture)); }

void Pairing::add_second(Picture picture) { add(second_, std::move(picture)); }

void Pairing::add(Stream& stream, Picture picture) {
  if (stream.newest_s && picture.stamp_s < *stream.newest_s - kMaxStepBack_s) {
    for (Stream* each : {&first_, &second_}) {
      while (!each->waiting.empty()) drop_oldest(*each);
      each->newest_s.reset();
    }
  }
  if (stream.newest_s && picture.stamp_s <= *stream.newest_s) {
    ++num_dropped_;
    return;
  }
  stream.newest_s = picture.stamp_s;
  stream.waiting.push_back(std::move(picture));
  if (stream.waiting.size() > capacity_) drop_oldest(stream);
}

void Pairing::drop_oldest(Stream& stream) {
  stream.waiting.pop_front();
  ++num_dropped_;
}

std::optional<std::size_t> Pairing::partner_of(const Picture& picture) const {
  std::optional<std::size_t> nearest;
  double nearest_s = tolerance_s_;
  for (std::size_t i = 0; i < second_.waiting.size(); ++i) {
    const double difference_s = std::abs(second_.waiting[i].stamp_s - picture.stamp_s);
    if (difference_s > nearest_s) continue;
    nearest = i;
    nearest_s = difference_s;
  }
  return nearest;
}

std::optional<FrameSet> Pairing::next() {
  while (!first_.waiting.empty()) {
    if (!has_second_) return FrameSet{taken_from(first_.waiting), std::nullopt};
    const Picture& oldest = first_.waiting.front();
    if (const auto partner = partner_of(oldest)) {
      for (std::size_t i = 0; i < *partner; ++i) drop_oldest(second_);
      Picture first = taken_from(first_.waiting);
      return FrameSet{std::move(first), taken_from(second_.waiting)};
    }
    const bool may_come = !second_.newest_s || *second_.newest_s <= oldest.stamp_s + tolerance_s_;
    if (may_come) return std::nullopt;
    drop_oldest(first_);
  }
  return std::nullopt;
}

}  // namespace samewhere::node
