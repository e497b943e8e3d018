#pragma once

#include <string>
#include <vector>

namespace samewhere::report {

struct PlotPoint {
  double x = 0.0;
  double y = 0.0;
};

// What is drawn: a line through the points, or a mark at each.
enum class PlotStyle { kLine, kMarks };

struct PlotCurve {
  std::string name;  // in the legend; empty: it has no line there
  std::vector<PlotPoint> points;
  std::string colour;  // as CSS has it
  PlotStyle style = PlotStyle::kLine;
};

struct PlotAxis {
  std::string name;
  double low = 0.0;  // < high; > 0 where logarithmic
  double high = 1.0;
  bool is_logarithmic = false;  // powers of ten are labelled, else six round steps
};

struct Plot {
  std::string title;
  std::string note;  // one sentence below
  PlotAxis x;
  PlotAxis y;
  std::vector<PlotCurve> curves;
};

// The plot as an SVG file of its own, on white. What lies outside of the axes is not drawn. Throws
// ContractError on axes without extent.
std::string plot_svg(const Plot& plot);

// `count` colours from light to dark of one hue, for curves that have an order.
std::vector<std::string> colours_in_order(int count);

}  // namespace samewhere::report
