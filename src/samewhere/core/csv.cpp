#include <samewhere/core/csv.hpp>

namespace samewhere::core {

std::string csv_field(std::string_view text) {
  if (text.find_first_of("\",\r\n") == std::string_view::npos) return std::string(text);
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"') quoted += '"';
    quoted += c;
  }
  return quoted + '"';
}

std::vector<std::string_view> csv_records(std::string_view text) {
  std::vector<std::string_view> records;
  bool is_in_quotes = false;
  std::size_t first = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '"') is_in_quotes = !is_in_quotes;  // a quote in a field is two
    if ((text[i] != '\n' || is_in_quotes) && i + 1 < text.size()) continue;
    records.push_back(text.substr(first, i + 1 - first));
    first = i + 1;
  }
  return records;
}

}  // namespace samewhere::core
