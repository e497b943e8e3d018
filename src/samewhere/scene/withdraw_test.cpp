#include <algorithm>

#include <gtest/gtest.h>

#include <samewhere/scene/test_map_file.hpp>
#include <samewhere/scene/test_partition.hpp>

namespace samewhere::scene {
namespace {

const core::CandidateId kFalse(1000);
const core::CandidateId kTrue(1001);

class Withdraw : public MapFiles {
 protected:
  // A map of random edits, and a false loop closure between its first keyframe and its last, not
  // added yet.
  void begin(std::uint64_t seed) {
    random_ = core::Random(seed);
    map_ = {};
    RandomEdits edits(seed);
    for (int i = 0; i < 6; ++i) map_ = apply(std::move(map_), edits.next(map_));
    for (int i = 0; i < 3; ++i) add_rich_keyframe(seed);
    false_loop_ = {map_.keyframes.back().id, core::KeyframeId(0), random_pose(random_),
                   random_information(random_), kFalse};
    num_before_ = map_.landmarks.size();
  }

  // Every second feature shows a new landmark.
  void add_rich_keyframe(std::uint64_t seed) {
    Edit edit;
    Keyframe keyframe;
    keyframe.id = core::KeyframeId(map_.keyframes.size());
    keyframe.view = features::test_view(features::test_world(seed, 400),
                                        static_cast<int>(keyframe.id.index()), {});
    keyframe.odometry = {core::KeyframeId(0), random_pose(random_), random_information(random_)};
    keyframe.slots.resize(static_cast<std::size_t>(keyframe.view.features->size()));
    for (std::size_t slot = 0; slot < keyframe.slots.size(); slot += 2) {
      Landmark landmark;
      landmark.id = core::LandmarkId(map_.landmarks.size() + edit.landmarks.size());
      landmark.anchor = keyframe.id;
      landmark.position_in_anchor = {0.0, 0.0, random_.uniform() + 1.0};
      landmark.observations = {{keyframe.id, static_cast<int>(slot)}};
      keyframe.slots[slot] = landmark.id;
      edit.landmarks.push_back(landmark);
    }
    edit.keyframes = {keyframe};
    map_ = apply(std::move(map_), edit);
  }

  core::LandmarkId any_live() {
    core::LandmarkId id;
    do id = core::LandmarkId(random_.index(num_before_));
    while (!is_live(map_.at(id)));
    return id;
  }

  std::vector<core::LandmarkId> different_live(std::size_t count) {
    std::vector<core::LandmarkId> ids;
    while (ids.size() < count) {
      const core::LandmarkId id = any_live();
      if (std::find(ids.begin(), ids.end(), id) == ids.end()) ids.push_back(id);
    }
    return ids;
  }

  void add_false_loop() {
    Edit edge;
    edge.loops = {false_loop_};
    map_ = apply(std::move(map_), edge);
  }

  bool merge(core::LandmarkId from, core::LandmarkId to, core::CandidateId cause) {
    if (from == to || !is_live(map_.at(from)) || !is_live(map_.at(to))) return false;
    Edit edit;
    edit.merges = {{from, to, cause}};
    map_ = apply(std::move(map_), edit);
    return true;
  }

  // A new observation of a landmark by a free feature of any keyframe.
  void observe(core::LandmarkId id, core::CandidateId cause) {
    const Keyframe& keyframe = map_.keyframes[random_.index(map_.keyframes.size())];
    if (keyframe.slots.empty()) return;
    const auto slot = random_.index(keyframe.slots.size());
    const auto& observations = map_.at(id).observations;
    if (!is_live(keyframe) || keyframe.slots[slot].is_valid() ||
        std::any_of(observations.begin(), observations.end(),
                    [&](const Observation& o) { return o.keyframe == keyframe.id; }))
      return;
    Edit edit;
    edit.sightings = {{id, {keyframe.id, static_cast<int>(slot), cause}}};
    map_ = apply(std::move(map_), edit);
  }

