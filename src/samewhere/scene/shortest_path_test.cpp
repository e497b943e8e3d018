#include <gtest/gtest.h>

#include <samewhere/scene/test_map_file.hpp>

namespace samewhere::scene {
namespace {

// A chain 0 - 1 - ... - 9 of odometry and a loop between 1 and 8.
TEST(ShortestPath, UsesALoopThatIsShorterThanOdometry) {
  const features::View view = features::test_view(features::test_world(1, 20), 0, {});
  Edit edit;
  for (std::uint64_t i = 0; i < 10; ++i) {
    Keyframe keyframe;
    keyframe.id = core::KeyframeId(i);
    keyframe.view = view;
    keyframe.slots.resize(static_cast<std::size_t>(view.features->size()));
    if (i > 0) keyframe.odometry = {core::KeyframeId(i - 1), {}, core::Matrix6d::Identity()};
    edit.keyframes.push_back(keyframe);
  }
  const MapVersion chain = apply({}, edit);
  const core::KeyframeId two(2);
  EXPECT_FALSE(shortest_path_uses_loop(chain, core::KeyframeId(9), two));
  Edit loop;
  loop.loops = {{core::KeyframeId(8),
                 core::KeyframeId(1),
                 {},
                 core::Matrix6d::Identity(),
                 core::CandidateId(1)}};
  const MapVersion closed = apply(chain, loop);
  EXPECT_TRUE(shortest_path_uses_loop(closed, core::KeyframeId(9), two));
  EXPECT_TRUE(shortest_path_uses_loop(closed, two, core::KeyframeId(9)));
  EXPECT_FALSE(shortest_path_uses_loop(closed, core::KeyframeId(9), core::KeyframeId(7)));
  EXPECT_FALSE(shortest_path_uses_loop(closed, two, two));
}

}  // namespace
}  // namespace samewhere::scene
