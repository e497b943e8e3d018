#include <algorithm>
#include <iterator>
#include <sstream>

#include <fmt/format.h>

#include <samewhere/report/html_text.hpp>
#include <samewhere/report/jpeg.hpp>
#include <samewhere/report/pair_figure.hpp>
#include <samewhere/report/pairs.hpp>

namespace samewhere::report {
namespace {

constexpr double kView_px = 400.0;  // width of a view on the page
constexpr double kGap_px = 4.0;
constexpr double kLine_px = 20.0;  // of text
constexpr double kMargin_px = 14.0;
constexpr std::size_t kLineLength = 100;  // characters that fit

// A view as it stands on the page.
struct Placed {
  const PairView* view = nullptr;
  double left_px = 0.0;

  double scale() const { return kView_px / view->image_size_px.width; }
  double height_px() const { return scale() * view->image_size_px.height; }
  Eigen::Vector2d on_page(const Eigen::Vector2f& pixel) const {
    return {left_px + scale() * pixel.x(), scale() * pixel.y()};
  }
};

std::string picture(const Placed& placed, core::FrameId frame) {
  return fmt::format(
      R"(<image x="{0:.1f}" width="{1:.1f}" height="{2:.1f}" preserveAspectRatio="none" href="{3}"/>)"
      R"(<text x="{4:.1f}" y="20" fill="white" stroke="black" stroke-width="3" paint-order="stroke">{5}</text>)"
      "\n",
      placed.left_px, kView_px, placed.height_px(), jpeg_data_uri(placed.view->jpeg),
      placed.left_px + 8.0, frame.index());
}

std::string lines_between(const PairRecord& record, const Placed& query, const Placed& match) {
  std::string path;
  for (const auto& [in_query, in_match] : record.matches_px) {
    const Eigen::Vector2d a = query.on_page(in_query);
    const Eigen::Vector2d b = match.on_page(in_match);
    fmt::format_to(std::back_inserter(path), "M{:.1f} {:.1f}L{:.1f} {:.1f}", a.x(), a.y(), b.x(),
                   b.y());
  }
  return path;
}

std::vector<std::string> in_lines(const std::string& text) {
  std::vector<std::string> lines(1);
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    if (lines.back().size() + word.size() >= kLineLength) lines.emplace_back();
    lines.back() += (lines.back().empty() ? "" : " ") + word;
  }
  return lines;
}

std::string text_below(const core::Verdict& verdict, double top_px) {
  std::vector<std::string> lines = in_lines(core::reason_of(verdict));
  lines.insert(lines.begin(), scores_of(core::evidence_of(verdict)));
  std::string text = fmt::format(R"(<text x="{}" y="{:.1f}" font-weight="bold">{}</text>)",
                                 kMargin_px, top_px, escaped(verdict_in_words(verdict)));
  for (const std::string& line : lines)
    fmt::format_to(std::back_inserter(text), "<text x=\"{}\" y=\"{:.1f}\">{}</text>\n", kMargin_px,
                   top_px += kLine_px, escaped(line));
  return text;
}

std::size_t num_lines(const core::Verdict& verdict) {
  return 2 + in_lines(core::reason_of(verdict)).size();
}

}  // namespace

std::string pair_svg(const PairRecord& record) {
  const Placed query{&record.query, 0.0};
  const Placed match{&record.match, kView_px + kGap_px};
  const double views_px = std::max(query.height_px(), match.height_px());
  const double text_px = kLine_px * static_cast<double>(num_lines(record.row.verdict));
  return fmt::format(
      R"(<svg xmlns="http://www.w3.org/2000/svg" width="{0:.0f}" height="{1:.0f}" viewBox="0 0 {0:.0f} {1:.0f}" )"
      R"(font-family="sans-serif" font-size="14"><rect width="100%" height="100%" fill="white"/>)"
      "\n{2}{3}"
      R"(<path d="{4}" stroke="#ffb000" stroke-width="0.8" stroke-opacity="0.5" fill="none"/>)"
      "\n{5}</svg>\n",
      2 * kView_px + kGap_px, views_px + text_px + 2 * kMargin_px,
      picture(query, record.row.candidate.query), picture(match, record.row.candidate.match),
      lines_between(record, query, match),
      text_below(record.row.verdict, views_px + kLine_px + kMargin_px / 2));
}

}  // namespace samewhere::report
