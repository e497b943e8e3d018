#include <algorithm>
#include <cstring>
#include <iterator>
#include <optional>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>
#include <samewhere/core/ordered_workers.hpp>
#include <samewhere/core/stage_thread.hpp>
#include <samewhere/pairs/labelled_pairs.hpp>
#include <samewhere/train/held_back.hpp>
#include <samewhere/train/pair_set.hpp>
#include <samewhere/train/sha256.hpp>

namespace samewhere::train {
namespace {

using core::InputError;
using nlohmann::json;
using verify::kNumPairPlanes;
using verify::kPairSide_px;

constexpr std::string_view kFormat = "samewhere pairs 1 ";
constexpr int kNumPictures = 2;  // the first planes: of numbers in [-1, 1]; the others in [0, 1]
constexpr double kZero = 128.0;
constexpr double kOne = 127.0;
constexpr double kWhole = 255.0;
constexpr std::size_t kNumBytes =
    std::size_t{kNumPairPlanes} * std::size_t{kPairSide_px} * std::size_t{kPairSide_px};

cv::Rect pictures() { return {0, 0, kPairSide_px, kNumPictures * kPairSide_px}; }
cv::Rect features() {
  return {0, kNumPictures * kPairSide_px, kPairSide_px,
          (kNumPairPlanes - kNumPictures) * kPairSide_px};
}

std::string_view bytes_of(const PairExample& pair) {
  return {pair.planes.ptr<char>(), pair.planes.total()};
}

std::string digest_of(const PairSet& set) {
  Sha256 sha;
  for (const PairSource& source : set.sources)
    sha.add(fmt::format("{} {} {};", source.num_same, source.num_wrong, source.is_held_back));
  for (const PairExample& pair : set.pairs) {
    sha.add(pair.is_same ? "same" : "wrong");
    sha.add(bytes_of(pair));
  }
  return sha.hex();
}

struct PairsOfSource {
  PairSource source;
  std::vector<PairExample> pairs;
};

PairsOfSource pairs_of_source(const std::string& name, const PairConfig& config) {
  const pairs::LabelledPairs labelled =
      pairs::labelled_pairs(name, {.step = config.step,
                                   .query_step = config.query_step,
                                   .window_frames = config.window_frames,
                                   .min_matches = config.min_matches,
                                   .other_cameras = config.other_cameras});
  PairsOfSource made{.source = {.source = name}, .pairs = {}};
  for (const pairs::LabelledPair& pair : labelled.pairs) {
    const auto view = verify::register_pair(labelled.views[static_cast<std::size_t>(pair.query)],
                                            labelled.views[static_cast<std::size_t>(pair.match)],
                                            pair.matches, {});
    if (!view) continue;
    ++(pair.is_same ? made.source.num_same : made.source.num_wrong);
    made.pairs.push_back({packed(view->planes), pair.is_same});
  }
  return made;
}

// Several sources at a time; which thread makes which is not seen in the pairs.
void read_sources(std::span<const std::string> names, bool is_held_back, const PairConfig& config,
                  PairSet& set) {
  const int num_threads = config.threads > 0 ? config.threads : core::num_hardware_threads();
  core::OrderedWorkers<PairsOfSource> workers(
      static_cast<int>(names.size()), num_threads,
      [&](int i) { return pairs_of_source(names[static_cast<std::size_t>(i)], config); });
  while (std::optional<PairsOfSource> made = workers.next()) {
    made->source.is_held_back = is_held_back;
    set.sources.push_back(made->source);
    std::move(made->pairs.begin(), made->pairs.end(), std::back_inserter(set.pairs));
  }
}

void require_both_kinds(const PairSet& set, bool is_held_back) {
  int num_same = 0;
  int num_wrong = 0;
  for (const PairSource& source : set.sources) {
    if (source.is_held_back != is_held_back) continue;
    num_same += source.num_same;
    num_wrong += source.num_wrong;
  }
  if (num_same > 0 && num_wrong > 0) return;
  throw InputError(
      fmt::format("{}: {} pairs of one place and {} of two that look alike, expected some of both",
                  is_held_back ? "--validate" : "SOURCE", num_same, num_wrong));
}

json header_of(const PairSet& set, const std::string& made_of) {
  json sources = json::array();
  for (const PairSource& source : set.sources)
    sources.push_back({source.source, source.num_same, source.num_wrong, source.is_held_back});
  json is_same = json::array();
  for (const PairExample& pair : set.pairs) is_same.push_back(pair.is_same ? 1 : 0);
  return {{"made_of", made_of}, {"sources", sources}, {"is_same", is_same}};
}

PairSet from_header(const json& header, std::string_view planes) {
  PairSet set;
  for (const json& row : header.at("sources"))
    set.sources.push_back({row.at(0), row.at(1), row.at(2), row.at(3)});
  for (const json& is_same : header.at("is_same")) {
    core::require(planes.size() >= kNumBytes, "each pair has its planes");
    PairExample pair{.planes = cv::Mat(kNumPairPlanes * kPairSide_px, kPairSide_px, CV_8U),
                     .is_same = is_same.get<int>() == 1};
    std::memcpy(pair.planes.data, planes.data(), kNumBytes);
    planes.remove_prefix(kNumBytes);
    set.pairs.push_back(std::move(pair));
  }
  return set;
}

// The bytes behind the first line feed.
std::string_view after_line(std::string_view text) {
  return text.substr(std::min(text.find('\n'), text.size() - 1) + 1);
}

// The format, and the checksum of all that follows.
std::string first_line(std::string_view content) {
  return fmt::format("{}{}\n", kFormat, sha256_of(content));
}

}  // namespace

cv::Mat packed(const cv::Mat& planes) {
  cv::Mat bytes(planes.size(), CV_8U);
  planes(pictures()).convertTo(bytes(pictures()), CV_8U, kOne, kZero);
  planes(features()).convertTo(bytes(features()), CV_8U, kWhole);
  return bytes;
}

cv::Mat unpacked(const cv::Mat& packed) {
  cv::Mat planes(packed.size(), CV_32F);
  packed(pictures()).convertTo(planes(pictures()), CV_32F, 1.0 / kOne, -kZero / kOne);
  packed(features()).convertTo(planes(features()), CV_32F, 1.0 / kWhole);
  return planes;
}

PairSet read_pairs(std::span<const std::string> sources, std::span<const std::string> validate,
                   const PairConfig& config) {
  require_other_places(sources, validate, "SOURCE");
  PairSet set;
  read_sources(sources, false, config, set);
  require_both_kinds(set, false);
  read_sources(validate, true, config, set);
  require_both_kinds(set, true);
  set.sha256 = digest_of(set);
  return set;
}

void write_pairs(const std::filesystem::path& path, const PairSet& set,
                 const std::string& made_of) {
  std::string content = header_of(set, made_of).dump() + "\n";
  for (const PairExample& pair : set.pairs) content += bytes_of(pair);
  core::write_file(path, first_line(content) + content);
}

PairSet load_pairs(const std::filesystem::path& path, const std::string& made_of) {
  const auto fail = [&](std::string_view why) {
    throw InputError(
        fmt::format("{}: {}; remove it to have the pairs made anew", path.string(), why));
  };
  const std::string file = core::read_file(path, core::kDataLimit);
  if (!file.starts_with(kFormat)) fail("is no file of prepared pairs");
  const std::string_view content = after_line(file);
  if (!file.starts_with(first_line(content))) fail("is damaged or cut short");
  const std::string_view planes = after_line(content);
  const json header = json::parse(content.substr(0, content.size() - planes.size()));
  if (header.at("made_of") != made_of) fail("holds the pairs of other sources or settings");
  PairSet set = from_header(header, planes);
  set.sha256 = digest_of(set);
  return set;
}

std::vector<int> pairs_of(const PairSet& set, bool is_held_back) {
  std::vector<int> indices;
  int next = 0;
  for (const PairSource& source : set.sources) {
    const int end = next + source.num_same + source.num_wrong;
    for (; next < end; ++next) {
      if (source.is_held_back == is_held_back) indices.push_back(next);
    }
  }
  return indices;
}

}  // namespace samewhere::train
