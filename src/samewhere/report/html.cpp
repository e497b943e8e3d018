#include <string_view>

#include <nlohmann/json.hpp>

#include <samewhere/core/errors.hpp>
#include <samewhere/report/html.hpp>
#include <samewhere/report/html_text.hpp>
#include <samewhere/report/page_data.hpp>
#include <samewhere/report/page_parts.hpp>
#include <samewhere/report/page_points.hpp>
#include <samewhere/report/page_template.hpp>

namespace samewhere::report {
namespace {

constexpr std::string_view kRunBlock = "<script type=\"application/json\" id=\"run\">";
constexpr std::string_view kDurationsBlock = "<script type=\"application/json\" id=\"durations\">";

std::string filled_page(std::string_view page, const PageBlocks& blocks,
                        const std::string& live_json) {
  return filled(page, {{"{{title}}", escaped(blocks.title)},
                       {"{{live}}", live_json},
                       {"{{run}}", blocks.run},
                       {"{{pictures}}", blocks.pictures},
                       {"{{durations}}", blocks.durations}});
}

}  // namespace

PageBlocks page_blocks(const RunRecord& record) {
  return {record.title, page_run_json(record), page_pictures_json(record),
          page_durations_json(record)};
}

std::string report_html(const RunRecord& record) {
  return filled_page(page_template(), page_blocks(record), "null");
}

std::string served_html(const PageBlocks& blocks, const std::string& live_json) {
  constexpr std::string_view kNoRequests = "default-src 'none';";
  std::string page(page_template());
  const std::size_t at = page.find(kNoRequests);
  core::require(at != std::string::npos, "the page has a content security policy");
  page.replace(at, kNoRequests.size(), "default-src 'none'; connect-src 'self';");
  return filled_page(page, blocks, live_json);
}

std::string with_dense_cloud(const std::string& report_html,
                             const std::vector<ColouredPoint>& cloud) {
  const std::size_t begin = report_html.rfind(kRunBlock);
  const std::size_t end = begin == std::string::npos ? begin : report_html.find("</script>", begin);
  if (end == std::string::npos)
    throw core::InputError("holds no data of a run; expected a report page");
  const std::size_t from = begin + kRunBlock.size();
  try {
    auto run = nlohmann::ordered_json::parse(report_html.substr(from, end - from));
    run["dense"] = page_points(cloud, kMaxPagePoints);
    return report_html.substr(0, from) + json_for_script(run) + report_html.substr(end);
  } catch (const nlohmann::json::exception& error) {
    throw core::InputError(std::string("its data is damaged: ") + error.what());
  }
}

std::string without_durations(const std::string& report_html) {
  return report_html.substr(0, report_html.rfind(kDurationsBlock));
}

}  // namespace samewhere::report
