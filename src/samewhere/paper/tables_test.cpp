#include <algorithm>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/paper/curves.hpp>
#include <samewhere/paper/tables.hpp>
#include <samewhere/paper/test_described.hpp>

namespace samewhere::paper {
namespace {

using testing::HasSubstr;
using testing::Not;

// Draws every queue, so that every seed finds the same.
PaperBlock sample_block() {
  const DescribedRecording recording = second_lap();
  const PaperPlan plan{.num_draws = {500}, .num_seeds = 2};
  return *run_paper_plan(recording, recording.by_describer.front(), small_store(), plan);
}

// The cells of the line that starts with `name`, after the name.
std::vector<std::string> cells_of(const std::string& text, const std::string& name) {
  const std::size_t at = text.find("\n" + name);
  EXPECT_NE(at, std::string::npos) << name << " in\n" << text;
  const std::size_t begin = at + 1 + name.size();
  std::istringstream line(text.substr(begin, text.find('\n', begin) - begin));
  std::vector<std::string> cells;
  for (std::string cell; line >> cell;) cells.push_back(cell);
  return cells;
}

TEST(PaperTables, ShowWhatWasCountedByHand) {
  const std::string text = paper_text(sample_block(), {2, 3, 6});
  using Cells = std::vector<std::string>;
  EXPECT_THAT(text, HasSubstr("second lap, by hand: 6 frames, 3 with a loop, window 2 frames"));
  EXPECT_EQ(cells_of(text, "Table 2: draws L"), (Cells{"500", "all", "exact"}));
  EXPECT_EQ(cells_of(text, "AUC"), (Cells{"0.5278", "0.5278", "0.5278"}));
  EXPECT_EQ(cells_of(text, "recall at 100 % precision"), (Cells{"0.3333", "0.3333", "0.3333"}));
  EXPECT_EQ(cells_of(text, "precision at recall .35"), (Cells{"0.6667", "0.6667", "0.6667"}));
  EXPECT_EQ(cells_of(text, "precision at recall .70"), (Cells{"0.0000", "0.0000", "0.0000"}));
  EXPECT_EQ(cells_of(text, "preprocess and describe, median"), (Cells{"2.000", "2.000", "2.000"}));
  EXPECT_EQ(cells_of(text, "right"), (Cells{"2.0", "2.0", "2.0"}));
  EXPECT_EQ(cells_of(text, "wrong"), (Cells{"1.0", "1.0", "1.0"}));
  EXPECT_EQ(cells_of(text, "  of these impostors"), (Cells{"1.0", "1.0", "1.0"}));
}

TEST(PaperTables, PublishedFiguresStandUnderTheirNumberOfDraws) {
  PaperBlock block = sample_block();
  for (PaperRun& run : block.runs) run.num_draws = 50;
  const std::string text = paper_text(block, {2, 3});
  EXPECT_EQ(cells_of(text, "published AUC, Lip6 Indoor"), std::vector<std::string>{"0.8321"});
  EXPECT_EQ(cells_of(text, "published, Bicocca Indoor"), std::vector<std::string>{"50.52"});
}

TEST(PaperTables, OnlyTheWantedOnesArePrinted) {
  const std::string text = paper_text(sample_block(), {3});
  EXPECT_THAT(text, HasSubstr("Table 3"));
  EXPECT_THAT(text, Not(HasSubstr("Table 2")));
  EXPECT_THAT(text, Not(HasSubstr("Table 6")));
}

TEST(PaperTables, ATableThatIsUnknownIsNamed) {
  EXPECT_EQ(parse_table_numbers("2,3"), (PaperTableNumbers{2, 3}));
  EXPECT_EQ(parse_table_numbers("6,2,6"), (PaperTableNumbers{2, 6}));
  for (const char* list : {"4", "2,", "", "2;3", "two", "2,33"}) {
    EXPECT_THROW(parse_table_numbers(list), core::InputError) << list;
  }
}

TEST(PaperTables, EverySearchHasARowAndEveryStepATime) {
  const std::vector<PaperBlock> blocks{sample_block(), sample_block()};
  const auto num_lines = [](const std::string& csv) {
    return std::count(csv.begin(), csv.end(), '\n');
  };
  const std::string searches = searches_csv(blocks);
  EXPECT_EQ(num_lines(searches), 1 + 2 * 4);
  EXPECT_THAT(searches,
              HasSubstr("second lap,by hand,0000000000001234,2,500,1,6,3,0.527778,0.333333,"
                        "0.666667,0.000000,2,1,1,0"));
  EXPECT_EQ(num_lines(times_csv(blocks)), 1 + 2 * 3 * 4);
}

TEST(PaperTables, NoLoopIsNoPerfection) {
  PaperBlock block = sample_block();
  for (PaperRun& run : block.runs) run.loops.counts = {};
  EXPECT_EQ(cells_of(paper_text(block, {6}), "wrong / (right + wrong)"),
            (std::vector<std::string>{"-", "-", "-"}));
}

TEST(PaperTables, TimesTogetherAreThoseOfTheTimedFrames) {
  PaperBlock block = sample_block();
  ASSERT_EQ(block.timed_frames, (std::vector<int>{0, 2, 4}));
  for (PaperRun& run : block.runs) {
    run.search_ms = {1, 90, 1, 90, 1, 90};
    run.exact_similarity_ms = {5, 90, 5, 90, 5, 90};
  }
  EXPECT_EQ(cells_of(paper_text(block, {3}), "together, median").front(), "8.000");
}

TEST(PaperTables, TheDescribersOfARecordingShareAPicture) {
  PaperBlock block = sample_block();
  block.recording = "hotel?seed=3&similarity=1";
  PaperBlock other = block;
  other.describer = "network";
  const std::string svg = curves_svg({block, other});
  EXPECT_THAT(svg, HasSubstr("hotel?seed=3&amp;similarity=1"));
  for (const char* curve : {"by hand, L = 500: 0.528", "by hand, exact: 0.528",
                            "network, L = 500: 0.528", "network, exact: 0.528"}) {
    EXPECT_THAT(svg, HasSubstr(curve));
  }
  EXPECT_THAT(svg, HasSubstr("Lip6 Indoor 0.832"));
}

}  // namespace
}  // namespace samewhere::paper
