#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <samewhere/core/source.hpp>
#include <samewhere/twin/front/dataset.hpp>

namespace samewhere::twin {

// A folder that appears whole or not at all: it is NAME.partial until finish().
class PartialFolder {
 public:
  // Throws InputError if either name is taken or the folder cannot be made.
  explicit PartialFolder(const std::filesystem::path& folder);
  PartialFolder(const PartialFolder&) = delete;
  PartialFolder& operator=(const PartialFolder&) = delete;
  ~PartialFolder();  // without finish(): nothing remains

  // Makes the folders on the way. Throws InputError if it cannot be written.
  void write(const std::filesystem::path& name, std::string_view content) const;
  void finish();

 private:
  std::filesystem::path folder_;
  std::filesystem::path partial_;
  bool is_finished_ = false;
};

// Gives every frame of the source to `take`, with a progress line. Throws core::Interrupted after
// Ctrl-C.
void write_each_frame(core::Source& source, const std::function<void(const core::Frame&)>& take);

// frames.csv and so on (dataset.hpp); stamps_s are those of all frames.
void write_tables(const PartialFolder& out, const std::vector<double>& stamps_s,
                  const SideTables& tables);
// same_place.pgm.
void write_places(const PartialFolder& out, std::size_t num_frames,
                  const core::PlaceTruthMatrix& places);

}  // namespace samewhere::twin
