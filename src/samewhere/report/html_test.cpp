#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <samewhere/core/errors.hpp>
#include <samewhere/report/html.hpp>
#include <samewhere/report/html_text.hpp>
#include <samewhere/report/page_data.hpp>
#include <samewhere/report/page_points.hpp>
#include <samewhere/report/page_template.hpp>
#include <samewhere/report/pair_figure.hpp>
#include <samewhere/report/pairs.hpp>
#include <samewhere/report/plan_view.hpp>
#include <samewhere/report/test_record.hpp>
#include <samewhere/report/upright.hpp>

namespace samewhere::report {
namespace {

using nlohmann::json;

int count_of(const std::string& text, const std::string& part) {
  int count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
    ++count;
  return count;
}

// The content of a block of the page.
std::string block(const std::string& html, const std::string& id) {
  const std::string begin = "<script type=\"application/json\" id=\"" + id + "\">";
  const std::size_t at = html.find(begin);
  if (at == std::string::npos) return "";
  const std::size_t from = at + begin.size();
  return html.substr(from, html.find("</script>", from) - from);
}

std::size_t num_bytes(const json& packed) {
  const std::string text = packed.at("base64");
  return text.size() / 4 * 3 - static_cast<std::size_t>(std::count(text.begin(), text.end(), '='));
}

TEST(ReportHtml, HoldsItsLibrariesAndAsksForNothingFromOutside) {
  const std::string html(page_template());
  EXPECT_TRUE(html.starts_with("<!DOCTYPE html>"));
  EXPECT_NE(html.find("default-src 'none'"), std::string::npos) << "the browser blocks requests";
  EXPECT_NE(html.find("WebGLRenderer"), std::string::npos);
  EXPECT_NE(html.find("Chart.js"), std::string::npos);
  for (const char* outside :
       {"<script src", "<img src=\"http", "@import", "url(http", "<!-- include"})
    EXPECT_EQ(html.find(outside), std::string::npos) << outside;
  EXPECT_EQ(count_of(html, "<script"), count_of(html, "</script>"));
}

TEST(ReportHtml, TakesADenseCloudAndLosesNothing) {
  const std::string before = report_html(sample_record());
  const std::vector<ColouredPoint> cloud(500, {{1.0F, 2.0F, 3.0F}, {10, 20, 30}});
  const std::string after = with_dense_cloud(with_dense_cloud(before, {}), cloud);
  json run = json::parse(block(after, "run"));
  EXPECT_EQ(run.at("dense").at("num_in_map"), 500);
  run.erase("dense");
  EXPECT_EQ(run, json::parse(block(before, "run")));
  EXPECT_EQ(block(after, "pictures"), block(before, "pictures"));
  EXPECT_EQ(block(after, "durations"), block(before, "durations"));
  EXPECT_THROW(with_dense_cloud("<html></html>", cloud), core::InputError);
}

TEST(ReportHtml, HoldsWhatTheRunFound) {
  const json run = json::parse(block(report_html(sample_record()), "run"));
  EXPECT_EQ(run.at("title"), "Round the corridor");
  EXPECT_EQ(run.at("figures").at(1).at("value"), "0.042 m");
  EXPECT_EQ(run.at("frames").at("num"), 320);
  EXPECT_EQ(num_bytes(run.at("frames").at("positions")), 320U * 3 * sizeof(float));
  EXPECT_EQ(num_bytes(run.at("frames").at("rotations")), 320U * 4 * 2);
  EXPECT_EQ(num_bytes(run.at("truth").at("stamps_s")), 320U * 4);
  EXPECT_EQ(run.at("candidates").size(), 35U);
  EXPECT_EQ(run.at("checks").at(0).at("num_rejected"), 20);
  EXPECT_EQ(run.at("config_yaml"), "verify:\n  min_inliers: 30\n");
}

TEST(ReportHtml, HoldsTheCandidatesAsLoopsJsonAndTheirEarlierVerdicts) {
  const json run = json::parse(page_run_json(sample_record()));
  int num_accepted = 0;
  for (const json& candidate : run.at("candidates")) {
    num_accepted += candidate.at("verdict") == "LOOP" ? 1 : 0;
    EXPECT_EQ(candidate.contains("earlier"), candidate.at("verdict") == "AMBIGUOUS");
  }
  EXPECT_EQ(num_accepted, 3);
  const json& undecided = run.at("candidates").at(30);
  EXPECT_EQ(undecided.at("query"), 300);
  EXPECT_EQ(undecided.at("earlier").at(0).at("reason"), "too narrow");
  EXPECT_EQ(undecided.at("scores").at("num_inliers"), 44);
}

TEST(ReportHtml, HoldsMatchesAsSharesOfTheImagesThresholdsAndCovariances) {
  RunRecord record = sample_record();
  record.matches[core::CandidateId(31)] = {{{0.0F, 0.5F}, {1.0F, 2.0F}, true}, {}};
  record.limits = {{"num_inliers", "verify.min_inliers", true, 30.0}};
  record.covariances = {{core::FrameId(9), 0.25 * Eigen::Matrix3d::Identity()}};
  const json run = json::parse(page_run_json(record));
  const json& matches = run.at("candidates").at(31).at("matches");
  EXPECT_EQ(matches.at("shares").at("base64"), "AAAAgP////8AAAAAAAAAAA==")
      << "0, 32768, 65535, 65535 at most, then zeros";
  EXPECT_EQ(matches.at("are_inliers").at("base64"), "AQA=");
  EXPECT_EQ(run.at("limits").at(0).at("value"), 30.0);
  EXPECT_EQ(num_bytes(run.at("covariances").at("matrices")), 6 * sizeof(float));
}

TEST(ReportHtml, HoldsThePicturesOfCandidatesFirstAndStaysSmall) {
  RunRecord record = sample_record();
  const std::size_t num_of_candidates = record.thumbnails.size();
  EXPECT_EQ(json::parse(page_pictures_json(record)).size(), num_of_candidates);
  for (int i = 0; i < 300; ++i)
    record.thumbnails.try_emplace(core::FrameId(static_cast<std::uint64_t>(i)),
                                  std::string(100'000, 'x'));
  const std::string pictures = page_pictures_json(record);
  EXPECT_LT(pictures.size(), kMaxPagePictures_bytes / 3 * 4 + 100'000);
  EXPECT_GT(json::parse(pictures).size(), num_of_candidates + 30);
}

TEST(ReportHtml, IsTheSameForTheSameRunButForItsLastBlock) {
  RunRecord slow = sample_record();
  slow.timings.add("track", 1e6);
  const std::string first = report_html(sample_record());
  const std::string second = report_html(slow);
  EXPECT_EQ(first, report_html(sample_record()));
  EXPECT_NE(first, second);
  EXPECT_EQ(without_durations(first), without_durations(second));
  EXPECT_GT(without_durations(first).size(), first.size() - 1000);
}

TEST(ReportHtml, HoldsNoTextThatWouldEndItsBlock) {
  RunRecord record = sample_record();
  const std::string hostile = "</script><b onclick='x'>&\"{{pictures}}";
  record.title = record.source = record.config_yaml = hostile;
  record.figures = {{hostile, hostile}};
  for (FrameRecord& frame : record.frames) frame.name = hostile;
  std::get<core::Ambiguous>(record.ledger.back().verdict).reason = hostile;
  const std::string html = report_html(record);
  EXPECT_EQ(html.find("<b onclick"), std::string::npos);
  const json run = json::parse(block(html, "run"));
  EXPECT_EQ(run.at("frames").at("names").at(3), hostile);
  EXPECT_EQ(escaped(hostile).find('<'), std::string::npos);
  EXPECT_EQ(json::parse(block(html, "pictures")).size(), record.thumbnails.size());
}

TEST(ReportHtml, OfARunThatSawNothingIsStillAPage) {
  const json run = json::parse(block(report_html({}), "run"));
  EXPECT_EQ(run.at("frames").at("num"), 0);
  EXPECT_EQ(run.at("num_candidates"), 0);
}

TEST(ReportHtml, HoldsPosesThatAreNotFiniteAsMissing) {
  RunRecord record = sample_record();
  const std::string clean = page_run_json(record);
  record.frames[10].world_from_camera = std::nullopt;
  const std::string missing = page_run_json(record);
  record.frames[10].world_from_camera =
      core::Rigid3{Eigen::Quaterniond::Identity(), {std::nan(""), 0, 0}};
  EXPECT_EQ(page_run_json(record), missing);
  EXPECT_NE(clean, missing);
}

TEST(PagePoints, AreWithinAStepOfWhereTheyAreAndOutliersAreLeftOut) {
  std::vector<ColouredPoint> points(1000);
  for (int i = 0; i < 1000; ++i)
    points[static_cast<std::size_t>(i)].in_world.x() = 0.01F * float(i);
  points[5].in_world.x() = 1e6F;
  points[6].in_world.y() = std::nanf("");
  const json packed = page_points(points, 5000);
  EXPECT_EQ(packed.at("num_in_map"), 1000);
  EXPECT_EQ(num_bytes(packed.at("colours")), 998U * 3);
  EXPECT_LT(packed.at("positions").at("step").at(0).get<double>(), 0.0003);
  EXPECT_EQ(num_bytes(page_points(points, 300).at("colours")), 250U * 3) << "every fourth";
  EXPECT_EQ(num_bytes(page_points({}, 300).at("colours")), 0U);
}

TEST(Upright, IsFoundInAnyWorldThoughTheCameraLooksDown) {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    core::Random random(seed);
    core::Vector6d tangent;
    for (double& value : tangent) value = 2.0 * random.gaussian();
    const core::Rigid3 other_from_world = core::exp_r3so3(tangent);
    const core::Rigid3 looking_down{core::exp_so3({-0.6, 0.0, 0.0}), Eigen::Vector3d::Zero()};
    std::vector<core::Rigid3> poses;
    for (int i = 0; i < 140; ++i)
      poses.push_back(other_from_world * corridor_pose(0.2 * i) * looking_down);
    const Upright upright = upright_of(poses);
    const Eigen::Vector3d up = other_from_world.rotation * -Eigen::Vector3d::UnitY();
    EXPECT_GT(upright.up.dot(up), 0.9999);
    EXPECT_NEAR(upright.right.dot(upright.up), 0.0, 1e-9);
    EXPECT_NEAR(upright.right.norm(), 1.0, 1e-9);
  }
}

TEST(Upright, OfACameraThatStandsStillOrNeverTurnsIsDecided) {
  EXPECT_TRUE(upright_of({}).up.allFinite());
  const Upright still = upright_of({core::Rigid3{}});
  EXPECT_NEAR(still.up.dot(-Eigen::Vector3d::UnitY()), 1.0, 1e-9);
  EXPECT_NEAR(still.right.dot(still.up), 0.0, 1e-9);
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
  const std::string svg = pair_svg(pair);
  EXPECT_EQ(count_of(svg, "<image"), 2);
  const std::size_t path = svg.find("<path");
  EXPECT_EQ(count_of(svg.substr(path, svg.find("stroke=\"#", path) - path), "L"), 2)
      << "a line for each match";
  EXPECT_EQ(count_of(svg, "<text"), 6) << "two numbers, verdict, scores, a reason in two lines";
  EXPECT_NE(svg.find("M0.0 0.0L779.0 250.0"), std::string::npos) << "each view at its own scale";
  EXPECT_NE(svg.find("rejected: odometry"), std::string::npos);
  EXPECT_NE(svg.find("9.8 m"), std::string::npos);
}

}  // namespace
}  // namespace samewhere::report
