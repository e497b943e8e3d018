#include <algorithm>
#include <memory>
#include <numeric>
#include <optional>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/interrupt.hpp>
#include <samewhere/core/ordered_workers.hpp>
#include <samewhere/core/random.hpp>
#include <samewhere/core/stage_thread.hpp>
#include <samewhere/describe/preprocess.hpp>
#include <samewhere/input/image_file.hpp>
#include <samewhere/input/open.hpp>
#include <samewhere/train/examples.hpp>
#include <samewhere/train/image_set.hpp>
#include <samewhere/train/sha256.hpp>
#include <samewhere/twin/studio.hpp>

namespace samewhere::train {
namespace {

constexpr int kBlockLength = 32;
constexpr int kValidationShare = 10;  // one block of so many

// Twice the encoder's input leaves a warped view sharp; more would be thrown away.
cv::Size stored_size_px(InputSize size) {
  const describe::Config published;
  const cv::Size input = input_size_px(size);
  return {std::min(2 * input.width, published.width_px),
          std::min(2 * input.height, published.height_px)};
}

cv::Mat prepared(const cv::Mat& image, InputSize size) {
  cv::Mat view;
  cv::resize(describe::preprocess(image, describe::Config{}), view, stored_size_px(size), 0.0, 0.0,
             cv::INTER_AREA);
  return view;
}

// `make(i)` gives image i, or nothing if it cannot be read.
using ImageMaker = std::function<std::optional<cv::Mat>(int)>;

struct OpenSource {
  std::string name;
  int num_images = 0;
  ImageMaker make;
};

OpenSource open_twin(const std::string& name, const Config& config) {
  const twin::Config usual;
  const auto walk = std::make_shared<const twin::Walkthrough>(twin::parse_spec(name), usual);
  const auto studio = std::make_shared<const twin::Studio>(*walk, usual);
  const int step = config.twin_step;
  return {.name = name,
          .num_images = (walk->num_frames() + step - 1) / step,
          .make = [walk, studio, step, size = config.input_size](int i) -> std::optional<cv::Mat> {
            return prepared(studio->pictures(i * step).images.front(), size);
          }};
}

OpenSource open_files(const std::string& name, const Config& config) {
  const auto recording =
      std::make_shared<const input::Recording>(input::read_recording(name, input::Config{}));
  return {.name = name,
          .num_images = static_cast<int>(recording->frames.size()),
          .make = [recording, size = config.input_size](int i) -> std::optional<cv::Mat> {
            const input::FrameFiles& files = recording->frames[static_cast<std::size_t>(i)];
            try {
              return prepared(input::read_image(files.images.front()), size);
            } catch (const core::InputError&) {
              return std::nullopt;  // counted
            }
          }};
}

void read_source(const OpenSource& source, const ReadingProgress& on_progress, ImageSet& images) {
  SourceCount count{.source = source.name};
  core::OrderedWorkers<std::optional<cv::Mat>> workers(source.num_images,
                                                       core::num_hardware_threads(), source.make);
  for (int i = 0; i < source.num_images && !core::is_interrupted(); ++i) {
    std::optional<cv::Mat> view = *workers.next();
    ++(view ? count.num_images : count.num_unreadable);
    if (view) images.views.push_back(*std::move(view));
    on_progress(source.name, i + 1, source.num_images);
  }
  if (count.num_images == 0 && !core::is_interrupted()) {
    throw core::InputError(
        fmt::format("{}: none of its {} images can be read, expected JPEG or PNG", source.name,
                    source.num_images));
  }
  images.sources.push_back(count);
}

std::string sha256_of(const std::vector<cv::Mat>& views) {
  Sha256 sha;
  for (const cv::Mat& view : views) {
    sha.add({view.ptr<char>(), view.total() * view.elemSize()});
  }
  return sha.hex();
}

}  // namespace

ImageSet read_images(std::span<const std::string> sources, const Config& config,
                     const ReadingProgress& on_progress) {
  ImageSet images;
  for (const std::string& name : sources) {
    if (core::is_interrupted()) return images;
    read_source(twin::is_twin_spec(name) ? open_twin(name, config) : open_files(name, config),
                on_progress, images);
  }
  if (images.views.size() < 2 && !core::is_interrupted()) {
    throw core::InputError("--images: one image in all, expected at least 2 to learn from");
  }
  images.sha256 = sha256_of(images.views);
  return images;
}

Split split_by_blocks(int num_images, std::uint64_t seed) {
  core::require(num_images >= 2, "there are images to learn from and images to check with");
  // few images: shorter blocks, so that one of ten can still be held back
  const int block_length = std::clamp(num_images / (2 * kValidationShare), 1, kBlockLength);
  const int num_blocks = (num_images + block_length - 1) / block_length;
  core::Random random(core::seed_of(seed, "split", 0));
  const std::vector<int> held_back =
      random.distinct_indices(std::max(1, num_blocks / kValidationShare), num_blocks);
  Split split;
  for (int i = 0; i < num_images; ++i) {
    const bool is_held_back =
        std::find(held_back.begin(), held_back.end(), i / block_length) != held_back.end();
    (is_held_back ? split.validation : split.training).push_back(i);
  }
  return split;
}

}  // namespace samewhere::train
