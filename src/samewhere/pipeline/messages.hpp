#pragma once

#include <functional>
#include <optional>
#include <variant>
#include <vector>

#include <opencv2/core/mat.hpp>

#include <samewhere/core/descriptor.hpp>
#include <samewhere/core/frame_pose.hpp>
#include <samewhere/core/ledger.hpp>
#include <samewhere/core/link.hpp>
#include <samewhere/map/local_bundle.hpp>
#include <samewhere/map/mapper.hpp>
#include <samewhere/scene/map_file.hpp>
#include <samewhere/scene/map_version.hpp>

// What the stages of SLAM say to each other. Tracking asks mapping, mapping asks loop closing and
// bundle adjustment. No other messages exist.

namespace samewhere::pipeline {

// --- Tracking to mapping. Keyframes get their ids in the order of the messages that bring them.

// Initialization or re-initialization with this view, which has depth. The map before is discarded.
// Answered at once.
struct StartMap {
  features::View view;
  cv::Mat image;
};

// Initialization or re-initialization with two views of one camera; the image is the second one's.
// The map before is discarded. Answered when bundle adjustment has placed both.
struct StartMapByMotion {
  map::ViewPair views;
  cv::Mat image;
};

// The view becomes a keyframe. Answered with the map in which it shows its landmarks.
struct AddKeyframe {
  scene::TrackedView tracked;
  cv::Mat image;  // empty: it was kept later than its frame; then no loop is looked for
  std::vector<core::FramePose> frames;  // since the last that were sent, its own the last of them
};

// Lost: which places of the whole map may the view show?
struct FindPlace {
  features::View view;
  cv::Mat image;
};

// No keyframe came for long, as in a room that the map knows: the frames are to be saved. Not
// answered.
struct SaveFrames {
  std::vector<core::FramePose> frames;  // since the last that were sent
};

// Nothing comes any more. Not answered.
struct EndOfInput {
  std::vector<core::FramePose> frames;  // since the last that were sent
};

using ToMapping =
    std::variant<StartMap, StartMapByMotion, AddKeyframe, FindPlace, SaveFrames, EndOfInput>;

// Where a lost camera may be.
struct Place {
  core::KeyframeId keyframe;
  std::optional<core::Rigid3> keyframe_from_body;  // none: views without depth do not tell
  bool is_recognised = false;  // by the loop verifier, or the last reference; else retrieved only
};

// --- Mapping to tracking.
struct MapAnswer {
  scene::MapVersion map;
  std::vector<Place> places;  // to FindPlace
  core::Ledger rows = {};     // that mapping has received or made since its last answer
};

// --- Mapping to loop closing.

// Does the keyframe show a place that was seen before? Answered once, maybe with nothing.
struct FindLoops {
  scene::MapVersion map;
  core::KeyframeId keyframe;
  cv::Mat image;            // empty: not looked for
  bool starts_map = false;  // the map before it was given up: its views are forgotten
};

// The input has ended: which of the candidates that wait do the loops of the map decide? Answered
// once, maybe with nothing.
struct AskAgain {
  scene::MapVersion map;
};

using ToLoopClosing = std::variant<FindLoops, FindPlace, AskAgain>;

// --- Loop closing to mapping.

// Its keyframes may be culled by now.
struct AcceptedLoop {
  scene::LoopEdge edge;
  core::CandidateId overruled = {};  // valid: see core::LoopClosure
  // Of its ends, in the map that it was measured in: loops that were closed since have changed
  // their lengths.
  double query_log_scale = 0.0;
  double match_log_scale = 0.0;
};

struct LoopAnswer {
  std::vector<AcceptedLoop> loops;
  std::uint64_t map_number = 0;                // MapVersion::number that they were verified on
  std::vector<Place> places;                   // to FindPlace
  std::optional<core::Descriptor> descriptor;  // of a view that is remembered from now on
  core::Ledger rows;                           // of all verified candidates
  std::optional<scene::Thumbnail> thumbnail;   // of the keyframe
};

// --- Mapping to full bundle adjustment; answered with its result for that version.
struct BundleAll {
  scene::MapVersion map;
  map::BundleWindow window;
};

using MappingLink = core::Link<ToMapping, MapAnswer>;
using LoopLink = core::Link<ToLoopClosing, LoopAnswer>;
using BundleLink = core::Link<BundleAll, scene::Edit>;

// What came since the map was kept last.
struct MapNews {
  std::vector<core::FramePose> frames;
  std::vector<core::Descriptor> descriptors;
  core::Ledger rows;
  std::vector<scene::Thumbnail> thumbnails;
};

// Called by mapping, in its thread, once per keyframe, between keyframes far apart, and at the end,
// if there is a map.
using KeepMap = std::function<void(const scene::MapVersion& map, const MapNews& news)>;

}  // namespace samewhere::pipeline
