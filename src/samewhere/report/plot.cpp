#include <cmath>
#include <iterator>

#include <fmt/format.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/report/html_text.hpp>
#include <samewhere/report/plot.hpp>

namespace samewhere::report {
namespace {

constexpr double kLeft_px = 70.0;
constexpr double kTop_px = 80.0;
constexpr double kPlotWidth_px = 560.0;  // of the plot itself
constexpr double kHeight_px = 400.0;     //
constexpr double kLegend_px = 240.0;
constexpr double kLegendStep_px = 22.0;
constexpr int kNumSteps = 5;  // of a linear axis
// attributes rather than a style sheet, which simple viewers do not read
constexpr const char* kLineLook = R"(fill="none" stroke-width="2.2" stroke-linejoin="round")";

// 0 at the low end of the axis, 1 at the high end.
double share_of(const PlotAxis& axis, double value) {
  if (!axis.is_logarithmic) return (value - axis.low) / (axis.high - axis.low);
  return std::log(value / axis.low) / std::log(axis.high / axis.low);
}

double x_px(const Plot& plot, double x) { return kLeft_px + kPlotWidth_px * share_of(plot.x, x); }
double y_px(const Plot& plot, double y) {
  return kTop_px + kHeight_px * (1.0 - share_of(plot.y, y));
}

bool is_inside(const PlotAxis& axis, double value) {
  return value >= axis.low && value <= axis.high;
}

void check(const PlotAxis& axis) {
  core::require(axis.low < axis.high && (!axis.is_logarithmic || axis.low > 0.0),
                "an axis of a plot has an extent");
}

std::vector<double> ticks(const PlotAxis& axis) {
  std::vector<double> values;
  if (axis.is_logarithmic) {
    const int last = static_cast<int>(std::floor(std::log10(axis.high) + 1e-9));
    for (int power = static_cast<int>(std::ceil(std::log10(axis.low) - 1e-9)); power <= last;
         ++power) {
      values.push_back(std::pow(10.0, power));
    }
  } else {
    for (int i = 0; i <= kNumSteps; ++i)
      values.push_back(axis.low + (axis.high - axis.low) * i / kNumSteps);
  }
  return values;
}

std::string axes(const Plot& plot) {
  std::string svg;
  const auto out = std::back_inserter(svg);
  const double bottom_px = kTop_px + kHeight_px;
  for (const double x : ticks(plot.x)) {
    fmt::format_to(out,
                   "<line stroke=\"#e5e2dc\" x1=\"{0:.1f}\" y1=\"{1}\" x2=\"{0:.1f}\" y2=\"{2}\"/>"
                   "<text x=\"{0:.1f}\" y=\"{3}\" text-anchor=\"middle\">{4:g}</text>\n",
                   x_px(plot, x), kTop_px, bottom_px, bottom_px + 20.0, x);
  }
  for (const double y : ticks(plot.y)) {
    fmt::format_to(out,
                   "<line stroke=\"#e5e2dc\" x1=\"{0}\" y1=\"{1:.1f}\" x2=\"{2}\" y2=\"{1:.1f}\"/>"
                   "<text x=\"{3}\" y=\"{4:.1f}\" text-anchor=\"end\">{5:g}</text>\n",
                   kLeft_px, y_px(plot, y), kLeft_px + kPlotWidth_px, kLeft_px - 8.0,
                   y_px(plot, y) + 5.0, y);
  }
  fmt::format_to(out,
                 "<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">{}</text>\n"
                 "<text x=\"{}\" y=\"{}\">{}</text>\n",
                 kLeft_px + kPlotWidth_px / 2.0, bottom_px + 44.0, escaped(plot.x.name), kLeft_px,
                 kTop_px - 14.0, escaped(plot.y.name));
  return svg;
}

std::string drawn(const Plot& plot, const PlotCurve& curve) {
  std::string svg;
  const auto out = std::back_inserter(svg);
  for (const PlotPoint& point : curve.points) {
    if (!is_inside(plot.x, point.x) || !is_inside(plot.y, point.y)) continue;
    const char* format = curve.style == PlotStyle::kMarks
                             ? "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"4.5\"/>"
                             : "{:.1f},{:.1f} ";
    fmt::format_to(out, fmt::runtime(format), x_px(plot, point.x), y_px(plot, point.y));
  }
  if (curve.style == PlotStyle::kMarks)
    return fmt::format("<g fill=\"{}\">{}</g>\n", escaped(curve.colour), svg);
  return fmt::format("<polyline {} stroke=\"{}\" points=\"{}\"/>\n", kLineLook,
                     escaped(curve.colour), svg);
}

std::string legend(const std::vector<PlotCurve>& curves) {
  std::string svg;
  double y = kTop_px + 8.0;
  const double x = kLeft_px + kPlotWidth_px + 24.0;
  for (const PlotCurve& curve : curves) {
    if (curve.name.empty()) continue;
    const std::string sign =
        curve.style == PlotStyle::kMarks
            ? fmt::format("<circle fill=\"{}\" cx=\"{}\" cy=\"{}\" r=\"4.5\"/>",
                          escaped(curve.colour), x + 11.0, y)
            : fmt::format("<polyline {} stroke=\"{}\" points=\"{},{} {},{}\"/>", kLineLook,
                          escaped(curve.colour), x, y, x + 22.0, y);
    fmt::format_to(std::back_inserter(svg), "{}<text x=\"{}\" y=\"{}\">{}</text>\n", sign, x + 30.0,
                   y + 5.0, escaped(curve.name));
    y += kLegendStep_px;
  }
  return svg;
}

}  // namespace

std::string plot_svg(const Plot& plot) {
  check(plot.x);
  check(plot.y);
  const double width_px = kLeft_px + kPlotWidth_px + kLegend_px;
  const double height_px = kTop_px + kHeight_px + 96.0;
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" "
      "height=\"{1}\">\n<rect width=\"{0}\" height=\"{1}\" fill=\"#ffffff\"/>\n"
      "<g font-family=\"system-ui, sans-serif\" font-size=\"14\" fill=\"#4a5056\">\n"
      "<text x=\"{2}\" y=\"32\" font-size=\"18\" font-weight=\"600\">{3}</text>\n",
      width_px, height_px, kLeft_px, escaped(plot.title));
  svg += axes(plot);
  for (const PlotCurve& curve : plot.curves) svg += drawn(plot, curve);
  svg += legend(plot.curves);
  return svg + fmt::format("<text x=\"{}\" y=\"{}\">{}</text>\n</g>\n</svg>\n", kLeft_px,
                           height_px - 18.0, escaped(plot.note));
}

std::vector<std::string> colours_in_order(int count) {
  std::vector<std::string> colours;
  for (int i = 0; i < count; ++i) {
    const double share = count > 1 ? static_cast<double>(i) / (count - 1) : 1.0;
    colours.push_back(
        fmt::format("hsl(205 {:.0f}% {:.0f}%)", 50.0 + 20.0 * share, 78.0 - 50.0 * share));
  }
  return colours;
}

}  // namespace samewhere::report
