#include <algorithm>
#include <memory>
#include <optional>

#include <fmt/format.h>

#include <samewhere/features/paged.hpp>
#include <samewhere/scene/map_check.hpp>
#include <samewhere/scene/map_content.hpp>
#include <samewhere/scene/map_rows.hpp>
#include <samewhere/scene/map_tables.hpp>
#include <samewhere/scene/map_values.hpp>
#include <samewhere/scene/row_file.hpp>

namespace samewhere::scene {
namespace {

std::string view_bytes(const features::View& view, std::uint64_t rig) {
  ByteWriter writer;
  writer(view.frame, view.stamp_s, rig, view.image_size_px.width, view.image_size_px.height,
         *view.features);
  return writer.bytes();
}

template <class T>
T value_of(const RowFile::Row& row) {
  T value{};
  ByteReader reader(row.bytes, row.name);
  reader(value);
  reader.finish();
  return value;
}

std::optional<core::FrameId> last_frame(const MapExtras& extras) {
  return extras.frames.empty() ? std::nullopt : std::optional(extras.frames.back().frame);
}

std::int64_t row_number(core::FrameId id) { return static_cast<std::int64_t>(id.value()); }

void refuse_damage(const char* complaint, const RowFile::Row& row) {
  if (complaint != nullptr)
    throw core::InputError(fmt::format("{} is damaged: it {}", row.name, complaint));
}

// What could not be read again is not written.
template <class T>
void require_readable(const std::filesystem::path& path, const char* table, std::int64_t number,
                      const T& value) {
  if (const char* complaint = complaint_on(value))
    throw core::InputError(
        fmt::format("{}: {} {} cannot be saved: it {}", path.string(), table, number, complaint));
}

// Settings are printed: a terminal would obey control characters (ASCII's, and those of Latin-1 as
// UTF-8 has them).
bool is_printed(std::string_view text) {
  constexpr std::size_t kMaxLength = 4096;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto c = static_cast<unsigned char>(text[i]);
    const bool is_after_c2 = i > 0 && static_cast<unsigned char>(text[i - 1]) == 0xc2;
    if (c < ' ' || c == 0x7f || (is_after_c2 && c < 0xa0)) return false;
  }
  return text.size() <= kMaxLength;
}

// Whose numbers can be used.
template <class T>
T checked_value_of(const RowFile::Row& row) {
  T value = value_of<T>(row);
  refuse_damage(complaint_on(value), row);
  return value;
}

// The same of what is numbered by its frame.
template <class T>
T value_of_frame(const RowFile::Row& row) {
  T value = checked_value_of<T>(row);
  if (row_number(value.frame) != row.number) refuse_damage("is of another frame", row);
  return value;
}

}  // namespace

MapFile::Content::Content(const std::filesystem::path& path, const MapHeader& header)
    : file_(RowFile::create(path, kMapKind,
                            [&header](RowFile& file) {
                              std::int64_t number = 0;
                              for (const auto& [name, value] : header)
                                file.put(kHeader, number++, name + "=" + value);
                              file.put(kState, 0,
                                       bytes_of(MapState{.num_settings = header.size()}));
                            })),
      header_(header),
      is_loaded_(true) {
  state_.num_settings = header.size();
}

MapFile::Content::Content(const std::filesystem::path& path, core::OpenMode mode)
    : file_(RowFile::open(path, kMapKind, mode)) {
  const MapState state = read_state();
  file_.read_list(kHeader, state.num_settings, [&](const RowFile::Row& row) {
    const auto equals = row.bytes.find('=');
    if (equals == row.bytes.npos || !is_printed(row.bytes))
      refuse_damage("is no setting with its value", row);
    header_.emplace(row.bytes.substr(0, equals), row.bytes.substr(equals + 1));
  });
}

MapState MapFile::Content::read_state() {
  MapState state;
  file_.read_list(kState, 1, [&](const RowFile::Row& row) { state = value_of<MapState>(row); });
  return state;
}

void MapFile::Content::read_rigs() {
  rigs_.clear();
  file_.read_list(kRig, state_.num_rigs, [&](const RowFile::Row& row) {
    rigs_.push_back(std::make_shared<const core::Rig>(checked_value_of<core::Rig>(row)));
  });
}

void MapFile::Content::read_loops(const char* table, std::uint64_t count,
                                  std::vector<LoopEdge>& loops) {
  file_.read_list(table, count, [&](const RowFile::Row& row) {
    loops.push_back(checked_value_of<LoopEdge>(row));
  });
}

