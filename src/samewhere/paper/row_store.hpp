#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include <nlohmann/json_fwd.hpp>

namespace samewhere::paper {

// What was measured already: one JSON file for each piece of work, written when that is done, so
// that an interrupted benchmark goes on where it stopped.
class RowStore {
 public:
  // Empty: keeps nothing.
  explicit RowStore(std::filesystem::path folder);

  // The rows of this piece, if they were measured with the same settings (`settings`: whatever
  // bears on them). A file that cannot be read counts as none.
  std::optional<nlohmann::json> find(const std::string& name, const std::string& settings) const;
  // Throws InputError if it cannot be written.
  void keep(const std::string& name, const std::string& settings, const nlohmann::json& rows) const;

 private:
  std::filesystem::path file_of(const std::string& name) const;

  std::filesystem::path folder_;
};

}  // namespace samewhere::paper
