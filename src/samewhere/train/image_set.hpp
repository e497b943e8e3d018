#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include <opencv2/core/mat.hpp>

#include <samewhere/train/config.hpp>

namespace samewhere::train {

// What one source gave.
struct SourceCount {
  std::string source;  // as it was named
  int num_images = 0;
  int num_unreadable = 0;  // skipped
};

// All views to learn from, prepared: grey, equalised, small.
struct ImageSet {
  std::vector<cv::Mat> views;  // source after source, each in its order
  std::vector<SourceCount> sources;
  std::string sha256;  // of all pixels
};

// Called now and then while a source is read: its name, images done, images in all.
using ReadingProgress = std::function<void(const std::string& source, int done, int total)>;

// Reads each source (a recording or folder of images, a list of images, twin:PRESET?seed=3), passes
// every view through describe::preprocess of the published settings and reduces it to twice the
// encoder's size, 360 x 480 at most. Of several cameras the first counts. An image that cannot be
// read is skipped and counted; the other errors are InputErrors: a source that is not there, or
// that has no readable image, or less than two images in all. Ends early, with what was read, once
// core::is_interrupted().
ImageSet read_images(std::span<const std::string> sources, const Config& config,
                     const ReadingProgress& on_progress);

// Indices of views to learn from, and of those that only tell how well it went.
struct Split {
  std::vector<int> training;
  std::vector<int> validation;
};

// Neighbours in time show the same place, so the order is cut into blocks and whole blocks are held
// back: about one image of ten. A block is 32 images long, less where there are few. At
// least two images; otherwise ContractError.
Split split_by_blocks(int num_images, std::uint64_t seed);

}  // namespace samewhere::train
