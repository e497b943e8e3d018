#include <string_view>

#include <gtest/gtest.h>

#include <samewhere/verify/decide.hpp>

namespace samewhere::verify {
namespace {

core::Candidate candidate(double similarity = 0.8) {
  return {core::CandidateId(0), core::FrameId(100), core::FrameId(0), similarity};
}

core::Evidence good_evidence() {
  core::Evidence evidence{.similarity = 0.8};
  evidence.geometry = core::GeometryEvidence{.num_matches = 120,
                                             .num_inliers = 90,
                                             .inlier_ratio = 0.75,
                                             .spread_ratio = 0.5,
                                             .overlap_ratio = 0.8,
                                             .reprojection_rmse_px = 1.0,
                                             .match_from_query = core::Sim3{}};
  evidence.odometry = core::OdometryEvidence{.correction_m = 0.1,
                                             .correction_rad = 0.01,
                                             .mahalanobis_squared = 2.0,
                                             .sigma_m = 0.2,
                                             .look_alike_gain = 200.0};
  return evidence;
}

// The stage that refuses, or "accepted".
std::string_view stage(const core::Evidence& evidence, const Config& config,
                       const History& history = {}) {
  return core::stage_of(decide(candidate(evidence.similarity), evidence, history, config));
}

TEST(Decide, GoodEvidenceIsALoopWithAPose) {
  const auto verdict = decide(candidate(), good_evidence(), {}, {});
  ASSERT_TRUE(core::is_loop(verdict));
  EXPECT_TRUE(std::get<core::LoopClosure>(verdict).match_from_query);
}

TEST(Decide, EachCheckRejectsUnderItsOwnName) {
  const Config config;
  core::Evidence evidence = good_evidence();
  evidence.geometry->num_matches = config.min_matches - 1;
  EXPECT_EQ(stage(evidence, config), "matches");
  evidence = good_evidence();
  evidence.geometry->num_inliers = config.min_inliers - 1;
  EXPECT_EQ(stage(evidence, config), "inliers");
  evidence = good_evidence();
  evidence.geometry->spread_ratio = 0.5 * config.min_spread_ratio;
  EXPECT_EQ(stage(evidence, config), "spread");
  evidence = good_evidence();
  evidence.geometry->pose_difference_m = 2.0 * config.max_pose_difference_m;
  EXPECT_EQ(stage(evidence, config), "consistency");
  evidence = good_evidence();
  evidence.geometry->pose_difference_rad = 2.0 * config.max_pose_difference_rad;
  EXPECT_EQ(stage(evidence, config), "consistency");
  evidence = good_evidence();
  evidence.odometry->mahalanobis_squared = 2.0 * config.max_odometry_chi_square;
  EXPECT_EQ(stage(evidence, config), "odometry");
  evidence = good_evidence();
  EXPECT_EQ(stage(evidence, {.min_similarity = 0.9}), "similarity");
  EXPECT_EQ(stage(evidence, config), "accepted");
}

TEST(Decide, TheReasonNamesWhatLoopsHaveTaughtOfOdometry) {
  const Config config;
  core::Evidence evidence = good_evidence();
  evidence.odometry->mahalanobis_squared = 2.0 * config.max_odometry_chi_square;
  const auto reason = [&] {
    return std::string(core::reason_of(decide(candidate(), evidence, {}, config)));
  };
  EXPECT_EQ(reason().find("variance"), std::string::npos) << reason();
  evidence.odometry->variance_factor = 0.25;
  EXPECT_NE(reason().find("its variance times 0.25"), std::string::npos) << reason();
  evidence.odometry->mahalanobis_squared = 2.0;
  evidence.odometry->look_alike_gain = config.min_look_alike_gain - 0.1;
  EXPECT_NE(reason().find("its variance times 0.25"), std::string::npos) << reason();
}

TEST(Decide, WithRequirePoseInliersAloneAreNoLoop) {
  core::Evidence evidence = good_evidence();
  evidence.geometry->match_from_query.reset();
  evidence.odometry.reset();
  EXPECT_EQ(stage(evidence, {}), "pose");
  EXPECT_EQ(stage(evidence, {.prior = Prior::kUnique, .require_pose = false, .min_views = 1}),
            "accepted");
}

TEST(Decide, AppearanceAloneIsAmbiguousUnlessNoTwoPlacesLookAlike) {
  core::Evidence evidence = good_evidence();
  evidence.geometry->num_inliers = 1000;
  evidence.odometry = core::OdometryEvidence{};  // does not join the two
  const auto verdict = decide(candidate(), evidence, {}, {});
  EXPECT_EQ(core::name_of(verdict), "AMBIGUOUS");
  EXPECT_EQ(core::stage_of(verdict), "evidence");
  EXPECT_EQ(core::reason_of(verdict), "appearance alone: cannot be told from a look-alike place");
  EXPECT_TRUE(is_recognized(verdict));
  EXPECT_EQ(stage(evidence, {.prior = Prior::kUnique}), "accepted");
  evidence.odometry.reset();
  EXPECT_EQ(stage(evidence, {}), "evidence");
}

TEST(Decide, OdometryOrEarlierLoopsMustTellThePlaceFromALookAlike) {
  const Config config;
  core::Evidence evidence = good_evidence();
  evidence.odometry->look_alike_gain = config.min_look_alike_gain - 0.1;
  EXPECT_EQ(stage(evidence, config), "evidence");
  EXPECT_EQ(stage(evidence, {.prior = Prior::kUnique}), "accepted");
  evidence.odometry->look_alike_gain_with_loops = config.min_look_alike_gain + 0.1;
  evidence.odometry->mahalanobis_squared_with_loops = 3.0;
  EXPECT_EQ(stage(evidence, config), "accepted");
  evidence.odometry->mahalanobis_squared_with_loops = config.max_competing_chi_square + 1.0;
  EXPECT_EQ(stage(evidence, config), "competing");
}

TEST(Decide, ByDeformationOnlyTheBendOfTheTrajectoryCounts) {
  const Config config{.method = Method::kDeformation, .max_deformation_ratio = 0.02};
  core::Evidence evidence = good_evidence();
  evidence.odometry->mahalanobis_squared = 2.0 * config.max_odometry_chi_square;
  evidence.deformation = core::DeformationEvidence{.rmse_m = 1.9, .path_m = 100.0};
  EXPECT_EQ(stage(evidence, config), "accepted");
  evidence.deformation->rmse_m = 2.1;
  EXPECT_EQ(stage(evidence, config), "deformation");
  evidence.geometry->num_inliers = 3;
  EXPECT_EQ(stage(evidence, config), "inliers");
}

TEST(Decide, InRecognitionAloneTheSequenceDecides) {
  const Config alone{.prior = Prior::kUnique, .require_pose = false};
  core::Evidence evidence = good_evidence();
  evidence.geometry->num_inliers = alone.min_inliers;
  EXPECT_EQ(stage(evidence, alone), "sequence") << "with a pose";
  evidence.geometry->match_from_query.reset();
  evidence.odometry.reset();
  --evidence.geometry->num_inliers;
  EXPECT_EQ(stage(evidence, alone), "sequence");
  evidence.sequence = core::SequenceEvidence{.num_views = alone.min_views - 1};
  const auto waits = decide(candidate(), evidence, {}, alone);
  EXPECT_EQ(core::name_of(waits), "AMBIGUOUS");
  EXPECT_NE(core::reason_of(waits).find("9 consecutive views match so far, 10 needed"),
            std::string::npos);
  evidence.sequence->is_over = true;
  EXPECT_EQ(stage(evidence, alone), "sequence");
  ++evidence.geometry->num_inliers;
  EXPECT_EQ(stage(evidence, alone), "accepted") << "enough of its own";
  evidence.sequence->num_views = alone.min_views;
  EXPECT_EQ(stage(evidence, alone), "accepted");
  // of each view less is asked, for it does not speak alone
  evidence.geometry->num_inliers = alone.min_inliers_in_sequence;
  evidence.geometry->spread_ratio = 0.01;
  EXPECT_EQ(stage(evidence, alone), "accepted");
  --evidence.geometry->num_inliers;
  EXPECT_EQ(stage(evidence, alone), "inliers");
}

TEST(Decide, ARejectionHasAReasonWithItsMetrics) {
  core::Evidence evidence = good_evidence();
  evidence.geometry->num_inliers = 17;
  const std::string reason =
      core::reason_of(decide(candidate(), evidence, {}, {.min_inliers = 40}));
  EXPECT_NE(reason.find("17"), std::string::npos) << reason;
  EXPECT_NE(reason.find("40"), std::string::npos) << reason;
}

TEST(Decide, AfterALoopDetectionPausesForTenFramesAndResumesAtTheEleventh) {
  const Config paper{.pause_frames = 10};
  const auto after = [&](int frames) {
    return stage(good_evidence(), paper, {core::FrameId(static_cast<std::uint64_t>(100 - frames))});
  };
  EXPECT_EQ(after(0), "pause") << "of one view one match is a loop";
  EXPECT_EQ(after(1), "pause");
  EXPECT_EQ(after(10), "pause");
  EXPECT_EQ(after(11), "accepted");
  EXPECT_EQ(stage(good_evidence(), {.pause_frames = 0}, {core::FrameId(100)}), "accepted")
      << "without a pause every match is decided by itself";
}

TEST(Decide, WhereGeometryIsNotRequiredALoopWithoutAGoodPoseIsCountedButHasNone) {
  core::Evidence evidence = good_evidence();
  evidence.geometry->num_inliers = 3;
  const auto verdict = decide(candidate(), evidence, {}, {.require_geometry = false});
  ASSERT_TRUE(core::is_loop(verdict));
  EXPECT_FALSE(std::get<core::LoopClosure>(verdict).match_from_query);
}

TEST(Score, InliersComeFirstAndSimilarityBreaksTies) {
  core::Evidence few = good_evidence();
  few.geometry->num_inliers = 40;
  few.similarity = 1.0;
  core::Evidence more = good_evidence();
  more.geometry->num_inliers = 41;
  more.similarity = -1.0;
  const Config by_inliers{.rank_by = RankBy::kInliers};
  EXPECT_GT(score(more, by_inliers), score(few, by_inliers));
  EXPECT_LT(score(more, {.rank_by = RankBy::kSimilarity}),
            score(few, {.rank_by = RankBy::kSimilarity}));
  more.geometry->num_inliers = 40;
  EXPECT_LT(score(more, by_inliers), score(few, by_inliers));
}

TEST(Score, ALongSequenceOfALookAlikeIsNotSurerThanAShortOneOfThePlace) {
  const Config config{
      .min_inliers = 52, .require_pose = false, .min_views = 2, .min_inliers_in_sequence = 40};
  const auto in_sequence = [](int num_views, int inliers_of_each) {
    core::Evidence evidence = good_evidence();
    evidence.geometry->num_inliers = inliers_of_each;
    evidence.sequence =
        core::SequenceEvidence{.num_views = num_views, .num_inliers = num_views * inliers_of_each};
    return evidence;
  };
  EXPECT_LT(score(in_sequence(30, 90), config), score(in_sequence(3, 120), config));
  EXPECT_NEAR(score(in_sequence(3, 120), config), 120.5, 0.5);
  // what just suffices scores the same, alone and in a sequence
  core::Evidence alone = in_sequence(1, 52);
  EXPECT_DOUBLE_EQ(score(alone, config), score(in_sequence(2, 40), config));
  alone.geometry->num_inliers = 3;
  EXPECT_LT(score(alone, config), 1.0);
}

TEST(Rank, AViewThatShowsMostOfTheSameComesBeforeATexturedCornerOfIt) {
  core::Evidence corner = good_evidence();
  corner.geometry->num_inliers = 200;
  corner.geometry->overlap_ratio = 0.3;
  core::Evidence most = good_evidence();
  most.geometry->num_inliers = 60;
  most.geometry->overlap_ratio = 0.9;
  EXPECT_GT(rank(most, {}), rank(corner, {}));
  EXPECT_GT(score(corner, {}), score(most, {})) << "surer of its place all the same";
  const Config by_looks{.rank_by = RankBy::kSimilarity};
  EXPECT_EQ(rank(most, by_looks), most.similarity);
}

TEST(Rank, OfWhatMayAgreeByChanceNoOverlapIsKnown) {
  const Config config;
  core::Evidence chance = good_evidence();
  chance.geometry->num_inliers = config.min_inliers - 20;
  chance.geometry->overlap_ratio = 1.0;
  core::Evidence nearly = good_evidence();
  nearly.geometry->num_inliers = config.min_inliers - 1;
  nearly.geometry->overlap_ratio = 0.4;
  EXPECT_GT(rank(nearly, config), rank(chance, config));
  chance.geometry->num_inliers = nearly.geometry->num_inliers;
  chance.similarity = nearly.similarity + 0.1;
  EXPECT_GT(rank(chance, config), rank(nearly, config)) << "of equals the more similar";
}

TEST(Decide, ALoopOverrulesThoseThatContradictItWithEnoughGain) {
  core::Evidence evidence = good_evidence();
  evidence.competing_loop = core::CompetingLoopEvidence{.frame = core::FrameId(20),
                                                        .mahalanobis_squared = 31.0,
                                                        .first_loop = core::CandidateId(7),
                                                        .gain = Config{}.min_competing_gain - 0.1};
  EXPECT_EQ(stage(evidence, {}), "competing");
  evidence.competing_loop->gain = Config{}.min_competing_gain + 0.1;
  const auto verdict = decide(candidate(), evidence, {}, {});
  ASSERT_TRUE(core::is_loop(verdict));
  EXPECT_EQ(std::get<core::LoopClosure>(verdict).overruled, core::CandidateId(7));
  evidence.competing_loop->mahalanobis_squared = 29.0;
  const auto agreeing = decide(candidate(), evidence, {}, {});
  EXPECT_FALSE(std::get<core::LoopClosure>(agreeing).overruled.is_valid()) << "nothing contradicts";
}

TEST(Decide, OdometryRejectsWhatContradictsALoopThatFitsItBetter) {
  core::Evidence evidence = good_evidence();
  evidence.competing_loop = core::CompetingLoopEvidence{.frame = core::FrameId(20),
                                                        .mahalanobis_squared = 31.0,
                                                        .first_loop = core::CandidateId(7),
                                                        .gain = 0.1 - Config{}.min_competing_gain};
  const auto name = [&] { return core::name_of(decide(candidate(), evidence, {}, {})); };
  EXPECT_EQ(name(), "AMBIGUOUS");
  evidence.competing_loop->gain = -Config{}.min_competing_gain;
  const auto verdict = decide(candidate(), evidence, {}, {});
  EXPECT_EQ(core::name_of(verdict), "NOT");
  EXPECT_EQ(core::stage_of(verdict), "competing");
  EXPECT_NE(core::reason_of(verdict).find("odometry fits that place better (gain -6)"),
            std::string::npos)
      << core::reason_of(verdict);
  evidence.competing_loop->gain.reset();
  EXPECT_EQ(name(), "AMBIGUOUS") << "nothing was compared";
}

TEST(Decide, ACompetingPlaceWithAboutAsManyInliersIsAmbiguous) {
  core::Evidence evidence = good_evidence();
  evidence.geometry->num_inliers = 200;
  evidence.competing_place = core::CompetingPlaceEvidence{
      .frame = core::FrameId(20), .num_inliers = 150, .apart_m = 5.9, .apart_rad = 0.01};
  EXPECT_EQ(stage(evidence, {}), "accepted");
  evidence.competing_place->num_inliers = 151;
  const auto verdict = decide(candidate(), evidence, {}, {});
  EXPECT_EQ(core::name_of(verdict), "AMBIGUOUS");
  EXPECT_EQ(core::stage_of(verdict), "competing");
  EXPECT_NE(core::reason_of(verdict).find("frame 20 shows another place, 5.90 m"),
            std::string::npos);
}

TEST(Decide, ACompetingPlaceThatAgreesWithOverruledLoopsDoesNotCount) {
  core::Evidence evidence = good_evidence();
  evidence.competing_place = core::CompetingPlaceEvidence{
      .frame = core::FrameId(20), .num_inliers = 2 * evidence.geometry->num_inliers};
  EXPECT_EQ(stage(evidence, {}), "competing");
  evidence.competing_loop = core::CompetingLoopEvidence{.frame = core::FrameId(20),
                                                        .mahalanobis_squared = 31.0,
                                                        .first_loop = core::CandidateId(7),
                                                        .gain = Config{}.min_competing_gain + 0.1};
  const auto verdict = decide(candidate(), evidence, {}, {});
  ASSERT_TRUE(core::is_loop(verdict));
  EXPECT_EQ(std::get<core::LoopClosure>(verdict).overruled, core::CandidateId(7));
}

TEST(Decide, ACompetingLoopFarFromHereIsAmbiguous) {
  core::Evidence evidence = good_evidence();
  evidence.competing_loop = core::CompetingLoopEvidence{
      .frame = core::FrameId(20), .apart_m = 1.8, .apart_rad = 0.01, .mahalanobis_squared = 29.0};
  EXPECT_EQ(stage(evidence, {}), "accepted");
  evidence.competing_loop->mahalanobis_squared = 31.0;
  const auto verdict = decide(candidate(), evidence, {}, {});
  EXPECT_EQ(core::name_of(verdict), "AMBIGUOUS");
  EXPECT_EQ(core::stage_of(verdict), "competing");
  EXPECT_NE(core::reason_of(verdict).find("at frame 20, 1.80 m"), std::string::npos);
}

}  // namespace
}  // namespace samewhere::verify
