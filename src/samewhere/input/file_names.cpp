#include <algorithm>
#include <array>
#include <charconv>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/file_kind.hpp>
#include <samewhere/input/file_names.hpp>
#include <samewhere/input/name_stamps.hpp>

namespace samewhere::input {
namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }

// Length of the run of digits, or else of other characters, that the text begins with.
std::size_t leading_run(std::string_view text) {
  const bool wants_digits = is_digit(text.front());
  std::size_t length = 0;
  while (length < text.size() && is_digit(text[length]) == wants_digits) ++length;
  return length;
}

// Negative, zero or positive; numbers of any length.
int compare_runs(std::string_view a, std::string_view b) {
  if (!is_digit(a.front()) || !is_digit(b.front())) return a.compare(b);
  a.remove_prefix(std::min(a.find_first_not_of('0'), a.size()));
  b.remove_prefix(std::min(b.find_first_not_of('0'), b.size()));
  if (a.size() != b.size()) return a.size() < b.size() ? -1 : 1;
  return a.compare(b);
}

}  // namespace

bool natural_less(std::string_view a, std::string_view b) {
  std::string_view rest_a = a;
  std::string_view rest_b = b;
  while (!rest_a.empty() && !rest_b.empty()) {
    const std::size_t length_a = leading_run(rest_a);
    const std::size_t length_b = leading_run(rest_b);
    const int order = compare_runs(rest_a.substr(0, length_a), rest_b.substr(0, length_b));
    if (order != 0) return order < 0;
    rest_a.remove_prefix(length_a);
    rest_b.remove_prefix(length_b);
  }
  if (rest_a.empty() && rest_b.empty()) return a < b;  // 1.jpg and 01.jpg
  return rest_a.empty();
}

std::optional<int> frame_number(std::string_view name) {
  constexpr std::size_t kMaxDigits = 9;
  name = name.substr(0, name.rfind('.'));
  while (!name.empty() && !is_digit(name.back())) name.remove_suffix(1);
  std::size_t num_digits = 0;
  while (num_digits < name.size() && is_digit(name[name.size() - 1 - num_digits])) ++num_digits;
  if (num_digits == 0) return std::nullopt;
  for (; num_digits > 1 && name[name.size() - num_digits] == '0'; --num_digits) {
  }
  if (num_digits > kMaxDigits) return std::nullopt;
  int number = 0;
  std::from_chars(name.data() + name.size() - num_digits, name.data() + name.size(), number);
  return number;
}

namespace {

std::string small_extension(std::string_view name) {
  std::string extension = std::filesystem::path(name).extension().string();
  for (char& c : extension) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return extension;
}

bool is_usual_image_name(std::string_view name) {
  const std::string extension = small_extension(name);
  return !name.starts_with('.') &&
         (extension == ".jpg" || extension == ".jpeg" || extension == ".png");
}

}  // namespace

bool is_image_name(std::string_view name) {
  if (is_usual_image_name(name)) return true;
  constexpr std::array kOthers = {".bmp", ".pgm", ".ppm", ".pnm", ".tif", ".tiff", ".webp"};
  const std::string extension = small_extension(name);
  return !name.starts_with('.') && name != kSamePlaceTable &&
         std::find(kOthers.begin(), kOthers.end(), extension) != kOthers.end();
}

bool is_there(const std::filesystem::path& path) { return core::is_there(path); }

bool is_folder(const std::filesystem::path& path) { return core::is_folder(path); }

std::vector<std::string> sorted_names(const std::filesystem::path& folder) {
  std::error_code error;
  std::vector<std::string> names;
  std::filesystem::directory_iterator entry(folder, error);
  for (; !error && entry != std::filesystem::directory_iterator(); entry.increment(error)) {
    std::string name = entry->path().filename().string();
    if (!name.starts_with('.')) names.push_back(std::move(name));
  }
  if (error) throw core::InputError(folder.string() + ": cannot be read: " + error.message());
  std::sort(names.begin(), names.end(), &natural_less);
  return names;
}

std::vector<std::string> picture_names(const std::filesystem::path& folder) {
  std::vector<std::string> names = sorted_names(folder);
  const bool has_usual = std::any_of(names.begin(), names.end(), &is_usual_image_name);
  std::erase_if(names, [has_usual](const std::string& name) {
    return !(has_usual ? is_usual_image_name(name) : is_image_name(name));
  });
  order_by_decimals(names);
  return names;
}

}  // namespace samewhere::input
