#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include <samewhere/pipeline/config.hpp>

namespace samewhere::paper {

// Whatever bears on rows, by name.
using RowSettings = std::map<std::string, std::string>;

// Every setting of the config, by its full name.
RowSettings settings_of(const pipeline::Config& config);

// What was measured already: one JSON file for each piece of work, written when that is done, so
// that an interrupted benchmark goes on where it stopped.
class RowStore {
 public:
  // Empty: keeps nothing. is_fresh: what the folder has counts as not measured.
  explicit RowStore(std::filesystem::path folder, bool is_fresh = false);

  // The rows of this piece, if they were measured with the same settings. A setting that the file
  // does not know yet must have its default. A file that cannot be read counts as none.
  std::optional<nlohmann::json> find(const std::string& name, const RowSettings& settings) const;
  // Throws InputError if it cannot be written.
  void keep(const std::string& name, const RowSettings& settings, const nlohmann::json& rows) const;

 private:
  std::filesystem::path file_of(const std::string& name) const;
  bool are_same(const RowSettings& kept, const RowSettings& settings) const;

  std::filesystem::path folder_;
  bool is_fresh_;
  RowSettings defaults_;
};

}  // namespace samewhere::paper
