#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include <samewhere/features/test_world.hpp>
#include <samewhere/pipeline/loop_detector.hpp>

namespace samewhere::pipeline {
namespace {

// A view in which nothing can be found again: similarity alone speaks.
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

std::vector<core::LedgerRow> judged(LoopDetector& detector, std::uint64_t query) {
  const auto without_odometry = [](const core::Candidate& /*candidate*/,
                                   const core::Sim3& /*match_from_query*/) {
    return std::optional<core::OdometryEvidence>();
  };
  const std::vector<core::Candidate> candidates = {
      candidate(query, 0, 0.9), candidate(query, 1, 0.8), candidate(query, 2, 0.6)};
  const core::Descriptor unused{.frame = core::FrameId(query), .unit = {}};
  return detector.judge(unused, query < 3 ? std::vector<core::Candidate>() : candidates,
                        blank_view(query), {without_odometry});
}

std::vector<std::string> stages(LoopDetector& detector, std::uint64_t query) {
  std::vector<std::string> stages;
  for (const auto& row : judged(detector, query)) stages.emplace_back(core::stage_of(row.verdict));
  return stages;
}

// A sequence may go on over weak pairs of a query to views further on: of two that it holds, the
// view shows the one that more of its own features agree with.
TEST(LoopDetector, TheBestOfAQueryIsWhatTheViewItselfShowsMostOf) {
  const auto accepted = [](std::uint64_t match, int num_inliers, int num_sequence_inliers) {
    core::LoopClosure loop{.candidate = core::CandidateId(match)};
    loop.evidence.geometry = core::GeometryEvidence{.num_inliers = num_inliers};
    loop.evidence.sequence = core::SequenceEvidence{.num_inliers = num_sequence_inliers};
    return core::LedgerRow{{.id = loop.candidate, .match = core::FrameId(match)}, loop};
  };
  const std::vector<core::LedgerRow> rows = {accepted(27, 176, 3852), accepted(31, 28, 4235)};
  EXPECT_EQ(best_of_query(rows, {})->candidate.match, core::FrameId(27));
}

int num_matches(const core::LedgerRow& row) {
  return core::evidence_of(row.verdict).geometry->num_matches;
}

TEST(LoopDetector, WithoutDepthWhoIsLostMayMatchWhatIsNotClearEnoughForALoop) {
  Config config;
  config.retrieve.window_frames = 0;
  config.verify.measure_all = true;
  LoopDetector detector(config);
  cv::Mat picture(480, 640, CV_8UC3);
  cv::RNG(5).fill(picture, cv::RNG::UNIFORM, 0, 256);
  const features::View view = features::test_view(features::test_world(5), 0, {}, 0.3, false);
  features::View later = features::with_near_doubles(view);
  later.frame = core::FrameId(20);
  detector.remember(detector.describe(view.frame, picture), view);
  core::Timings timings;
  const auto places = detector.recognise(picture, later, timings);
  ASSERT_EQ(places.size(), 1U);
  EXPECT_GT(num_matches(places[0]), 100);
  const auto no_odometry = [](const core::Candidate& /*candidate*/,
                              const core::Sim3& /*match_from_query*/) {
    return std::optional<core::OdometryEvidence>();
  };
  const auto loops = detector.look(picture, later, {no_odometry}, timings);
  ASSERT_EQ(loops.size(), 1U);
  EXPECT_EQ(num_matches(loops[0]), 0);
}

// Thirty views of three places, ten each; those of the first look most like the view that is looked
// at, those of the last least. The candidates' matches.
std::vector<std::uint64_t> matches_of_places(const retrieve::Config& retrieve,
                                             const IsConnected& is_connected) {
  Config config;
  config.retrieve = retrieve;
  config.retrieve.window_frames = 0;
  LoopDetector detector(config);
  cv::RNG random(5);
  cv::Mat picture(480, 640, CV_8UC1);
  random.fill(picture, cv::RNG::UNIFORM, 0, 256);
  cv::resize(picture(cv::Rect(0, 0, 40, 30)), picture, picture.size(), 0, 0, cv::INTER_CUBIC);
  cv::Mat noise(picture.size(), CV_8UC1);
  random.fill(noise, cv::RNG::UNIFORM, 0, 256);
  cv::resize(noise(cv::Rect(0, 0, 40, 30)), noise, noise.size(), 0, 0, cv::INTER_CUBIC);
  for (std::uint64_t frame = 0; frame < 30; ++frame) {
    cv::Mat seen;
    const double share = 0.02 * static_cast<double>(frame);
    cv::addWeighted(picture, 1.0 - share, noise, share, 0.0, seen);
    detector.remember(detector.describe(core::FrameId(frame), seen), blank_view(frame));
  }
  MapKnowledge map;
  map.measure_odometry = [](const auto&, const auto&) { return std::nullopt; };
  map.is_connected = is_connected;
  map.are_one_place = [](core::FrameId a, core::FrameId b) {
    return a.index() / 10 == b.index() / 10;
  };
  core::Timings timings;
  std::vector<std::uint64_t> matches;
  for (const auto& row : detector.look(picture, blank_view(40), map, timings))
    matches.push_back(row.candidate.match.index());
  return matches;
}

TEST(LoopDetector, CandidatesAreTheBestViewsOfDifferentPlaces) {
  const auto nobody = [](core::FrameId /*match*/) { return false; };
  EXPECT_EQ(matches_of_places({.shortlist = 30}, nobody), (std::vector<std::uint64_t>{0, 10, 20}));
  EXPECT_EQ(matches_of_places({.num_candidates = 2, .shortlist = 30, .views_per_place = 2}, nobody),
            (std::vector<std::uint64_t>{0, 1, 10, 11}));
  EXPECT_EQ(matches_of_places({.shortlist = 0}, nobody), (std::vector<std::uint64_t>{0, 1, 2}));
}

// However many of those that look most alike the map holds together with the view already.
TEST(LoopDetector, ViewsThatAreConnectedDoNotTakeThePlaceOfOthers) {
  const auto first_place = [](core::FrameId match) { return match.index() < 10; };
  EXPECT_EQ(matches_of_places({.shortlist = 30}, first_place),
            (std::vector<std::uint64_t>{10, 20}));
  EXPECT_TRUE(matches_of_places({.shortlist = 0}, first_place).empty());
}

// Two views of the map that show the same things, and that the map knows to be two places; a view
// that shows what both show.
class TwoPlaces : public testing::Test {
 protected:
  // What is said of both, if the second was seen from a direction that shows less.
  std::vector<core::LedgerRow> judged(double turned_rad, bool are_two) {
    Config config;
    config.retrieve.window_frames = 40;
    LoopDetector detector(config);
    const features::TestWorld world = features::test_world(3);
    const auto view = [&](int frame, double angle_rad) {
      return features::test_view(world, frame, core::Rigid3{core::exp_so3({0.0, angle_rad, 0.0})});
    };
    const auto described = [](std::uint64_t frame) {
      return core::Descriptor{.frame = core::FrameId(frame), .unit = {0.6F, 0.0F, 0.8F}};
    };
    MapKnowledge map;
    map.measure_odometry = [](const auto&, const auto&) { return std::nullopt; };
    map.measure_other_place = [&](const core::LedgerRow&, const core::LedgerRow& other) {
      return are_two ? std::optional(core::OtherPlaceEvidence{.frame = other.candidate.match})
                     : std::nullopt;
    };
    detector.judge(described(0), {}, view(0, 0.0), map);
    detector.judge(described(1), {}, view(1, turned_rad), map);
    return detector.judge(described(90), {candidate(90, 0, 0.9), candidate(90, 1, 0.8)},
                          view(90, 0.0), map);
  }

