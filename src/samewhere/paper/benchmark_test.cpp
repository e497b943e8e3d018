#include <filesystem>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>
#include <samewhere/core/random.hpp>
#include <samewhere/input/test_folder.hpp>
#include <samewhere/paper/benchmark.hpp>

namespace samewhere::paper {
namespace {

class PaperBenchmark : public testing::Test {
 protected:
  // Two laps past three walls.
  PaperBenchmark() {
    for (int frame = 0; frame < 6; ++frame)
      folder_.write_png("walk/" + std::to_string(frame) + ".png", wall(frame % 3));
    folder_.write("walk/same_place.txt",
                  "1 0 0 0 0 0\n0 1 0 0 0 0\n0 0 1 0 0 0\n1 0 0 1 0 0\n0 1 0 0 1 0\n0 0 1 0 0 1\n");
  }

  static cv::Mat wall(int number) {
    core::Random random(static_cast<std::uint64_t>(number));
    cv::Mat image(120, 160, CV_8U);
    for (int i = 0; i < image.rows * image.cols; ++i)
      image.at<unsigned char>(i / 160, i % 160) = static_cast<unsigned char>(random.index(256));
    return image;
  }

  BenchmarkPlan plan() const {
    return {.config = pipeline::profile("paper"),
            .sources = {(folder_.root() / "walk").string() + "@2"},
            .methods = {"hog", "ours"},
            .needs_all_sources = true,
            .needs_all_methods = true,
            .tables = {2, 4},
            .searches = {.num_draws = {10, 50}, .num_seeds = 2},
            .num_slam_runs = 1};
  }
  std::filesystem::path rows() const { return folder_.root() / "rows"; }

  Results run(const BenchmarkPlan& plan) const {
    Results results;
    EXPECT_TRUE(run_benchmark(plan, RowStore(rows()), results, [](const Results&) {}));
    return results;
  }

  input::TestFolder folder_;
};

double auc_of(const Results& results, const std::string& method, SearchKind search) {
  for (const RecognitionRow& row : results.recognition) {
    if (row.method == method && row.search == search) return row.result.auc;
  }
  ADD_FAILURE() << method;
  return 0.0;
}

TEST_F(PaperBenchmark, MeasuresEachMethodOnEachSequence) {
  const Results results = run(plan());
  EXPECT_EQ(results.recordings, std::vector<std::string>{"walk"});
  EXPECT_EQ(results.recognition.size(), 2u + 2u + 1u) << "two seeds, all, exact; ours";
  EXPECT_EQ(auc_of(results, "hog", SearchKind::kExact), 1.0);
  EXPECT_TRUE(std::filesystem::exists(rows() / "walk-2.hog.json"));
  EXPECT_TRUE(std::filesystem::exists(rows() / "walk-2.ours.json"));
}

TEST_F(PaperBenchmark, WhatWasMeasuredIsNotMeasuredAgain) {
  run(plan());
  // a figure that no measurement gives
  const std::filesystem::path file = rows() / "walk-2.hog.json";
  nlohmann::json kept = nlohmann::json::parse(core::read_file(file));
  for (nlohmann::json& row : kept.at("rows")) row["result"]["auc"] = 0.25;
  core::write_file(file, kept.dump());
  EXPECT_EQ(auc_of(run(plan()), "hog", SearchKind::kExact), 0.25);
  BenchmarkPlan more = plan();
  more.searches.num_seeds = 3;
  EXPECT_EQ(auc_of(run(more), "hog", SearchKind::kExact), 1.0) << "with other settings it is";
  core::write_file(file, "{\"rows\": 3");
  EXPECT_EQ(auc_of(run(plan()), "hog", SearchKind::kExact), 1.0) << "a cut file is measured again";
}

TEST_F(PaperBenchmark, WhatCannotBeUsedIsAnErrorOrAMissingRow) {
  BenchmarkPlan bad = plan();
  bad.methods = {"hog", "/nowhere/net.onnx"};
  EXPECT_THROW(check_plan(bad), core::InputError);
  bad.needs_all_methods = false;
  EXPECT_NO_THROW(check_plan(bad));
  const Results results = run(bad);
  ASSERT_EQ(results.missing.size(), 1u);
  EXPECT_EQ(results.missing.front().method, "/nowhere/net.onnx");
  EXPECT_EQ(auc_of(results, "hog", SearchKind::kExact), 1.0);
}

TEST_F(PaperBenchmark, APlanIsCheckedBeforeAnyWork) {
  BenchmarkPlan twice = plan();
  twice.sources.push_back(twice.sources.front());
  EXPECT_THROW(check_plan(twice), core::InputError);
  BenchmarkPlan same_method = plan();
  same_method.methods = {"hog", "hog"};
  EXPECT_THROW(check_plan(same_method), core::InputError);
  std::filesystem::remove(folder_.root() / "walk/same_place.txt");
  EXPECT_THROW(check_plan(plan()), core::InputError);
}

TEST_F(PaperBenchmark, SlamNeedsACalibration) {
  BenchmarkPlan slam = plan();
  slam.tables = {7};
  const Results results = run(slam);
  ASSERT_EQ(results.missing.size(), 1u);
  EXPECT_EQ(results.missing.front().reason, "no calibration");
}

}  // namespace
}  // namespace samewhere::paper
