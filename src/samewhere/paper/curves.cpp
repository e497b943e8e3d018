#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

#include <fmt/format.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/paper/curves.hpp>
#include <samewhere/paper/published.hpp>
#include <samewhere/report/plot.hpp>

namespace samewhere::paper {
namespace {

// A hue for each describer: its sampled search, and lighter its exact one.
constexpr std::array<std::pair<const char*, const char*>, 3> kDescriberColours = {
    {{"#1f5f8b", "#9cc3dd"}, {"#b5451b", "#edb79c"}, {"#3c7d3c", "#aed4ae"}}};

// The sampled search with the published number of draws, or the most draws of all, and the exact
// one.
std::pair<const PaperRun*, const PaperRun*> runs_to_draw(const PaperBlock& block) {
  const PaperRun* sampled = nullptr;
  for (const PaperRun& run : block.runs) {
    if (run.search != retrieve::Search::kSampled || run.seed != 0) continue;
    if (sampled == nullptr || sampled->num_draws != kPublishedDrawsOfUse) sampled = &run;
  }
  core::require(sampled != nullptr, "some search draws");
  return {sampled, &block.runs.back()};
}

report::PlotCurve curve_of(const PaperBlock& block, const PaperRun& run,
                           const std::string& colour) {
  const bool is_sampled = run.search == retrieve::Search::kSampled;
  report::PlotCurve curve{
      .name = fmt::format("{}, {}: {:.3f}", block.describer,
                          is_sampled ? fmt::format("L = {}", run.num_draws) : std::string("exact"),
                          run.result.auc),
      .points = {},
      .colour = colour};
  for (const auto& point : run.result.curve)
    curve.points.push_back({point.recall, point.precision});
  return curve;
}

report::PlotCurve published_points() {
  report::PlotCurve points{.name = "published, its own data",
                           .points = {},
                           .colour = "#888888",
                           .style = report::PlotStyle::kMarks};
  for (const auto& [recall, precision] : kPublishedPoints)
    points.points.push_back({recall, precision});
  return points;
}

std::string published_note() {
  std::string note = fmt::format("Numbers are AUC. Published at L = {}:", kPublishedDrawsOfUse);
  const auto* const column =
      std::find(kPublishedNumDraws.begin(), kPublishedNumDraws.end(), kPublishedDrawsOfUse);
  const auto index = static_cast<std::size_t>(column - kPublishedNumDraws.begin());
  const char* separator = " ";
  for (const PublishedSequence& published : kPublishedSequences) {
    note += fmt::format("{}{} {:.3f}", separator, published.name, published.auc[index]);
    separator = ", ";
  }
  return note;
}

}  // namespace

std::string curves_svg(const std::vector<PaperBlock>& blocks) {
  core::require(!blocks.empty(), "curves are of something");
  report::Plot plot{.title = fmt::format("{}, window {} frames", blocks.front().recording,
                                         blocks.front().window_frames),
                    .note = published_note(),
                    .x = {"recall", 0.0, 1.0, false},
                    .y = {"precision", 0.0, 1.0, false},
                    .curves = {}};
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    const auto& [sampled_colour, exact_colour] = kDescriberColours[i % kDescriberColours.size()];
    const auto [sampled, exact] = runs_to_draw(blocks[i]);
    plot.curves.push_back(curve_of(blocks[i], *exact, exact_colour));
    plot.curves.push_back(curve_of(blocks[i], *sampled, sampled_colour));
  }
  plot.curves.push_back(published_points());
  return report::plot_svg(plot);
}

}  // namespace samewhere::paper
