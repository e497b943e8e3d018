#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include <opencv2/core/mat.hpp>

#include <samewhere/core/truth.hpp>
#include <samewhere/train/config.hpp>

namespace samewhere::train {

// What one source gave.
struct SourceCount {
  std::string source;  // as it was named
  int num_images = 0;
  int num_unreadable = 0;         // skipped
  bool is_held_back = false;      // only to validate with
  core::PlaceTruthMatrix places;  // over its views; of no frames where it is not known
};

// All views to learn from and to validate with, prepared: grey, equalised, small.
struct ImageSet {
  std::vector<cv::Mat> views;  // source after source, each in its order
  std::vector<SourceCount> sources;
  std::string sha256;  // of all pixels, and of what belongs to which source
};

// Index of the source that a view is from.
int source_of(const ImageSet& images, int view);
// Index of a source's first view.
int first_view_of(const ImageSet& images, int source);

// Called now and then while a source is read: its name, images done, images in all.
using ReadingProgress = std::function<void(const std::string& source, int done, int total)>;

// Reads each source (a recording or folder of images, a list of images, twin:PRESET?seed=3), those
// to validate with last, passes every view through describe::preprocess of the published settings
// and reduces it to twice the encoder's size, 360 x 480 at most. Of several cameras the first
// counts. An image that cannot be read is skipped and counted; the other errors are InputErrors: a
// source that is not there, that has no readable image, or that is to be learnt from and validated
// with (a rendered building of the same seed is the same), or less than two images to learn from.
// Ends early, with what was read, once core::is_interrupted().
ImageSet read_images(std::span<const std::string> sources, std::span<const std::string> validate,
                     const Config& config, const ReadingProgress& on_progress);

// Indices of views to learn from, and of those that only tell how well it went.
struct Split {
  std::vector<int> training;
  std::vector<int> validation;
};

// Where sources are held back, their views validate and all others are learnt from. Else,
// neighbours in time showing the same place, each source is cut into blocks and about one of ten is
// held back; views within a quarter of a block before and behind it in its source are in neither
// list. A block is 32 views long, less where there are few. A place that a walk returns to may
// still be on both sides: only other sources are surely other places. At least two images;
// otherwise ContractError.
Split split_views(const ImageSet& images, std::uint64_t seed);

}  // namespace samewhere::train
