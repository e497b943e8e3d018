#include <algorithm>
#include <iterator>
#include <memory>
#include <utility>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/interrupt.hpp>
#include <samewhere/core/progress.hpp>
#include <samewhere/core/random.hpp>
#include <samewhere/input/prefetch.hpp>
#include <samewhere/paper/spread.hpp>
#include <samewhere/paper/view_pool.hpp>
#include <samewhere/run/open_source.hpp>

namespace samewhere::paper {

cv::Mat random_crop(const cv::Mat& picture, std::uint64_t frame, std::uint64_t number) {
  core::Random random(core::seed_of(frame, "crop", number));
  const double scale = random.uniform(0.5, 0.9);
  const cv::Size size(std::max(1, static_cast<int>(scale * picture.cols)),
                      std::max(1, static_cast<int>(scale * picture.rows)));
  const auto drawn = [&random](int bound) {
    return static_cast<int>(random.index(static_cast<std::uint64_t>(bound) + 1));
  };
  const int left = drawn(picture.cols - size.width);
  const int top = drawn(picture.rows - size.height);
  return picture(cv::Rect(cv::Point(left, top), size));
}

ViewPoolMaker::ViewPoolMaker(describe::Describer& describer, int num_frames, const PoolSize& size)
    : describer_(describer), size_(size), num_frames_(num_frames) {
  core::require(num_frames > 0 && size.num_stored > 0, "a pool has views, made of frames");
  rounds_.resize(static_cast<std::size_t>((size.num_stored - 1) / num_frames + 1));
}

void ViewPoolMaker::add(const cv::Mat& picture) {
  const auto frame = static_cast<std::uint64_t>(num_added_);
  for (std::size_t round = 0; round < rounds_.size(); ++round) {
    rounds_[round].push_back(described(round == 0 ? picture : random_crop(picture, frame, round)));
  }
  add_queries(picture);
  ++num_added_;
}

void ViewPoolMaker::add_queries(const cv::Mat& picture) {
  const auto frame = static_cast<std::uint64_t>(num_added_);
  const int num_here = num_spread_on(num_added_, num_frames_, size_.num_queries);
  if (num_here == 0) return;
  const cv::Mat kept = picture.clone();
  for (int i = 0; i < num_here; ++i) {
    const std::uint64_t number = rounds_.size() + static_cast<std::uint64_t>(i);
    pool_.queries.push_back(described(random_crop(kept, frame, number)));
    pool_.pictures.push_back(kept);
  }
}

ViewPool ViewPoolMaker::pool() && {
  for (auto& round : rounds_) {
    pool_.stored.insert(pool_.stored.end(), std::make_move_iterator(round.begin()),
                        std::make_move_iterator(round.end()));
    round.clear();
  }
  pool_.stored.resize(std::min(pool_.stored.size(), static_cast<std::size_t>(size_.num_stored)));
  for (std::size_t i = 0; i < pool_.stored.size(); ++i) pool_.stored[i].frame = core::FrameId(i);
  return std::move(pool_);
}

core::Descriptor ViewPoolMaker::described(const cv::Mat& picture) {
  return describer_.describe(core::FrameId(static_cast<std::uint64_t>(num_added_)), picture);
}

std::optional<ViewPool> make_view_pool(const std::vector<pipeline::Config>& sources,
                                       describe::Describer& describer, const PoolSize& size) {
  std::vector<std::unique_ptr<core::Source>> opened;
  int num_frames = 0;
  for (const pipeline::Config& config : sources) {
    opened.push_back(run::open_source(config));
    num_frames += opened.back()->info().num_frames;
  }
  if (num_frames <= 0) throw core::InputError("the sources hold no frame; expected at least one");
  ViewPoolMaker maker(describer, num_frames, size);
  core::Progress progress("frames and crops described", num_frames);
  int num_done = 0;
  for (auto& each : opened) {
    const auto source = input::prefetched(std::move(each));
    while (const std::optional<core::Frame> frame = source->next()) {
      if (core::is_interrupted()) return std::nullopt;
      maker.add(frame->images.front());
      progress.update(++num_done);
    }
  }
  return std::move(maker).pool();
}

}  // namespace samewhere::paper
