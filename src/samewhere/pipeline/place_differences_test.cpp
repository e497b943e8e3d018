#include <gtest/gtest.h>

#include <samewhere/features/test_world.hpp>
#include <samewhere/map/mapper.hpp>
#include <samewhere/map/test_map.hpp>
#include <samewhere/pipeline/config.hpp>
#include <samewhere/pipeline/place_differences.hpp>

namespace samewhere::pipeline {
namespace {

constexpr double kWall_m = 5.0;
const core::KeyframeId kFirstPlace(0);
const core::KeyframeId kSecondPlace(1);
const core::Rigid3 kElsewhere{Eigen::Quaterniond::Identity(), {50.0, 0.0, 0.0}};

// A wall in front of the camera, with some 30 points in each cell of the image.
features::TestWorld wall(std::uint64_t seed) {
  core::Random random(seed);
  features::TestWorld world;
  for (int i = 0; i < 1500; ++i) {
    world.points.emplace_back(random.uniform(-3.2, 3.2), random.uniform(-2.4, 2.4), kWall_m);
    std::array<std::uint8_t, 32> descriptor{};
    for (auto& byte : descriptor) byte = static_cast<std::uint8_t>(random.index(256));
    world.descriptors.push_back(descriptor);
  }
  return world;
}

// Another picture hangs on the wall, from left_m to right_m.
features::TestWorld with_picture(features::TestWorld world, double left_m, double right_m,
                                 std::uint64_t seed) {
  core::Random random(seed);
  for (std::size_t i = 0; i < world.points.size(); ++i) {
    const Eigen::Vector3d& point = world.points[i];
    if (point.x() < left_m || point.x() > right_m || std::abs(point.y()) > 1.2) continue;
    for (auto& byte : world.descriptors[i]) byte = static_cast<std::uint8_t>(random.index(256));
  }
  return world;
}

class PlaceDifferencesTest : public testing::Test {
 protected:
  // The camera sees `seen`; the map holds `here` and, far away, `there`.
  void add(const features::TestWorld& seen, const features::TestWorld& here,
           const features::TestWorld& there) {
    scene::MapVersion map;
    map = apply(map, map::start_map(map, features::test_view(here, 0, {}), {}));
    map = apply(map, map::start_map(map, features::test_view(there, 1, {}), kElsewhere));
    const features::View view = features::test_view(seen, 10, {});
    const RelocalizedPose at_here = pose_at(map, view, kFirstPlace);
    const RelocalizedPose at_there = pose_at(map, view, kSecondPlace);
    const ViewEvidence of_here = measure_view(view, map, place_of(at_here), &at_here, config_.map);
    const ViewEvidence of_there =
        measure_view(view, map, place_of(at_there), &at_there, config_.map);
    differences_.add(view, {of_here, at_here}, {of_there, at_there});
  }

  RelocalizedPose pose_at(const scene::MapVersion& map, const features::View& view,
                          core::KeyframeId keyframe) {
    scene::LocalMap local_map = map::local_map(map, keyframe, config_.map);
    auto track = tracker_.track(view, local_map, {});
    EXPECT_TRUE(track.has_value());
    return {std::move(local_map), track.value_or(track::Track{})};
  }

  Config config_;
  track::Tracker tracker_{{config_.track, config_.features, config_.optimize, 0}};
  PlaceDifferences differences_;
  features::TestWorld here_ = wall(3);
};

TEST_F(PlaceDifferencesTest, EqualPlacesShowTheSameObjects) {
  add(here_, here_, here_);
  EXPECT_GT(differences_.both(), 20.0);
  EXPECT_EQ(differences_.only_here(), 0.0);
  EXPECT_EQ(differences_.only_there(), 0.0);
  EXPECT_FALSE(differences_.is_here());
  EXPECT_EQ(log_ratio_by_differences(differences_), 0.0);
}

TEST_F(PlaceDifferencesTest, AnObjectOfOnePlaceTellsThemApart) {
  add(here_, here_, with_picture(here_, -2.4, 0.0, 4));
  EXPECT_GE(differences_.only_here(), 4.0);
  EXPECT_EQ(differences_.only_there(), 0.0);
  EXPECT_TRUE(differences_.is_here());
  EXPECT_FALSE(differences_.is_there()) << "the camera is here";
  EXPECT_TRUE(differences_.swapped().is_there());
  EXPECT_GT(log_ratio_by_differences(differences_), 1.5);
}

TEST_F(PlaceDifferencesTest, AnObjectCountsOnce) {
  const features::TestWorld there = with_picture(here_, -2.4, 0.0, 4);
  add(here_, here_, there);
  const double once = differences_.only_here();
  for (int i = 0; i < 10; ++i) add(here_, here_, there);
  EXPECT_LT(differences_.only_here(), 1.1 * once);
}

TEST_F(PlaceDifferencesTest, AThirdPlaceDiffersFromBoth) {
  const features::TestWorld third = with_picture(here_, -2.4, 0.0, 4);
  const features::TestWorld there = with_picture(third, 0.0, 2.4, 5);
  add(third, here_, there);
  EXPECT_GE(differences_.only_here(), 3.0);
  EXPECT_GE(differences_.only_there(), 3.0);
  EXPECT_FALSE(differences_.is_here());
  EXPECT_FALSE(differences_.is_there());
  EXPECT_LT(log_ratio_by_differences(differences_), 0.0);
}

TEST(LogRatioByObjects, OfAPlaceThatIsNotInTheMapMostMayBeThoseOfThisOne) {
  constexpr double kConfirmed = 2.5;  // track.relocalization.min_log_ratio
  EXPECT_EQ(log_ratio_by_objects(0.0, 0.0), 0.0);
  EXPECT_GT(log_ratio_by_objects(7.0, 0.0), kConfirmed);
  EXPECT_LT(log_ratio_by_objects(4.0, 0.0), kConfirmed) << "a closer one may show as many";
  EXPECT_LT(log_ratio_by_objects(8.0, 1.0), kConfirmed);
  EXPECT_LT(log_ratio_by_objects(5.0, 2.0), 0.0);
  for (double own = 1.0; own < 30.0; ++own)
    EXPECT_GT(log_ratio_by_objects(own + 1.0, 0.0), log_ratio_by_objects(own, 0.0));
}

}  // namespace
}  // namespace samewhere::pipeline