features::View MapFile::Content::read_view(const RowFile::Row& row) {
  features::View view;
  std::uint64_t rig = 0;
  const auto features = std::make_shared<features::Features>();
  ByteReader reader(row.bytes, row.name);
  reader(view.frame, view.stamp_s, rig, view.image_size_px.width, view.image_size_px.height,
         *features);
  reader.finish();
  if (rig >= rigs_.size()) throw core::InputError(row.name + " is damaged: its rig is not there");
  view.rig = rigs_[rig];
  view.features = features;
  refuse_damage(complaint_on(view), row);
  view.features = features::paged(view.features, feature_memory_);
  leave_memory(*view.features);
  return view;
}

void MapFile::Content::read_keyframes(MapVersion& map) {
  const std::uint64_t count = state_.num_keyframes;
  std::vector<Keyframe> keyframes;
  file_.read_list(kKeyframe, count, [&](const RowFile::Row& row) {
    keyframes.push_back(checked_value_of<Keyframe>(row));
  });
  std::size_t next = 0;
  file_.read_list(kView, count,
                  [&](const RowFile::Row& row) { keyframes[next++].view = read_view(row); });
  next = 0;
  file_.read_list(kSlots, count, [&](const RowFile::Row& row) {
    keyframes[next++].slots = value_of<std::vector<core::LandmarkId>>(row);
  });
  for (Keyframe& keyframe : keyframes) map.keyframes.push_back(std::move(keyframe));
}

void MapFile::Content::read_extras(MapExtras& extras) {
  file_.read(kFrame, state_.num_frames, [&](const RowFile::Row& row) {
    extras.frames.push_back(value_of_frame<core::FramePose>(row));
  });
  file_.read(kDescriptor, state_.num_descriptors, [&](const RowFile::Row& row) {
    extras.descriptors.push_back(value_of_frame<core::Descriptor>(row));
  });
  extras.ledger = ledger();
}

std::vector<std::string> MapFile::Content::ledger() {
  std::vector<std::string> rows;
  file_.read_list(kLedger, read_state().num_ledger_rows,
                  [&](const RowFile::Row& row) { rows.emplace_back(row.bytes); });
  return rows;
}

std::optional<std::string> MapFile::Content::thumbnail(core::FrameId frame) {
  return file_.find(kThumbnail, row_number(frame));
}

StoredMap MapFile::Content::load() {
  core::Transaction moment = file_.transaction();  // another program may write meanwhile
  state_ = read_state();
  read_rigs();
  StoredMap stored;
  stored.map.number = state_.map_number;
  read_keyframes(stored.map);
  file_.read_list(kLandmark, state_.num_landmarks, [&](const RowFile::Row& row) {
    stored.map.landmarks.push_back(checked_value_of<Landmark>(row));
  });
  read_loops(kLoop, state_.num_loops, stored.map.loops);
  read_loops(suspended_loops_table(file_.version()), state_.num_suspended_loops,
             stored.map.suspended_loops);
  file_.read_list(kMerge, state_.num_merges, [&](const RowFile::Row& row) {
    stored.map.merges.push_back(value_of<Merge>(row));
  });
  read_extras(stored.extras);
  moment.commit();
  check_map(stored.map, path().string());
  check_extras(stored, path().string());
  if (state_.last_frame != last_frame(stored.extras))
    throw core::InputError(path().string() +
                           ": is damaged: its last frame is another than it says");
  map_ = stored.map;
  is_loaded_ = true;
  return stored;
}

namespace {

// Calls use(i, before, now) for each element of `after` that may not be as in `before` (nullptr:
// new).
template <class T, class Use>
void each_change(const ChunkedVector<T>& before, const ChunkedVector<T>& after, const Use& use) {
  for (std::size_t k = 0; k < after.num_chunks(); ++k) {
    if (k < before.num_chunks() && after.shares_chunk(before, k)) continue;
    const auto [begin, end] = after.range_of_chunk(k);
    for (std::size_t i = begin; i < end; ++i)
      use(static_cast<std::int64_t>(i), i < before.size() ? &before[i] : nullptr, after[i]);
  }
}

}  // namespace

template <class T>
void MapFile::Content::put_change(const char* table, std::int64_t number, const T* before,
                                  const T& now) {
  const std::string bytes = bytes_of(now);
  if (before != nullptr && bytes == bytes_of(*before)) return;
  require_readable(path(), table, number, now);
  file_.put(table, number, bytes);
}

std::uint64_t MapFile::Content::rig_number(const core::Rig& rig, MapState& state) {
  require_readable(path(), kRig, static_cast<std::int64_t>(rigs_.size()), rig);
  const std::string bytes = bytes_of(rig);
  for (std::size_t i = 0; i < rigs_.size(); ++i) {
    if (rigs_[i].get() == &rig || bytes_of(*rigs_[i]) == bytes) return i;
  }
  file_.put(kRig, static_cast<std::int64_t>(rigs_.size()), bytes);
  rigs_.push_back(std::make_shared<const core::Rig>(rig));
  return state.num_rigs++;
}

