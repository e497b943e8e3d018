#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include <samewhere/features/test_world.hpp>
#include <samewhere/pipeline/loop_detector.hpp>
#include <samewhere/pipeline/test_map_context.hpp>
#include <samewhere/pipeline/verifier_settings.hpp>

namespace samewhere::pipeline {
namespace {

// A view without features: similarity alone decides.
features::View blank_view(std::uint64_t frame) {
  return {.frame = core::FrameId(frame),
          .stamp_s = 0.0,
          .rig = std::make_shared<core::Rig>(),
          .image_size_px = {640, 480},
          .features = std::make_shared<features::Features>()};
}

core::Candidate candidate(std::uint64_t query, std::uint64_t match, double similarity) {
  return {{}, core::FrameId(query), core::FrameId(match), similarity};
}

LoopDetector detector_of(const Config& config) { return {config, recognition_settings(config)}; }

std::vector<core::LedgerRow> verified(LoopDetector& detector, std::uint64_t query) {
  const std::vector<core::Candidate> candidates = {
      candidate(query, 0, 0.9), candidate(query, 1, 0.8), candidate(query, 2, 0.6)};
  const core::Descriptor unused{.frame = core::FrameId(query), .unit = {}};
  return detector.verify(unused, query < 3 ? std::vector<core::Candidate>() : candidates,
                         blank_view(query), verify::WithoutMap());
}

std::vector<std::string> stages(LoopDetector& detector, std::uint64_t query) {
  std::vector<std::string> stages;
  for (const auto& row : verified(detector, query))
    stages.emplace_back(core::stage_of(row.verdict));
  return stages;
}

// A sequence may go on over weak pairs of a query to views further on: of two that it holds, the
// view shows the one that more of its own features agree with.
TEST(LoopDetector, TheBestOfAQueryHasMostInliersOfItsOwn) {
  const auto accepted = [](std::uint64_t match, int num_inliers, int num_sequence_inliers) {
    core::LoopClosure loop{.candidate = core::CandidateId(match)};
    loop.evidence.geometry = core::GeometryEvidence{.num_inliers = num_inliers};
    loop.evidence.sequence = core::SequenceEvidence{.num_inliers = num_sequence_inliers};
    return core::LedgerRow{{.id = loop.candidate, .match = core::FrameId(match)}, loop};
  };
  const std::vector<core::LedgerRow> rows = {accepted(27, 176, 3852), accepted(31, 28, 4235)};
  EXPECT_EQ(verify::best_of_query(rows, {})->candidate.match, core::FrameId(27));
}

// Seen from where the query was taken, a look-alike overlaps more than the place itself.
TEST(LoopDetector, AViewWithFarFewerInliersIsNotTheBestForItsOverlap) {
  const auto accepted = [](std::uint64_t match, int num_inliers, double overlap_ratio) {
    core::LoopClosure loop{.candidate = core::CandidateId(match)};
    loop.evidence.geometry =
        core::GeometryEvidence{.num_inliers = num_inliers, .overlap_ratio = overlap_ratio};
    return core::LedgerRow{{.id = loop.candidate, .match = core::FrameId(match)}, loop};
  };
  std::vector<core::LedgerRow> rows = {accepted(315, 285, 1.0), accepted(63, 438, 0.70)};
  EXPECT_EQ(verify::best_of_query(rows, {})->candidate.match, core::FrameId(63));
  rows.push_back(accepted(49, 400, 0.80));
  EXPECT_EQ(verify::best_of_query(rows, {})->candidate.match, core::FrameId(49));
}

int num_matches(const core::LedgerRow& row) {
  return core::evidence_of(row.verdict).geometry->num_matches;
}

TEST(LoopDetector, RelocalizationWithoutDepthAcceptsLessDistinctMatches) {
  Config config;
  config.retrieve.window_frames = 0;
  config.verify.measure_all = true;
  LoopDetector detector = detector_of(config);
  cv::Mat picture(480, 640, CV_8UC3);
  cv::RNG(5).fill(picture, cv::RNG::UNIFORM, 0, 256);
  const features::View view = features::test_view(features::test_world(5), 0, {}, 0.3, false);
  features::View later = features::with_near_doubles(view);
  later.frame = core::FrameId(20);
  detector.remember(detector.index().describe(view.frame, picture), view);
  core::Timings timings;
  const auto places = detector.relocalize(picture, later, timings);
  ASSERT_EQ(places.size(), 1U);
  EXPECT_GT(num_matches(places[0]), 100);
  const auto loops = detector.detect(picture, later, verify::WithoutMap(), timings);
  ASSERT_EQ(loops.size(), 1U);
  EXPECT_EQ(num_matches(loops[0]), 0);
}

// Two views of the map that show the same things, and that the map knows to be two places; a view
// that shows what both show.
class CompetingPlaces : public testing::Test {
 protected:
  // What is said of both, if the second was seen from a direction that shows less.
  std::vector<core::LedgerRow> verified(double turned_rad, bool are_two) {
    Config config;
    config.retrieve.window_frames = 40;
    config.verify.prior = verify::Prior::kUnique;  // there is no odometry
    LoopDetector detector = detector_of(config);
    const features::TestWorld world = features::test_world(3);
    const auto view = [&](int frame, double angle_rad) {
      return features::test_view(world, frame, core::Rigid3{core::exp_so3({0.0, angle_rad, 0.0})});
    };
    const auto described = [](std::uint64_t frame) {
      return core::Descriptor{.frame = core::FrameId(frame), .unit = {0.6F, 0.0F, 0.8F}};
    };
    TestMap map;
    map.is_every_match_a_place = are_two;
    detector.verify(described(0), {}, view(0, 0.0), map);
    detector.verify(described(1), {}, view(1, turned_rad), map);
    return detector.verify(described(90), {candidate(90, 0, 0.9), candidate(90, 1, 0.8)},
                           view(90, 0.0), map);
  }