  // Merges and observations caused by the false loop; later merges of landmarks that took part.
  void add_false_loop_and_merges() {
    add_false_loop();
    for (int i = 0; i < 15; ++i) {
      const core::LandmarkId one = any_live();
      const core::LandmarkId other = any_live();
      const bool is_merged = merge(one, other, kFalse);
      if (is_merged && random_.index(2) == 0) merge(other, any_live(), {});
      if (is_merged && random_.index(2) == 0) merge(any_live(), survivor_of(map_, one).id, kTrue);
      observe(any_live(), kFalse);
    }
  }

  MapVersion without_false_loop() const {
    Edit edit;
    edit.withdrawn_loops = {kFalse};
    return apply(map_, edit);
  }

  core::Random random_{0};
  MapVersion map_;
  LoopEdge false_loop_;
  std::size_t num_before_ = 0;
};

TEST_F(Withdraw, RestoresThePartitionOfLandmarks) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    begin(seed);
    const MapVersion before = map_;
    add_false_loop_and_merges();
    ASSERT_GT(map_.merges.size(), before.merges.size() + 10);
    const MapVersion after = without_false_loop();
    EXPECT_TRUE(partition_of(after) == partition_of(before));
    EXPECT_EQ(after.loops.size(), before.loops.size());
    ASSERT_EQ(after.merges.size(), before.merges.size());
    for (std::size_t i = 0; i < before.merges.size(); ++i)
      EXPECT_TRUE(is_same(after.merges[i], before.merges[i]));
    EXPECT_FALSE(partition_of(map_) == partition_of(before)) << "the loop changed nothing";
  }
}

TEST_F(Withdraw, RestoresThePartitionDespiteLaterCullingAndKeyframes) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    begin(seed);
    const auto before = survivors(map_, num_before_);
    add_false_loop_and_merges();
    RandomEdits edits(seed + 100);
    Edit later =
        edits.next(map_);  // a keyframe with observations, culling, outliers of bundle adjustment
    later.merges.clear();
    map_ = apply(std::move(map_), later);
    Edit cull;
    for (int i = 0; i < 10; ++i) cull.culled_landmarks.push_back(any_live());
    for (std::size_t i = 1; i + 1 < map_.keyframes.size() && cull.culled_keyframes.empty(); ++i) {
      const core::KeyframeId id(i);
      const bool is_held = std::any_of(map_.loops.begin(), map_.loops.end(), [&](const auto& l) {
        return l.query == id || l.match == id;
      });
      if (is_live(map_.at(id)) && !is_held) cull.culled_keyframes = {id};
    }
    map_ = apply(std::move(map_), cull);
    const MapVersion after = without_false_loop();
    EXPECT_EQ(survivors(after, num_before_), before);
    expect_slots_and_observations_agree(after);
  }
}

TEST_F(Withdraw, KeepsIndependentMerges) {
  begin(3);
  const std::vector<core::LandmarkId> ids = different_live(7);
  ASSERT_TRUE(merge(ids[0], ids[1], {}));
  add_false_loop();
  ASSERT_TRUE(merge(ids[2], ids[3], kFalse));
  ASSERT_TRUE(merge(ids[4], ids[5], kTrue));
  const core::LandmarkId younger(map_.landmarks.size());
  add_rich_keyframe(3);
  ASSERT_TRUE(merge(younger, ids[6], {}));
  const MapVersion after = without_false_loop();
  EXPECT_EQ(after.merges.size(), map_.merges.size() - 1);
  EXPECT_EQ(after.at(ids[0]).merged_into, ids[1]) << "merged before the loop";
  EXPECT_EQ(after.at(ids[4]).merged_into, ids[5]) << "caused by another loop";
  EXPECT_EQ(after.at(younger).merged_into, ids[6]) << "created after the loop";
  EXPECT_TRUE(is_live(after.at(ids[2])));
}

