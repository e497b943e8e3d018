#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include <samewhere/report/record.hpp>
#include <samewhere/scene/map_file.hpp>

namespace samewhere::run {

// A finished run as the input of another program.
struct ExportRequest {
  std::filesystem::path run;  // its folder; config.yaml there says what the source was
  std::filesystem::path map;  // its map file
  std::filesystem::path out;  // empty: the default of the format, in `run`
  int session = -1;           // whose frames; -1: the only one
  bool is_binary = false;     // COLMAP's .bin in place of .txt
  bool is_undistorted = false;
  bool replaces_earlier = false;
};

// What a format is made from. `request.out` is set and may be written.
struct ExportJob {
  const ExportRequest& request;
  const scene::StoredMap& stored;
};

// Writes one format; returns what came of it, for a person. Throws InputError, and Interrupted
// after Ctrl-C.
using WriteExport = std::vector<report::Figure> (*)(const ExportJob&);

// A row of the table of formats: a new one is a function and a row.
struct ExportFormat {
  const char* name;          // after --to
  const char* default_name;  // of its file or folder in a run
  const char* content;       // half a line
  bool is_folder;            // with pictures; else one file
  bool has_binary;           // whether --binary has a meaning
  WriteExport write;
};

std::span<const ExportFormat> export_formats();

// Throws InputError if there is no such format, an option has no meaning for it, the file or folder
// may not be written, the map has no such session, or as the format's function does.
std::vector<report::Figure> export_run(const std::string& format, const ExportRequest& request);

}  // namespace samewhere::run
