#include <charconv>
#include <cmath>
#include <sstream>

#include <fmt/format.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>
#include <samewhere/core/text_file.hpp>

namespace samewhere::core {
std::string printable(const std::string& word) {
  constexpr std::size_t kMaxLength = 40;
  std::string text = word.substr(0, kMaxLength);
  for (char& c : text) {
    if (c < ' ' || c > '~') c = '?';
  }
  return word.size() > kMaxLength ? text + "..." : text;
}

std::vector<TextLine> read_text_lines(const std::filesystem::path& path) {
  std::istringstream text(read_file(path));
  std::vector<TextLine> lines;
  int line_number = 0;
  for (std::string line; std::getline(text, line);) {
    ++line_number;
    std::istringstream in(line);
    std::vector<std::string> words;
    for (std::string word; in >> word;) words.push_back(word);
    if (words.empty() || words.front().starts_with('#')) continue;
    lines.push_back({fmt::format("{}, line {}", path.string(), line_number), std::move(words)});
  }
  return lines;
}

double finite_number(const TextLine& line, std::size_t column) {
  require(column < line.words.size(), "the column of a text line exists");
  const std::string& word = line.words[column];
  double number = 0.0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  if (error != std::errc{} || end != word.data() + word.size() || !std::isfinite(number)) {
    throw InputError(
        fmt::format("{}: found '{}', expected a finite number", line.place, printable(word)));
  }
  return number;
}

std::vector<double> finite_numbers(const TextLine& line, std::size_t count,
                                   std::string_view meaning) {
  if (line.words.size() != count) {
    throw InputError(fmt::format("{}: found {} values, expected {} ({})", line.place,
                                 line.words.size(), count, meaning));
  }
  std::vector<double> numbers;
  for (std::size_t i = 0; i < count; ++i) numbers.push_back(finite_number(line, i));
  return numbers;
}

}  // namespace samewhere::core
