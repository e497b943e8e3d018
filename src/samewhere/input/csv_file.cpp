#include <sstream>
#include <string>

#include <fmt/format.h>

#include <samewhere/core/file.hpp>
#include <samewhere/input/csv_file.hpp>

namespace samewhere::input {
namespace {

// A carriage return at the end of a line is white space too.
std::string trimmed(const std::string& word) {
  constexpr const char* kWhiteSpace = " \t\r";
  const std::size_t first = word.find_first_not_of(kWhiteSpace);
  if (first == std::string::npos) return "";
  return word.substr(first, word.find_last_not_of(kWhiteSpace) - first + 1);
}

}  // namespace

std::vector<core::TextLine> read_csv_lines(const std::filesystem::path& path) {
  std::istringstream text(core::read_file(path));
  std::vector<core::TextLine> lines;
  int line_number = 0;
  for (std::string line; std::getline(text, line);) {
    ++line_number;
    const std::string content = trimmed(line);
    if (content.empty() || content.front() == '#') continue;
    std::istringstream in(content);
    std::vector<std::string> words;
    for (std::string word; std::getline(in, word, ',');) words.push_back(trimmed(word));
    lines.push_back({fmt::format("{}, line {}", path.string(), line_number), std::move(words)});
  }
  return lines;
}

}  // namespace samewhere::input
