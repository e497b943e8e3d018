#include <algorithm>
#include <optional>

#include <fmt/format.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/input/file_names.hpp>
#include <samewhere/input/list_file.hpp>

namespace samewhere::input {
namespace {

using core::InputError;
using std::filesystem::path;

constexpr std::string_view kBetweenWords = " \t,";

bool is_file(const path& file) { return is_there(file) && !is_folder(file); }

// Nothing if there is no such file.
std::optional<ListedFile> found(const path& folder, std::string_view name) {
  if (name.empty()) return std::nullopt;
  std::string with_slashes(name);
  if (is_file(folder / with_slashes)) return ListedFile{with_slashes, folder / with_slashes, true};
  std::replace(with_slashes.begin(), with_slashes.end(), '\\', '/');
  if (is_file(folder / with_slashes))
    return ListedFile{std::string(name), folder / with_slashes, true};
  return std::nullopt;
}

// What stands in quotes at the beginning; empty if nothing does.
std::string_view in_quotes(std::string_view text) {
  if (text.empty() || (text.front() != '"' && text.front() != '\'')) return {};
  const std::size_t end = text.find(text.front(), 1);
  return end == std::string_view::npos ? std::string_view{} : text.substr(1, end - 1);
}

// What comes behind the first word and what separates it from the next.
std::string_view without_first_word(std::string_view text) {
  const std::size_t end = text.find_first_of(kBetweenWords);
  if (end == std::string_view::npos) return {};
  text.remove_prefix(end);
  const std::size_t next = text.find_first_not_of(kBetweenWords);
  return next == std::string_view::npos ? std::string_view{} : text.substr(next);
}

StampedFile stamped_file(const path& folder, const core::TextLine& line, std::string_view text) {
  const std::size_t end = std::min(text.find_first_of(kBetweenWords), text.size());
  const core::TextLine stamp{line.place, {std::string(text.substr(0, end))}};
  const std::string_view name = without_first_word(text);
  if (name.empty()) throw InputError(line.place + ": found one word, expected 'stamp filename'");
  return {line.place, core::finite_number(stamp, 0), listed_file(folder, name)};
}

void require_rising(const std::string& place, double last_s, double stamp_s) {
  if (stamp_s > last_s) return;
  throw InputError(fmt::format("{}: found stamp {:.6f} after {:.6f}, expected stamps that rise",
                               place, stamp_s, last_s));
}

std::vector<core::TextLine> lines_of(const path& list) {
  std::vector<core::TextLine> lines = core::read_text_lines(list);
  core::drop_column_names(lines);
  return lines;
}

bool is_number(const std::string& word) {
  try {
    core::finite_number({"", {word}}, 0);
    return true;
  } catch (const InputError&) {
    return false;
  }
}

bool names_depth(const std::string& name) {
  std::string small = name;
  for (char& c : small) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return small.find("depth") != std::string::npos;
}

// The line cut at its second stamp, which stands behind a file's name.
StampedPair association(const path& folder, const core::TextLine& line) {
  const std::string_view text = line.text;
  for (std::string_view rest = without_first_word(text); !rest.empty();) {
    rest = without_first_word(rest);
    const std::string word(rest.substr(0, rest.find_first_of(kBetweenWords)));
    if (rest.empty() || !is_number(word) || without_first_word(rest).empty()) continue;
    const std::string_view first =
        text.substr(0, text.find_last_not_of(kBetweenWords, text.size() - rest.size() - 1) + 1);
    StampedPair pair{stamped_file(folder, line, first), stamped_file(folder, line, rest)};
    if (names_depth(pair.colour.file.name) && !names_depth(pair.depth.file.name))
      std::swap(pair.colour, pair.depth);
    return pair;
  }
  throw InputError(fmt::format("{}: found '{}', expected 'stamp filename stamp filename'",
                               line.place, core::printable(line.text)));
}

}  // namespace

ListedFile listed_file(const path& folder, std::string_view text) {
  const std::string_view first = text.substr(0, text.find_first_of(" \t"));
  if (auto file = found(folder, first)) return *std::move(file);
  if (auto file = found(folder, in_quotes(text))) return *std::move(file);
  for (std::string_view words = text; !words.empty();) {
    if (auto file = found(folder, words)) return *std::move(file);
    words = words.substr(0, std::min(words.find_last_of(kBetweenWords), words.size()));
    if (words.find_first_of(kBetweenWords) == std::string_view::npos) {
      if (auto file = found(folder, words)) return *std::move(file);
      break;
    }
  }
  return {std::string(text), folder / text, false};
}

std::vector<StampedFile> read_stamped_files(const path& list) {
  std::vector<StampedFile> files;
  for (const core::TextLine& line : lines_of(list)) {
    StampedFile file = stamped_file(list.parent_path(), line, line.text);
    if (!files.empty()) require_rising(line.place, files.back().stamp_s, file.stamp_s);
    files.push_back(std::move(file));
  }
  return files;
}

std::vector<StampedPair> read_associations(const path& list) {
  std::vector<StampedPair> pairs;
  for (const core::TextLine& line : lines_of(list)) {
    StampedPair pair = association(list.parent_path(), line);
    if (!pairs.empty())
      require_rising(line.place, pairs.back().colour.stamp_s, pair.colour.stamp_s);
    pairs.push_back(std::move(pair));
  }
  return pairs;
}

}  // namespace samewhere::input
