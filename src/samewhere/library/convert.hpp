#pragma once

#include <samewhere/core/frame_pose.hpp>
#include <samewhere/core/ledger.hpp>
#include <samewhere/core/rig.hpp>
#include <samewhere/core/rigid3.hpp>
#include <samewhere/event.hpp>
#include <samewhere/pipeline/config.hpp>
#include <samewhere/slam.hpp>
#include <samewhere/types.hpp>

// Between the types of the library's interface and those of the program.

namespace samewhere::library {

Pose pose_of(const core::Rigid3& a_from_b);
core::Rigid3 rigid_of(const Pose& a_from_b);
// Whether it is finite and its linear part a rotation, within 1 %.
bool is_rigid(const Pose& a_from_b);
// With the size of its images, at the origin of the body.
Camera camera_of(const core::Camera& camera, int width_px, int height_px);
FrameKey key_of(core::FrameId frame);
Status status_of(core::FrameStatus status);
LoopVerdict verdict_of(const core::LedgerRow& row);

// The profile with the settings and the prior. Throws core::InputError.
pipeline::Config config_of(const std::string& profile, const std::vector<std::string>& settings,
                           std::optional<Prior> prior);

}  // namespace samewhere::library
