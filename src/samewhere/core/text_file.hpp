#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <samewhere/core/file_kind.hpp>

namespace samewhere::core {

// A line of a text file that says something, cut into words at white space.
struct TextLine {
  std::string place;  // "poses.txt, line 12": how a message calls it
  std::vector<std::string> words;
  std::string text = {};  // the line as it stands, without white space at its ends
};

// The text of a file: without the byte order mark that editors on Windows put before UTF-8, every
// line ended by a line feed alone, whether the file ends lines by CR LF, LF or CR. Throws
// InputError if the file cannot be read, is larger than `limit`, or is UTF-16 or UTF-32.
std::string read_text(const std::filesystem::path& path, const SizeLimit& limit = kTextLimit);

// Bounds the memory that the lines of one file take, which may be a hundred times its size.
class LineMemory {
 public:
  // To be called with each line before it is cut into words. Throws InputError beyond 600 MB; poses
  // of an hour at 200 Hz take 540.
  void add(const TextLine& line);

 private:
  std::size_t num_bytes_ = 0;
};

// All lines but the blank ones and those that begin with '#'. Throws InputError as read_text, and
// if they take too much memory (LineMemory).
std::vector<TextLine> read_text_lines(const std::filesystem::path& path);

// The text without white space at its ends.
std::string_view trimmed(std::string_view text);

// The text cut into words at white space and commas, as in "1.5, 2.5, 3".
std::vector<std::string> words_between_commas(std::string_view text);

// Leaves out a first line that names columns, as tables have: one whose first word begins with a
// letter and is no number (nan and inf are).
void drop_column_names(std::vector<TextLine>& lines);

// A word fit for a message: a binary file read by mistake has words of any length and any bytes.
std::string printable(const std::string& word);

// The word as a finite number, which a plus may lead. Throws InputError naming the line and the
// word found.
double finite_number(const TextLine& line, std::size_t column);

// All words of the line as finite numbers, exactly `count` of them. `meaning` says what they stand
// for. Throws InputError naming the line, what was found and what was expected.
std::vector<double> finite_numbers(const TextLine& line, std::size_t count,
                                   std::string_view meaning);

}  // namespace samewhere::core
