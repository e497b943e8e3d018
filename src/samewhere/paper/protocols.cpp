#include <algorithm>
#include <cctype>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/input/file_names.hpp>
#include <samewhere/input/place_matrix.hpp>
#include <samewhere/paper/protocols.hpp>

namespace samewhere::paper {
namespace {

using std::filesystem::path;

// What a folder is known by, in small letters and digits.
struct Marks {
  bool is_whole_name = false;            // or a part of the name
  std::vector<std::string> names;        // of the folder
  std::vector<std::string> entries;      // beginnings of the names of entries, all of them needed
  std::vector<std::string> in_pictures;  // beginning of the first name in Images/ or the folder
};

struct Row {
  Protocol protocol;
  Marks marks;
};

// The one table of protocols; docs/data.md repeats it for readers.
constexpr const char* kOwn = "same_place.pgm, or depth and true poses";

// With a published matrix, or names that say it.
std::vector<Row> place_sets() {
  return {
      {{.data_set = "Lip6 Indoor",
        .window_s = 30.0,
        .tolerance_frames = 10,
        .num_images = 388,
        .place_file = "Lip6IndoorGroundTruth.mat"},
       {.names = {"lip6indoor"}, .in_pictures = {"lip6kennedy"}}},
      {{.data_set = "Bicocca 25b",
        .window_s = 30.0,
        .tolerance_frames = 10,
        .place_file = "a *GroundTruth.mat or *_GT*.mat",
        .pose_file = "Bicocca_2009-02-25b-GROUNDTRUTH.csv"},
       {.names = {"bicocca20090225b", "bicocca25b"}, .entries = {"bicocca20090225b", "frontal"}}},
      {{.data_set = "New College",
        .window_frames = 70,
        .num_images = 2146,
        .place_file = "NewCollegeGroundTruth.mat or NewCollegeTextFormat.txt"},
       {.names = {"newcollege"}, .entries = {"newcollege"}}},
      {{.data_set = "City Centre",
        .window_frames = 250,
        .num_images = 2474,
        .place_file = "CityCentreGroundTruth.mat or CityCentreTextFormat.txt"},
       {.names = {"citycentre", "citycenter"}, .entries = {"citycentre"}}},
      {{.data_set = "GardensPoint",
        .window_frames = 199,
        .num_images = 600,
        .place_file = "day_left/, day_right/ and night_right/"},
       {.names = {"gardenspoint"}, .entries = {"dayright"}}},
  };
}

// With depth and true poses.
std::vector<Row> slam_sets() {
  return {
      {{.data_set = "TUM fr3/long_office_household",
        .window_s = 10.0,
        .has_depth = true,
        .place_file = kOwn,
        .pose_file = "groundtruth.txt"},
       {.names = {"freiburg3longoffice", "fr3longoffice", "fr3loh"}}},
      {{.data_set = "OpenLORIS-Scene",
        .window_s = 10.0,
        .has_depth = true,
        .place_file = kOwn,
        .pose_file = "groundtruth.txt with trans_matrix.yaml"},
       {.names = {"openloris"}, .entries = {"colortxt", "sensorsyaml"}}},
  };
}

// Single recordings.
std::vector<Row> recordings() {
  return {
      {{.data_set = "rtabmap_corridor",
        .window_frames = 19,
        .num_images = 84,
        .place_file = "same_place.txt"},
       {.is_whole_name = true, .names = {"rtabmapcorridor"}}},
      {{.data_set = "redkitchen",
        .window_frames = 149,
        .num_images = 1000,
        .has_depth = true,
        .place_file = kOwn,
        .pose_file = "frame-*.pose.txt"},
       {.is_whole_name = true, .names = {"redkitchen"}}},
      {{.data_set = "hololens",
        .window_frames = 60,
        .num_images = 373,
        .has_depth = true,
        .place_file = kOwn,
        .pose_file = "poses.txt"},
       {.is_whole_name = true, .names = {"hololens"}}},
      {{.data_set = "tum_fr1_rpy",
        .window_frames = 50,
        .num_images = 200,
        .has_depth = true,
        .place_file = kOwn,
        .pose_file = "groundtruth.txt"},
       {.is_whole_name = true, .names = {"tumfr1rpy"}}},
  };
}

const std::vector<Row>& table() {
  static const std::vector<Row> rows = [] {
    std::vector<Row> all = place_sets();
    for (const auto& part : {slam_sets(), recordings()})
      all.insert(all.end(), part.begin(), part.end());
    return all;
  }();
  return rows;
}

std::string letters_and_digits(const std::string& text) {
  std::string plain;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (std::isalnum(byte) != 0) plain += static_cast<char>(std::tolower(byte));
  }
  return plain;
}

std::vector<std::string> plain_names(const path& folder) {
  std::vector<std::string> names;
  if (!input::is_folder(folder)) return names;
  for (const std::string& name : input::sorted_names(folder))
    names.push_back(letters_and_digits(name));
  return names;
}

bool has_beginning(const std::vector<std::string>& names, const std::string& beginning) {
  return std::any_of(names.begin(), names.end(),
                     [&](const std::string& name) { return name.starts_with(beginning); });
}

bool is_called(const std::string& plain_name, const Marks& marks) {
  return std::any_of(marks.names.begin(), marks.names.end(), [&](const std::string& name) {
    return marks.is_whole_name ? plain_name == name : plain_name.find(name) != std::string::npos;
  });
}

bool has_all_entries(const std::vector<std::string>& entries, const Marks& marks) {
  return !marks.entries.empty() &&
         std::all_of(marks.entries.begin(), marks.entries.end(),
                     [&](const std::string& entry) { return has_beginning(entries, entry); });
}

// The last part of the path, also for "data/redkitchen/" and ".".
std::string plain_name_of(const path& folder) {
  std::error_code error;  // on an error the path is empty, and so is the name
  const path whole = std::filesystem::weakly_canonical(folder, error);
  const path last = whole.has_filename() ? whole.filename() : whole.parent_path().filename();
  return letters_and_digits(last.string());
}

// Of the table; rows().size(): none.
std::size_t row_of(const path& folder) {
  const std::vector<Row>& rows = table();
  const auto find = [&rows](const auto& fits) {
    return static_cast<std::size_t>(std::find_if(rows.begin(), rows.end(), fits) - rows.begin());
  };
  const std::string name = plain_name_of(folder);
  const std::size_t by_name = find([&](const Row& row) { return is_called(name, row.marks); });
  if (by_name < rows.size()) return by_name;
  const std::vector<std::string> entries = plain_names(folder);
  std::vector<std::string> pictures = plain_names(folder / "Images");
  if (pictures.empty()) pictures = entries;
  return find([&](const Row& row) {
    return has_all_entries(entries, row.marks) ||
           std::any_of(row.marks.in_pictures.begin(), row.marks.in_pictures.end(),
                       [&](const std::string& mark) { return has_beginning(pictures, mark); });
  });
}

// Whether a trajectory lies in the folder.
bool has_poses(const path& folder) {
  const std::vector<std::string> names = plain_names(folder);
  return std::any_of(names.begin(), names.end(), [](const std::string& name) {
    return name == "groundtruthtxt" || name == "groundtruthtum" || name == "posestxt" ||
           name.ends_with("posetxt");
  });
}

using FoundSet = std::pair<std::size_t, path>;  // row of the table

// A data set is not searched for others.
void search(const path& folder, int levels, std::vector<FoundSet>& found) {
  try {
    if (!input::is_folder(folder)) return;
    const std::size_t row = row_of(folder);
    const bool is_known = row < table().size();
    const bool is_by_depth = is_known && table()[row].protocol.has_depth && has_poses(folder);
    if (is_by_depth || (is_known && input::has_place_truth(folder))) {
      found.emplace_back(row, folder);
      return;
    }
    if (levels == 0) return;
    for (const std::string& name : input::sorted_names(folder))
      search(folder / name, levels - 1, found);
  } catch (const core::InputError&) {
    // not to be read: no data set
  }
}

// Of a seed from 1000 on, which nothing was tuned on, with a window of ten seconds.
std::string rendered_source(const char* preset) {
  return fmt::format("twin:{}?seed=1000@10s", preset);
}

}  // namespace

