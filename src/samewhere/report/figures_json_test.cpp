#include <limits>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <samewhere/report/figure.hpp>
#include <samewhere/report/figures_json.hpp>

namespace samewhere::report {
namespace {

TEST(FiguresJson, GivesTheNumbersBesideTheTextOfEach) {
  const auto document = nlohmann::json::parse(
      figures_json("office", {figure("ATE RMSE (median)", "{:.2f} m ({:.2f})", 0.01331, 0.0126),
                              figure("loops accepted: true / false", "{} / {}", 1, 0U),
                              {"describer", "a49a75344d825251, hog"},
                              {"scale", "unknown since 2020"}}));
  EXPECT_EQ(document["title"], "office");
  const auto& figures = document["figures"];
  const auto numbers = [&](const char* name) {
    return figures[name]["numbers"].get<std::vector<double>>();
  };
  EXPECT_EQ(figures["ATE RMSE (median)"]["value"], "0.01 m (0.01)");
  EXPECT_EQ(numbers("ATE RMSE (median)"), (std::vector{0.01331, 0.0126})) << "not rounded";
  EXPECT_EQ(numbers("loops accepted: true / false"), (std::vector{1.0, 0.0}));
  EXPECT_EQ(figures["describer"]["value"], "a49a75344d825251, hog");
  EXPECT_TRUE(numbers("scale").empty()) << "of a text none are taken";
}

TEST(FiguresJson, HasNullForWhatIsNotFinite) {
  const auto document = nlohmann::json::parse(
      figures_json("x", {figure("error", "{}", std::numeric_limits<double>::infinity())}));
  EXPECT_TRUE(document["figures"]["error"]["numbers"][0].is_null());
}

TEST(FiguresJson, IsWholeWhateverTheNameOfTheRecording) {
  const auto document = nlohmann::json::parse(figures_json("a\"\n\xff", {{"x", ""}}));
  EXPECT_TRUE(document["figures"]["x"]["numbers"].empty());
}

}  // namespace
}  // namespace samewhere::report