TEST_F(Withdraw, UndoesMergesOfMappingSinceTheLoop) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    begin(seed);
    for (int i = 0; i < 5; ++i) merge(any_live(), any_live(), {});
    const auto before = classes(map_, num_before_);
    add_false_loop();
    add_rich_keyframe(seed);
    num_before_ = map_.landmarks.size();  // to choose from: younger ones, too
    for (int i = 0; i < 60; ++i) merge(any_live(), any_live(), {});
    EXPECT_NE(classes(map_, before.size()), before) << "the loop changed nothing";
    const MapVersion after = without_false_loop();
    EXPECT_EQ(classes(after, before.size()), before);
    EXPECT_LT(after.merges.size(), map_.merges.size());
    expect_slots_and_observations_agree(after);
  }
}

TEST_F(Withdraw, SeparatesOldLandmarksMergedThroughAYoungerOne) {
  begin(9);
  const std::vector<core::LandmarkId> ids = different_live(2);
  const auto before = classes(map_, num_before_);
  add_false_loop();
  const core::LandmarkId younger(map_.landmarks.size());
  add_rich_keyframe(9);
  ASSERT_TRUE(merge(ids[0], younger, {}));
  ASSERT_TRUE(merge(younger, ids[1], {}));
  const MapVersion after = without_false_loop();
  EXPECT_EQ(classes(after, num_before_), before);
  EXPECT_EQ(after.at(ids[0]).merged_into, younger) << "one of the two merges stays";
}

TEST_F(Withdraw, UnmergingALandmarkUndoesItsLaterMergesAlone) {
  begin(4);
  const MapVersion before = map_;
  const core::LandmarkId a = any_live();
  core::LandmarkId b = any_live();
  while (b == a) b = any_live();
  core::LandmarkId c = any_live();
  while (c == a || c == b) c = any_live();
  ASSERT_TRUE(merge(a, b, {}));
  const Partition with_a_merged = partition_of(map_);
  ASSERT_TRUE(merge(b, c, {}));
  Edit unmerge;
  unmerge.unmerged_landmarks = {b};
  EXPECT_TRUE(partition_of(apply(map_, unmerge)) == with_a_merged) << "earlier ones stay";
  unmerge.unmerged_landmarks = {a};
  EXPECT_TRUE(partition_of(apply(map_, unmerge)) == partition_of(before)) << "later ones go";
}

TEST_F(Withdraw, KeepsThePositionOfAMergedLandmarkWhoseAnchorWasCulled) {
  begin(6);
  const core::KeyframeId anchor(map_.keyframes.size() - 2);
  const core::LandmarkId merged = map_.at(anchor).slots[0];
  Edit seen;
  seen.sightings = {{merged, {false_loop_.query, 1}}};
  map_ = apply(std::move(map_), seen);
  core::LandmarkId other = any_live();
  while (other == merged) other = any_live();
  ASSERT_TRUE(merge(merged, other, {}));
  Edit edge;
  edge.loops = {false_loop_};
  edge.pose_changes = {{anchor, random_pose(random_)}};
  map_ = apply(std::move(map_), edge);
  Edit cull;
  cull.culled_keyframes = {anchor};
  map_ = apply(std::move(map_), cull);
  const Eigen::Vector3d before = position_in_world(map_, map_.at(merged));

  MapVersion after = without_false_loop();
  Edit unmerge;
  unmerge.unmerged_landmarks = {merged};
  after = apply(std::move(after), unmerge);
  ASSERT_TRUE(is_live(after.at(merged)));
  EXPECT_LT((position_in_world(after, after.at(merged)) - before).norm(), 1e-9);
}

TEST_F(Withdraw, WorksOnAStoredMap) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    begin(seed);
    const Partition before = partition_of(map_);
    const std::filesystem::path file_path = path(std::to_string(seed) + ".sw");
    MapFile::create(file_path, {}).commit(map_, {});
    add_false_loop_and_merges();
    {
      MapFile file = MapFile::open(file_path, MapAccess::kExtend);
      file.load();
      file.commit(map_, {});
    }
    MapFile file = MapFile::open(file_path, MapAccess::kExtend);
    const StoredMap stored = file.load();
    expect_same(stored.map, map_);
    Edit edit;
    edit.withdrawn_loops = {kFalse};
    edit.suspended_loops = {false_loop_};
    const MapVersion after = apply(stored.map, edit);
    EXPECT_TRUE(partition_of(after) == before);
    file.commit(after, {});
    expect_same(MapFile::open(file_path).load().map, after);
  }
}

