// Relocalization in the map of the session, or of an earlier one.

#include <algorithm>

#include <gtest/gtest.h>
#include <opencv2/core/utility.hpp>

#include <samewhere/evaluate/trajectory_error.hpp>
#include <samewhere/pipeline/slam.hpp>
#include <samewhere/twin/front/twin.hpp>

namespace samewhere::pipeline {
namespace {

constexpr double kSamePlace_m = 0.1;
constexpr double kSamePlace_rad = 0.05;

Config config_of(const std::string& source, int num_frames) {
  cv::setNumThreads(1);
  Config config;
  config.source = source;
  config.twin.num_frames = num_frames;
  config.retrieve.window_frames = 75;
  return config;
}

struct Walk {
  std::vector<core::Frame> frames;
  core::Trajectory truth;
};

Walk walk_of(const Config& config) {
  const auto source = twin::open_twin(config.source, config.twin);
  Walk walk;
  while (const auto frame = source->next()) walk.frames.push_back(*frame);
  walk.truth = source->truth().trajectory;
  return walk;
}

core::Frame with_id(core::Frame frame, std::size_t index, std::uint16_t session) {
  frame.id = core::FrameId(index, session);
  frame.stamp_s = static_cast<double>(index) / 15.0;
  return frame;
}

scene::StoredMap stored(const Slam& slam) {
  return {slam.map(), {.frames = slam.frames(), .descriptors = slam.descriptors()}};
}

// World poses of the frames of a Slam; lost ones have none.
std::vector<std::optional<core::Rigid3>> poses_of(const Slam& slam) {
  std::vector<std::optional<core::Rigid3>> poses;
  for (const auto& frame : slam.frames()) {
    poses.emplace_back();
    if (frame.is_measured)
      poses.back() =
          world_from_body(slam.map(), frame.reference_keyframe) * frame.reference_from_frame;
  }
  return poses;
}

// Whether the pose is where the truth has it, in the world of the walk that began at truth[0].
bool is_right(const core::Rigid3& world_from_body, const Walk& walk, std::size_t position) {
  const core::Rigid3 truth =
      inverse(walk.truth[0].world_from_camera) * walk.truth[position].world_from_camera;
  const core::Rigid3 apart = inverse(truth) * world_from_body;
  return apart.translation.norm() < kSamePlace_m &&
         core::angle_rad(apart.rotation) < kSamePlace_rad;
}

TEST(Relocalization, LocalizesInItsOwnMapAndLeavesItUnchanged) {
  const Config config = config_of("twin:office-loop?seed=7", 40);
  const Walk walk = walk_of(config);
  Slam first(config);
  for (const auto& frame : walk.frames) first.feed(frame);
  first.finish();

  Slam second(config, stored(first), Slam::Use::kLocalize);
  ASSERT_EQ(second.session(), 1);
  // from the middle on, so that the place is not that of the first keyframe
  for (std::size_t i = 20; i < walk.frames.size(); ++i)
    second.feed(with_id(walk.frames[i], i - 20, 1));
  second.finish();
  const auto poses = poses_of(second);
  int num_measured = 0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (!poses[i]) continue;
    ++num_measured;
    EXPECT_TRUE(is_right(*poses[i], walk, 20 + i)) << "frame " << 20 + i;
  }
  EXPECT_GE(num_measured, 15) << "of 20: the first views decide between hypotheses";
  EXPECT_EQ(second.map().number, first.map().number) << "the map stays as it is";
  EXPECT_EQ(second.map().keyframes.size(), first.map().keyframes.size());
}

TEST(Relocalization, ALaterSessionExtendsTheMapOnceRelocalized) {
  Config config = config_of("twin:office-loop?seed=7", 40);
  config.verify.prior = verify::Prior::kUnique;
  const Walk walk = walk_of(config);
  Slam first(config);
  for (std::size_t i = 0; i < 20; ++i) first.feed(walk.frames[i]);
  first.finish();
  Slam second(config, stored(first), Slam::Use::kExtend);
  for (std::size_t i = 10; i < walk.frames.size(); ++i)
    second.feed(with_id(walk.frames[i], i - 10, 1));
  second.finish();
  const auto first_sure = static_cast<std::size_t>(config.track.relocalization.min_views - 1);
  EXPECT_EQ(second.frames()[first_sure].status, core::FrameStatus::kResumed);
  ASSERT_GT(second.map().keyframes.size(), first.map().keyframes.size());
  EXPECT_EQ(second.map().keyframes.back().view.frame.session(), 1);
  const auto poses = poses_of(second);
  ASSERT_TRUE(poses.back().has_value());
  EXPECT_TRUE(is_right(*poses.back(), walk, walk.frames.size() - 1))
      << "in the world of the first session";
}

// The office may have a look-alike that is not in the map.
TEST(Relocalization, NothingIsWrittenToTheMapWhileProvisional) {
  const Config config = config_of("twin:office-loop?seed=7", 60);
  const Walk walk = walk_of(config);
  Slam first(config);
  for (std::size_t i = 0; i < 20; ++i) first.feed(walk.frames[i]);
  first.finish();
  Slam second(config, stored(first), Slam::Use::kExtend);
  int num_provisional = 0;
  for (std::size_t i = 10; i < walk.frames.size(); ++i) {
    second.feed(with_id(walk.frames[i], i - 10, 1));
    EXPECT_FALSE(is_confirmed(second.frames().back())) << "frame " << i;
    num_provisional += second.phase() == SessionPhase::kProvisional ? 1 : 0;
  }
  second.finish();
  EXPECT_GE(num_provisional, 10);
  EXPECT_GE(second.relocalizations().num_provisional, 1);
  EXPECT_EQ(second.relocalizations().num_confirmed, 0);
  EXPECT_EQ(second.map().number, first.map().number);
  EXPECT_EQ(second.map().keyframes.size(), first.map().keyframes.size());
  EXPECT_TRUE(trajectory_of(second.map(), second.frames()).empty());
}

TEST(Relocalization, ProvisionalPosesAreIdenticalWithAndWithoutThreads) {
  Config config = config_of("twin:office-loop?seed=7", 40);
  const Walk walk = walk_of(config);
  Slam first(config);
  for (const auto& frame : walk.frames) first.feed(frame);
  first.finish();
  std::vector<std::vector<std::optional<core::Rigid3>>> poses;
  for (const bool threads : {false, true}) {
    config.threads = threads;
    Slam second(config, stored(first), Slam::Use::kExtend);
    for (std::size_t i = 10; i < walk.frames.size(); ++i)
      second.feed(with_id(walk.frames[i], i - 10, 1));
    second.finish();
    poses.push_back(poses_of(second));
  }
  ASSERT_EQ(poses[0].size(), poses[1].size());
  for (std::size_t i = 0; i < poses[0].size(); ++i) {
    ASSERT_EQ(poses[0][i].has_value(), poses[1][i].has_value()) << "frame " << i;
    if (!poses[0][i]) continue;
    EXPECT_EQ(poses[0][i]->translation, poses[1][i]->translation) << "frame " << i;
    EXPECT_EQ(poses[0][i]->rotation.coeffs(), poses[1][i]->rotation.coeffs()) << "frame " << i;
  }
}

TEST(Relocalization, AShortLossIsBridgedByThePredictedMotion) {
  const Config config = config_of("twin:office-loop?seed=7", 60);
  const Walk walk = walk_of(config);
  Slam slam(config);
  for (std::size_t i = 0; i < walk.frames.size(); ++i) {
    core::Frame frame = with_id(walk.frames[i], i, 0);
    if (i == 50 || i == 51) {
      frame.images[0] = cv::Mat::zeros(frame.images[0].size(), frame.images[0].type());
      frame.depth_m.reset();
    }
    slam.feed(frame);
  }
  slam.finish();
  EXPECT_GE(slam.relocalizations().num_by_motion, 1);
  EXPECT_EQ(slam.relocalizations().num_provisional, 0);
  EXPECT_EQ(slam.frames()[52].status, core::FrameStatus::kResumed);
}

TEST(Relocalization, RejectsAnotherBuilding) {
  const Config config = config_of("twin:office-loop?seed=7", 30);
  const Walk walk = walk_of(config);
  Slam first(config);
  for (const auto& frame : walk.frames) first.feed(frame);
  first.finish();
  const Walk elsewhere = walk_of(config_of("twin:office-loop?seed=8", 30));
  Slam second(config, stored(first), Slam::Use::kLocalize);
  for (std::size_t i = 0; i < elsewhere.frames.size(); ++i)
    second.feed(with_id(elsewhere.frames[i], i, 1));
  second.finish();
  for (const auto& frame : second.frames()) EXPECT_FALSE(frame.is_measured) << frame.frame;
  EXPECT_FALSE(second.ledger().empty()) << "every look-alike place has a verdict";
}

TEST(Relocalization, RelocalizesAKidnappedCamera) {
  const Config config = config_of("twin:office-loop?seed=7", 90);
  const Walk walk = walk_of(config);
  std::vector<std::size_t> positions;
  for (std::size_t i = 0; i < walk.frames.size(); ++i) positions.push_back(i);
  for (std::size_t i = 0; i < 15; ++i) positions.push_back(i);  // back at the start
  Slam slam(config);
  for (std::size_t i = 0; i < positions.size(); ++i) {
    core::Frame frame = with_id(walk.frames[positions[i]], i, 0);
    if (i >= walk.frames.size()) frame.stamp_s += 5.0;  // time to be carried there
    slam.feed(frame);
  }
  slam.finish();
  const auto poses = poses_of(slam);
  int num_measured = 0;
  for (std::size_t i = walk.frames.size(); i < positions.size(); ++i) {
    if (!poses[i]) continue;
    ++num_measured;
    EXPECT_TRUE(is_right(*poses[i], walk, positions[i])) << "frame " << positions[i] << " again";
  }
  EXPECT_GE(num_measured, 10) << "of 15: the first views decide between hypotheses";
}

TEST(Relocalization, DoesNotRelocalizeInAnUnmappedRoom) {
  const Config config = config_of("twin:office-loop?seed=7", 90);
  const Walk walk = walk_of(config);
  const Walk elsewhere = walk_of(config_of("twin:office-loop?seed=8", 25));
  Slam slam(config);
  std::size_t index = 0;
  for (const auto& frame : walk.frames) slam.feed(with_id(frame, index++, 0));
  const std::size_t num_before = index;
  for (const auto& other : elsewhere.frames) {
    core::Frame frame = with_id(other, index++, 0);
    frame.stamp_s += walk.frames.back().stamp_s + 60.0;  // the whole map is reachable
    slam.feed(frame);
  }
  slam.finish();
  for (std::size_t i = 0; i < index; ++i)
    EXPECT_EQ(slam.frames()[i].is_measured, i < num_before) << "frame " << i;
}

// The camera may have been carried to a look-alike place meanwhile: after a second motion still
// tells, after twenty it does not.
TEST(Relocalization, AfterALongGapAPoseThatCouldBeTrackedIsProvisional) {
  const Config config = config_of("twin:office-loop?seed=7", 60);
  const Walk walk = walk_of(config);
  const auto status_after = [&](double gap_s) {
    Slam slam(config);
    std::size_t index = 0;
    for (const auto& frame : walk.frames) slam.feed(with_id(frame, index++, 0));
    for (int i = 0; i < 15; ++i) {
      core::Frame frame = with_id(walk.frames.back(), index++, 0);
      frame.stamp_s += gap_s;
      slam.feed(frame);
    }
    slam.finish();
    return slam.frames().back().status;
  };
  EXPECT_EQ(status_after(1.5), core::FrameStatus::kTracking);
  EXPECT_EQ(status_after(20.0), core::FrameStatus::kProvisional);
}

TEST(Relocalization, RejectsPosesThatAreNotReachable) {
  const Config config = config_of("twin:office-loop?seed=7", 90);
  const Walk walk = walk_of(config);
  Slam slam(config);
  std::size_t index = 0;
  for (const auto& frame : walk.frames) slam.feed(with_id(frame, index++, 0));
  const std::size_t num_before = index;
  for (std::size_t i = 0; i < 5; ++i) slam.feed(with_id(walk.frames[i], index++, 0));
  slam.finish();
  const double way_m = (walk.truth.front().world_from_camera.translation -
                        walk.truth.back().world_from_camera.translation)
                           .norm();
  ASSERT_GT(way_m, 0.5 + config.track.relocalization.max_speed_m_s * 5.0 / 15.0)
      << "else it is reachable";
  for (std::size_t i = num_before; i < index; ++i)
    EXPECT_FALSE(slam.frames()[i].is_measured) << "frame " << i;
}

TEST(Relocalization, RelocalizesAKidnappedMonocularCamera) {
  constexpr std::size_t kFirst = 40;
  constexpr std::size_t kNumAgain = 20;
  const Config config = config_of("twin:office-loop?seed=7&camera=mono", 90);
  const Walk walk = walk_of(config);
  std::vector<std::size_t> positions;
  for (std::size_t i = 0; i < walk.frames.size(); ++i) positions.push_back(i);
  for (std::size_t i = 0; i < kNumAgain; ++i) positions.push_back(kFirst + i);
  Slam slam(config, DepthFrom::kMotion);
  for (std::size_t i = 0; i < positions.size(); ++i)
    slam.feed(with_id(walk.frames[positions[i]], i, 0));
  slam.finish();
  const auto poses = poses_of(slam);
  ASSERT_TRUE(poses[kFirst] && poses[walk.frames.size() - 1]);
  const auto between = [&](std::size_t a, std::size_t b) { return inverse(*poses[a]) * *poses[b]; };
  // no metric scale; a wrong place would be off by much of the distance between both
  const double way = between(kFirst, walk.frames.size() - 1).translation.norm();
  int num_measured = 0;
  for (std::size_t i = walk.frames.size(); i < positions.size(); ++i) {
    if (!poses[i] || !poses[positions[i]]) continue;
    ++num_measured;
    EXPECT_LT(between(positions[i], i).translation.norm(), 0.1 * way) << "frame " << positions[i];
    EXPECT_LT(core::angle_rad(between(positions[i], i).rotation), kSamePlace_rad);
  }
  EXPECT_GE(num_measured, 14) << "of " << kNumAgain << ", provisional";
}

// A monocular camera, moved after a second to another building.
class MovedToAnotherBuilding : public testing::Test {
 protected:
  static constexpr int kNumBefore = 25;
  static constexpr int kNumAfter = 60;

