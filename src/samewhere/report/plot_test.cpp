#include <algorithm>
#include <regex>
#include <stack>

#include <gtest/gtest.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/report/plot.hpp>

namespace samewhere::report {
namespace {

Plot sample() {
  return {
      .title = "misses & hits <measured>",
      .note = "a \"note\"",
      .x = {"views", 100.0, 10'000.0, true},
      .y = {"chance", 0.0, 1.0, false},
      .curves = {{"L = 10", {{100, 0}, {1000, 0.5}, {10'000, 1}}, "#123456"},
                 {"measured", {{1000, 0.25}, {99, 0.5}, {1000, 1.5}}, "red", PlotStyle::kMarks}}};
}

bool is_well_nested_svg(const std::string& svg) {
  const std::regex tag("<(/?)([a-z]+)[^<>]*?(/?)>");
  std::stack<std::string> open;
  for (std::sregex_iterator it(svg.begin(), svg.end(), tag), end; it != end; ++it) {
    if ((*it)[3] == "/") continue;
    if ((*it)[1] != "/") {
      open.push((*it)[2]);
    } else if (open.empty() || open.top() != (*it)[2]) {
      return false;
    } else {
      open.pop();
    }
  }
  const std::string rest = std::regex_replace(svg, tag, "");
  return open.empty() && rest.find_first_of("<>") == std::string::npos;
}

TEST(Plot, IsWellFormedWhateverItsWordsAre) {
  const std::string svg = plot_svg(sample());
  EXPECT_TRUE(svg.starts_with("<svg xmlns="));
  EXPECT_TRUE(is_well_nested_svg(svg)) << svg;
  EXPECT_NE(svg.find("misses &amp; hits &lt;measured&gt;"), std::string::npos) << svg;
}

TEST(Plot, PointsAreWhereTheAxesSay) {
  const std::string svg = plot_svg(sample());
  // the corners and the middle of a plot of 560 x 400 pixels at (70, 80)
  EXPECT_NE(svg.find("points=\"70.0,480.0 350.0,280.0 630.0,80.0 \""), std::string::npos) << svg;
  EXPECT_NE(svg.find("<circle cx=\"350.0\" cy=\"380.0\""), std::string::npos) << svg;
  // powers of ten on one axis, fifths on the other
  for (const char* label : {">100<", ">1000<", ">10000<", ">0.2<", ">0.8<"})
    EXPECT_NE(svg.find(label), std::string::npos) << label;
}

TEST(Plot, WhatLiesOutsideIsNotDrawn) {
  const std::string svg = plot_svg(sample());
  // one mark of three, and one in the legend
  const std::regex circle("<circle");
  EXPECT_EQ(std::distance(std::sregex_iterator(svg.begin(), svg.end(), circle), {}), 2) << svg;
}

TEST(Plot, AnAxisWithoutExtentIsRefused) {
  Plot plot = sample();
  plot.x.low = 0.0;
  EXPECT_THROW(plot_svg(plot), core::ContractError);
  plot = sample();
  plot.y.high = 0.0;
  EXPECT_THROW(plot_svg(plot), core::ContractError);
}

TEST(Plot, ColoursInOrderDiffer) {
  std::vector<std::string> colours = colours_in_order(7);
  ASSERT_EQ(colours.size(), 7u);
  std::sort(colours.begin(), colours.end());
  EXPECT_EQ(std::unique(colours.begin(), colours.end()), colours.end());
  EXPECT_EQ(colours_in_order(1).size(), 1u);
}

}  // namespace
}  // namespace samewhere::report
