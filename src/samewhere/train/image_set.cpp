#include <algorithm>
#include <cstdint>
#include <filesystem>
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
#include <samewhere/train/held_back.hpp>
#include <samewhere/train/image_set.hpp>
#include <samewhere/train/sha256.hpp>
#include <samewhere/twin/front/studio.hpp>

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
  core::PlaceTruthMatrix places;
};

// Of every `step`th frame.
core::PlaceTruthMatrix thinned(const core::PlaceTruthMatrix& all, int step) {
  core::PlaceTruthMatrix places{.num_frames = (all.num_frames + step - 1) / step};
  for (int query = 0; query < all.num_frames; query += step) {
    for (int match = 0; match < all.num_frames; match += step) {
      places.values.push_back(all.at(query, match));
    }
  }
  return places;
}

core::PlaceTruthMatrix places_of(const twin::Walkthrough& walk, const Config& config) {
  if (config.contrast == 0.0 || !walk.truth().places) return {};
  return thinned(*walk.truth().places, config.twin_step);
}

OpenSource open_twin(const std::string& name, const Config& config) {
  const twin::Config usual;
  const auto walk = std::make_shared<const twin::Walkthrough>(twin::parse_spec(name), usual);
  const auto studio = std::make_shared<const twin::Studio>(*walk, usual);
  const int step = config.twin_step;
  return {.name = name,
          .num_images = (walk->num_frames() + step - 1) / step,
          .make = [walk, studio, step, size = config.input_size](int i) -> std::optional<cv::Mat> {
            return prepared(studio->pictures(i * step).images.front(), size);
          },
          .places = places_of(*walk, config)};
}

OpenSource open_files(const std::string& name, const Config& config) {
  const auto recording = std::make_shared<const input::Recording>(
      input::read_recording(name, input::Config{.needs_calibration = false}));
  return {.name = name,
          .num_images = static_cast<int>(recording->frames.size()),
          .make = [recording, size = config.input_size](int i) -> std::optional<cv::Mat> {
            const input::FrameFiles& files = recording->frames[static_cast<std::size_t>(i)];
            try {
              return prepared(input::read_image(files.images.front()), size);
            } catch (const core::InputError&) {
              return std::nullopt;  // counted
            }
          },
          .places = {}};
}

// Reads it into `images`.
void read_source(const OpenSource& source, bool is_held_back, const ReadingProgress& on_progress,
                 ImageSet& images) {
  SourceCount count{.source = source.name, .is_held_back = is_held_back, .places = source.places};
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

std::string digest_of(const ImageSet& images) {
  Sha256 sha;
  for (const SourceCount& source : images.sources) {
    sha.add(fmt::format("{}{};", source.num_images, source.is_held_back ? " held back" : ""));
  }
  for (const cv::Mat& view : images.views) {
    sha.add({view.ptr<char>(), view.total() * view.elemSize()});
  }
  return sha.hex();
}

// Views next to each other in one source, from `begin` up to `end`.
struct Block {
  int begin = 0;
  int end = 0;
  int source_begin = 0;
  int source_end = 0;
};

std::vector<Block> cut_into_blocks(const ImageSet& images, int length) {
  std::vector<Block> blocks;
  int source_begin = 0;
  for (const SourceCount& source : images.sources) {
    const int source_end = source_begin + source.num_images;
    for (int begin = source_begin; begin < source_end; begin += length) {
      blocks.push_back({begin, std::min(begin + length, source_end), source_begin, source_end});
    }
    source_begin = source_end;
  }
  return blocks;
}

enum class Use : std::uint8_t { kTraining, kNone, kValidation };

std::vector<Use> use_of_sources(const ImageSet& images) {
  std::vector<Use> uses;
  for (const SourceCount& source : images.sources) {
    uses.insert(uses.end(), static_cast<std::size_t>(source.num_images),
                source.is_held_back ? Use::kValidation : Use::kTraining);
  }
  return uses;
}

void hold_back_blocks(const ImageSet& images, std::uint64_t seed, std::vector<Use>& uses) {
  const int num_images = static_cast<int>(uses.size());
  // few images: shorter blocks, so that one of ten can still be held back
  const int length = std::clamp(num_images / (2 * kValidationShare), 1, kBlockLength);
  const int margin = length / 4;
  const std::vector<Block> blocks = cut_into_blocks(images, length);
  const int num_blocks = static_cast<int>(blocks.size());
  core::Random random(core::seed_of(seed, "split", 0));
  const auto set = [&](int begin, int end, Use use) {
    for (int i = begin; i < end; ++i) {
      Use& before = uses[static_cast<std::size_t>(i)];
      before = std::max(before, use);  // a margin takes nothing from another block held back
    }
  };
  for (const int index :
       random.distinct_indices(std::max(1, num_blocks / kValidationShare), num_blocks)) {
    const Block& block = blocks[static_cast<std::size_t>(index)];
    set(std::max(block.begin - margin, block.source_begin),
        std::min(block.end + margin, block.source_end), Use::kNone);
    set(block.begin, block.end, Use::kValidation);
  }
}

}  // namespace

int source_of(const ImageSet& images, int view) {
  int end = 0;
  for (std::size_t i = 0; i < images.sources.size(); ++i) {
    end += images.sources[i].num_images;
    if (view < end) return static_cast<int>(i);
  }
  throw core::ContractError("every view is from a source");
}

int first_view_of(const ImageSet& images, int source) {
  int first = 0;
  for (int i = 0; i < source; ++i) first += images.sources[static_cast<std::size_t>(i)].num_images;
  return first;
}

ImageSet read_images(std::span<const std::string> sources, std::span<const std::string> validate,
                     const Config& config, const ReadingProgress& on_progress) {
  require_other_places(sources, validate, "--images");
  ImageSet images;
  const auto read = [&](const std::string& name, bool is_held_back) {
    if (core::is_interrupted()) return;
    read_source(twin::is_twin_spec(name) ? open_twin(name, config) : open_files(name, config),
                is_held_back, on_progress, images);
  };
  for (const std::string& name : sources) read(name, false);
  if (images.views.size() < 2 && !core::is_interrupted()) {
    throw core::InputError("--images: one image in all, expected at least 2 to learn from");
  }
  for (const std::string& name : validate) read(name, true);
  images.sha256 = digest_of(images);
  return images;
}

Split split_views(const ImageSet& images, std::uint64_t seed) {
  std::vector<Use> uses = use_of_sources(images);
  core::require(uses.size() >= 2, "there are images to learn from and images to check with");
  const bool has_held_back =
      std::any_of(images.sources.begin(), images.sources.end(),
                  [](const SourceCount& source) { return source.is_held_back; });
  if (!has_held_back) hold_back_blocks(images, seed, uses);
  Split split;
  for (std::size_t i = 0; i < uses.size(); ++i) {
    if (uses[i] == Use::kTraining) split.training.push_back(static_cast<int>(i));
    if (uses[i] == Use::kValidation) split.validation.push_back(static_cast<int>(i));
  }
  return split;
}

}  // namespace samewhere::train