TEST_F(Withdraw, ASuspendedLoopIsNoEdgeUntilItIsAccepted) {
  begin(5);
  Edit suspend;
  suspend.suspended_loops = {false_loop_};
  const MapVersion suspended = apply(map_, suspend);
  EXPECT_EQ(suspended.loops.size(), map_.loops.size());
  EXPECT_EQ(suspended.suspended_loops.size(), map_.suspended_loops.size() + 1);
  Edit accept;
  accept.loops = {false_loop_};
  const MapVersion accepted = apply(suspended, accept);
  EXPECT_EQ(accepted.loops.size(), map_.loops.size() + 1);
  EXPECT_EQ(accepted.suspended_loops.size(), map_.suspended_loops.size());
}

TEST_F(Withdraw, DropsLocalBundleAdjustmentOfOlderKeyframesSinceTheLoop) {
  begin(7);
  const std::uint64_t newest = map_.keyframes.back().id.index();
  ASSERT_GE(newest, 3U);
  const auto refine = [&](std::uint64_t keyframe) {
    Edit edit;
    edit.refinements = {{core::KeyframeId(keyframe), random_pose(random_)}};
    map_ = apply(std::move(map_), edit);
  };
  refine(newest - 1);
  refine(newest);
  Edit edge;
  edge.loops = {false_loop_};
  map_ = apply(std::move(map_), edge);
  refine(newest);
  add_rich_keyframe(7);
  refine(newest + 1);
  const MapVersion after = without_false_loop();
  EXPECT_TRUE(after.keyframes[newest - 1].refined_parent_from_keyframe) << "before the loop";
  EXPECT_FALSE(after.keyframes[newest].refined_parent_from_keyframe) << "after the loop";
  EXPECT_TRUE(after.keyframes[newest + 1].refined_parent_from_keyframe) << "younger than the loop";
}

TEST_F(Withdraw, DropsFullBundleAdjustmentOfAllKeyframesSinceTheLoop) {
  begin(8);
  const std::uint64_t newest = map_.keyframes.back().id.index();
  const auto settle = [&](std::uint64_t keyframe) {
    Edit edit;
    edit.settled = {{core::KeyframeId(keyframe), random_pose(random_)}};
    map_ = apply(std::move(map_), edit);
  };
  const auto is_settled = [](const MapVersion& map, std::uint64_t keyframe) {
    return map.keyframes[keyframe].settled_parent_from_keyframe.has_value();
  };
  settle(newest - 1);
  Edit edge;
  edge.loops = {false_loop_};
  map_ = apply(std::move(map_), edge);
  add_rich_keyframe(8);
  settle(newest);
  settle(newest + 1);
  const MapVersion after = without_false_loop();
  EXPECT_TRUE(is_settled(after, newest - 1)) << "before the loop";
  EXPECT_FALSE(is_settled(after, newest));
  EXPECT_FALSE(is_settled(after, newest + 1)) << "younger than the loop, but optimized with it";
}

TEST_F(Withdraw, RefusesUnknownCausesAndLandmarksThatAreNotMerged) {
  begin(6);
  Edit edit;
  edit.withdrawn_loops = {core::CandidateId(123456)};
  EXPECT_THROW(apply(map_, edit), core::ContractError);
  edit.withdrawn_loops = {core::CandidateId{}};
  EXPECT_THROW(apply(map_, edit), core::ContractError) << "merges of mapping have no cause";
  Edit unmerge;
  unmerge.unmerged_landmarks = {any_live()};
  EXPECT_THROW(apply(map_, unmerge), core::ContractError);
}

}  // namespace
}  // namespace samewhere::scene
