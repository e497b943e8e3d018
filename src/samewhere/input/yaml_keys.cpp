#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/geometry/camera_check.hpp>
#include <samewhere/input/yaml_keys.hpp>

namespace samewhere::input {
namespace {

using core::InputError;

// Some files begin with OpenCV's `%YAML:1.0`, which no YAML parser but OpenCV's knows; the line
// stays, empty, so that the others keep their numbers. OpenCV and JSON allow tabs.
std::string readable(std::string text) {
  std::replace(text.begin(), text.end(), '\t', ' ');
  if (!text.starts_with("%YAML")) return text;
  return text.erase(0, std::min(text.find('\n'), text.size()));
}

YAML::Node parse(const std::filesystem::path& file, std::string text) {
  try {
    YAML::Node root = YAML::Load(readable(std::move(text)));
    if (root.IsMap()) return root;
  } catch (const YAML::Exception& error) {
    throw InputError(
        fmt::format("{}, line {}: not YAML: {}", file.string(), error.mark.line + 1, error.msg));
  }
  throw InputError(file.string() + ": is no list of keys and values, expected those of a camera");
}

void add_words(const YAML::Node& node, int depth, core::TextLine& line) {
  constexpr std::size_t kMostWords = 64;
  constexpr int kMostDepth = 2;
  if (node.IsScalar()) {
    line.words.push_back(node.Scalar());
    return;
  }
  if (!node.IsSequence() || depth == kMostDepth) {
    throw InputError(line.place + ": expected plain values");
  }
  for (const YAML::Node& entry : node) {
    add_words(entry, depth + 1, line);
    if (line.words.size() <= kMostWords) continue;
    throw InputError(fmt::format("{}: expected at most {} values", line.place, kMostWords));
  }
}

}  // namespace

YamlKeys::YamlKeys(const std::filesystem::path& file, std::string text)
    : YamlKeys(file, parse(file, std::move(text))) {}

YamlKeys::YamlKeys(const std::filesystem::path& file, const YAML::Node& map)
    : file_(file), root_(map) {
  std::set<std::string> seen;
  for (const std::string& name : names()) {
    if (seen.insert(name).second) continue;
    throw InputError(
        fmt::format("{}: has the key {} twice", file_.string(), core::printable(name)));
  }
}

std::vector<std::string> YamlKeys::names() const {
  std::vector<std::string> names;
  for (const auto& entry : root_) {
    if (entry.first.IsScalar()) names.push_back(entry.first.Scalar());
  }
  return names;
}

std::vector<YamlKeys> YamlKeys::maps(const std::string& key) const {
  if (!has_list(key)) throw InputError(fmt::format("{}: has no list {}", file_.string(), key));
  std::vector<YamlKeys> maps;
  for (const YAML::Node& entry : root_[key]) {
    if (!entry.IsMap()) {
      throw InputError(fmt::format("{}, line {}: {}: expected keys and values", file_.string(),
                                   entry.Mark().line + 1, key));
    }
    maps.emplace_back(file_, entry);
  }
  return maps;
}

std::optional<std::string> YamlKeys::first_of(std::initializer_list<const char*> keys) const {
  const auto found = std::find_if(
      keys.begin(), keys.end(), [&](const char* key) { return has(key) && !root_[key].IsNull(); });
  if (found == keys.end()) return std::nullopt;
  return *found;
}

core::TextLine YamlKeys::line(const std::string& key) const {
  const YAML::Node value = root_[key];
  if (!value) throw InputError(fmt::format("{}: has no {}", file_.string(), key));
  core::TextLine line{fmt::format("{}, line {}: {}", file_.string(), value.Mark().line + 1, key),
                      {}};
  const bool is_matrix = value.IsMap() && value["data"];
  const YAML::Node values = is_matrix ? value["data"] : value;
  if (value.IsMap() && !is_matrix) {
    throw InputError(fmt::format("{}: has no {}.data", file_.string(), key));
  }
  add_words(values, 0, line);
  return line;
}

std::string YamlKeys::word(const std::string& key) const {
  const core::TextLine words = line(key);
  if (words.words.size() == 1) return words.words.front();
  throw InputError(
      fmt::format("{}: found {} values, expected one", words.place, words.words.size()));
}

double YamlKeys::number(const std::string& key) const {
  word(key);
  return core::finite_number(line(key), 0);
}

double YamlKeys::number_or(const std::string& key, double otherwise) const {
  return has(key) ? number(key) : otherwise;
}

std::vector<double> YamlKeys::numbers(const std::string& key) const {
  const core::TextLine words = line(key);
  std::vector<double> numbers;
  for (std::size_t i = 0; i < words.words.size(); ++i) {
    numbers.push_back(core::finite_number(words, i));
  }
  return numbers;
}

int YamlKeys::pixels(const std::string& key) const {
  const double length_px = number(key);
  if (length_px >= 1.0 && length_px <= geometry::kMaxPicture_px &&
      length_px == std::floor(length_px)) {
    return static_cast<int>(length_px);
  }
  throw InputError(fmt::format("{}: found {}, expected whole pixels, 1 to {}", line(key).place,
                               length_px, geometry::kMaxPicture_px));
}

}  // namespace samewhere::input