  static std::vector<std::string_view> verdicts(const std::vector<core::LedgerRow>& rows) {
    std::vector<std::string_view> names;
    for (const auto& row : rows) names.push_back(core::name_of(row.verdict));
    return names;
  }
};

TEST_F(CompetingPlaces, WithAsManyInliersAreAmbiguous) {
  EXPECT_EQ(verdicts(verified(0.0, true)),
            (std::vector<std::string_view>{"AMBIGUOUS", "AMBIGUOUS"}));
  EXPECT_EQ(verdicts(verified(0.0, false)), (std::vector<std::string_view>{"LOOP", "LOOP"}));
}

TEST_F(CompetingPlaces, TheOneWithFarMoreInliersIsAccepted) {
  const auto rows = verified(0.4, true);
  EXPECT_EQ(verdicts(rows), (std::vector<std::string_view>{"LOOP", "AMBIGUOUS"}));
  const auto& other = core::evidence_of(rows[1].verdict).competing_place;
  ASSERT_TRUE(other);
  EXPECT_EQ(other->frame, core::FrameId(0));
  EXPECT_EQ(other->num_inliers, core::evidence_of(rows[0].verdict).geometry->num_inliers);
}

// A camera turns about itself, a view every two degrees and a bit, and then shows once more what
// `seen_again` has shown.
class TurnAround {
 public:
  explicit TurnAround(int neighbour_frames) {
    config_.retrieve.window_frames = 40;
    config_.verify.neighbour_frames = neighbour_frames;
  }

  // The rows of frame `query`, if the search finds `found`.
  std::vector<core::LedgerRow> look_again(int query, int seen_again, int found) {
    LoopDetector detector = detector_of(config_);
    for (int frame = 0; frame < kNumViews; ++frame)
      detector.verify(described(frame), {}, turned(frame, frame), verify::WithoutMap());
    return detector.verify(
        described(query),
        {candidate(static_cast<std::uint64_t>(query), static_cast<std::uint64_t>(found), 0.9)},
        turned(query, seen_again), verify::WithoutMap());
  }

  const Config& config() const { return config_; }

 private:
  static constexpr int kNumViews = 30;

  static core::Descriptor described(int frame) {
    return {.frame = core::FrameId(static_cast<std::uint64_t>(frame)), .unit = {0.6F, 0.0F, 0.8F}};
  }

  features::View turned(int frame, int steps) const {
    return features::test_view(world_, frame,
                               core::Rigid3{core::exp_so3({0.0, 0.04 * steps, 0.0})});
  }

