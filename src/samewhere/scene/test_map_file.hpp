#pragma once

#include <cmath>
#include <filesystem>
#include <functional>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <unistd.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/scene/test_edits.hpp>

namespace samewhere::scene {

// Bit for bit, by hand: not by the lists that the file is written by.
inline bool is_same(const core::Rigid3& a, const core::Rigid3& b) {
  return a.rotation.coeffs() == b.rotation.coeffs() && a.translation == b.translation;
}

inline bool is_same(const OdometryEdge& a, const OdometryEdge& b) {
  return a.parent == b.parent && is_same(a.parent_from_keyframe, b.parent_from_keyframe) &&
         a.information == b.information;
}

template <class T>
bool is_same(const std::optional<T>& a, const std::optional<T>& b) {
  return a.has_value() == b.has_value() && (!a || is_same(*a, *b));
}

inline bool is_same(const features::View& a, const features::View& b) {
  const features::Features& f = *a.features;
  const features::Features& g = *b.features;
  return a.frame == b.frame && a.stamp_s == b.stamp_s && a.image_size_px == b.image_size_px &&
         f.raw_px == g.raw_px && f.undistorted_px == g.undistorted_px && f.depth_m == g.depth_m &&
         f.right_x_px == g.right_x_px && f.octave == g.octave && f.angle_rad == g.angle_rad &&
         f.rgb == g.rgb && cv::norm(f.descriptors, g.descriptors, cv::NORM_L1) == 0.0 &&
         std::get<0>(a.rig->cameras[0]).fx_px == std::get<0>(b.rig->cameras[0]).fx_px;
}

inline bool is_same(const Keyframe& a, const Keyframe& b) {
  return a.id == b.id && is_same(a.world_from_body, b.world_from_body) &&
         is_same(a.odometry, b.odometry) && is_same(a.view, b.view) && a.slots == b.slots &&
         is_same(a.refined_parent_from_keyframe, b.refined_parent_from_keyframe) &&
         a.refined_at == b.refined_at &&
         is_same(a.settled_parent_from_keyframe, b.settled_parent_from_keyframe) &&
         a.settled_at == b.settled_at && a.log_scale == b.log_scale &&
         is_same(a.culled_parent_from_keyframe, b.culled_parent_from_keyframe);
}

inline bool is_same(const Landmark& a, const Landmark& b) {
  const auto same_observation = [](const Observation& o, const Observation& p) {
    return o.keyframe == p.keyframe && o.slot == p.slot && o.cause == p.cause;
  };
  return a.id == b.id && a.anchor == b.anchor && a.position_in_anchor == b.position_in_anchor &&
         a.normal_in_anchor == b.normal_in_anchor &&
         std::signbit(a.normal_in_anchor.x()) == std::signbit(b.normal_in_anchor.x()) &&
         a.range_m == b.range_m && a.octave == b.octave && a.weight == b.weight &&
         a.descriptor == b.descriptor && a.rgb == b.rgb && a.merged_into == b.merged_into &&
         a.is_culled == b.is_culled &&
         std::equal(a.observations.begin(), a.observations.end(), b.observations.begin(),
                    b.observations.end(), same_observation);
}

inline bool is_same(const LoopEdge& a, const LoopEdge& b) {
  return a.query == b.query && a.match == b.match &&
         is_same(a.match_from_query, b.match_from_query) && a.information == b.information &&
         a.cause == b.cause && a.log_scale == b.log_scale && a.closed_at == b.closed_at &&
         a.num_landmarks_then == b.num_landmarks_then;
}

inline bool is_same(const Merge& a, const Merge& b) {
  return a.from == b.from && a.to == b.to && a.cause == b.cause && a.made_at == b.made_at;
}

inline void expect_same(const MapVersion& a, const MapVersion& b) {
  ASSERT_EQ(a.merges.size(), b.merges.size());
  for (std::size_t i = 0; i < a.merges.size(); ++i)
    EXPECT_TRUE(is_same(a.merges[i], b.merges[i])) << "merge " << i;
  ASSERT_EQ(a.number, b.number);
  ASSERT_EQ(a.keyframes.size(), b.keyframes.size());
  ASSERT_EQ(a.landmarks.size(), b.landmarks.size());
  ASSERT_EQ(a.loops.size(), b.loops.size());
  for (std::size_t i = 0; i < a.keyframes.size(); ++i)
    EXPECT_TRUE(is_same(a.keyframes[i], b.keyframes[i])) << "keyframe " << i;
  for (std::size_t i = 0; i < a.landmarks.size(); ++i)
    EXPECT_TRUE(is_same(a.landmarks[i], b.landmarks[i])) << "landmark " << i;
  for (std::size_t i = 0; i < a.loops.size(); ++i)
    EXPECT_TRUE(is_same(a.loops[i], b.loops[i])) << "loop " << i;
  ASSERT_EQ(a.suspended_loops.size(), b.suspended_loops.size());
  for (std::size_t i = 0; i < a.suspended_loops.size(); ++i)
    EXPECT_TRUE(is_same(a.suspended_loops[i], b.suspended_loops[i])) << "suspended loop " << i;
}

inline void expect_same(const MapExtras& a, const MapExtras& b) {
  EXPECT_EQ(a.ledger, b.ledger);
  ASSERT_EQ(a.descriptors.size(), b.descriptors.size());
  for (std::size_t i = 0; i < a.descriptors.size(); ++i) {
    EXPECT_EQ(a.descriptors[i].frame, b.descriptors[i].frame);
    EXPECT_EQ(a.descriptors[i].unit, b.descriptors[i].unit);
    EXPECT_EQ(a.descriptors[i].describer_checksum, b.descriptors[i].describer_checksum);
  }
  ASSERT_EQ(a.frames.size(), b.frames.size());
  for (std::size_t i = 0; i < a.frames.size(); ++i) {
    const core::FramePose& f = a.frames[i];
    const core::FramePose& g = b.frames[i];
    EXPECT_TRUE(f.frame == g.frame && f.stamp_s == g.stamp_s && f.status == g.status &&
                f.is_measured == g.is_measured && f.reference_keyframe == g.reference_keyframe &&
                is_same(f.reference_from_frame, g.reference_from_frame) &&
                f.information == g.information && f.num_inliers == g.num_inliers)
        << "frame " << i;
  }
}

class MapFiles : public testing::Test {
 protected:
  MapFiles() {
    folder_ = std::filesystem::path(testing::TempDir()) /
              ("samewhere_map_file_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder_);
  }
  ~MapFiles() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path path(const std::string& name = "m.sw") const { return folder_ / name; }

  static std::string complaint(const std::function<void()>& work) {
    try {
      work();
    } catch (const core::InputError& error) {
      return error.what();
    }
    return "none";
  }

  // A map of a few keyframes in path().
  MapVersion write_small_map() const {
    MapFile file = MapFile::create(path(), {{"features.num_features", "1000"}});
    RandomEdits edits(1);
    core::Random random(1);
    MapVersion map;
    for (int i = 0; i < kNumKeyframes; ++i) {
      map = apply(std::move(map), edits.next(map));
      file.commit(map, extras_of(map, random));
    }
    return map;
  }

  static constexpr int kNumKeyframes = 10;
  std::filesystem::path folder_;
};

}  // namespace samewhere::scene
