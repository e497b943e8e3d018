#pragma once

// How the parts of a map are written as bytes (bytes.hpp): each list names every field once.

#include <samewhere/core/descriptor.hpp>
#include <samewhere/core/frame_pose.hpp>
#include <samewhere/scene/bytes.hpp>
#include <samewhere/scene/map_version.hpp>

namespace samewhere::scene {

template <class Archive>
void fields(Archive& archive, Value<Archive, core::PinholeRadtan>& camera) {
  archive(camera.width_px, camera.height_px, camera.fx_px, camera.fy_px, camera.cx_px, camera.cy_px,
          camera.k1, camera.k2, camera.p1, camera.p2, camera.k3);
}

// Of a view in a map every camera is of this model (core/rig.hpp), without k4 k5 k6.
template <class Archive>
void fields(Archive& archive, Value<Archive, core::Camera>& camera) {
  archive(std::get<core::PinholeRadtan>(camera));
}

template <class Archive>
void fields(Archive& archive, Value<Archive, core::Imu>& imu) {
  archive(imu.body_from_imu, imu.gyroscope_noise_rad_s_sqrt_hz,
          imu.accelerometer_noise_m_s2_sqrt_hz, imu.gyroscope_bias_walk_rad_s2_sqrt_hz,
          imu.accelerometer_bias_walk_m_s3_sqrt_hz);
}

template <class Archive>
void fields(Archive& archive, Value<Archive, core::Rig>& rig) {
  archive(rig.cameras, rig.body_from_camera, rig.imu);
  archive.at_end(rig.body_from_taken_camera);
}

template <class Archive>
void fields(Archive& archive, Value<Archive, features::Features>& features) {
  archive(features.raw_px, features.undistorted_px, features.depth_m, features.right_x_px,
          features.octave, features.angle_rad, features.rgb, features.descriptors);
}

template <class Archive>
void fields(Archive& archive, Value<Archive, OdometryEdge>& edge) {
  archive(edge.parent, edge.parent_from_keyframe, edge.information);
}

// Without its view and its slots: they have rows of their own, because they change seldom and are
// large.
template <class Archive>
void fields(Archive& archive, Value<Archive, Keyframe>& keyframe) {
  archive(keyframe.id, keyframe.world_from_body, keyframe.odometry,
          keyframe.refined_parent_from_keyframe, keyframe.refined_at,
          keyframe.settled_parent_from_keyframe, keyframe.settled_at,
          keyframe.culled_parent_from_keyframe, keyframe.log_scale);
}

template <class Archive>
void fields(Archive& archive, Value<Archive, Observation>& observation) {
  archive(observation.keyframe, observation.slot, observation.cause);
}

template <class Archive>
void fields(Archive& archive, Value<Archive, Landmark>& landmark) {
  archive(landmark.id, landmark.anchor, landmark.position_in_anchor, landmark.normal_in_anchor,
          landmark.range_m, landmark.octave, landmark.weight, landmark.descriptor, landmark.rgb,
          landmark.observations, landmark.merged_into, landmark.is_culled);
}

template <class Archive>
void fields(Archive& archive, Value<Archive, LoopEdge>& loop) {
  archive(loop.query, loop.match, loop.match_from_query, loop.information, loop.cause,
          loop.log_scale, loop.closed_at, loop.num_landmarks_then);
}

template <class Archive>
void fields(Archive& archive, Value<Archive, Merge>& merge) {
  archive(merge.from, merge.to, merge.cause, merge.made_at);
}

template <class Archive>
void fields(Archive& archive, Value<Archive, core::FramePose>& pose) {
  archive(pose.frame, pose.stamp_s, pose.status, pose.is_measured, pose.reference_keyframe,
          pose.reference_from_frame, pose.information, pose.num_inliers, pose.log_scale);
}

template <class Archive>
void fields(Archive& archive, Value<Archive, core::Descriptor>& descriptor) {
  archive(descriptor.frame, descriptor.unit, descriptor.describer_checksum);
}

template <class T>
std::string bytes_of(const T& value) {
  ByteWriter writer;
  writer(value);
  return writer.bytes();
}

}  // namespace samewhere::scene
