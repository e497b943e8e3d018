// Our figures against the independent Python scorers that lie beside the shared data, where both
// are there.
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <regex>
#include <sstream>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <samewhere/core/file.hpp>
#include <samewhere/core/random.hpp>
#include <samewhere/core/tum_file.hpp>
#include <samewhere/evaluate/precision_recall.hpp>
#include <samewhere/evaluate/tower_walk.hpp>
#include <samewhere/evaluate/trajectory_error.hpp>

namespace samewhere::evaluate {
namespace {

namespace fs = std::filesystem;

// What a shell command prints, or nothing if it fails.
std::optional<std::string> output_of(const std::string& command) {
  FILE* const pipe = popen((command + " 2>/dev/null").c_str(), "r");
  if (pipe == nullptr) return std::nullopt;
  std::string output;
  std::array<char, 4096> buffer{};
  while (const std::size_t count = fread(buffer.data(), 1, buffer.size(), pipe))
    output.append(buffer.data(), count);
  if (pclose(pipe) != 0) return std::nullopt;
  return output;
}

// A Python that has numpy.
std::optional<std::string> python() {
  for (const char* candidate : {"python3", "/usr/bin/python3"})
    if (output_of(std::string(candidate) + " -c 'import numpy'")) return candidate;
  return std::nullopt;
}

class PythonTools : public testing::Test {
 protected:
  void SetUp() override {
    const char* data = std::getenv("SAMEWHERE_DATA");
    if (data == nullptr) GTEST_SKIP() << "SAMEWHERE_DATA is not set";
    data_ = data;
    tools_ = data_ / ".." / "tools";
    for (const char* tool : {"ate.py", "pr.py", "walk.py"})
      if (!fs::exists(tools_ / tool)) GTEST_SKIP() << tool << " is not beside the data";
    const std::optional<std::string> found = python();
    if (!found) GTEST_SKIP() << "no python3 with numpy";
    python_ = *found;
    std::string pattern = (fs::temp_directory_path() / "samewhere_XXXXXX").string();
    ASSERT_NE(mkdtemp(pattern.data()), nullptr);
    folder_ = pattern;
  }

  void TearDown() override {
    if (!folder_.empty()) fs::remove_all(folder_);
  }

  std::string run(const std::string& tool, const std::string& arguments) const {
    const std::optional<std::string> output =
        output_of(fmt::format("{} '{}' {}", python_, (tools_ / tool).string(), arguments));
    EXPECT_TRUE(output) << tool << " " << arguments;
    return output.value_or("");
  }

