#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include <samewhere/report/funnel.hpp>
#include <samewhere/report/html_text.hpp>
#include <samewhere/report/jpeg.hpp>
#include <samewhere/report/loops.hpp>
#include <samewhere/report/pairs.hpp>

namespace samewhere::report {
namespace {

std::string name_of_frame(const RunRecord& record, core::FrameId frame) {
  const auto index = static_cast<std::size_t>(frame.index());
  if (index < record.frames.size() && record.frames[index].pose.frame == frame)
    return record.frames[index].name;
  return "";
}

// `called`: the frame as it is printed.
std::string view(const RunRecord& record, core::FrameId frame, const std::string& called) {
  std::string image;
  const auto thumbnail = record.thumbnails.find(frame);
  if (thumbnail != record.thumbnails.end())
    image = fmt::format("<img src=\"{}\" alt=\"frame {}\" loading=\"lazy\">",
                        jpeg_data_uri(thumbnail->second), called);
  return fmt::format("<div class=\"view{}\" title=\"{}\">{}<span>{}</span></div>",
                     image.empty() ? " missing" : "", escaped(name_of_frame(record, frame)), image,
                     called);
}

std::string verdict_label(const core::Verdict& verdict) {
  const char* shade = core::is_loop(verdict)                             ? "yes"
                      : std::holds_alternative<core::Ambiguous>(verdict) ? "maybe"
                                                                         : "no";
  return fmt::format("<span class=\"verdict {}\">{}</span>", shade, verdict_in_words(verdict));
}

std::string card(const RunRecord& record, const core::LedgerRow& row) {
  return fmt::format(
      "<figure class=\"pair\"><div class=\"views\">{}{}</div><figcaption><div class=\"what\">{}"
      "<span class=\"scores\">{}</span></div><p>{}</p></figcaption></figure>\n",
      view(record, row.candidate.query, std::to_string(row.candidate.query.index())),
      view(record, row.candidate.match, name_of_match(row.candidate)), verdict_label(row.verdict),
      scores_of(core::evidence_of(row.verdict)), escaped(core::reason_of(row.verdict)));
}

// Inliers, then similarity (the least where it is no number, so that the order stays one).
std::pair<int, double> strength_of(const core::LedgerRow& row) {
  const auto& geometry = core::evidence_of(row.verdict).geometry;
  const double similarity = row.candidate.similarity;
  return {geometry ? geometry->num_inliers : 0, std::isfinite(similarity) ? similarity : -1.0};
}

}  // namespace

std::string scores_of(const core::Evidence& evidence) {
  std::string text = fmt::format("similarity {:.2f}", evidence.similarity);
  if (evidence.geometry)
    fmt::format_to(std::back_inserter(text), " · {} matches · {} inliers",
                   evidence.geometry->num_guided_matches > 0 ? evidence.geometry->num_guided_matches
                                                             : evidence.geometry->num_matches,
                   evidence.geometry->num_inliers);
  return text;
}

std::string verdict_in_words(const core::Verdict& verdict) {
  if (core::is_loop(verdict)) return "accepted";
  if (std::holds_alternative<core::Ambiguous>(verdict)) return "ambiguous";
  return fmt::format("rejected: {}", core::stage_of(verdict));
}

std::vector<const core::LedgerRow*> accepted_rows(const core::Ledger& ledger) {
  std::vector<const core::LedgerRow*> rows = final_rows(ledger);
  std::erase_if(rows, [](const core::LedgerRow* row) { return !core::is_loop(row->verdict); });
  return rows;
}

std::vector<const core::LedgerRow*> rejected_rows(const core::Ledger& ledger) {
  std::vector<const core::LedgerRow*> rows = final_rows(ledger);
  std::erase_if(rows, [](const core::LedgerRow* row) { return core::is_loop(row->verdict); });
  std::stable_sort(rows.begin(), rows.end(),
                   [](const core::LedgerRow* a, const core::LedgerRow* b) {
                     return strength_of(*a) > strength_of(*b);
                   });
  return rows;
}

std::string pair_cards(const RunRecord& record, const std::vector<const core::LedgerRow*>& rows,
                       std::size_t max_pairs) {
  const std::size_t num_shown = std::min(rows.size(), max_pairs);
  std::string html = "<div class=\"pairs\">\n";
  for (std::size_t i = 0; i < num_shown; ++i) html += card(record, *rows[i]);
  html += "</div>\n";
  if (num_shown < rows.size())
    fmt::format_to(std::back_inserter(html), "<p class=\"note\">{} more in loops.json.</p>\n",
                   rows.size() - num_shown);
  return html;
}

}  // namespace samewhere::report
