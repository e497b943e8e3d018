#include <algorithm>
#include <cctype>
#include <charconv>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>
#include <samewhere/core/text_file.hpp>
#include <samewhere/input/file_names.hpp>
#include <samewhere/input/mat_file.hpp>
#include <samewhere/input/place_matrix.hpp>
#include <samewhere/input/truth_file.hpp>

namespace samewhere::input {
namespace {

using core::InputError;
using core::PlaceTruth;
using core::PlaceTruthMatrix;
using std::filesystem::path;

constexpr core::SizeLimit kTextMatrixLimit{1000 * core::kMegabyte, "a matrix of same places"};

std::string in_small_letters(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

bool is_matrix_name(const std::string& name, std::string_view ending) {
  const std::string small = in_small_letters(name);
  const auto has = [&small](std::string_view part) {
    return small.find(part) != std::string::npos;
  };
  if (!small.ends_with(ending) || small == "groundtruth.txt") return false;
  const bool is_mat = ending == ".mat";
  return has("groundtruth") ||
         (is_mat ? has("_gt") || small.starts_with("gt_") : has("textformat"));
}

PlaceTruth value_of(std::string_view word, const std::string& place) {
  if (word.starts_with('+')) word.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error == std::errc{} && end == word.data() + word.size())
    return place_truth_of_value(value, place);
  throw InputError(fmt::format("{}: found '{}', expected a number", place,
                               core::printable(std::string(word.substr(0, 100)))));
}

// Appends the values of a line; returns how many.
std::size_t append_values(std::string_view line, const std::string& place,
                          std::vector<PlaceTruth>& values) {
  constexpr std::string_view kBetween = " \t,;";
  std::size_t num_values = 0;
  while (true) {
    const std::size_t first = line.find_first_not_of(kBetween);
    if (first == std::string_view::npos) return num_values;
    line.remove_prefix(first);
    const std::size_t length = std::min(line.find_first_of(kBetween), line.size());
    values.push_back(value_of(line.substr(0, length), place));
    line.remove_prefix(length);
    if (++num_values > static_cast<std::size_t>(kMaxPlaceRows))
      throw InputError(fmt::format("{}: has more than {} columns", place, kMaxPlaceRows));
  }
}

// Not as core::TextLines: a matrix has millions of words.
PlaceTruthMatrix read_text_places(const path& file) {
  const std::string text = core::read_text(file, kTextMatrixLimit);
  PlaceTruthMatrix places;
  std::size_t num_columns = 0;
  int line_number = 0;
  for (std::string_view rest = text; !rest.empty();) {
    const std::size_t length = std::min(rest.find('\n'), rest.size());
    const std::string_view line = core::trimmed(rest.substr(0, length));
    rest.remove_prefix(std::min(length + 1, rest.size()));
    const std::string place = fmt::format("{}, line {}", file.string(), ++line_number);
    if (line.empty() || line.front() == '#') continue;
    const std::size_t num_values = append_values(line, place, places.values);
    if (places.num_frames == 0) num_columns = num_values;
    if (num_values != num_columns) {
      throw InputError(fmt::format("{}: has {} columns, expected {} as the first row", place,
                                   num_values, num_columns));
    }
    if (static_cast<std::size_t>(++places.num_frames) <= num_columns) continue;
    throw InputError(fmt::format("{}: is row {}, expected {}, as many as columns", place,
                                 places.num_frames, num_columns));
  }
  if (places.num_frames == 0 || static_cast<std::size_t>(places.num_frames) != num_columns) {
    throw InputError(fmt::format("{}: has {} rows of {} columns, expected a square matrix",
                                 file.string(), places.num_frames, num_columns));
  }
  return places;
}

void mirror(PlaceTruthMatrix& places) {
  const auto rows = static_cast<std::size_t>(places.num_frames);
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t column = 0; column < row; ++column) {
      PlaceTruth& below = places.values[row * rows + column];
      PlaceTruth& above = places.values[column * rows + row];
      if (below == PlaceTruth::kDifferent) below = above;
      if (above == PlaceTruth::kSame) below = above;
      above = below;
    }
  }
}

PlaceTruthMatrix rows_of(const PlaceTruthMatrix& matrix, const std::vector<int>& rows) {
  PlaceTruthMatrix chosen{static_cast<int>(rows.size()), {}};
  chosen.values.reserve(rows.size() * rows.size());
  for (const int row : rows) {
    for (const int column : rows) chosen.values.push_back(matrix.at(row, column));
  }
  return chosen;
}

[[noreturn]] void fail_size(const path& file, const PlaceTruthMatrix& matrix,
                            const Recording& recording, const std::string& why) {
  throw InputError(fmt::format("{}: is {} x {}, expected {} x {}, one row and column per frame; {}",
                               file.string(), matrix.num_frames, matrix.num_frames,
                               recording.frames.size(), recording.frames.size(), why));
}