  fs::path data_, tools_, folder_;
  std::string python_;
};

// The number printed for a key of a Python dict, whatever numpy wraps around it.
double figure(const std::string& dict, const std::string& key) {
  const std::regex pattern("'" + key + R"(': (?:np\.\w+\()?([-+.\w]+))");
  std::smatch found;
  if (std::regex_search(dict, found, pattern)) return std::stod(found[1]);
  ADD_FAILURE() << "no " << key << " in " << dict;
  return 0.0;
}

// Seeded: noisy, some poses missing, in another world and another unit.
core::Trajectory disturbed(const core::Trajectory& truth, std::uint64_t seed) {
  core::Random random(seed);
  const core::Sim3 other{1.7, core::exp_so3({0.3, -1.1, 0.7}), {4.0, -2.0, 1.0}};
  core::Trajectory estimate;
  for (const core::StampedPose& pose : truth) {
    if (random.uniform() < 0.2) continue;
    core::StampedPose moved = pose;
    moved.stamp_s += random.uniform(0.0, 0.01);
    moved.world_from_camera.translation =
        other * pose.world_from_camera.translation +
        0.05 * Eigen::Vector3d(random.gaussian(), random.gaussian(), random.gaussian());
    estimate.push_back(moved);
  }
  return estimate;
}

std::string as_text(const core::Trajectory& trajectory) {
  std::string text;
  for (const core::StampedPose& pose : trajectory) {
    const Eigen::Vector3d& t = pose.world_from_camera.translation;
    text += fmt::format("{} {} {} {} 0 0 0 1\n", pose.stamp_s, t.x(), t.y(), t.z());
  }
  return text;
}

TEST_F(PythonTools, AgreeOnTheTrajectoryError) {
  for (const char* file :
       {"redkitchen/groundtruth.tum", "hololens/groundtruth.tum", "tum_fr1_rpy/groundtruth.txt"}) {
    for (std::uint64_t seed = 0; seed < 3; ++seed) {
      SCOPED_TRACE(testing::Message() << file << " seed " << seed);
      const core::Trajectory truth = core::read_tum(data_ / file);
      const core::Trajectory estimate = disturbed(truth, seed);
      core::write_file(folder_ / "estimate.tum", as_text(estimate));
      for (const auto& [name, alignment] :
           {std::pair{"se3", Alignment::kSe3}, std::pair{"sim3", Alignment::kSim3}}) {
        const std::string theirs =
            run("ate.py", fmt::format("'{}' '{}' {}", (data_ / file).string(),
                                      (folder_ / "estimate.tum").string(), name));
        const std::optional<AteResult> ours = ate(truth, estimate, alignment);
        ASSERT_TRUE(ours);
        EXPECT_EQ(ours->num_poses, figure(theirs, "n"));
        EXPECT_NEAR(ours->rmse_m, figure(theirs, "rmse"), 1e-9);
        EXPECT_NEAR(ours->median_m, figure(theirs, "median"), 1e-9);
        EXPECT_NEAR(ours->max_m, figure(theirs, "max"), 1e-9);
        EXPECT_NEAR(ours->min_m, figure(theirs, "min"), 1e-9);
        EXPECT_NEAR(ours->scale, figure(theirs, "scale"), 1e-9);
      }
    }
  }
}

core::PlaceTruthMatrix read_matrix(const fs::path& path) {
  const std::string bytes = core::read_file(path);
  std::istringstream stream(bytes);
  core::PlaceTruthMatrix matrix;
  if (bytes.starts_with("P5")) {
    std::string magic;
    stream >> magic >> matrix.num_frames;
    const auto size = static_cast<std::size_t>(matrix.num_frames) * matrix.num_frames;
    for (const char value : bytes.substr(bytes.size() - size))
      matrix.values.push_back(static_cast<core::PlaceTruth>(value));
    return matrix;
  }
  for (int value = 0; stream >> value;)
    matrix.values.push_back(static_cast<core::PlaceTruth>(value));
  matrix.num_frames = static_cast<int>(std::lround(std::sqrt(matrix.values.size())));
  return matrix;
}

// One answer for most queries, right more often than chance so that the curve has a shape; scores
// are coarse, so that many are equal.
std::vector<Match> random_matches(const core::PlaceTruthMatrix& truth, std::uint64_t seed) {
  core::Random random(seed);
  std::vector<Match> matches;
  for (int query = 1; query < truth.num_frames; ++query) {
    if (random.uniform() < 0.1) continue;
    const auto older = [&] { return static_cast<int>(random.index(query)); };
    int match = older();
    for (int trial = 0; trial < 30 && truth.at(query, match) != core::PlaceTruth::kSame; ++trial)
      match = older();
    const double bonus = truth.at(query, match) == core::PlaceTruth::kSame ? 0.3 : 0.0;
    matches.push_back({query, match, std::round(50.0 * (bonus + random.uniform())) / 50.0});
  }
  return matches;
}

std::string as_text(const std::vector<Match>& matches) {
  std::string text;
  for (const Match& row : matches)
    text += fmt::format("{} {} {}\n", row.query, row.match, row.score);
  return text;
}

TEST_F(PythonTools, AgreeOnPrecisionAndRecall) {
  for (const auto& [file, window_frames] :
       {std::pair{"redkitchen/same_place.pgm", 149}, std::pair{"hololens/same_place.pgm", 60},
        std::pair{"rtabmap_corridor/same_place.txt", 19}}) {
    const core::PlaceTruthMatrix truth = read_matrix(data_ / file);
    for (std::uint64_t seed = 0; seed < 3; ++seed) {
      SCOPED_TRACE(testing::Message() << file << " seed " << seed);
      const std::vector<Match> matches = random_matches(truth, seed);
      core::write_file(folder_ / "matches.txt", as_text(matches));
      const std::string theirs =
          run("pr.py", fmt::format("'{}' '{}' {}", (data_ / file).string(),
                                   (folder_ / "matches.txt").string(), window_frames));
      const PrecisionRecall ours = precision_recall(truth, matches, window_frames);
      EXPECT_GT(ours.auc, 0.0);
      EXPECT_NEAR(ours.auc, figure(theirs, "auc"), 1e-9);
      EXPECT_NEAR(ours.recall_at_full_precision, figure(theirs, "r100"), 1e-9);
      EXPECT_NEAR(ours.precision_at_recall_35, figure(theirs, "p_at_r35"), 1e-9);
      EXPECT_NEAR(ours.precision_at_recall_70, figure(theirs, "p_at_r70"), 1e-9);
      EXPECT_NEAR(ours.max_recall, figure(theirs, "max_recall"), 1e-9);
      EXPECT_EQ(ours.num_queries, figure(theirs, "queries"));
      EXPECT_EQ(ours.num_with_loop, figure(theirs, "with_loop"));
      EXPECT_EQ(ours.num_false, figure(theirs, "wrong"));
    }
  }
}

TEST_F(PythonTools, CountTheSameQueriesWithALoopAsPublished) {
  const auto queries_with_loop = [&](const char* file, int window_frames) {
    return precision_recall(read_matrix(data_ / file), {}, window_frames).num_with_loop;
  };
  EXPECT_EQ(queries_with_loop("rtabmap_corridor/same_place.txt", 19), 44);
  EXPECT_EQ(queries_with_loop("redkitchen/same_place.pgm", 149), 709);
  EXPECT_EQ(queries_with_loop("hololens/same_place.pgm", 60), 54);
}

TEST_F(PythonTools, AgreeOnTheTowerWalk) {
  const fs::path path = data_ / "ie_tower" / "walk.txt";
  const std::vector<WalkPlace> walk = read_walk(path);
  core::Random random(1);
  std::vector<Match> accepted;
  for (int i = 0; i < 500; ++i) {
    const int query = 100 + static_cast<int>(random.index(walk.size() - 100));
    accepted.push_back({query, query - static_cast<int>(random.index(100)), 1.0});
  }
  core::write_file(folder_ / "accepted.txt", as_text(accepted));
  const std::string theirs =
      run("walk.py", fmt::format("'{}' '{}'", path.string(), (folder_ / "accepted.txt").string()));
  const WalkCounts ours = count_walk(walk, accepted);
  EXPECT_EQ(ours.num_loops, figure(theirs, "loops"));
  EXPECT_EQ(ours.num_false, figure(theirs, "wrong"));
  EXPECT_EQ(ours.num_same_floor, figure(theirs, "same_floor"));
  EXPECT_EQ(ours.num_same_clip, figure(theirs, "same_clip"));
  EXPECT_GT(ours.num_same_clip, 0);
}

}  // namespace
}  // namespace samewhere::evaluate
