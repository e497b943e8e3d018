#include <algorithm>
#include <cmath>
#include <regex>
#include <stack>

#include <gtest/gtest.h>

#include <samewhere/report/html.hpp>
#include <samewhere/report/html_text.hpp>
#include <samewhere/report/pair_figure.hpp>
#include <samewhere/report/pairs.hpp>
#include <samewhere/report/plan_view.hpp>
#include <samewhere/report/status_strip.hpp>
#include <samewhere/report/test_record.hpp>
#include <samewhere/report/trajectory_figure.hpp>

namespace samewhere::report {
namespace {

int count_of(const std::string& text, const std::string& part) {
  int count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
    ++count;
  return count;
}

// Every tag that is opened is closed, in the right order.
testing::AssertionResult is_well_nested(const std::string& html) {
  const std::regex tag("<(/?)([a-z][a-z0-9]*)[^>]*?(/?)>");
  std::stack<std::string> open;
  for (std::sregex_iterator it(html.begin(), html.end(), tag), end; it != end; ++it) {
    const std::string name = (*it)[2];
    if (name == "meta" || name == "img" || (*it)[3] == "/") continue;
    if ((*it)[1] != "/") {
      open.push(name);
    } else if (open.empty() || open.top() != name) {
      return testing::AssertionFailure() << "</" << name << "> closes nothing";
    } else {
      open.pop();
    }
  }
  if (open.empty()) return testing::AssertionSuccess();
  return testing::AssertionFailure() << "<" << open.top() << "> is never closed";
}

// Without the pictures, which are long.
std::string without_pictures(const std::string& html) {
  std::string text;
  for (std::size_t at = 0; at < html.size();) {
    const std::size_t start = html.find("data:image", at);
    text += html.substr(at, start - at);
    if (start == std::string::npos) break;
    at = html.find('"', start);
  }
  return text;
}

TEST(Html, WithUnknownScaleThereIsNoScaleBar) {
  RunRecord record = sample_record();
  EXPECT_NE(report_html(record).find("class=\"bar\""), std::string::npos);
  record.is_scale_unknown = true;
  const std::string html = report_html(record);
  EXPECT_EQ(html.find("class=\"bar\""), std::string::npos);
  EXPECT_NE(html.find("Scale unknown"), std::string::npos);
}

TEST(ReportHtml, IsWellNestedAndNeedsNothingFromOutside) {
  const std::string html = without_pictures(report_html(sample_record()));
  EXPECT_TRUE(html.starts_with("<!DOCTYPE html>"));
  EXPECT_TRUE(is_well_nested(html));
  for (const char* outside : {"http:", "https:", "url(", "@import", "<script", "<link"})
    EXPECT_EQ(html.find(outside), std::string::npos) << outside;
}

TEST(ReportHtml, ShowsWhatTheRunFound) {
  const std::string html = report_html(sample_record());
  for (const char* part :
       {"Round the corridor", "0.042 m", "312 with a measured pose", "3 accepted", "31 rejected",
        "1 ambiguous", "<b>20</b> of 35 rejected", "class=\"truth\"", "class=\"odometry\"",
        "a corridor that looks the same", "corridor_305.png", "min_inliers: 30"})
    EXPECT_NE(html.find(part), std::string::npos) << part;
  EXPECT_EQ(count_of(html, "<figure class=\"pair\">"), 3 + 12);
  EXPECT_EQ(count_of(html, "<img src=\"data:image/jpeg;base64,"), 2 * (3 + 12));
  EXPECT_EQ(count_of(html, "<g class=\"loop\">"), 3);
  EXPECT_NE(html.find("20 more in loops.json"), std::string::npos);
}

TEST(ReportHtml, IsTheSameForTheSameRunHoweverLongItTook) {
  RunRecord slow = sample_record();
  slow.timings.add("track", 1e6);
  EXPECT_EQ(report_html(sample_record()), report_html(slow));
}

TEST(ReportHtml, EscapesEveryNameAndReason) {
  RunRecord record = sample_record();
  const std::string hostile = "<b onclick='x'>&\"";
  record.title = record.source = record.config_yaml = hostile;
  record.figures = {{hostile, hostile}};
  for (FrameRecord& frame : record.frames) frame.name = hostile;
  std::get<core::Ambiguous>(record.ledger.back().verdict).reason = hostile;
  const std::string html = without_pictures(report_html(record));
  EXPECT_EQ(html.find("<b onclick"), std::string::npos);
  EXPECT_EQ(html.find("'x'"), std::string::npos);
  EXPECT_TRUE(is_well_nested(html));
  EXPECT_EQ(escaped(hostile), "&lt;b onclick=&#39;x&#39;&gt;&amp;&quot;");
}

TEST(ReportHtml, OfARunThatSawNothingIsStillAPage) {
  const std::string html = report_html({});
  EXPECT_TRUE(is_well_nested(html));
  EXPECT_NE(html.find("No loop candidates"), std::string::npos);
  EXPECT_EQ(html.find("<section>"), std::string::npos);
}

TEST(ReportHtml, OfOneFrameWithoutTruthOrLoops) {
  RunRecord record;
  record.title = "one frame";
  record.frames = {frame_record(0, core::Rigid3{})};
  const std::string html = report_html(record);
  EXPECT_TRUE(is_well_nested(html));
  EXPECT_NE(html.find("1 frame, 1 with a measured pose"), std::string::npos);
  EXPECT_EQ(html.find("nan"), std::string::npos);
  EXPECT_EQ(html.find("class=\"truth\""), std::string::npos);
  EXPECT_EQ(html.find("class=\"odometry\""), std::string::npos);
}

TEST(ReportHtml, SaysWhenNoPoseWasMeasuredOrTheRunWasInterrupted) {
  RunRecord record;
  record.frames = {frame_record(7, std::nullopt)};
  EXPECT_NE(report_html(record).find("No pose was measured"), std::string::npos);
  EXPECT_EQ(report_html(record).find("was interrupted"), std::string::npos);
  record.is_interrupted = true;
  EXPECT_NE(report_html(record).find("was interrupted"), std::string::npos);
}

TEST(ReportHtml, CapsTheAcceptedPairsAndSaysSo) {
  RunRecord record;
  for (int i = 0; i < 315; ++i)
    record.ledger.push_back(loop_row(candidate(i, 100 + i, i, 0.8), 40));
  const std::string html = report_html(record);
  EXPECT_EQ(count_of(html, "<figure class=\"pair\">"), 300);
  EXPECT_NE(html.find("15 more in loops.json"), std::string::npos);
}

TEST(TrajectoryFigure, BreaksThePathWhereNothingWasMeasured) {
  const RunRecord record = sample_record();
  EXPECT_EQ(count_of(trajectory_figure(record), "<polyline class=\"path\""), 2);
}

TEST(TrajectoryFigure, LeavesOutPosesThatAreNotFinite) {
  RunRecord record = sample_record();
  record.frames[10].world_from_camera->translation.x() = std::nan("");
  record.odometry[10].world_from_camera.translation.y() = INFINITY;
  const std::string figure = trajectory_figure(record);
  EXPECT_EQ(figure.find("nan"), std::string::npos);
  EXPECT_EQ(figure.find("inf"), std::string::npos);
}

std::vector<core::Rigid3> left_turn(const core::Rigid3& other_from_world) {
  std::vector<core::Rigid3> poses;
  for (int i = 0; i < 140; ++i) poses.push_back(other_from_world * corridor_pose(0.2 * i));
  return poses;
}

TEST(PlanView, IsNeverMirroredWhateverTheWorld) {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    core::Random random(seed);
    core::Vector6d tangent;
    for (double& value : tangent) value = 2.0 * random.gaussian();
    const std::vector<core::Rigid3> poses = left_turn(core::exp_r3so3(tangent));
    const PlanView view = plan_view_of(poses);
    EXPECT_TRUE(view.is_from_above);
    const Eigen::Vector2d first = seen(view, poses.front().translation);
    const Eigen::Vector2d corner = seen(view, poses[100].translation);
    const Eigen::Vector2d last = seen(view, poses.back().translation);
    const Eigen::Vector2d before = corner - first;
    const Eigen::Vector2d after = last - corner;
    EXPECT_NEAR(before.norm(), 20.0, 1e-6);
    EXPECT_NEAR(after.norm(), 7.8, 1e-6);
    EXPECT_GT(before.x() * after.y() - before.y() * after.x(), 0.0) << "not a left turn";
  }
}

TEST(PlanView, OfACameraThatStandsStillOrMovesUprightIsDecided) {
  EXPECT_TRUE(seen(plan_view_of({core::Rigid3{}}), Eigen::Vector3d::Zero()).allFinite());
  std::vector<core::Rigid3> lift;
  for (int i = 0; i < 10; ++i)
    lift.push_back({Eigen::Quaterniond::Identity(), {0.1 * (i % 3), 1.0 * i, 0.0}});
  EXPECT_FALSE(plan_view_of(lift).is_from_above);
}

TEST(StatusStrip, DrawsARectangleForEachRunOfAState) {
  const std::string strip = status_strip(sample_record().frames);
  EXPECT_EQ(count_of(strip, "<rect"), 7);
  EXPECT_NE(strip.find("lost: frames 150 to 157"), std::string::npos);
  EXPECT_NE(strip.find("tracking 291"), std::string::npos);
  EXPECT_EQ(status_strip({}), "");
}

TEST(RejectedRows, ComeMostInliersFirst) {
  const core::Ledger ledger = sample_ledger();
  const auto rows = rejected_rows(ledger);
  ASSERT_EQ(rows.size(), 32u);
  EXPECT_EQ(rows[0]->candidate.query, core::FrameId(301));  // 71 inliers
  EXPECT_EQ(rows[1]->candidate.query, core::FrameId(300));  // 44, ambiguous
  EXPECT_EQ(rows[2]->candidate.query, core::FrameId(293));
  EXPECT_EQ(rows.back()->candidate.query, core::FrameId(270));
}

TEST(PairSvg, ShowsBothViewsMatchesAndReason) {
  const RunRecord record = sample_record();
  const core::LedgerRow& row = *rejected_rows(record.ledger)[0];
  PairRecord pair{row,
                  {record.thumbnails.at(row.candidate.query), {640, 480}},
                  {record.thumbnails.at(row.candidate.match), {320, 240}},
                  {{{0.0F, 0.0F}, {300.0F, 200.0F}}, {{10.0F, 20.0F}, {30.0F, 40.0F}}}};
  const std::string svg = without_pictures(pair_svg(pair));
  EXPECT_TRUE(is_well_nested(svg));
  EXPECT_EQ(count_of(svg, "<image"), 2);
  const std::size_t path = svg.find("<path");
  EXPECT_EQ(count_of(svg.substr(path, svg.find("stroke=\"#", path) - path), "L"), 2)
      << "a line for each match";
  EXPECT_EQ(count_of(svg, "<text"), 6) << "two numbers, verdict, scores, a reason in two lines";
  EXPECT_NE(svg.find("M0.0 0.0L779.0 250.0"), std::string::npos) << "each view at its own scale";
  EXPECT_NE(svg.find("rejected: odometry"), std::string::npos);
  EXPECT_NE(svg.find("9.8 m"), std::string::npos);
}

TEST(PairCards, DoWithoutAThumbnail) {
  RunRecord record;
  record.ledger = {loop_row(candidate(0, 9, 1, 0.8), 40)};
  const std::string html = pair_cards(record, accepted_rows(record.ledger), 10);
  EXPECT_EQ(html.find("<img"), std::string::npos);
  EXPECT_EQ(count_of(html, "view missing"), 2);
}

}  // namespace
}  // namespace samewhere::report
