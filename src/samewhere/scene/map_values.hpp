#pragma once

#include <samewhere/core/descriptor.hpp>
#include <samewhere/core/frame_pose.hpp>
#include <samewhere/scene/map_version.hpp>

namespace samewhere::scene {

// Whether the numbers of one row of a map file can be used: finite, in the range that their meaning
// allows, lists of one length. What a row says of other rows is checked by map_check.hpp. The
// answer is how a message goes on after "it" ("has no camera"); nullptr: they can.
const char* complaint_on(const core::Rig& rig);
const char* complaint_on(const features::View& view);
const char* complaint_on(const Keyframe& keyframe);  // without its view and its slots
const char* complaint_on(const Landmark& landmark);
const char* complaint_on(const LoopEdge& loop);
const char* complaint_on(const core::FramePose& pose);
const char* complaint_on(const core::Descriptor& descriptor);
// Links alone, which map_check.hpp checks.
inline const char* complaint_on(const Merge& /*merge*/) { return nullptr; }
inline const char* complaint_on(const std::vector<core::LandmarkId>& /*slots*/) { return nullptr; }

}  // namespace samewhere::scene
