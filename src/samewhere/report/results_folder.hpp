#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include <samewhere/core/folder_lock.hpp>

namespace samewhere::report {

// Where a run puts its results.
struct ResultsPlace {
  std::filesystem::path folder;          // as asked for; empty: the first of ...
  std::filesystem::path name;            // ... NAME, NAME-2, NAME-3 that is not there
  bool replaces_earlier = false;         // the folder may hold the results of an earlier run
  std::filesystem::path source = {};     // of the run: never the folder for results
  std::filesystem::path known_map = {};  // that the run starts in; it stays if it is in the folder
};

// The results folder of a run, locked while this object lives. It is created at the first good
// frame: a run without one changes nothing on the disk.
class ResultsFolder {
 public:
  // Throws InputError if the folder cannot take the results: it is the recording, holds results of
  // an earlier run that are not to be replaced, holds files with the names of results that are of
  // no run (a recording or a map), or another program is writing into it.
  explicit ResultsFolder(ResultsPlace place);

  // At the first good frame: creates the folder (two simultaneous runs of one name get one each)
  // and removes the results of an earlier run, those of `samewhere dense`, and partial files. Other
  // files stay. Logs what it removed. Throws InputError, also if another program is writing to a
  // map in it.
  void begin();

  bool has_begun() const { return has_begun_; }
  // Once it has begun.
  const std::filesystem::path& path() const { return place_.folder; }

 private:
  void require_usable() const;
  void remove_earlier_results() const;
  void make_of_name();

  ResultsPlace place_;
  std::optional<core::FolderLock> lock_;
  bool has_begun_ = false;
};

}  // namespace samewhere::report
