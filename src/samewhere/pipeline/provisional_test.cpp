#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include <samewhere/features/test_world.hpp>
#include <samewhere/map/mapper.hpp>
#include <samewhere/map/test_map.hpp>
#include <samewhere/pipeline/provisional.hpp>

namespace samewhere::pipeline {
namespace {

using Decision = ProvisionalRelocalization::Decision;

const core::Rigid3 kFarRoom{Eigen::Quaterniond::Identity(), {50.0, 0.0, 0.0}};
// Points are seen from there on until they leave the view, at similar distances.
constexpr double kSight_m = 9.0;
constexpr double kSide_m = 4.0;
constexpr double kKeyframes_m = 0.5;
constexpr double kViews_m = 0.1;

// A hall along z: points on both walls.
features::TestWorld corridor(std::uint64_t seed, double length_m) {
  core::Random random(seed);
  features::TestWorld world;
  for (int i = 0; i < static_cast<int>(150.0 * length_m); ++i) {
    const double side = random.uniform(0.0, 1.0) < 0.5 ? -kSide_m : kSide_m;
    world.points.emplace_back(side, random.uniform(-1.2, 1.2), random.uniform(0.0, length_m));
    std::array<std::uint8_t, 32> descriptor{};
    for (auto& byte : descriptor) byte = static_cast<std::uint8_t>(random.index(256));
    world.descriptors.push_back(descriptor);
  }
  return world;
}

// From here on, this share of the points gets random descriptors.
features::TestWorld different_from(features::TestWorld world, double from_m, double share) {
  core::Random random(9);
  for (std::size_t i = 0; i < world.points.size(); ++i) {
    if (world.points[i].z() < from_m || random.uniform(0.0, 1.0) >= share) continue;
    for (auto& byte : world.descriptors[i]) byte = static_cast<std::uint8_t>(random.index(256));
  }
  return world;
}

core::Rigid3 at(double along_m) { return {Eigen::Quaterniond::Identity(), {0.0, 0.0, along_m}}; }

features::View view_of(const features::TestWorld& world, int frame, double along_m) {
  features::TestWorld near;
  for (std::size_t i = 0; i < world.points.size(); ++i) {
    const double ahead_m = world.points[i].z() - along_m;
    if (ahead_m < kSide_m || ahead_m > kSight_m) continue;
    near.points.push_back(world.points[i]);
    near.descriptors.push_back(world.descriptors[i]);
  }
  return features::test_view(near, frame, at(along_m));
}

// Adds a walk along the corridor, which lies at `world_from_corridor`.
void add_walk(scene::MapVersion& map, const features::TestWorld& world, double length_m,
              const core::Rigid3& world_from_corridor) {
  std::size_t first_landmark = map.landmarks.size();
  for (int i = 0; i * kKeyframes_m <= length_m; ++i) {
    const double along_m = i * kKeyframes_m;
    const features::View view = view_of(world, static_cast<int>(map.keyframes.size()), along_m);
    const core::Rigid3 world_from_body = world_from_corridor * at(along_m);
    if (i == 0) {
      map = apply(map, map::start_map(map, view, world_from_body));
      continue;
    }
    const auto is_elsewhere = [&](core::LandmarkId id) { return id.index() < first_landmark; };
    map = apply(
        map, map::add_keyframe(map, map::test_tracked(map, view, world_from_body, is_elsewhere)));
  }
}

class ProvisionalRelocalizationTest : public testing::Test {
 protected:
  ProvisionalRelocalizationTest() { add_walk(map_, world_, 16.0, {}); }

  // Tracked at `keyframe`, where the view of the corridor's begin may have been taken.
  RelocalizedPose pose_at(const features::View& view, core::KeyframeId keyframe) {
    const scene::LocalMap local_map = map::local_map(map_, keyframe, config_.map);
    auto track = tracker_.track(view, local_map, {});
    EXPECT_TRUE(track);
    return {local_map, *track};
  }

  void begin(core::KeyframeId best, const std::vector<core::KeyframeId>& others = {},
             double log_ratio_by_motion = 0.0) {
    const features::View view = view_of(world_, 1000, 0.0);
    LeadingHypotheses leading{pose_at(view, best), {}};
    for (const auto& other : others) leading.others.push_back({other, core::Rigid3{}, true});
    provisional_.begin(leading, log_ratio_by_motion, view);
  }

  // Walks through the corridor until there is a decision; where it comes.
  struct End {
    Decision decision = Decision::kOpen;
    double along_m = 0.0;
    std::optional<RelocalizedPose> confirmed;
  };
  End walk(const features::TestWorld& world, double from_m, double to_m) {
    End end;
    for (end.along_m = from_m; end.along_m < to_m; end.along_m += kViews_m) {
      auto result = look(world, end.along_m);
      if (result.decision == Decision::kOpen) continue;
      end.decision = result.decision;
      end.confirmed = std::move(result.confirmed);
      break;
    }
    return end;
  }

  ProvisionalRelocalization::Result look(const features::TestWorld& world, double along_m) {
    const features::View view = view_of(world, 2000 + num_views_++, along_m);
    auto result = provisional_.evaluate(view, map_, is_asked_ ? &none_ : nullptr);
    is_asked_ = provisional_.wants_places();
    if (is_asked_) provisional_.note_asked();
    if (result.new_from_old) new_from_old_ = result.new_from_old;
    return result;
  }

