// `samewhere optimize` on a graph with an outlier loop, and on files that are no graphs.

#include <algorithm>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "program.hpp"
#include <samewhere/core/file.hpp>
#include <samewhere/input/test_folder.hpp>

namespace samewhere::test {
namespace {

using ::testing::HasSubstr;

constexpr const char* kInformation = "400 0 0 400 0 2500";

// Twice around a square of four poses, with true loop closures and one outlier edge.
std::string square() {
  std::string text;
  for (int i = 0; i < 8; ++i)
    text += fmt::format("VERTEX_SE2 {} {} {} {}\n", i, i % 4 == 1 || i % 4 == 2 ? 1 : 0,
                        i % 4 >= 2 ? 1 : 0, 1.5707963 * i);
  for (int i = 0; i < 7; ++i)
    text += fmt::format("EDGE_SE2 {} {} 1 0 1.5707963 {}\n", i, i + 1, kInformation);
  for (int i = 0; i < 3; ++i)
    text += fmt::format("EDGE_SE2 {} {} 0.01 0 0 {}\n", i, i + 4, kInformation);
  return text + fmt::format("EDGE_SE2 1 7 3 3 0 {}\n", kInformation);
}

class Optimize : public testing::Test {
 protected:
  Outcome run(const std::string& arguments) const { return run_program(arguments, folder_.root()); }
  std::filesystem::path path(const std::string& name) const { return folder_.root() / name; }
  input::TestFolder folder_;
};

TEST_F(Optimize, RejectsTheOutlierEdgeAndReportsIt) {
  folder_.write("graph.g2o", square() + "VERTEX_XY 9 0 0\n");
  const Outcome done =
      run("optimize " + quoted(path("graph.g2o")) + " --out " + quoted(path("out.g2o")) +
          " --loops " + quoted(path("loops.csv")) + " --svg " + quoted(path("graph.svg")));
  ASSERT_EQ(done.exit_code, 0) << done.err;
  EXPECT_THAT(done.out, HasSubstr("8 in the plane"));
  EXPECT_THAT(done.out, HasSubstr("11: 7 odometry, 4 loops"));
  EXPECT_THAT(done.out, HasSubstr("1 of unknown type VERTEX_XY"));
  EXPECT_THAT(done.out, HasSubstr("3 / 1"));
  EXPECT_THAT(done.out, HasSubstr("as computed by g2o"));
  EXPECT_THAT(done.out, testing::ContainsRegex("converged +yes"));
  const std::string loops = core::read_file(path("loops.csv"));
  EXPECT_THAT(loops, HasSubstr("a,b,squared_error,weight\n0,4,"));
  EXPECT_EQ(loops.substr(loops.size() - 3), ",0\n") << "the last one is the outlier";
  EXPECT_THAT(core::read_file(path("graph.svg")), HasSubstr("rejected loops (1)"));
  // the solved graph is at its optimum already
  const Outcome again = run("optimize " + quoted(path("out.g2o")));
  EXPECT_EQ(again.exit_code, 0) << again.err;
  EXPECT_THAT(again.out, HasSubstr("3 / 1"));
}

TEST_F(Optimize, ComponentsAreReported) {
  std::string text = square();
  text += "VERTEX_SE2 20 5 5 0\nVERTEX_SE2 21 6 5 0\n";
  folder_.write("graph.g2o", text + fmt::format("EDGE_SE2 20 21 1 0 0 {}\n", kInformation));
  const Outcome done = run("optimize " + quoted(path("graph.g2o")));
  EXPECT_EQ(done.exit_code, 0) << done.err;
  EXPECT_THAT(done.out, HasSubstr("2, each optimized separately"));
}

TEST_F(Optimize, AFileThatIsNoGraphIsAnErrorAndNothingIsWritten) {
  folder_.write("cut.g2o", square().substr(0, square().size() - 8));
  folder_.write("noise.g2o",
                "\x7f"
                "ELF\x01\x02 what\n");
  const std::pair<std::string, std::string> broken[] = {{"cut.g2o", "expected 11 of EDGE_SE2"},
                                                        {"noise.g2o", "expected some of both"},
                                                        {"nowhere.g2o", "cannot be read"}};
  for (const auto& [name, complaint] : broken) {
    const Outcome done =
        run("optimize " + quoted(path(name)) + " --out " + quoted(path("never.g2o")));
    EXPECT_EQ(done.exit_code, 2) << name;
    EXPECT_THAT(done.err, HasSubstr(name));
    EXPECT_THAT(done.err, HasSubstr(complaint));
    EXPECT_EQ(std::count(done.err.begin(), done.err.end(), '\n'), 1) << done.err;
  }
  EXPECT_FALSE(std::filesystem::exists(path("never.g2o")));
}

}  // namespace
}  // namespace samewhere::test
