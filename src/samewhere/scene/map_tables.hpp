#pragma once

// The tables of a map file, and its one row of counts.

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include <samewhere/core/ids.hpp>
#include <samewhere/scene/bytes.hpp>
#include <samewhere/scene/row_file.hpp>

namespace samewhere::scene {

inline constexpr const char* kHeader = "header";
inline constexpr const char* kState = "state";
inline constexpr const char* kRig = "rig";
inline constexpr const char* kKeyframe = "keyframe";
inline constexpr const char* kView = "view";    // of keyframes, same numbers; never changes
inline constexpr const char* kSlots = "slots";  // of keyframes, same numbers
inline constexpr const char* kLandmark = "landmark";
inline constexpr const char* kLoop = "loop";
inline constexpr const char* kSuspendedLoop = "suspended_loop";
inline constexpr const char* kSuspendedLoopBefore7 = "doubted_loop";  // its name in version 6
inline constexpr const char* kMerge = "merge";
inline constexpr const char* kFrame = "frame";            // number: the frame's id
inline constexpr const char* kDescriptor = "descriptor";  // number: the frame's id
inline constexpr const char* kLedger = "ledger";          // bytes: a line of JSON
inline constexpr const char* kThumbnail = "thumbnail";    // number: the frame's id; bytes: JPEG
inline constexpr std::array kTables = {kHeader, kState,      kRig,    kKeyframe,      kView,
                                       kSlots,  kLandmark,   kLoop,   kSuspendedLoop, kMerge,
                                       kFrame,  kDescriptor, kLedger, kThumbnail};
inline constexpr auto kTablesBefore7 = [] {
  auto tables = kTables;
  for (const char*& table : tables)
    if (std::string_view(table) == kSuspendedLoop) table = kSuspendedLoopBefore7;
  return tables;
}();

// 5: thumbnails. 6: cameras of maps are pinholes. 7: table suspended_loop.
inline constexpr std::int64_t kMapFileVersion = 7;
inline constexpr std::int64_t kMapMagic = 0x534d5748;  // "SMWH"
inline constexpr FileKind kMapKindBefore7{"samewhere map", kMapMagic, 6, kTablesBefore7};
inline constexpr FileKind kMapKind{.name = "samewhere map",
                                   .magic = kMapMagic,
                                   .version = kMapFileVersion,
                                   .tables = kTables,
                                   .before = &kMapKindBefore7,
                                   .remedy = "`samewhere map FILE upgrade` rewrites it"};

// The table of suspended loops in a file of this version.
constexpr const char* suspended_loops_table(std::int64_t version) {
  return version < 7 ? kSuspendedLoopBefore7 : kSuspendedLoop;
}

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