// By the numbers in the names of frames.
std::vector<int> numbered_rows(const path& file, const PlaceTruthMatrix& matrix,
                               const Recording& recording) {
  std::vector<int> rows;
  for (const FrameFiles& frame : recording.frames) {
    const std::optional<int> number = frame_number(frame.name);
    if (!number || *number > matrix.num_frames)
      fail_size(file, matrix, recording, frame.name + " does not say its row");
    rows.push_back(*number);
  }
  const int first_number = *std::min_element(rows.begin(), rows.end()) == 0 ? 0 : 1;
  for (int& row : rows) row -= first_number;
  const bool rises =
      std::adjacent_find(rows.begin(), rows.end(), std::greater_equal<>()) == rows.end();
  if (!rises || rows.back() >= matrix.num_frames)
    fail_size(file, matrix, recording, "the names do not say the rows");
  const bool is_renamed = 2 * rows.size() == static_cast<std::size_t>(matrix.num_frames) &&
                          rows.back() + 1 == static_cast<int>(rows.size());
  if (is_renamed)
    fail_size(file, matrix, recording, "images of one camera keep their numbers, 1 3 5 ...");
  return rows;
}

// 0: none fits.
std::size_t step_of(std::size_t num_images, std::size_t num_rows) {
  constexpr std::size_t kMostStep = 60;
  for (std::size_t step = 2; step <= kMostStep; ++step) {
    if ((num_images + step - 1) / step == num_rows) return step;
  }
  return 0;
}

void keep_each(std::size_t step, std::vector<FrameFiles>& frames) {
  std::vector<FrameFiles> kept;
  for (std::size_t i = 0; i < frames.size(); i += step) kept.push_back(std::move(frames[i]));
  frames = std::move(kept);
}

// Trajectories have such names, too.
bool begins_as_matrix(const path& file) {
  constexpr std::size_t kNumBytes = 4096;
  const std::string bytes = core::read_beginning(file, kNumBytes);
  const std::string_view text(bytes);
  const std::string_view line = text.substr(0, text.find_first_of("\r\n"));
  return !line.empty() && line.find_first_not_of("012 \t,;") == std::string_view::npos;
}

// Empty: there is none.
path matrix_in(const path& place, const char* ending) {
  if (!is_folder(place)) return {};
  for (const std::string& name : sorted_names(place)) {
    if (!is_matrix_name(name, ending) || is_folder(place / name)) continue;
    if (name.ends_with(".mat") || begins_as_matrix(place / name)) return place / name;
  }
  return {};
}

}  // namespace

path published_matrix(const path& folder) {
  for (const char* const ending : {".txt", ".mat"}) {
    for (const path& place : {folder, folder / "masks"}) {
      const path found = matrix_in(place, ending);
      if (!found.empty()) return found;
    }
  }
  return {};
}

bool has_place_truth(const path& folder) {
  return is_there(folder / kSamePlaceTable) || is_there(folder / "same_place.txt") ||
         std::count_if(kTraverses.begin(), kTraverses.end(),
                       [&](const char* name) { return is_folder(folder / name); }) > 1 ||
         !published_matrix(folder).empty();
}

PlaceTruthMatrix read_published_matrix(const path& file) {
  const bool is_mat = in_small_letters(file.extension().string()) == ".mat";
  PlaceTruthMatrix places = is_mat ? read_mat_matrix(file) : read_text_places(file);
  mirror(places);
  return places;
}

void set_places(const path& file, const PlaceTruthMatrix& matrix, Recording& recording) {
  const std::size_t num_images = recording.frames.size();
  const auto num_rows = static_cast<std::size_t>(matrix.num_frames);
  if (num_rows == num_images) {
    recording.truth.places = matrix;
  } else if (num_rows > num_images) {
    recording.truth.places = rows_of(matrix, numbered_rows(file, matrix, recording));
  } else if (const std::size_t step = step_of(num_images, num_rows); step > 0) {
    spdlog::warn("{}: has {} rows for {} images; the first of each {} is a frame", file.string(),
                 num_rows, num_images, step);
    keep_each(step, recording.frames);
    recording.truth.places = matrix;
  } else {
    fail_size(file, matrix, recording, "no whole number of images belongs to a row");
  }
}

void widen(int tolerance_frames, PlaceTruthMatrix& places) {
  const int n = places.num_frames;
  for (int row = 0; row < n; ++row) {
    PlaceTruth* const values = places.values.data() + static_cast<std::ptrdiff_t>(row) * n;
    std::vector<int> same;
    for (int column = 0; column < n; ++column) {
      if (values[column] == PlaceTruth::kSame) same.push_back(column);
    }
    for (const int column : same) {
      const int last = std::min(n - 1, column + tolerance_frames);
      for (int near = std::max(0, column - tolerance_frames); near <= last; ++near)
        values[near] = PlaceTruth::kSame;
    }
  }
}

void add_published_places(const path& folder, const Config& config, Recording& recording) {
  if (!recording.truth.places) {
    read_if_sound("the run goes on without it", [&] {
      const path file = published_matrix(folder);
      if (!file.empty()) set_places(file, read_published_matrix(file), recording);
    });
  }
  if (recording.truth.places && !recording.is_place_truth_final &&
      config.truth_tolerance_frames > 0)
    widen(config.truth_tolerance_frames, *recording.truth.places);
}

}  // namespace samewhere::input