  void walk_on(Slam& slam) const {
    std::size_t i = 0;
    for (const auto& frame : before_.frames) slam.feed(with_id(frame, i++, 0));
    for (const auto& frame : after_.frames) slam.feed(with_id(frame, i++, 0));
    slam.finish();
  }
  // Poses of either building.
  static int num_measured(const Slam& slam, std::size_t begin, std::size_t end) {
    const auto poses = poses_of(slam);
    return static_cast<int>(std::count_if(poses.begin() + static_cast<std::ptrdiff_t>(begin),
                                          poses.begin() + static_cast<std::ptrdiff_t>(end),
                                          [](const auto& pose) { return pose.has_value(); }));
  }
  static int num_before(const Slam& slam) { return num_measured(slam, 0, kNumBefore); }
  static int num_after(const Slam& slam) {
    return num_measured(slam, kNumBefore, kNumBefore + kNumAfter);
  }

  Config config_ = config_of("twin:office-loop?seed=7&camera=mono", kNumBefore);
  Walk before_ = walk_of(config_);
  Walk after_ = walk_of(config_of("twin:twin-corridors?seed=7&camera=mono", kNumAfter));
};

TEST_F(MovedToAnotherBuilding, ASmallMapIsDiscardedByReinitialization) {
  Slam slam(config_, DepthFrom::kMotion);
  walk_on(slam);
  EXPECT_EQ(num_before(slam), 0) << "poses of the discarded map";
  EXPECT_GE(slam.num_reinitializations(), 1);
  EXPECT_GE(num_after(slam), 40) << "of " << kNumAfter;
  core::Trajectory trajectory = trajectory_of(slam.map(), slam.frames());
  for (auto& pose : trajectory) pose.stamp_s -= kNumBefore / 15.0;
  const auto error = evaluate::ate(after_.truth, trajectory, evaluate::Alignment::kSim3);
  ASSERT_TRUE(error);
  EXPECT_LT(error->rmse_m, 0.05);
  const core::KeyframeId first = slam.frames().back().reference_keyframe;
  for (const auto& shown : slam.map().at(first).slots) {
    EXPECT_TRUE(!shown.is_valid() || is_live(survivor_of(slam.map(), shown)));
  }
}

TEST_F(MovedToAnotherBuilding, AMapThatIsNotProvisionalIsKept) {
  config_.track.initialization.provisional_keyframes = 0;
  Slam slam(config_, DepthFrom::kMotion);
  walk_on(slam);
  EXPECT_GE(num_before(slam), 10);
  EXPECT_EQ(num_after(slam), 0) << "the other building is not in the map";
  EXPECT_EQ(slam.num_reinitializations(), 0);
}

}  // namespace
}  // namespace samewhere::pipeline
