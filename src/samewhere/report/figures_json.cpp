#include <algorithm>
#include <charconv>
#include <string_view>

#include <nlohmann/json.hpp>

#include <samewhere/report/figures_json.hpp>

namespace samewhere::report {
namespace {

using Json = nlohmann::ordered_json;

// Words that are numbers as a whole: a checksum has none.
Json numbers_in(std::string_view text) {
  constexpr std::string_view kBetweenWords = " ,;:()/";
  Json numbers = Json::array();
  while (!text.empty()) {
    const std::size_t start = std::min(text.find_first_not_of(kBetweenWords), text.size());
    text.remove_prefix(start);
    const std::size_t length = std::min(text.find_first_of(kBetweenWords), text.size());
    double number = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + length, number);
    if (error == std::errc{} && end == text.data() + length && length > 0)
      numbers.push_back(number);
    text.remove_prefix(length);
  }
  return numbers;
}

}  // namespace

std::string figures_json(const std::string& title, const std::vector<Figure>& figures) {
  Json by_name = Json::object();
  for (const Figure& figure : figures)
    by_name[figure.name] = {{"value", figure.value}, {"numbers", numbers_in(figure.value)}};
  const Json document = {{"title", title}, {"figures", by_name}};
  // names of recordings may hold any bytes
  return document.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace samewhere::report
