#include <sstream>
#include <string>

#include <fmt/format.h>

#include <samewhere/input/csv_file.hpp>

namespace samewhere::input {
namespace {

// At commas; where a line has none, at semicolons, or else at white space, as some tools write.
std::vector<std::string> words_of(const std::string& content) {
  const auto has = [&content](char c) { return content.find(c) != std::string::npos; };
  if (!has(',') && !has(';')) return core::words_between_commas(content);
  std::istringstream in(content);
  std::vector<std::string> words;
  for (std::string word; std::getline(in, word, has(',') ? ',' : ';');)
    words.emplace_back(core::trimmed(word));
  return words;
}

}  // namespace

std::vector<core::TextLine> read_csv_lines(const std::filesystem::path& path) {
  std::istringstream text(core::read_text(path));
  std::vector<core::TextLine> lines;
  core::LineMemory memory;
  int line_number = 0;
  for (std::string line; std::getline(text, line);) {
    ++line_number;
    std::string content(core::trimmed(line));
    if (content.empty() || content.front() == '#') continue;
    core::TextLine added{
        fmt::format("{}, line {}", path.string(), line_number), {}, std::move(content)};
    memory.add(added);
    added.words = words_of(added.text);
    lines.push_back(std::move(added));
  }
  return lines;
}

}  // namespace samewhere::input
