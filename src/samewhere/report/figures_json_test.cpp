#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <samewhere/report/figures_json.hpp>

namespace samewhere::report {
namespace {

TEST(FiguresJson, GivesTheNumbersBesideTheTextOfEach) {
  const auto document = nlohmann::json::parse(
      figures_json("office", {{"ATE RMSE (median, max)", "0.0133 m (0.0126, 0.0254)"},
                              {"loops accepted: right / wrong / unknown", "1 / 0 / 2"},
                              {"frames with a measured pose", "611 of 611 (100.0 %)"},
                              {"describer", "a49a75344d825251, hog"}}));
  EXPECT_EQ(document["title"], "office");
  const auto& figures = document["figures"];
  const auto numbers = [&](const char* name) {
    return figures[name]["numbers"].get<std::vector<double>>();
  };
  EXPECT_EQ(numbers("ATE RMSE (median, max)"), (std::vector{0.0133, 0.0126, 0.0254}));
  EXPECT_EQ(numbers("loops accepted: right / wrong / unknown"), (std::vector{1.0, 0.0, 2.0}));
  EXPECT_EQ(numbers("frames with a measured pose"), (std::vector{611.0, 611.0, 100.0}));
  EXPECT_TRUE(numbers("describer").empty());
  EXPECT_EQ(figures["describer"]["value"], "a49a75344d825251, hog");
}

TEST(FiguresJson, IsWholeWhateverTheNameOfTheRecording) {
  const auto document = nlohmann::json::parse(figures_json("a\"\n\xff", {{"x", ""}}));
  EXPECT_TRUE(document["figures"]["x"]["numbers"].empty());
}

}  // namespace
}  // namespace samewhere::report