void MapFile::Content::write_keyframes(const MapVersion& after, MapState& state) {
  each_change(map_.keyframes, after.keyframes,
              [&](std::int64_t number, const Keyframe* before, const Keyframe& now) {
                put_change(kKeyframe, number, before, now);
                put_change(kSlots, number, before ? &before->slots : nullptr, now.slots);
                if (before != nullptr) return;
                require_readable(path(), kView, number, now.view);
                file_.put(kView, number, view_bytes(now.view, rig_number(*now.view.rig, state)));
              });
  state.num_keyframes = after.keyframes.size();
}

void MapFile::Content::write_landmarks(const MapVersion& after, MapState& state) {
  each_change(map_.landmarks, after.landmarks,
              [&](std::int64_t number, const Landmark* before, const Landmark& now) {
                put_change(kLandmark, number, before, now);
              });
  state.num_landmarks = after.landmarks.size();
}

void MapFile::Content::write_loops(const char* table, const std::vector<LoopEdge>& before,
                                   const std::vector<LoopEdge>& after) {
  for (std::size_t i = 0; i < after.size(); ++i)
    put_change(table, static_cast<std::int64_t>(i), i < before.size() ? &before[i] : nullptr,
               after[i]);
  file_.remove_from(table, static_cast<std::int64_t>(after.size()));
}

void MapFile::Content::write_merges(const MapVersion& after, MapState& state) {
  each_change(map_.merges, after.merges,
              [&](std::int64_t number, const Merge* before, const Merge& now) {
                put_change(kMerge, number, before, now);
              });
  file_.remove_from(kMerge, static_cast<std::int64_t>(after.merges.size()));
  state.num_merges = after.merges.size();
}

void MapFile::Content::write_extras(const MapExtras& extras, MapState& state) {
  for (const core::FramePose& frame : extras.frames) {
    require_readable(path(), kFrame, row_number(frame.frame), frame);
    file_.put(kFrame, row_number(frame.frame), bytes_of(frame));
    if (state.last_frame && frame.frame <= *state.last_frame) continue;
    state.last_frame = frame.frame;
    ++state.num_frames;
  }
  for (const core::Descriptor& descriptor : extras.descriptors) {
    require_readable(path(), kDescriptor, row_number(descriptor.frame), descriptor);
    file_.put(kDescriptor, row_number(descriptor.frame), bytes_of(descriptor));
    ++state.num_descriptors;
  }
  for (const std::string& row : extras.ledger)
    file_.put(kLedger, static_cast<std::int64_t>(state.num_ledger_rows++), row);
  for (const Thumbnail& thumbnail : extras.thumbnails)
    file_.put(kThumbnail, row_number(thumbnail.frame), thumbnail.jpeg);
}

void MapFile::Content::require_unchanged() {
  if (bytes_of(read_state()) == bytes_of(state_)) return;
  throw core::InputError(path().string() +
                         ": another program has written to this map meanwhile; what came since is "
                         "not in it");
}

void MapFile::Content::commit(const MapVersion& after, const MapExtras& extras) {
  core::require(is_loaded_, "a map file that was opened is loaded before it is written");
  core::require(after.keyframes.size() >= map_.keyframes.size() &&
                    after.landmarks.size() >= map_.landmarks.size(),
                "a map file is given a later version of its map");
  try {
    write(after, extras);
  } catch (const core::NoSpace&) {
    if (!file_.shrink_log()) throw;
    write(after, extras);
  }
}

// Everything or, if it throws, nothing.
void MapFile::Content::write(const MapVersion& after, const MapExtras& extras) {
  rigs_.resize(state_.num_rigs);  // without those of a commit that failed
  MapState state = state_;
  file_.begin_writing();
  core::Transaction transaction = file_.transaction();
  require_unchanged();
  write_keyframes(after, state);
  write_landmarks(after, state);
  write_loops(kLoop, map_.loops, after.loops);
  write_loops(kSuspendedLoop, map_.suspended_loops, after.suspended_loops);
  state.num_loops = after.loops.size();
  state.num_suspended_loops = after.suspended_loops.size();
  write_merges(after, state);
  write_extras(extras, state);
  state.map_number = after.number;
  file_.put(kState, 0, bytes_of(state));
  file_.commit(transaction);
  state_ = state;
  map_ = after;
}

}  // namespace samewhere::scene
