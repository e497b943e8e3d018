#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numeric>
#include <optional>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include <samewhere/input/name_stamps.hpp>

namespace samewhere::input {
namespace {

constexpr std::size_t kMaxDigits = 18;  // of what 64 bits hold

bool is_digit(char c) { return c >= '0' && c <= '9'; }

// The last number before the extension, as digits.
struct NumberInName {
  bool has_prefix = false;  // something stands before it
  std::string_view whole;
  std::string_view fraction;  // empty: no point
};

std::string_view digits_at_end(std::string_view text) {
  std::size_t first = text.size();
  while (first > 0 && is_digit(text[first - 1])) --first;
  return text.substr(first);
}

NumberInName number_in(std::string_view name) {
  name = name.substr(0, name.rfind('.'));
  while (!name.empty() && !is_digit(name.back())) name.remove_suffix(1);
  NumberInName number{false, digits_at_end(name), {}};
  name.remove_suffix(number.whole.size());
  if (name.ends_with('.')) {
    const std::string_view before = digits_at_end(name.substr(0, name.size() - 1));
    if (!before.empty()) {
      number.fraction = std::exchange(number.whole, before);
      name.remove_suffix(1 + before.size());
    }
  }
  number.has_prefix = !name.empty();
  return number;
}

std::int64_t value_of(std::string_view digits) {
  std::int64_t value = 0;
  std::from_chars(digits.data(), digits.data() + digits.size(), value);
  return value;
}

// ---- decimal numbers

// Behind the point is a count of milli-, micro- or nanoseconds without the zeros that should lead
// it: such counts end with zeros and never begin with one, decimals that are cut do the reverse.
bool are_counts(const std::vector<NumberInName>& numbers) {
  bool has_end_zero = false;
  bool has_lead_zero = false;
  bool has_other_length = false;
  for (const NumberInName& number : numbers) {
    const std::string_view f = number.fraction;
    has_end_zero |= f.size() > 1 && f.back() == '0';
    has_lead_zero |= f.size() > 1 && f.front() == '0';
    has_other_length |= f.size() != numbers.front().fraction.size();
  }
  return has_end_zero && !has_lead_zero && has_other_length;
}

// Seconds, and billionths of one.
using Decimal = std::pair<std::int64_t, std::int64_t>;

Decimal decimal_of(const NumberInName& number, std::size_t count_digits) {
  constexpr std::size_t kDigits = 9;  // nanoseconds
  std::string digits(number.fraction);
  if (count_digits > digits.size()) digits.insert(0, count_digits - digits.size(), '0');
  digits.resize(kDigits, '0');
  return {value_of(number.whole), value_of(digits)};
}

// Nothing if not all are decimal numbers, at least one with a point, and no two alike.
std::optional<std::vector<Decimal>> decimals_of(const std::vector<std::string>& names) {
  constexpr std::size_t kEpochDigits = 9;  // seconds since 1970 may stand behind a word
  std::vector<NumberInName> numbers;
  std::size_t longest = 0;
  for (const std::string& name : names) {
    const NumberInName number = number_in(name);
    const bool is_decimal = !number.whole.empty() && number.whole.size() <= kMaxDigits &&
                            (!number.has_prefix || number.whole.size() >= kEpochDigits);
    if (!is_decimal) return std::nullopt;
    longest = std::max(longest, number.fraction.size());
    numbers.push_back(number);
  }
  if (longest == 0) return std::nullopt;
  std::size_t count_digits = 0;
  if (are_counts(numbers)) count_digits = longest <= 3 ? 3 : longest <= 6 ? 6 : 9;
  std::vector<Decimal> decimals;
  for (const NumberInName& number : numbers) decimals.push_back(decimal_of(number, count_digits));
  std::vector<Decimal> sorted = decimals;
  std::sort(sorted.begin(), sorted.end());
  if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end()) return std::nullopt;
  return decimals;
}

template <class Number>
Number median_step(const std::vector<Number>& rising) {
  std::vector<Number> steps;
  for (std::size_t i = 1; i < rising.size(); ++i) steps.push_back(rising[i] - rising[i - 1]);
  if (steps.empty()) return Number{1};
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>((steps.size() - 1) / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return *middle;
}

bool rise(const std::vector<double>& stamps_s) {
  return std::adjacent_find(stamps_s.begin(), stamps_s.end(), std::greater_equal<>()) ==
         stamps_s.end();
}

// Whether a recording may have a picture each so many seconds.
bool is_frame_time(double step_s) { return step_s >= 1e-3 && step_s <= 100.0; }

std::optional<std::vector<double>> seconds_of(const std::vector<std::string>& names) {
  const auto decimals = decimals_of(names);
  if (!decimals) return std::nullopt;
  std::vector<double> stamps_s;
  for (const auto& [whole_s, rest_ns] : *decimals)
    stamps_s.push_back(static_cast<double>(whole_s) + static_cast<double>(rest_ns) / 1e9);
  if (!rise(stamps_s) || !is_frame_time(median_step(stamps_s))) return std::nullopt;
  return stamps_s;
}

// ---- whole numbers

struct Unit {
  const char* name;
  std::int64_t per_s;
};
constexpr std::array kUnits = {Unit{"seconds", 1}, Unit{"milliseconds", 1'000},
                               Unit{"microseconds", 1'000'000}, Unit{"nanoseconds", 1'000'000'000}};

// The last whole number of each name. Nothing if one has none, or they do not rise.
std::optional<std::vector<std::int64_t>> rising_numbers(const std::vector<std::string>& names) {
  std::vector<std::int64_t> numbers;
  for (const std::string& name : names) {
    const NumberInName number = number_in(name);
    const std::string_view last = number.fraction.empty() ? number.whole : number.fraction;
    // 19 digits hold nanoseconds since 1970
    if (last.empty() || last.size() > kMaxDigits + 1 ||
        (last.size() > kMaxDigits && last.front() > '8'))
      return std::nullopt;
    numbers.push_back(value_of(last));
    if (numbers.size() > 1 && numbers.back() <= numbers.rbegin()[1]) return std::nullopt;
  }
  return numbers;
}

std::vector<double> in_seconds(const std::vector<std::int64_t>& numbers, std::int64_t per_s) {
  std::vector<double> stamps_s;
  for (const std::int64_t number : numbers) {
    // whole seconds apart: nanoseconds since 1970 have more digits than a double
    const std::int64_t whole_s = number / per_s;
    stamps_s.push_back(static_cast<double>(whole_s) +
                       static_cast<double>(number % per_s) / static_cast<double>(per_s));
  }
  return stamps_s;
}

// Numbers that count from 1970 and lie between 2000 and 2100.
const Unit* unit_since_1970(const std::vector<std::int64_t>& numbers) {
  constexpr std::int64_t kYear2000_s = 1'000'000'000;  // 2001, to be of ten digits
  constexpr std::int64_t kYear2100_s = 4'102'444'800;
  const auto step = static_cast<double>(median_step(numbers));
  for (const Unit& unit : kUnits) {
    const bool is_in_range =
        numbers.front() / unit.per_s >= kYear2000_s && numbers.back() / unit.per_s <= kYear2100_s;
    if (is_in_range && is_frame_time(step / static_cast<double>(unit.per_s))) return &unit;
  }
  return nullptr;
}

// Two of three steps are about the same: pictures may be missing.
bool is_regular(const std::vector<std::int64_t>& numbers) {
  const std::int64_t step = median_step(numbers);
  std::size_t num_alike = 0;
  for (std::size_t i = 1; i < numbers.size(); ++i) {
    const std::int64_t each = numbers[i] - numbers[i - 1];
    num_alike += 2 * each >= step && 2 * each <= 3 * step ? 1U : 0U;
  }
  return 3 * num_alike >= 2 * (numbers.size() - 1);
}

// Each tenth or thirtieth frame, frames missing here and there. Milliseconds between the pictures
// of a camera are seldom round, and large numbers are no frame numbers.
bool are_each_nth(const std::vector<std::int64_t>& numbers) {
  constexpr std::int64_t kMaxFirst = 1'000'000;
  constexpr std::int64_t kMaxStep = 300;
  constexpr std::int64_t kRound = 5;
  const std::int64_t step = median_step(numbers);
  if (step > kMaxStep || step % kRound != 0 || numbers.front() >= kMaxFirst) return false;
  for (std::size_t i = 1; i < numbers.size(); ++i) {
    if ((numbers[i] - numbers[i - 1]) % step != 0) return false;
  }
  return true;
}

constexpr std::int64_t kFewFrames = 15;  // milliseconds between two frames are more

bool are_frame_numbers(const std::vector<std::int64_t>& numbers) {
  constexpr std::int64_t kMost = 999'999'999;
  constexpr std::int64_t kMaxStep = 1000;
  const std::int64_t step = median_step(numbers);
  if (numbers.back() > kMost) return false;
  return step <= kFewFrames || are_each_nth(numbers) || (step <= kMaxStep && !is_regular(numbers));
}

// hhmmssmmm, of all: then the last millisecond of a minute is 40,001 before the first of the next.
std::optional<std::vector<std::int64_t>> ms_of_day(const std::vector<std::int64_t>& numbers) {
  std::vector<std::int64_t> times_ms;
  for (const std::int64_t number : numbers) {
    const std::int64_t hour = number / 10'000'000;
    const std::int64_t minute = number / 100'000 % 100;
    const std::int64_t second = number / 1'000 % 100;
    if (hour > 23 || minute > 59 || second > 59) return std::nullopt;
    times_ms.push_back(((hour * 60 + minute) * 60 + second) * 1'000 + number % 1'000);
  }
  if (numbers.front() < 1'000'000) return std::nullopt;  // a count as well
  return times_ms;
}

// The unit in which a regular step is the time between two frames. Nothing: none.
const Unit* unit_of_step(std::int64_t step) {
  constexpr std::int64_t kMaxStep_ms = 2'000;
  for (std::size_t i = 1; i < kUnits.size(); ++i) {
    if (step < kMaxStep_ms * kUnits[i].per_s / 1'000) return &kUnits[i];
  }
  return nullptr;
}

std::vector<double> positions(std::size_t count, double fps) {
  std::vector<double> stamps_s;
  for (std::size_t i = 0; i < count; ++i) stamps_s.push_back(static_cast<double>(i) / fps);
  return stamps_s;
}

std::vector<double> frame_numbers(const std::vector<std::int64_t>& numbers, double fps) {
  std::vector<double> stamps_s;
  for (const std::int64_t number : numbers) stamps_s.push_back(static_cast<double>(number) / fps);
  return stamps_s;
}

std::string remark_on(std::int64_t step, const std::string& taken_as) {
  return fmt::format(
      "the numbers in the names of the pictures rise by {} from one to the next: taken as {}; "
      "--set input.fps=N if the pictures are frames of N a second",
      step, taken_as);
}

NameStamps stamps_from_times(const std::vector<std::int64_t>& numbers, double fps) {
  const std::int64_t step = median_step(numbers);
  if (const auto times_ms = ms_of_day(numbers);
      times_ms && unit_of_step(step) == &kUnits[1] && is_regular(numbers)) {
    return {in_seconds(*times_ms, kUnits[1].per_s), true,
            remark_on(step, "the time of day in milliseconds, hhmmssmmm")};
  }
  const Unit* const unit = unit_of_step(step);
  if (unit == nullptr || !is_regular(numbers)) {
    return {positions(numbers.size(), fps), false,
            remark_on(step, fmt::format("neither frame numbers nor times, so that the pictures "
                                        "count by position at {} frames per second",
                                        fps))};
  }
  return {in_seconds(numbers, unit->per_s), true, remark_on(step, unit->name)};
}

}  // namespace

void order_by_decimals(std::vector<std::string>& names) {
  const auto decimals = decimals_of(names);
  if (!decimals) return;
  std::vector<std::size_t> order(names.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return (*decimals)[a] < (*decimals)[b]; });
  std::vector<std::string> sorted;
  for (const std::size_t i : order) sorted.push_back(names[i]);
  names = std::move(sorted);
}

NameStamps stamps_from_names(const std::vector<std::string>& names, double fps, bool is_fps_given) {
  constexpr std::int64_t kAboutOne = 4;
  if (!is_fps_given) {
    if (auto stamps_s = seconds_of(names)) return {*std::move(stamps_s), true, {}};
  }
  const auto numbers = rising_numbers(names);
  if (!numbers) return {positions(names.size(), fps), false, {}};
  const std::int64_t step = median_step(*numbers);
  if (are_frame_numbers(*numbers)) {
    const bool is_usual = step <= kAboutOne || is_fps_given;
    return {frame_numbers(*numbers, fps), false,
            is_usual ? "" : remark_on(step, fmt::format("frame numbers at {} a second", fps))};
  }
  if (const Unit* const unit = unit_since_1970(*numbers); unit != nullptr && !is_fps_given)
    return {in_seconds(*numbers, unit->per_s), true, {}};
  if (is_fps_given || step <= kFewFrames) return {positions(names.size(), fps), false, {}};
  return stamps_from_times(*numbers, fps);
}

}  // namespace samewhere::input
