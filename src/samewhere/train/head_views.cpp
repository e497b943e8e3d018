#include <cstdlib>
#include <cstring>
#include <memory>
#include <optional>
#include <sstream>
#include <utility>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include <samewhere/core/checksum.hpp>
#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>
#include <samewhere/core/interrupt.hpp>
#include <samewhere/core/random.hpp>
#include <samewhere/input/image_file.hpp>
#include <samewhere/input/open.hpp>
#include <samewhere/train/examples.hpp>
#include <samewhere/train/head_views.hpp>
#include <samewhere/twin/front/studio.hpp>

namespace samewhere::train {
namespace {

constexpr int kNeighbours = 10;
// Goes up when the same source and settings give other views.
constexpr const char* kViewsVersion = "head views 1";

cv::Mat as_bgr(const cv::Mat& image) {
  if (image.channels() == 3) return image;
  cv::Mat bgr;
  cv::cvtColor(image, bgr, cv::COLOR_GRAY2BGR);
  return bgr;
}

void add_map(const cv::Mat& picture, network::Trunk& trunk, HeadSource& source) {
  if (core::is_interrupted()) throw core::Interrupted();
  const cv::Mat map = trunk.run(picture);
  source.shape = {map.size[1], map.size[2], map.size[3]};
  cv::Mat half;
  map.reshape(1, 1).convertTo(half, CV_16F);
  source.maps.push_back(half);
}

HeadSource render(const std::string& name, network::Trunk& trunk, int step,
                  const HeadProgress& on_progress) {
  const twin::Config usual;
  const twin::Walkthrough walk(twin::parse_spec(name), usual);
  const twin::Studio studio(walk, usual);
  const twin::WalkTruth& truth = twin::watched_truth(walk);
  if (!truth.places) {
    throw core::InputError(fmt::format("{}: the walk is long, expected one of at most {} frames",
                                       name, twin::kMaxFramesOfMatrix));
  }
  HeadSource source{.name = name, .frames_per_view = step};
  const int num_views = (walk.num_frames() + step - 1) / step;
  source.places.num_frames = num_views;
  for (int view = 0; view < num_views; ++view) {
    add_map(as_bgr(studio.pictures(view * step).images.front()), trunk, source);
    for (int other = 0; other < num_views; ++other)
      source.places.values.push_back(truth.places->at(view * step, other * step));
    on_progress(view + 1, num_views);
  }
  for (const twin::AliasedPair& pair : truth.aliased_pairs) {
    if (pair.query % step == 0 && pair.match % step == 0)
      source.aliased_pairs.push_back({pair.query / step, pair.match / step});
  }
  return source;
}

HeadSource read_images_of(const std::string& name, network::Trunk& trunk, const HeadConfig& config,
                          const HeadProgress& on_progress) {
  const input::Recording recording =
      input::read_recording(name, input::Config{.needs_calibration = false});
  HeadSource source{.name = name, .views_per_image = 1 + config.num_distorted};
  const int num_images = static_cast<int>(recording.frames.size());
  for (int i = 0; i < num_images; ++i) {
    on_progress(i + 1, num_images);
    cv::Mat picture;
    try {
      picture =
          as_bgr(input::read_image(recording.frames[static_cast<std::size_t>(i)].images.front()));
    } catch (const core::InputError&) {
      continue;
    }
    add_map(picture, trunk, source);
    core::Random random(core::seed_of(static_cast<std::uint64_t>(config.seed), "distort",
                                      static_cast<std::uint64_t>(i)));
    for (int k = 0; k < config.num_distorted; ++k)
      add_map(distorted_picture(picture, random), trunk, source);
  }
  if (source.maps.empty()) {
    throw core::InputError(
        fmt::format("{}: none of its {} images can be read, expected JPEG or "
                    "PNG",
                    name, num_images));
  }
  return source;
}

// A head line, the maps, the places as one byte each, the aliased pairs as two numbers each.
std::string as_bytes(const HeadSource& source) {
  std::string bytes =
      fmt::format("{} {} {} {} {} {} {} {}\n", source.shape.channels, source.shape.rows,
                  source.shape.columns, source.num_views(), source.views_per_image,
                  source.frames_per_view, source.places.num_frames, source.aliased_pairs.size());
  for (const cv::Mat& map : source.maps)
    bytes.append(map.ptr<char>(), map.total() * map.elemSize());
  for (const core::PlaceTruth place : source.places.values) bytes += static_cast<char>(place);
  bytes.append(reinterpret_cast<const char*>(source.aliased_pairs.data()),  // NOLINT: bytes
               source.aliased_pairs.size() * sizeof(core::FramePair));
  return bytes;
}

HeadSource from_bytes(const std::string& name, const std::string& bytes) {
  HeadSource source{.name = name};
  int num_views = 0;
  std::size_t num_pairs = 0;
  const std::size_t line = bytes.find('\n') + 1;
  std::istringstream head(bytes.substr(0, line));
  head >> source.shape.channels >> source.shape.rows >> source.shape.columns >> num_views >>
      source.views_per_image >> source.frames_per_view >> source.places.num_frames >> num_pairs;
  const auto num_places = static_cast<std::size_t>(source.places.num_frames) *
                          static_cast<std::size_t>(source.places.num_frames);
  const std::size_t map_bytes = static_cast<std::size_t>(source.shape.size()) * 2;
  core::require(bytes.size() == line + map_bytes * static_cast<std::size_t>(num_views) +
                                    num_places + num_pairs * sizeof(core::FramePair),
                "a file of feature maps is as long as it says");
  const char* at = bytes.data() + line;
  for (int i = 0; i < num_views; ++i, at += map_bytes) {
    source.maps.emplace_back(1, source.shape.size(), CV_16F);
    std::memcpy(source.maps.back().data, at, map_bytes);
  }
  for (std::size_t i = 0; i < num_places; ++i, ++at)
    source.places.values.push_back(static_cast<core::PlaceTruth>(*at));
  source.aliased_pairs.resize(num_pairs);
  if (num_pairs > 0)
    std::memcpy(source.aliased_pairs.data(), at, num_pairs * sizeof(core::FramePair));
  return source;
}

}  // namespace

Relation relation_of(const HeadSource& source, int a, int b) {
  if (a == b) return Relation::kIgnored;
  if (!source.is_walk()) {
    const int distance = std::abs(a / source.views_per_image - b / source.views_per_image);
    if (distance == 0) return Relation::kSame;
    return distance <= kNeighbours ? Relation::kIgnored : Relation::kDifferent;
  }
  const core::PlaceTruth place = source.places.at(a, b);
  if (place == core::PlaceTruth::kNear) return Relation::kIgnored;
  return place == core::PlaceTruth::kSame ? Relation::kSame : Relation::kDifferent;
}

HeadSource read_head_source(const std::string& name, network::Trunk& trunk,
                            const HeadConfig& config, const std::filesystem::path& cache,
                            const HeadProgress& on_progress) {
  const std::string key = fmt::format("{} {:016x} {} {} {} {}", kViewsVersion, trunk.checksum(),
                                      name, config.twin_step, config.num_distorted, config.seed);
  const auto file = cache / fmt::format("{:016x}.maps", core::checksum(key));
  if (!cache.empty() && core::is_there(file))
    return from_bytes(name, core::read_file(file, core::kDataLimit));
  HeadSource source = twin::is_twin_spec(name) ? render(name, trunk, config.twin_step, on_progress)
                                               : read_images_of(name, trunk, config, on_progress);
  if (!cache.empty()) {
    core::make_writable_folder(cache);
    core::write_file(file, as_bytes(source));
  }
  return source;
}

}  // namespace samewhere::train
