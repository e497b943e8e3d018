#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <samewhere/core/errors.hpp>
#include <samewhere/paper/page.hpp>
#include <samewhere/paper/table_cells.hpp>
#include <samewhere/paper/tables.hpp>
#include <samewhere/paper/test_results.hpp>

namespace samewhere::paper {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using Cells = std::vector<std::string>;

const PaperTableNumbers kAll{2, 3, 4, 5, 6, 7, 8};

// The cells of the first row with this name of the first table with this title.
Cells cells_of(const std::vector<PaperTable>& tables, const std::string& title,
               const std::string& name) {
  for (const PaperTable& table : tables) {
    if (table.title != title) continue;
    const auto column = std::find(table.header.begin(), table.header.end(), name);
    Cells cells;
    for (const PaperTable::Row& row : table.rows) {
      if (row.cells.front() == name) return {row.cells.begin() + 1, row.cells.end()};
      if (column != table.header.end())
        cells.push_back(row.cells[static_cast<std::size_t>(column - table.header.begin())]);
    }
    if (!cells.empty()) return cells;
  }
  ADD_FAILURE() << title << ", " << name;
  return {};
}

TEST(PaperTables, TableTwoHasARowForEachNumberOfDraws) {
  const auto tables = make_tables(made_up_results(), {2});
  ASSERT_EQ(tables.size(), 1u);
  const PaperTable& table = tables.front();
  EXPECT_THAT(table.header, ElementsAre("draws L", "hall <1>", "published, TUM fr3_loh",
                                        "published, Lip6 Indoor", "published, Bicocca Indoor"));
  EXPECT_EQ(table.num_published_columns, 3);
  ASSERT_EQ(table.rows.size(), 3u);
  EXPECT_EQ(table.rows.front().cells.front(), "50");
  EXPECT_EQ(cells_of(tables, "AUC by number of draws", "hall <1>"),
            (Cells{"0.7500 ± 0.0707", "-", "0.8500"}));
  EXPECT_EQ(cells_of(tables, "AUC by number of draws", "published, Lip6 Indoor"),
            (Cells{"0.8321", "", ""}));
}

TEST(PaperTables, MethodsStandBesideTheSearchThatThePaperUses) {
  const auto tables = make_tables(made_up_results(), kAll);
  EXPECT_EQ(cells_of(tables, "AUC by method", "hall <1>"), (Cells{"0.7500 ± 0.0707", "0.9500"}));
  EXPECT_EQ(cells_of(tables, "AUC by method", "published, TUM fr3_loh"), (Cells{"0.8221", ""}));
  EXPECT_EQ(cells_of(tables, "AUC by method, exact search", "hall <1>"),
            (Cells{"0.8500", "0.9500"}));
  EXPECT_EQ(cells_of(tables, "milliseconds a frame by method", "hall <1>"),
            (Cells{"12.50 ± 0.00", "12.50"}));
  const char* alone = "loops right/wrong, by recognition alone";
  EXPECT_EQ(cells_of(tables, alone, "hall <1>"), (Cells{"4.0 ± 0.0 / 1.0 ± 0.0", "6/0"}));
  EXPECT_EQ(cells_of(tables, alone, "all, first seed"),
            (Cells{"1 of 5 false (20.0 %)", "0 of 6 false, at most 50.0 % at 95 %"}));
}

TEST(PaperTables, SlamHasLoopsErrorsAndRates) {
  const auto tables = make_tables(made_up_results(), kAll);
  EXPECT_EQ(cells_of(tables, "loops right/wrong in SLAM", "hall <1>"),
            (Cells{"3.0 ± 0.0 / 2.0 ± 0.0", "3.0 ± 0.0 / 0.0 ± 0.0"}));
  EXPECT_EQ(cells_of(tables, "loops right/wrong in SLAM", "published, Bicocca Indoor"),
            (Cells{"25/16", ""}))
      << "ORB-SLAM2 closes loops by bag of words";
  EXPECT_EQ(cells_of(tables, "absolute trajectory error, m", "hall <1>, bag of words"),
            (Cells{"6.0000 ± 2.8284", "0.0100 ± 0.0000", "2.7000 ± 1.2728", "3.0000 ± 1.4142",
                   "95.0 ± 0.0"}));
  EXPECT_EQ(cells_of(tables, "frames per second", "hall <1>"), (Cells{"40.0 ± 0.0", "40.0 ± 0.0"}));
}

TEST(PaperTables, WithoutARowThereIsNoTable) {
  Results results = made_up_results();
  results.slam.clear();
  EXPECT_EQ(make_tables(results, {7, 8}).size(), 0u) << "published figures alone are no table";
}

TEST(PaperTables, ATableThatIsUnknownIsNamed) {
  EXPECT_EQ(parse_table_numbers("2,3"), (PaperTableNumbers{2, 3}));
  EXPECT_EQ(parse_table_numbers("7,2-4"), (PaperTableNumbers{2, 3, 4, 7}));
  for (const char* list : {"9", "1", "2,", "", "2;3", "two", "2,33", "4-2", "2-9"})
    EXPECT_THROW(parse_table_numbers(list), core::InputError) << list;
}

TEST(PaperCells, AZeroComesWithItsBound) {
  EXPECT_EQ(mean_cell({}, 2), "-");
  EXPECT_EQ(mean_cell({0.5}, 2), "0.50");
  EXPECT_EQ(mean_cell({1.0, 3.0}, 1), "2.0 ± 1.4");
  EXPECT_EQ(false_share(0, 0), "no loop");
  EXPECT_EQ(false_share(0, 2), "0 of 2 false, at most 100.0 % at 95 %");
}

TEST(PaperResults, EveryRowIsInTheFiles) {
  const Results results = made_up_results();
  const auto num_lines = [](const std::string& csv) {
    return std::count(csv.begin(), csv.end(), '\n');
  };
  EXPECT_EQ(num_lines(recognition_csv(results)), 1 + 4);
  EXPECT_THAT(recognition_csv(results),
              HasSubstr("hall <1>,7,paper,sampled,50,1,20,8,0.800000,0.500000,1.000000,0.750000,4,"
                        "1,1,0,12.500000,"));
  EXPECT_EQ(num_lines(slam_csv(results)), 1 + 4);
  const nlohmann::json json = results_json(results);
  EXPECT_EQ(json.at("recognition").size(), 4u);
  EXPECT_EQ(json.at("published").at("sequences").size(), 3u);
  EXPECT_EQ(json.at("published").at("sequences").at(0).at("auc_by_method").at("gem"), .8103);
}

TEST(PaperResults, RowsComeBackFromTheirFiles) {
  for (const RecognitionRow& row : made_up_results().recognition) {
    const nlohmann::json json = row;
    EXPECT_EQ(nlohmann::json(json.get<RecognitionRow>()), json);
  }
  for (const SlamRow& row : made_up_results().slam) {
    const nlohmann::json json = row;
    EXPECT_EQ(nlohmann::json(json.get<SlamRow>()), json);
  }
  SlamRow lost = made_up_slam("off", 0, 1.0);
  lost.ate_m.reset();
  EXPECT_FALSE(nlohmann::json(lost).get<SlamRow>().ate_m.has_value());
}

TEST(PaperPage, HoldsTablesFiguresAndWhatIsMissing) {
  const Results results = made_up_results();
  const std::string page =
      page_html(results, make_tables(results, kAll), {{"Figure 3: curves", "<svg/>"}}, "bench <x>");
  EXPECT_THAT(page, HasSubstr("<h2>Table 2: AUC by number of draws</h2>"));
  EXPECT_THAT(page, HasSubstr("<th class=\"published\">published, Lip6 Indoor</th>"));
  EXPECT_THAT(page, HasSubstr("<td class=\"published\">0.8321</td>"));
  EXPECT_THAT(page, HasSubstr("<td><b>0.9500</b></td>")) << "the best of a sequence is bold";
  EXPECT_THAT(page, Not(HasSubstr("<b>0.7500")));
  EXPECT_THAT(page, HasSubstr("hall &lt;1&gt;"));
  EXPECT_THAT(page, Not(HasSubstr("hall <1>")));
  EXPECT_THAT(page, HasSubstr("bench &lt;x&gt;"));
  EXPECT_THAT(page, HasSubstr("data:image/svg+xml;base64,PHN2Zy8+"));
  EXPECT_THAT(page, HasSubstr("<li>gem: no file</li>"));
}

}  // namespace
}  // namespace samewhere::paper
