#include <string_view>

#include <samewhere/report/html.hpp>
#include <samewhere/report/html_text.hpp>
#include <samewhere/report/page_data.hpp>
#include <samewhere/report/page_template.hpp>

namespace samewhere::report {
namespace {

constexpr std::string_view kDurationsBlock = "<script type=\"application/json\" id=\"durations\">";

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