  static std::vector<std::string_view> verdicts(const std::vector<core::LedgerRow>& rows) {
    std::vector<std::string_view> names;
    for (const auto& row : rows) names.push_back(core::name_of(row.verdict));
    return names;
  }
};

TEST_F(TwoPlaces, ThatShowAViewAsWellAreAmbiguous) {
  EXPECT_EQ(verdicts(judged(0.0, true)), (std::vector<std::string_view>{"AMBIGUOUS", "AMBIGUOUS"}));
  EXPECT_EQ(verdicts(judged(0.0, false)), (std::vector<std::string_view>{"LOOP", "LOOP"}));
}

TEST_F(TwoPlaces, OfWhichOneShowsFarMoreAreThatOne) {
  const auto rows = judged(0.4, true);
  EXPECT_EQ(verdicts(rows), (std::vector<std::string_view>{"LOOP", "AMBIGUOUS"}));
  const auto& other = core::evidence_of(rows[1].verdict).other_place;
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

  // All that is judged of frame `query`, if the search finds `found`.
  std::vector<core::LedgerRow> look_again(int query, int seen_again, int found) {
    LoopDetector detector(config_);
    for (int frame = 0; frame < kNumViews; ++frame)
      detector.judge(described(frame), {}, turned(frame, frame), {no_odometry});
    return detector.judge(
        described(query),
        {candidate(static_cast<std::uint64_t>(query), static_cast<std::uint64_t>(found), 0.9)},
        turned(query, seen_again), {no_odometry});
  }

  const Config& config() const { return config_; }

 private:
  static constexpr int kNumViews = 30;

  static std::optional<core::OdometryEvidence> no_odometry(const core::Candidate& /*candidate*/,
                                                           const core::Sim3& /*found*/) {
    return std::nullopt;
  }

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

TEST(LoopDetector, BesideTheBestMatchItFindsTheViewThatShowsMostOfTheSame) {
  TurnAround looking(8);
  const auto rows = looking.look_again(100, 12, 5);
  EXPECT_EQ(best_of_query(rows, looking.config().verify)->candidate.match, core::FrameId(12));
  std::vector<std::uint64_t> matches = matches_of(rows);
  EXPECT_EQ(matches.at(0), 5U) << "what the search found";
  EXPECT_EQ(matches.at(1), 13U) << "there is none 8 before, and 8 behind is better";
  for (std::size_t i = 1; i < rows.size(); ++i)
    EXPECT_TRUE(rows[i].candidate.is_foretold) << "looked for on purpose: " << matches[i];
  std::sort(matches.begin(), matches.end());
  EXPECT_EQ(std::unique(matches.begin(), matches.end()), matches.end()) << "none twice";
}

TEST(LoopDetector, WhatSearchFindsIsAllWhereNobodyLooksAround) {
  EXPECT_EQ(matches_of(TurnAround(0).look_again(100, 12, 5)), (std::vector<std::uint64_t>{5}));
}

TEST(LoopDetector, NobodyLooksAroundAmongViewsThatAreTooYoung) {
  const auto rows = TurnAround(8).look_again(50, 12, 5);
  EXPECT_GT(rows.size(), 1U);
  for (const std::uint64_t match : matches_of(rows)) EXPECT_LT(match, 10U) << "window 40";
}

TEST(LoopDetector, NorWhereNothingMatches) {
  EXPECT_EQ(matches_of(TurnAround(8).look_again(100, 70, 5)), (std::vector<std::uint64_t>{5}))
      << "the other way round";
}

TEST(LoopDetector, ThePublishedOneAcceptsTheBestMatchOfAViewAndThenPauses) {
  Config config = profile("paper");
  config.retrieve.window_frames = 0;
  LoopDetector detector(config);
  for (std::uint64_t frame = 0; frame < 3; ++frame) EXPECT_TRUE(stages(detector, frame).empty());
  using Stages = std::vector<std::string>;
  EXPECT_EQ(stages(detector, 20), (Stages{"accepted", "pause", "similarity"}));
  EXPECT_EQ(stages(detector, 30), (Stages{"pause", "pause", "similarity"}));
  EXPECT_EQ(stages(detector, 31), (Stages{"accepted", "pause", "similarity"}));
}

TEST(LoopDetector, WithoutAPauseEveryMatchOfAViewIsJudgedForItself) {
  Config config = profile("paper");
  config.retrieve.window_frames = 0;
  config.verify.pause_frames = 0;
  LoopDetector detector(config);
  for (std::uint64_t frame = 0; frame < 3; ++frame) EXPECT_TRUE(stages(detector, frame).empty());
  EXPECT_EQ(stages(detector, 20), (std::vector<std::string>{"accepted", "accepted", "similarity"}));
}

TEST(LoopDetector, WhatIsRefusedEarlyIsMeasuredIfOneAsks) {
  Config config = profile("paper");
  config.retrieve.window_frames = 0;
  for (const bool measures_all : {false, true}) {
    config.verify.measure_all = measures_all;
    LoopDetector detector(config);
    for (std::uint64_t frame = 0; frame < 3; ++frame) judged(detector, frame);
    const auto rows = judged(detector, 20);
    ASSERT_EQ(rows.size(), 3U);
    EXPECT_EQ(core::stage_of(rows[1].verdict), "pause");
    EXPECT_EQ(core::evidence_of(rows[1].verdict).geometry.has_value(), measures_all);
    EXPECT_EQ(core::evidence_of(rows[2].verdict).geometry.has_value(), measures_all);
  }
}

}  // namespace
}  // namespace samewhere::pipeline
