#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>
#include <utility>

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

namespace {

// By the byte order mark, or by the zero beside the first letter where there is none.
void refuse_wide_text(const std::filesystem::path& path, std::string_view bytes) {
  using namespace std::string_view_literals;
  const bool has_mark = bytes.starts_with("\xff\xfe"sv) || bytes.starts_with("\xfe\xff"sv) ||
                        bytes.starts_with("\0\0\xfe\xff"sv);
  const auto is_ascii = [](char c) { return (c >= ' ' && c <= '~') || (c >= '\t' && c <= '\r'); };
  const bool is_bare =
      bytes.size() >= 4 && bytes.size() % 2 == 0 &&
      ((is_ascii(bytes[0]) && bytes[1] == 0 && is_ascii(bytes[2]) && bytes[3] == 0) ||
       (bytes[0] == 0 && is_ascii(bytes[1]) && bytes[2] == 0 && is_ascii(bytes[3])));
  if (!has_mark && !is_bare) return;
  throw InputError(path.string() + ": is text in UTF-16 or UTF-32, expected UTF-8 or ASCII");
}

// CR LF and CR alone to LF.
std::string with_line_feeds(std::string text) {
  if (std::count(text.begin(), text.end(), '\r') == 0) return text;
  std::string out;
  out.reserve(text.size());
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '\r') {
      out += text[i];
    } else if (i + 1 == text.size() || text[i + 1] != '\n') {
      out += '\n';
    }
  }
  return out;
}

constexpr std::string_view kWhiteSpace = " \t\r\n\v\f";

// Calls `use` for each word between white space.
template <class Use>
void for_each_word(std::string_view text, const Use& use) {
  while (true) {
    const std::size_t first = text.find_first_not_of(kWhiteSpace);
    if (first == std::string_view::npos) return;
    text.remove_prefix(first);
    const std::size_t length = std::min(text.find_first_of(kWhiteSpace), text.size());
    use(text.substr(0, length));
    text.remove_prefix(length);
  }
}

std::vector<std::string> words_of(std::string_view text) {
  std::vector<std::string> words;
  for_each_word(text, [&words](std::string_view word) { words.emplace_back(word); });
  return words;
}

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '"'; }

// nan and inf are numbers too.
bool begins_as_number(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  double number = 0.0;
  return std::from_chars(word.data(), word.data() + word.size(), number).ec == std::errc{};
}

}  // namespace

std::string read_text(const std::filesystem::path& path, const SizeLimit& limit) {
  constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
  std::string bytes = read_file(path, limit);
  refuse_wide_text(path, bytes);
  if (bytes.starts_with(kByteOrderMark)) bytes.erase(0, kByteOrderMark.size());
  return with_line_feeds(std::move(bytes));
}

void LineMemory::add(const TextLine& line) {
  constexpr std::size_t kMost_bytes = 600'000'000;
  constexpr std::size_t kLine_bytes = 200;  // of itself, as part of a list that grows
  constexpr std::size_t kWord_bytes = 48;   // the same
  std::size_t num_words = 1;
  for (const char c : line.text) num_words += c == ' ' || c == '\t' || c == ',' || c == ';' ? 1 : 0;
  num_bytes_ += kLine_bytes + line.place.size() + line.text.size() + kWord_bytes * num_words;
  if (num_bytes_ <= kMost_bytes) return;
  throw InputError(
      fmt::format("{}: takes more than {} MB of memory up to here, expected a shorter file",
                  line.place, kMost_bytes / kMegabyte));
}

std::vector<TextLine> read_text_lines(const std::filesystem::path& path) {
  std::istringstream text(read_text(path));
  std::vector<TextLine> lines;
  LineMemory memory;
  int line_number = 0;
  for (std::string line; std::getline(text, line);) {
    ++line_number;
    const std::string_view content = trimmed(line);
    if (content.empty() || content.front() == '#') continue;
    TextLine added{
        fmt::format("{}, line {}", path.string(), line_number), {}, std::string(content)};
    memory.add(added);
    added.words = words_of(content);
    lines.push_back(std::move(added));
  }
  return lines;
}

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(kWhiteSpace);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kWhiteSpace) - first + 1);
}

std::vector<std::string> words_between_commas(std::string_view text) {
  std::string spaced(text);
  std::replace(spaced.begin(), spaced.end(), ',', ' ');
  return words_of(spaced);
}

void drop_column_names(std::vector<TextLine>& lines) {
  if (lines.empty() || lines.front().words.empty()) return;
  const std::string& first = lines.front().words.front();
  if (!first.empty() && is_letter(first.front()) && !begins_as_number(first))
    lines.erase(lines.begin());
}

double finite_number(const TextLine& line, std::size_t column) {
  require(column < line.words.size(), "the column of a text line exists");
  const std::string& word = line.words[column];
  std::string_view digits = word;
  if (digits.size() > 1 && digits[0] == '+' && digits[1] != '-') digits.remove_prefix(1);
  double number = 0.0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  if (error != std::errc{} || end != digits.data() + digits.size() || !std::isfinite(number)) {
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
