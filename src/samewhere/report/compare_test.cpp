#include <algorithm>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <samewhere/core/errors.hpp>
#include <samewhere/report/compare.hpp>
#include <samewhere/report/html.hpp>
#include <samewhere/report/page_template.hpp>
#include <samewhere/report/test_record.hpp>

namespace samewhere::report {
namespace {

ComparedRun run_with(const std::string& name, std::vector<JudgedPair> candidates) {
  ComparedRun run;
  run.name = name;
  run.source = "walk";
  run.candidates = std::move(candidates);
  return run;
}

std::string complaint_of(const std::string& html) {
  try {
    read_report_html(html, "a", "a/report.html");
  } catch (const core::InputError& error) {
    return error.what();
  }
  return "";
}

TEST(ReadReportHtml, GivesWhatTheReportOfARunHolds) {
  RunRecord record = sample_record();
  const auto accepted =
      std::find_if(record.ledger.begin(), record.ledger.end(),
                   [](const core::LedgerRow& row) { return core::is_loop(row.verdict); });
  ASSERT_NE(accepted, record.ledger.end());
  record.false_loops.insert(accepted->candidate.id);
  const ComparedRun run = read_report_html(report_html(record), "monday", "report.html");
  EXPECT_EQ(run.name, "monday");
  EXPECT_EQ(run.source, record.source);
  ASSERT_EQ(run.figures.size(), record.figures.size());
  EXPECT_EQ(run.figures.at(1).value, record.figures.at(1).value);
  int num_false = 0;
  for (const JudgedPair& pair : run.candidates) num_false += pair.is_false ? 1 : 0;
  EXPECT_EQ(num_false, 1);
}

TEST(ReadReportHtml, RefusesOtherPagesAndCutOnesWithOneLine) {
  EXPECT_EQ(complaint_of("<html></html>"),
            "a/report.html: has no block `run`; expected the report.html of a run");
  const std::string page = report_html(sample_record());
  EXPECT_NE(complaint_of(page.substr(0, page.rfind("</script>"))), "");
  std::string newer = page;
  const std::string version = "{\"version\":1,";
  newer.replace(newer.rfind(version), version.size(), "{\"version\":9,");
  EXPECT_EQ(complaint_of(newer),
            "a/report.html: version 9 of the report page; expected 1: run it again with this "
            "program");
  std::string damaged = page;
  damaged.replace(damaged.rfind(version), version.size(), "{\"version\" 1,");
  EXPECT_NE(complaint_of(damaged).find("is damaged"), std::string::npos);
  EXPECT_EQ(complaint_of(damaged).find('\n'), std::string::npos);
}

TEST(JudgedElsewhere, CountsVerdictsOnTheSameViews) {
  const std::vector<ComparedRun> runs = {run_with("a", {{100, 10, "accepted", true},
                                                        {200, 20, "accepted", true},
                                                        {300, 30, "accepted", true},
                                                        {400, 40, "accepted", false}}),
                                         run_with("b", {{103, 12, "rejected: odometry", false},
                                                        {101, 10, "ambiguous: evidence", false},
                                                        {200, 45, "accepted", false},
                                                        {310, 20, "rejected: odometry", false},
                                                        {400, 40, "rejected: inliers", false}})};
  const std::vector<JudgedElsewhere> judged = judged_elsewhere(runs);
  ASSERT_EQ(judged.size(), 1U) << "b accepted nothing false";
  EXPECT_EQ(judged.front().accepted_by, 0U);
  const std::vector<std::pair<std::string, int>> expected = {
      {"ambiguous: evidence", 1}, {"no candidate", 1}, {"rejected: odometry", 1}};
  EXPECT_EQ(judged.front().verdicts, expected)
      << "the nearest counts; a match more than 10 frames away is another place";
}

TEST(JudgedElsewhere, LeavesOutRunsOfAnotherRecording) {
  std::vector<ComparedRun> runs = {run_with("a", {{100, 10, "accepted", true}}),
                                   run_with("b", {{100, 10, "rejected: odometry", false}})};
  runs.back().source = "another walk";
  EXPECT_TRUE(judged_elsewhere(runs).empty());
}

TEST(MetricsOf, HasARowPerNameAndADashWhereARunLacksIt) {
  std::vector<ComparedRun> runs = {run_with("a", {}), run_with("b", {})};
  runs[0].figures = {{"ATE RMSE", "0.1 m", {}}};
  runs[1].figures = {{"scale", "unknown", {}}, {"ATE RMSE", "0.2 m", {}}};
  const Table table = metrics_of(runs);
  EXPECT_EQ(table.header, (std::vector<std::string>{"metric", "a", "b"}));
  ASSERT_EQ(table.rows.size(), 2U);
  EXPECT_EQ(table.rows[0], (std::vector<std::string>{"ATE RMSE", "0.1 m", "0.2 m"}));
  EXPECT_EQ(table.rows[1], (std::vector<std::string>{"scale", "-", "unknown"}));
}

TEST(CompareHtml, HoldsEachRunAndAsksForNothingFromOutside) {
  const std::string page = report_html(sample_record());
  const std::string html =
      compare_html({read_report_html(page, "a </script>", "a"), read_report_html(page, "b", "b")});
  EXPECT_NE(html.find("default-src 'none'"), std::string::npos);
  const std::string begin = "<script type=\"application/json\" id=\"runs\">";
  const std::size_t at = html.rfind(begin) + begin.size();
  const auto runs = nlohmann::json::parse(html.substr(at, html.find("</script>", at) - at));
  ASSERT_EQ(runs.size(), 2U);
  EXPECT_EQ(runs.at(0).at("name"), "a </script>");
  EXPECT_EQ(runs.at(1).at("run").at("title"), sample_record().title);
}

}  // namespace
}  // namespace samewhere::report
