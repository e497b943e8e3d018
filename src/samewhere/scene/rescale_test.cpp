#include <cmath>

#include <gtest/gtest.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/scene/known_depths.hpp>
#include <samewhere/scene/rescale.hpp>
#include <samewhere/scene/test_edits.hpp>

namespace samewhere::scene {
namespace {

MapVersion random_map(std::uint64_t seed) {
  RandomEdits edits(seed);
  MapVersion map;
  for (int i = 0; i < 12; ++i) map = apply(std::move(map), edits.next(map));
  return map;
}

core::Rigid3 stretched(core::Rigid3 pose, double factor) {
  pose.translation *= factor;
  return pose;
}

// The whole world `factor` times as large.
Edit growth(const MapVersion& map, double factor) {
  Edit edit;
  for (std::size_t i = 0; i < map.keyframes.size(); ++i) {
    const Keyframe& keyframe = map.keyframes[i];
    if (!is_live(keyframe)) continue;
    const core::Rigid3 grown = stretched(keyframe.world_from_body, factor);
    edit.pose_changes.push_back({keyframe.id, grown * inverse(keyframe.world_from_body), factor});
  }
  return edit;
}

double chi2(const core::Rigid3& found, const core::Rigid3& measured,
            const core::Matrix6d& information) {
  const core::Vector6d error = core::log_r3so3(inverse(measured) * found);
  core::Vector6d r;
  r << found.translation - measured.translation, error.tail<3>();
  return r.dot(information * r);
}

TEST(Rescale, AWorldThatGrowsAsAWholeIsTheSameWorld) {
  constexpr double kFactor = 1.7;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    SCOPED_TRACE(seed);
    const MapVersion before = random_map(seed);
    const MapVersion after = apply(before, growth(before, kFactor));
    for (std::size_t i = 0; i < before.keyframes.size(); ++i) {
      const core::KeyframeId id(i);
      EXPECT_TRUE(stretched(world_from_body(before, id), kFactor)
                      .matrix()
                      .isApprox(world_from_body(after, id).matrix(), 1e-9));
      EXPECT_NEAR(after.at(id).log_scale, before.at(id).log_scale + std::log(kFactor), 1e-12);
    }
    for (std::size_t i = 0; i < before.landmarks.size(); ++i) {
      const core::LandmarkId id(i);
      EXPECT_TRUE((kFactor * position_in_world(before, before.at(id)))
                      .isApprox(position_in_world(after, after.at(id)), 1e-9));
    }
    ASSERT_EQ(before.loops.size(), after.loops.size());
    for (std::size_t i = 0; i < before.loops.size(); ++i) {
      const LoopEdge& was = before.loops[i];
      const LoopEdge& is = after.loops[i];
      EXPECT_NEAR(is.log_scale, was.log_scale, 1e-12);
      const auto seen = [](const MapVersion& map, const LoopEdge& loop) {
        return inverse(world_from_body(map, loop.match)) * world_from_body(map, loop.query);
      };
      const double expected = chi2(seen(before, was), was.match_from_query, was.information);
      EXPECT_NEAR(chi2(seen(after, is), is.match_from_query, is.information), expected,
                  1e-9 * expected)
          << "an error in variances has no unit";
    }
    const auto odometry_before = odometry_poses(before);
    const auto odometry_after = odometry_poses(after);
    for (std::size_t i = 1; i < odometry_before.size(); ++i) {
      const core::Rigid3 was = inverse(odometry_before[0]) * odometry_before[i];
      const core::Rigid3 is = inverse(odometry_after[0]) * odometry_after[i];
      if (before.keyframes[i].odometry) {
        EXPECT_TRUE(was.matrix().isApprox(is.matrix(), 1e-9)) << "odometry stays as it measured";
      }
    }
  }
}

TEST(Rescale, OneKeyframeStretchesWhatWasMeasuredFromIt) {
  const MapVersion before = random_map(3);
  core::KeyframeId parent;
  for (std::size_t i = 0; i < before.keyframes.size(); ++i)
    if (is_live(before.keyframes[i]) && before.keyframes[i].odometry)
      parent = before.keyframes[i].odometry->parent;
  ASSERT_TRUE(parent.is_valid());
  Edit edit;
  edit.pose_changes = {{parent, core::Rigid3{}, 2.0}};
  const MapVersion after = apply(before, edit);
  int num_children = 0;
  for (std::size_t i = 0; i < before.keyframes.size(); ++i) {
    const Keyframe& was = before.keyframes[i];
    const Keyframe& is = after.keyframes[i];
    const bool hangs_there = holder_of(before, was.id).keyframe == parent;
    EXPECT_NEAR(is.log_scale - was.log_scale, hangs_there ? std::log(2.0) : 0.0, 1e-12) << i;
    if (!was.odometry || was.odometry->parent != parent) continue;
    ++num_children;
    EXPECT_TRUE((2.0 * was.odometry->parent_from_keyframe.translation)
                    .isApprox(is.odometry->parent_from_keyframe.translation));
  }
  EXPECT_GT(num_children, 0);
  for (std::size_t i = 0; i < before.loops.size(); ++i) {
    const LoopEdge& loop = before.loops[i];
    const auto is_there = [&](core::KeyframeId id) {
      return holder_of(before, id).keyframe == parent ? 1.0 : 0.0;
    };
    EXPECT_NEAR(after.loops[i].log_scale - loop.log_scale,
                std::log(2.0) * (is_there(loop.match) - is_there(loop.query)), 1e-12);
  }
}

TEST(Rescale, AFrameIsAsFarFromItsKeyframeAsThatSaysToday) {
  MapVersion map = random_map(4);
  const core::KeyframeId id(0);
  core::FramePose pose{.is_measured = true, .reference_keyframe = id};
  pose.reference_from_frame.translation = {1.0, 2.0, 3.0};
  pose.log_scale = map.at(id).log_scale;
  Edit edit;
  edit.pose_changes = {{id, core::Rigid3{}, 0.5}};
  map = apply(std::move(map), edit);
  EXPECT_TRUE(reference_from_frame(map, pose).translation.isApprox(Eigen::Vector3d(0.5, 1.0, 1.5)));
}

TEST(Rescale, AFactorThatIsNotPositiveIsABrokenPromise) {
  MapVersion map = random_map(5);
  EXPECT_THROW(rescale(map, {1.0}), core::ContractError);
  EXPECT_THROW(rescale(map, std::vector<double>(map.keyframes.size(), 0.0)), core::ContractError);
}

TEST(KnownDepths, AreThoseOfTheLandmarksThatAKeyframeShows) {
  const MapVersion map = random_map(6);
  int num_known = 0;
  for (std::size_t i = 0; i < map.keyframes.size(); ++i) {
    const Keyframe& keyframe = map.keyframes[i];
    const features::View view = with_known_depths(map, keyframe.id);
    for (std::size_t slot = 0; slot < keyframe.slots.size(); ++slot) {
      const core::LandmarkId shown = keyframe.slots[slot];
      if (!shown.is_valid()) {
        EXPECT_EQ(view.features->depth_m[slot], 0.0F);
        continue;
      }
      const Eigen::Vector3d in_body =
          inverse(world_from_body(map, keyframe.id)) * position_in_world(map, map.at(shown));
      EXPECT_NEAR(view.features->depth_m[slot], std::max(0.0, in_body.z()), 1e-4);
      num_known += in_body.z() > 0.0 ? 1 : 0;
    }
  }
  EXPECT_GT(num_known, 4);
}

}  // namespace
}  // namespace samewhere::scene
