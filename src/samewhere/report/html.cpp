#include <algorithm>
#include <iterator>

#include <fmt/format.h>

#include <samewhere/report/funnel.hpp>
#include <samewhere/report/html.hpp>
#include <samewhere/report/html_text.hpp>
#include <samewhere/report/pairs.hpp>
#include <samewhere/report/status_strip.hpp>
#include <samewhere/report/style.hpp>
#include <samewhere/report/trajectory_figure.hpp>

namespace samewhere::report {
namespace {

constexpr std::size_t kMaxAcceptedPairs = 300;
constexpr std::size_t kMaxRejectedPairs = 12;

std::string counted(int count, std::string_view one, std::string_view many) {
  return fmt::format("{} {}", count, count == 1 ? one : many);
}

// The run in two sentences.
std::string lead(const RunRecord& record, const Funnel& funnel) {
  std::string text;
  if (!record.frames.empty()) {
    const auto num_measured =
        std::count_if(record.frames.begin(), record.frames.end(),
                      [](const FrameRecord& frame) { return is_confirmed(frame.pose); });
    text = fmt::format("{}, {} with a measured pose. ",
                       counted(static_cast<int>(record.frames.size()), "frame", "frames"),
                       num_measured);
  }
  if (funnel.num_candidates == 0) return text + "No loop candidates.";
  const int num_rejected = funnel.num_candidates - funnel.num_accepted - funnel.num_ambiguous;
  text += fmt::format("{}: {} accepted, {} rejected",
                      counted(funnel.num_candidates, "loop candidate", "loop candidates"),
                      funnel.num_accepted, num_rejected);
  if (funnel.num_ambiguous > 0) text += fmt::format(", {} ambiguous", funnel.num_ambiguous);
  return text + ".";
}

std::string header(const RunRecord& record, const Funnel& funnel) {
  std::string html =
      fmt::format("<header><h1>{}</h1><p class=\"source\">{}</p><p class=\"lead\">{}</p>",
                  escaped(record.title), escaped(record.source), lead(record, funnel));
  if (record.is_interrupted)
    html +=
        "<p class=\"warning\">The run was interrupted; the report covers the frames up to "
        "there.</p>";
  if (record.input_error)
    html += fmt::format("<p class=\"warning\">The input failed and the run ended there: {}</p>",
                        escaped(*record.input_error));
  if (!record.figures.empty()) {
    html += "<dl class=\"figures\">";
    for (const Figure& figure : record.figures)
      fmt::format_to(std::back_inserter(html), "<div><dt>{}</dt><dd>{}</dd></div>",
                     escaped(figure.name), escaped(figure.value));
    html += "</dl>";
  }
  return html + "</header>\n";
}

std::string section(std::string_view title, std::string_view note, const std::string& content) {
  const std::string note_html =
      note.empty() ? std::string() : fmt::format("<p class=\"note\">{}</p>", note);
  return fmt::format("<section><h2>{}</h2>{}{}</section>\n", title, note_html, content);
}

std::string bar(std::string_view css_class, int count, int num_candidates) {
  if (count == 0) return "";
  const double share = 100.0 * count / num_candidates;
  return fmt::format("<div class=\"{}\" style=\"flex:0 0 max(2px,{:.2f}%)\"></div>", css_class,
                     share);
}

std::string funnel_line(std::string_view question, std::string_view name, const std::string& bars,
                        const std::string& counts) {
  return fmt::format(
      "<div class=\"row\"><div class=\"ask\">{}<small>{}</small></div>"
      "<div class=\"track-bar\">{}</div><div class=\"count\">{}</div></div>\n",
      question, name, bars, counts);
}

std::string funnel_bars(const Funnel& funnel) {
  std::string html = "<div class=\"funnel\">\n";
  for (const FunnelRow& row : funnel.rows) {
    std::string question(question_of(row.stage));
    question[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(question[0])));
    html += funnel_line(question, core::name_of(row.stage),
                        bar("passed", row.num_arrived - row.num_rejected, funnel.num_candidates) +
                            bar("rejected", row.num_rejected, funnel.num_candidates),
                        fmt::format("<b>{}</b> of {} rejected", row.num_rejected, row.num_arrived));
  }
  html += funnel_line("Ambiguous", "more than one place explains the view",
                      bar("ambiguous", funnel.num_ambiguous, funnel.num_candidates),
                      fmt::format("<b>{}</b>", funnel.num_ambiguous));
  html += funnel_line("Accepted", "loop closures",
                      bar("accepted", funnel.num_accepted, funnel.num_candidates),
                      fmt::format("<b>{}</b>", funnel.num_accepted));
  return html + "</div>\n";
}

std::string trajectory_sections(const RunRecord& record) {
  if (record.frames.empty()) return "";
  const std::string figure = trajectory_figure(record);
  return section("Trajectory", figure.empty() ? "No pose was measured." : "", figure) +
         section("Tracking status", "", status_strip(record.frames));
}

std::string verification_sections(const RunRecord& record, const Funnel& funnel) {
  if (funnel.num_candidates == 0) return "";
  std::string html =
      section("Loop verification",
              "Each candidate passes these checks in order; the first that fails rejects it.",
              funnel_bars(funnel));
  const auto rejected = rejected_rows(record.ledger);
  if (!rejected.empty())
    html += section("Rejected candidates, most inliers first", "The query is on the left.",
                    pair_cards(record, rejected, kMaxRejectedPairs));
  const auto accepted = accepted_rows(record.ledger);
  html += accepted.empty() ? section("Accepted loop closures", "None.", "")
                           : section("Accepted loop closures", "The query is on the left.",
                                     pair_cards(record, accepted, kMaxAcceptedPairs));
  return html;
}

}  // namespace

std::string report_html(const RunRecord& record) {
  const Funnel found = funnel(record.ledger);
  std::string html =
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta name=\"color-scheme\" content=\"light dark\">\n";
  html += fmt::format("<title>{}</title>\n<style>{}</style></head>\n<body><main>\n",
                      escaped(record.title), style_sheet());
  html +=
      header(record, found) + trajectory_sections(record) + verification_sections(record, found);
  if (!record.config_yaml.empty())
    html += fmt::format("<details><summary>Configuration</summary><pre>{}</pre></details>\n",
                        escaped(record.config_yaml));
  return html + "</main></body></html>\n";
}

}  // namespace samewhere::report
