#include <initializer_list>
#include <string_view>
#include <utility>

#include <samewhere/core/errors.hpp>
#include <samewhere/report/html.hpp>
#include <samewhere/report/html_text.hpp>
#include <samewhere/report/page_data.hpp>
#include <samewhere/report/page_template.hpp>

namespace samewhere::report {
namespace {

constexpr std::string_view kDurationsBlock = "<script type=\"application/json\" id=\"durations\">";

// The template with each placeholder, in the order of the template, replaced by a text. What is in
// the texts is not searched.
std::string filled(
    std::string_view page,
    std::initializer_list<std::pair<std::string_view, std::string>> text_of_placeholder) {
  std::string html;
  for (const auto& [placeholder, text] : text_of_placeholder) {
    const std::size_t at = page.find(placeholder);
    core::require(at != std::string_view::npos, "the page has a place for each of its parts");
    html.append(page.substr(0, at)).append(text);
    page.remove_prefix(at + placeholder.size());
  }
  return html.append(page);
}

}  // namespace

std::string report_html(const RunRecord& record) {
  return filled(page_template(), {{"{{title}}", escaped(record.title)},
                                  {"{{run}}", page_run_json(record)},
                                  {"{{pictures}}", page_pictures_json(record)},
                                  {"{{durations}}", page_durations_json(record.timings)}});
}

std::string without_durations(const std::string& report_html) {
  return report_html.substr(0, report_html.rfind(kDurationsBlock));
}

}  // namespace samewhere::report
