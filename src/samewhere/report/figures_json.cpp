#include <nlohmann/json.hpp>

#include <samewhere/report/figures_json.hpp>

namespace samewhere::report {
namespace {

using Json = nlohmann::ordered_json;

}  // namespace

std::string figures_json(const std::string& title, const std::vector<Figure>& figures) {
  Json by_name = Json::object();
  for (const Figure& figure : figures)
    by_name[figure.name] = {{"value", figure.value}, {"numbers", figure.numbers}};
  const Json document = {{"title", title}, {"figures", by_name}};
  // names of recordings may hold any bytes
  return document.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace samewhere::report
