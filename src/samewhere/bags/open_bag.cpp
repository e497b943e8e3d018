#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <samewhere/bags/compression.hpp>
#include <samewhere/bags/readers.hpp>
#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>

namespace samewhere::bags {
namespace {

using core::InputError;
using std::filesystem::path;

constexpr const char* kMetadata = "metadata.yaml";

bool is_packed_as_a_whole(std::string_view beginning) {
  return beginning.starts_with("\x28\xb5\x2f\xfd") || beginning.starts_with("\x04\x22\x4d\x18");
}

bool has_name_of_bag(const path& path) {
  const std::string ending = path.extension().string();
  return ending == ".mcap" || ending == ".db3" || ending == ".bag";
}

std::unique_ptr<BagReader> open_file(const path& file) {
  const std::string beginning = core::read_beginning(file, kBeginningSize);
  if (is_mcap(beginning)) return open_mcap(file);
  if (is_sqlite(beginning)) return open_sqlite(file);
  if (is_ros1_bag(beginning)) return open_ros1_bag(file);
  if (is_packed_as_a_whole(beginning)) {
    throw InputError(file.string() +
                     ": is compressed as a whole; expected the file in it, as `zstd -d` gives it");
  }
  if (beginning.starts_with("version https://git-lfs")) {
    throw InputError(file.string() +
                     ": is a pointer of Git LFS, expected the file itself: `git lfs pull` gets it");
  }
  if (beginning.empty()) throw InputError(file.string() + ": is empty, expected a recording");
  throw InputError(file.string() + ": is no recording, expected an .mcap, .db3 or .bag file");
}

// The files that metadata.yaml lists, in their order.
std::vector<path> files_of(const path& folder) {
  const path metadata = folder / kMetadata;
  std::vector<path> files;
  try {
    const YAML::Node listed = YAML::Load(core::read_file(
        metadata, core::kSettingsLimit))["rosbag2_bagfile_information"]["relative_file_paths"];
    for (const YAML::Node& name : listed) {
      const path listed_path = name.as<std::string>();
      // early versions listed them relative to the folder above
      files.push_back(core::is_there(folder / listed_path) ? folder / listed_path
                                                           : folder / listed_path.filename());
    }
  } catch (const YAML::Exception& error) {
    throw InputError(fmt::format("{}:{}: {}", metadata.string(), error.mark.line + 1, error.msg));
  }
  if (files.empty()) {
    throw InputError(metadata.string() +
                     ": lists no file (rosbag2_bagfile_information: relative_file_paths)");
  }
  return files;
}

}  // namespace

std::optional<messages::Layout> layout_of(const Topic& topic) {
  if (topic.encoding == "cdr") return messages::Layout::kCdr;
  if (topic.encoding == "ros1") return messages::Layout::kRos1;
  return std::nullopt;
}

bool is_bag(const path& path) {
  if (core::is_folder(path)) {
    return core::is_there(path / kMetadata) &&
           core::read_beginning(path / kMetadata, 4096).find("rosbag2_bagfile_information") !=
               std::string::npos;
  }
  const std::string beginning = core::read_beginning(path, kBeginningSize);
  return has_name_of_bag(path) || is_mcap(beginning) || is_sqlite(beginning) ||
         is_ros1_bag(beginning) || is_packed_as_a_whole(beginning);
}

std::unique_ptr<BagReader> open_bag(const path& path) {
  if (!core::is_folder(path)) return open_file(path);
  std::vector<std::unique_ptr<BagReader>> parts;
  for (const auto& file : files_of(path)) parts.push_back(open_file(file));
  return open_split_bag(std::move(parts));
}

std::unique_ptr<BagWriter> make_bag(const path& path, BagFormat format, Compression compression) {
  switch (format) {
    case BagFormat::kMcap:
      return make_mcap(path, compression);
    case BagFormat::kRos1:
      return make_ros1_bag(path, compression);
    case BagFormat::kSqlite:
      break;
  }
  if (compression != Compression::kNone)
    throw InputError(path.string() + ": messages in an SQLite file are written uncompressed");
  return make_sqlite(path);
}

}  // namespace samewhere::bags
