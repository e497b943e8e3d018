#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace samewhere::core {

// A line of a text file that says something, cut into words at white space.
struct TextLine {
  std::string place;  // "poses.txt, line 12": how a message calls it
  std::vector<std::string> words;
};

// All lines but the blank ones and those that begin with '#'. Throws InputError if the file cannot
// be read.
std::vector<TextLine> read_text_lines(const std::filesystem::path& path);

// A word fit for a message: a binary file read by mistake has words of any length and any bytes.
std::string printable(const std::string& word);

// The word as a finite number. Throws InputError naming the line and the word found.
double finite_number(const TextLine& line, std::size_t column);

// All words of the line as finite numbers, exactly `count` of them. `meaning` says what they stand
// for. Throws InputError naming the line, what was found and what was expected.
std::vector<double> finite_numbers(const TextLine& line, std::size_t count,
                                   std::string_view meaning);

}  // namespace samewhere::core
