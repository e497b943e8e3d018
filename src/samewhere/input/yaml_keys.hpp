#pragma once

#include <filesystem>
#include <initializer_list>
#include <optional>
#include <string>
#include <vector>

#include <yaml-cpp/yaml.h>

#include <samewhere/core/text_file.hpp>

namespace samewhere::input {

// The keys and values of a YAML or JSON file, by name. All members throw InputError naming file,
// line and key if a value is not what is asked for.
class YamlKeys {
 public:
  // Of the text of a file: OpenCV's `%YAML:1.0` and tabs are allowed.
  YamlKeys(const std::filesystem::path& file, std::string text);
  YamlKeys(const std::filesystem::path& file, const YAML::Node& map);

  bool has(const std::string& key) const { return static_cast<bool>(root_[key]); }
  bool has_map(const std::string& key) const { return has(key) && root_[key].IsMap(); }
  bool has_list(const std::string& key) const { return has(key) && root_[key].IsSequence(); }
  std::vector<std::string> names() const;
  // What lies under a key that has_map.
  YamlKeys below(const std::string& key) const { return {file_, root_[key]}; }

  // The maps of a list of maps.
  std::vector<YamlKeys> maps(const std::string& key) const;

  // The first of the keys that is there; nothing if none is.
  std::optional<std::string> first_of(std::initializer_list<const char*> keys) const;

  // The values of a key as words: one, a list, lists in a list, or the list `data` of a matrix.
  core::TextLine line(const std::string& key) const;
  std::string word(const std::string& key) const;  // the only value
  double number(const std::string& key) const;
  double number_or(const std::string& key, double otherwise) const;
  std::vector<double> numbers(const std::string& key) const;
  int pixels(const std::string& key) const;  // whole, 1 to geometry::kMaxPicture_px

  const std::filesystem::path& file() const { return file_; }

 private:
  std::filesystem::path file_;
  YAML::Node root_;
};

}  // namespace samewhere::input