std::optional<Protocol> protocol_of(const path& folder) {
  const std::size_t row = row_of(folder);
  return row < table().size() ? std::optional(table()[row].protocol) : std::nullopt;
}

pipeline::Config with_protocol(pipeline::Config config, const Protocol& protocol) {
  const bool has_window =
      config.retrieve.window_frames >= 0 || config.retrieve.window_s != retrieve::Config{}.window_s;
  if (!has_window) {
    config.retrieve.window_frames = protocol.window_frames;
    config.retrieve.window_s = protocol.window_s;
  }
  if (config.input.truth_tolerance_frames < 0)
    config.input.truth_tolerance_frames = protocol.tolerance_frames;
  return config;
}

std::vector<std::string> missing_of(const Protocol& protocol, const core::SourceInfo& info,
                                    const core::Truth& truth) {
  std::vector<std::string> missing;
  if (info.num_frames < protocol.num_images) {
    missing.push_back(
        fmt::format("{} of {} images", protocol.num_images - info.num_frames, protocol.num_images));
  }
  if (protocol.has_depth && !info.has_depth) missing.emplace_back("depth");
  const bool is_by_depth = info.has_depth && !truth.trajectory.empty();
  if (!truth.places && !is_by_depth) missing.push_back("truth of places: " + protocol.place_file);
  if (!protocol.pose_file.empty() && truth.trajectory.empty())
    missing.push_back("true poses: " + protocol.pose_file);
  return missing;
}

int num_queries_with_loop(const core::PlaceTruthMatrix& places, int window_frames) {
  int num_with_loop = 0;
  for (int query = 0; query < places.num_frames; ++query) {
    bool has_loop = false;
    for (int match = 0; match < query - window_frames && !has_loop; ++match)
      has_loop = places.at(query, match) == core::PlaceTruth::kSame;
    num_with_loop += has_loop ? 1 : 0;
  }
  return num_with_loop;
}

std::vector<path> find_data_sets(const path& root) {
  constexpr int kLevels = 3;
  if (!input::is_folder(root))
    throw core::InputError(root.string() + ": is no folder, expected one with data sets");
  std::vector<FoundSet> found;
  search(root, kLevels, found);
  std::sort(found.begin(), found.end());
  std::vector<path> folders;
  for (FoundSet& each : found) folders.push_back(std::move(each.second));
  return folders;
}

std::vector<std::string> default_sources(const path& root) {
  std::vector<std::string> sources;
  if (!root.empty()) {
    for (const path& folder : find_data_sets(root)) sources.push_back(folder.string());
  }
  for (const char* const preset : {"twin-corridors", "office-loop", "second-visit", "mirror"})
    sources.push_back(rendered_source(preset));
  return sources;
}

std::string quick_source() { return "twin:office-loop?seed=1000&speed=2@10s"; }

}  // namespace samewhere::paper
