#include <system_error>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>
#include <samewhere/core/file_kind.hpp>
#include <samewhere/run/export_place.hpp>

namespace samewhere::run {
namespace {

namespace fs = std::filesystem;

// What the formats write into a folder beside the note.
constexpr const char* kExportedNames[] = {"transforms.json", "sparse_points.ply", "sparse",
                                          "images", "depth"};

// Whether `path` is the folder or below it.
bool is_within(const fs::path& path, const fs::path& folder) {
  std::error_code unknown;  // then the path has not the form of one, such as that of a twin
  const fs::path inside =
      fs::weakly_canonical(path, unknown).lexically_relative(fs::weakly_canonical(folder, unknown));
  return !inside.empty() && *inside.begin() != "..";
}

void remove_exported(const fs::path& folder) {
  for (const char* name : kExportedNames) {
    std::error_code error;
    fs::remove_all(folder / name, error);  // a link goes, what it leads to stays
    if (error)
      throw core::InputError((folder / name).string() + ": cannot be removed: " + error.message());
  }
}

}  // namespace

void check_export_folder(const fs::path& folder, const fs::path& source, bool replaces_earlier) {
  if (!core::is_there(folder)) return;
  if (!core::is_folder(folder))
    throw core::InputError(folder.string() + ": is no folder; expected a folder for the export");
  if (is_within(source, folder)) {
    throw core::InputError(folder.string() +
                           ": holds the recording itself; expected another folder for the export");
  }
  std::error_code unreadable;  // told when it is written
  if (fs::is_empty(folder, unreadable) || unreadable) return;
  if (!fs::is_regular_file(fs::symlink_status(folder / kExportNote, unreadable))) {
    throw core::InputError(folder.string() +
                           ": holds files that no export wrote; expected a new or empty folder");
  }
  if (!replaces_earlier) {
    throw core::InputError(
        folder.string() +
        ": holds an earlier export; expected another folder, or --force to replace it");
  }
}

void begin_export_folder(const fs::path& folder, std::string_view note) {
  core::make_writable_folder(folder);
  remove_exported(folder);
  core::write_file(folder / kExportNote, note);
}

void check_export_file(const fs::path& file, const fs::path& map, bool replaces_earlier) {
  std::error_code not_there;
  if (fs::equivalent(file, map, not_there))
    throw core::InputError(file.string() + ": is the map itself; expected another file");
  const fs::file_status status = fs::symlink_status(file, not_there);
  if (fs::is_directory(status))
    throw core::InputError(file.string() + ": is a folder; expected a file");
  const bool is_file = fs::is_regular_file(status) || fs::is_symlink(status);
  if (is_file && !replaces_earlier && !core::is_open_descriptor(file)) {
    throw core::InputError(file.string() +
                           ": is there already; expected another name, or --force to replace it");
  }
  core::make_writable_folder(fs::absolute(file).parent_path());
}

}  // namespace samewhere::run
