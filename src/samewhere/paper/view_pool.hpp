#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <opencv2/core/mat.hpp>

#include <samewhere/core/descriptor.hpp>
#include <samewhere/describe/describer.hpp>
#include <samewhere/pipeline/config.hpp>

namespace samewhere::paper {

// Views for stores of any size up to a largest one, and views to ask for.
struct ViewPool {
  std::vector<core::Descriptor> stored;
  std::vector<core::Descriptor> queries;
  std::vector<cv::Mat> pictures;  // the whole frames that the queries are crops of, in their order
};

struct PoolSize {
  int num_stored = 0;
  int num_queries = 0;
};

// Number `number` of the random crops of a picture: half of its sides to all but a tenth, at least
// one pixel. Shares the picture's memory.
cv::Mat random_crop(const cv::Mat& picture, std::uint64_t frame, std::uint64_t number);

// Makes a pool of frames that come one by one. Stored are first all frames, then random crops of
// them in the same order until there are enough; query i is another crop, of frame i * num_frames /
// num_queries.
class ViewPoolMaker {
 public:
  // `describer` outlives the maker. There are frames and room for some, or ContractError.
  ViewPoolMaker(describe::Describer& describer, int num_frames, const PoolSize& size);

  void add(const cv::Mat& picture);
  ViewPool pool() &&;

 private:
  void add_queries(const cv::Mat& picture);
  core::Descriptor described(const cv::Mat& picture);

  describe::Describer& describer_;
  PoolSize size_;
  int num_frames_;
  int num_added_ = 0;
  std::vector<std::vector<core::Descriptor>> rounds_;  // 0: the frames themselves; crops of them
  ViewPool pool_;
};

// The pool of all frames of the sources in turn, each read once, with a progress line on stderr.
// Nothing after Ctrl-C. Throws InputError.
std::optional<ViewPool> make_view_pool(const std::vector<pipeline::Config>& sources,
                                       describe::Describer& describer, const PoolSize& size);

}  // namespace samewhere::paper