  features::TestWorld world_ = corridor(5, 36.0);
  Config config_;
  scene::MapVersion map_;
  track::Tracker tracker_{{config_.track, config_.features, config_.optimize, 0}};
  ProvisionalRelocalization provisional_{config_, tracker_};
  const std::vector<Place> none_;
  bool is_asked_ = false;
  int num_views_ = 0;
  std::optional<core::Rigid3> new_from_old_;
};

TEST_F(ProvisionalRelocalizationTest, ManyViewsOfOnePlaceAreNoEvidence) {
  begin(core::KeyframeId(0));
  for (int i = 0; i < 100; ++i) {
    const auto result = look(world_, 0.0);
    ASSERT_EQ(result.decision, Decision::kOpen) << "view " << i;
    EXPECT_EQ(result.pose.status, core::FrameStatus::kProvisional);
    EXPECT_LT(world_from_frame(map_, result.pose).translation.norm(), 0.05);
  }
}

TEST_F(ProvisionalRelocalizationTest, MetresOfACorridorDoNotExcludeAnotherThatIsNotInTheMap) {
  begin(core::KeyframeId(0));
  EXPECT_EQ(walk(world_, 0.0, 12.0).decision, Decision::kOpen);
}

TEST_F(ProvisionalRelocalizationTest, IsTakenBackWhereTheCameraLeavesWhatBothPlacesHaveInCommon) {
  begin(core::KeyframeId(0));
  const End end = walk(different_from(world_, 5.0 + kSight_m, 1.0), 0.0, 14.0);
  EXPECT_EQ(end.decision, Decision::kTakenBack);
  EXPECT_GT(end.along_m, 5.0);
  EXPECT_LT(end.along_m, 5.0 + 5.0) << "all that is in view differs after 5 m";
  EXPECT_FALSE(provisional_.is_active());
}

class WithALookAlikeInTheMap : public ProvisionalRelocalizationTest {
 protected:
  void add_lookalike(double different_share) {
    lookalike_ = core::KeyframeId(map_.keyframes.size());
    add_walk(map_, different_from(world_, 0.0, different_share), 16.0, kFarRoom);
  }

  core::KeyframeId lookalike_;
};

TEST_F(WithALookAlikeInTheMap, IsConfirmedOverMetresIfItExplainsMuchLess) {
  add_lookalike(0.5);
  begin(core::KeyframeId(0), {lookalike_});
  const End end = walk(world_, 0.0, 10.0);
  ASSERT_EQ(end.decision, Decision::kConfirmed);
  EXPECT_GT(end.along_m, 0.2) << "one view is not enough";
  ASSERT_TRUE(end.confirmed);
  const core::Rigid3 pose = world_from_frame(map_, end.confirmed->track.pose);
  EXPECT_LT((pose.translation - at(end.along_m).translation).norm(), 0.1);
}

TEST_F(WithALookAlikeInTheMap, IsNeverConfirmedIfItExplainsAsMuch) {
  add_lookalike(0.0);
  begin(core::KeyframeId(0), {lookalike_});
  EXPECT_NE(walk(world_, 0.0, 12.0).decision, Decision::kConfirmed);
}

TEST_F(WithALookAlikeInTheMap, TheBestHypothesisTakesOverAndThePosesMove) {
  add_lookalike(0.5);
  begin(lookalike_, {core::KeyframeId(0)});
  EXPECT_EQ(walk(world_, 0.0, 10.0).decision, Decision::kConfirmed);
  ASSERT_TRUE(new_from_old_);
  EXPECT_LT((new_from_old_->translation + kFarRoom.translation).norm(), 0.2);
}

// The map of the predicted place ends after 3 m.
TEST_F(ProvisionalRelocalizationTest, MotionThatPredictsOnePlaceIsNoEvidenceForAnother) {
  const core::KeyframeId predicted(map_.keyframes.size());
  add_walk(map_, world_, 3.0, kFarRoom);
  begin(predicted, {core::KeyframeId(0)}, 4.0);
  const End end = walk(world_, 0.0, 12.0);
  ASSERT_TRUE(new_from_old_) << "the other place takes over";
  EXPECT_EQ(end.decision, Decision::kOpen);
}

TEST_F(ProvisionalRelocalizationTest, BridgesBlankViewsByTheLastMotion) {
  begin(core::KeyframeId(0));
  walk(world_, 0.0, 2.0);
  const auto result = look(features::TestWorld{}, 2.0);
  EXPECT_EQ(result.decision, Decision::kOpen);
  EXPECT_NEAR(world_from_frame(map_, result.pose).translation.z(), 2.0, 0.1);
  EXPECT_EQ(look(world_, 2.0 + kViews_m).decision, Decision::kOpen);
}

TEST_F(ProvisionalRelocalizationTest, IsTakenBackAfterManyBlankViews) {
  begin(core::KeyframeId(0));
  Decision decision = Decision::kOpen;
  for (int i = 0; i < 40 && decision == Decision::kOpen; ++i)
    decision = look(features::TestWorld{}, 0.0).decision;
  EXPECT_EQ(decision, Decision::kTakenBack);
}

}  // namespace
}  // namespace samewhere::pipeline
