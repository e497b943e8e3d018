#include <gmock/gmock.h>
#include <unistd.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/tum_file.hpp>
#include <samewhere/map/test_map.hpp>
#include <samewhere/optimize/g2o_file.hpp>
#include <samewhere/run/map_export.hpp>

namespace samewhere::run {
namespace {

using testing::HasSubstr;

class MapExport : public testing::Test {
 protected:
  ~MapExport() override { std::filesystem::remove(path_); }

  // A frame a keyframe, and of a second session one more, which has the first one's stamp.
  static scene::StoredMap stored_map(int num_sessions) {
    scene::StoredMap stored{.map = map::test_map(features::test_world(1), 6), .extras = {}};
    for (std::size_t i = 0; i < stored.map.keyframes.size(); ++i)
      stored.extras.frames.push_back(frame_of(core::FrameId(i), 0.1 * static_cast<double>(i)));
    if (num_sessions == 2) stored.extras.frames.push_back(frame_of(core::FrameId(0, 1), 0.0));
    return stored;
  }

  static core::FramePose frame_of(core::FrameId id, double stamp_s) {
    return {.frame = id,
            .stamp_s = stamp_s,
            .status = core::FrameStatus::kTracking,
            .is_measured = true,
            .reference_keyframe = core::KeyframeId(0)};
  }

  std::string complaint(const scene::StoredMap& stored, int session) const {
    try {
      export_map(stored, {.ply = {}, .tum = path_, .kitti = {}, .g2o = {}, .session = session});
    } catch (const core::InputError& error) {
      return error.what();
    }
    return "none";
  }

  std::filesystem::path path_ = testing::TempDir() + "map_export_" + std::to_string(getpid());
};

TEST_F(MapExport, OdometryPastACulledKeyframeIsNoLoop) {
  scene::StoredMap stored = stored_map(1);
  stored.map = apply(stored.map, {.culled_keyframes = {core::KeyframeId(2), core::KeyframeId(3)}});
  export_map(stored, {.ply = {}, .tum = {}, .kitti = {}, .g2o = path_, .session = -1});
  const optimize::G2oGraph graph = optimize::read_g2o(path_);
  EXPECT_EQ(graph.names, (std::vector<long>{0, 1, 2, 3}));
  ASSERT_EQ(graph.graph.edges.size(), 3U);
  for (const optimize::PoseEdge& edge : graph.graph.edges) EXPECT_FALSE(edge.is_loop);
}

TEST_F(MapExport, FramesAreOfOneSession) {
  const scene::StoredMap two = stored_map(2);
  EXPECT_THAT(complaint(two, -1),
              HasSubstr("--session = none: the map holds frames of 2 sessions"));
  EXPECT_THAT(complaint(two, 2), HasSubstr("expected one of 0 to 1"));
  EXPECT_EQ(complaint(two, 0), "none");
  EXPECT_EQ(core::read_tum(path_).size(), 6U);
  EXPECT_EQ(complaint(two, 1), "none");
  EXPECT_EQ(core::read_tum(path_).size(), 1U);
  EXPECT_EQ(complaint(stored_map(1), -1), "none") << "no choice";
  EXPECT_EQ(core::read_tum(path_).size(), 6U);
}

TEST_F(MapExport, SessionsAreCountedByTheirFrames) {
  EXPECT_EQ(figures_of_map({}, stored_map(2)).front().value, "2") << "though it added no keyframe";
}

}  // namespace
}  // namespace samewhere::run
