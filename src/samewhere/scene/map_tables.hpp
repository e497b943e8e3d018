#pragma once

// The tables of a map file, and its one row of counts.

#include <cstdint>
#include <optional>

#include <samewhere/core/ids.hpp>
#include <samewhere/scene/bytes.hpp>
#include <samewhere/scene/row_file.hpp>

namespace samewhere::scene {

inline constexpr char kHeader[] = "header";
inline constexpr char kState[] = "state";
inline constexpr char kRig[] = "rig";
inline constexpr char kKeyframe[] = "keyframe";
inline constexpr char kView[] = "view";    // of keyframes, same numbers; never changes
inline constexpr char kSlots[] = "slots";  // of keyframes, same numbers
inline constexpr char kLandmark[] = "landmark";
inline constexpr char kLoop[] = "loop";
inline constexpr char kSuspendedLoop[] = "suspended_loop";
inline constexpr char kSuspendedLoopBefore7[] = "doubted_loop";  // its name in version 6
inline constexpr char kMerge[] = "merge";
inline constexpr char kFrame[] = "frame";            // number: the frame's id
inline constexpr char kDescriptor[] = "descriptor";  // number: the frame's id
inline constexpr char kLedger[] = "ledger";          // bytes: a line of JSON
inline constexpr char kThumbnail[] = "thumbnail";    // number: the frame's id; bytes: JPEG
inline constexpr const char* kTables[] = {kHeader, kState,      kRig,    kKeyframe,      kView,
                                          kSlots,  kLandmark,   kLoop,   kSuspendedLoop, kMerge,
                                          kFrame,  kDescriptor, kLedger, kThumbnail};

inline constexpr const char* kTablesBefore7[] = {kHeader,   kState,    kRig,
                                                 kKeyframe, kView,     kSlots,
                                                 kLandmark, kLoop,     kSuspendedLoopBefore7,
                                                 kMerge,    kFrame,    kDescriptor,
                                                 kLedger,   kThumbnail};

// 5: thumbnails. 6: cameras of maps are pinholes. 7: table suspended_loop.
inline constexpr std::int64_t kMapFileVersion = 7;
inline constexpr FileKind kMapKindBefore7{"samewhere map", 0x534d5748 /* "SMWH" */, 6,
                                          kTablesBefore7};
inline constexpr FileKind kMapKind{"samewhere map", 0x534d5748, kMapFileVersion, kTables,
                                   &kMapKindBefore7};

// Number of rows after a commit, to detect missing rows (but not thumbnails, which no other row
// names).
struct MapState {
  std::uint64_t map_number = 0;
  std::uint64_t num_settings = 0;
  std::uint64_t num_rigs = 0;
  std::uint64_t num_keyframes = 0;
  std::uint64_t num_landmarks = 0;
  std::uint64_t num_loops = 0;
  std::uint64_t num_suspended_loops = 0;
  std::uint64_t num_merges = 0;
  std::uint64_t num_frames = 0;
  std::uint64_t num_descriptors = 0;
  std::uint64_t num_ledger_rows = 0;
  std::optional<core::FrameId> last_frame;
};

template <class Archive>
void fields(Archive& archive, Value<Archive, MapState>& state) {
  archive(state.map_number, state.num_settings, state.num_rigs, state.num_keyframes,
          state.num_landmarks, state.num_loops, state.num_suspended_loops, state.num_merges,
          state.num_frames, state.num_descriptors, state.num_ledger_rows, state.last_frame);
}

}  // namespace samewhere::scene