  Config config_;
  features::TestWorld world_ = features::test_world(3);
};

std::vector<std::uint64_t> matches_of(const std::vector<core::LedgerRow>& rows) {
  std::vector<std::uint64_t> matches;
  for (const auto& row : rows) matches.push_back(row.candidate.match.index());
  return matches;
}

TEST(LoopDetector, NeighboursOfTheBestMatchGiveTheViewThatShowsMostOfTheSame) {
  TurnAround looking(8);
  const auto rows = looking.look_again(100, 12, 5);
  EXPECT_EQ(verify::best_of_query(rows, looking.config().verify)->candidate.match,
            core::FrameId(12));
  std::vector<std::uint64_t> matches = matches_of(rows);
  EXPECT_EQ(matches.at(0), 5U) << "what the search found";
  EXPECT_EQ(matches.at(1), 13U) << "there is none 8 before, and 8 after is better";
  for (std::size_t i = 1; i < rows.size(); ++i)
    EXPECT_EQ(rows[i].candidate.origin, core::Origin::kNeighbour) << matches[i];
  std::sort(matches.begin(), matches.end());
  EXPECT_EQ(std::unique(matches.begin(), matches.end()), matches.end()) << "none twice";
}

TEST(LoopDetector, NeighboursAreOffByDefault) {
  EXPECT_EQ(matches_of(TurnAround(0).look_again(100, 12, 5)), (std::vector<std::uint64_t>{5}));
}

TEST(LoopDetector, NeighboursAreOutsideTheExclusionWindow) {
  const auto rows = TurnAround(8).look_again(50, 12, 5);
  EXPECT_GT(rows.size(), 1U);
  for (const std::uint64_t match : matches_of(rows)) EXPECT_LT(match, 10U) << "window 40";
}

TEST(LoopDetector, NeighboursNeedAMatchToStartFrom) {
  EXPECT_EQ(matches_of(TurnAround(8).look_again(100, 70, 5)), (std::vector<std::uint64_t>{5}))
      << "the other way round";
}

TEST(LoopDetector, ProfilePaperAcceptsTheBestMatchOfAViewAndThenPauses) {
  Config config = profile("paper");
  config.retrieve.window_frames = 0;
  LoopDetector detector = detector_of(config);
  for (std::uint64_t frame = 0; frame < 3; ++frame) EXPECT_TRUE(stages(detector, frame).empty());
  using Stages = std::vector<std::string>;
  EXPECT_EQ(stages(detector, 20), (Stages{"accepted", "pause", "similarity"}));
  EXPECT_EQ(stages(detector, 30), (Stages{"pause", "pause", "similarity"}));
  EXPECT_EQ(stages(detector, 31), (Stages{"accepted", "pause", "similarity"}));
}

TEST(LoopDetector, WithoutAPauseEveryMatchOfAViewIsVerifiedByItself) {
  Config config = profile("paper");
  config.retrieve.window_frames = 0;
  config.verify.pause_frames = 0;
  LoopDetector detector = detector_of(config);
  for (std::uint64_t frame = 0; frame < 3; ++frame) EXPECT_TRUE(stages(detector, frame).empty());
  EXPECT_EQ(stages(detector, 20), (std::vector<std::string>{"accepted", "accepted", "similarity"}));
}

TEST(LoopDetector, MeasureAllMeasuresCandidatesThatAreRejectedEarly) {
  Config config = profile("paper");
  config.retrieve.window_frames = 0;
  for (const bool measures_all : {false, true}) {
    config.verify.measure_all = measures_all;
    LoopDetector detector = detector_of(config);
    for (std::uint64_t frame = 0; frame < 3; ++frame) verified(detector, frame);
    const auto rows = verified(detector, 20);
    ASSERT_EQ(rows.size(), 3U);
    EXPECT_EQ(core::stage_of(rows[1].verdict), "pause");
    EXPECT_EQ(core::evidence_of(rows[1].verdict).geometry.has_value(), measures_all);
    EXPECT_EQ(core::evidence_of(rows[2].verdict).geometry.has_value(), measures_all);
  }
}

}  // namespace
}  // namespace samewhere::pipeline
