#include <algorithm>
#include <memory>
#include <optional>

#include <fmt/format.h>

#include <samewhere/features/paged.hpp>
#include <samewhere/scene/map_check.hpp>
#include <samewhere/scene/map_file.hpp>
#include <samewhere/scene/map_rows.hpp>
#include <samewhere/scene/row_file.hpp>

namespace samewhere::scene {
namespace {

constexpr char kHeader[] = "header";
constexpr char kState[] = "state";
constexpr char kRig[] = "rig";
constexpr char kKeyframe[] = "keyframe";
constexpr char kView[] = "view";    // of keyframes, same numbers; never changes
constexpr char kSlots[] = "slots";  // of keyframes, same numbers
constexpr char kLandmark[] = "landmark";
constexpr char kLoop[] = "loop";
constexpr char kDoubtedLoop[] = "doubted_loop";
constexpr char kMerge[] = "merge";
constexpr char kFrame[] = "frame";            // number: the frame's id
constexpr char kDescriptor[] = "descriptor";  // number: the frame's id
constexpr char kLedger[] = "ledger";          // bytes: a line of JSON
constexpr char kThumbnail[] = "thumbnail";    // number: the frame's id; bytes: JPEG
constexpr const char* kTables[] = {kHeader, kState,      kRig,    kKeyframe,    kView,
                                   kSlots,  kLandmark,   kLoop,   kDoubtedLoop, kMerge,
                                   kFrame,  kDescriptor, kLedger, kThumbnail};

// 5: thumbnails.
constexpr std::int64_t kMapFileVersion = 6;
constexpr FileKind kMapKind{"samewhere map", 0x534d5748 /* "SMWH" */, kMapFileVersion, kTables};

// How much a commit left: rows that went missing are missed (but thumbnails, on which nothing
// hangs).
struct State {
  std::uint64_t map_number = 0;
  std::uint64_t num_settings = 0;
  std::uint64_t num_rigs = 0;
  std::uint64_t num_keyframes = 0;
  std::uint64_t num_landmarks = 0;
  std::uint64_t num_loops = 0;
  std::uint64_t num_doubted_loops = 0;
  std::uint64_t num_merges = 0;
  std::uint64_t num_frames = 0;
  std::uint64_t num_descriptors = 0;
  std::uint64_t num_ledger_rows = 0;
  std::optional<core::FrameId> last_frame;
};

template <class Archive>
void fields(Archive& archive, Value<Archive, State>& state) {
  archive(state.map_number, state.num_settings, state.num_rigs, state.num_keyframes,
          state.num_landmarks, state.num_loops, state.num_doubted_loops, state.num_merges,
          state.num_frames, state.num_descriptors, state.num_ledger_rows, state.last_frame);
}

std::string view_bytes(const features::View& view, std::uint64_t rig) {
  ByteWriter writer;
  writer(view.frame, view.stamp_s, rig, view.image_size_px.width, view.image_size_px.height,
         *view.features);
  return writer.bytes();
}

template <class T>
T value_of(std::string_view bytes, const std::string& row) {
  T value{};
  ByteReader reader(bytes, row);
  reader(value);
  reader.finish();
  return value;
}

std::int64_t row_number(core::FrameId id) { return static_cast<std::int64_t>(id.value()); }

}  // namespace

class MapFile::Content {
 public:
  explicit Content(RowFile file) : file_(std::move(file)) {}

  void write_header(const MapHeader& header);
  void read_header();
  const MapHeader& header() const { return header_; }
  const std::filesystem::path& path() const { return file_.path(); }

  void begin_writing() { file_.begin_writing(); }
  StoredMap load();
  std::optional<std::string> thumbnail(core::FrameId frame) {
    return file_.find(kThumbnail, row_number(frame));
  }
  void commit(const MapVersion& after, const MapExtras& extras);

 private:
  // Since this one has read or written it: for what was not locked out (a network drive).
  void require_unchanged();
  State read_state();
  void read_rigs();
  features::View read_view(std::string_view bytes, const std::string& row);
  void read_keyframes(MapVersion& map);
  void read_extras(MapExtras& extras);

  void write_keyframes(const MapVersion& after, State& state);
  void write_landmarks(const MapVersion& after, State& state);
  void read_loops(const char* table, std::uint64_t count, std::vector<LoopEdge>& loops);
  void write_loops(const char* table, const std::vector<LoopEdge>& before,
                   const std::vector<LoopEdge>& after);
  void write_merges(const MapVersion& after, State& state);
  void write_extras(const MapExtras& extras, State& state);
  std::uint64_t rig_number(const core::Rig& rig, State& state);
  template <class T>
  void put_change(const char* table, std::int64_t number, const T* before, const T& now);

  RowFile file_;
  MapHeader header_;
  // As of the last commit.
  bool is_loaded_ = false;
  State state_;
  MapVersion map_;
  std::vector<std::shared_ptr<const core::Rig>> rigs_;
  core::PagedMemory feature_memory_;
};

void MapFile::Content::write_header(const MapHeader& header) {
  file_.begin_writing();
  Transaction transaction = file_.transaction();
  std::int64_t number = 0;
  for (const auto& [name, value] : header) file_.put(kHeader, number++, name + "=" + value);
  state_.num_settings = header.size();
  file_.put(kState, 0, bytes_of(state_));
  transaction.commit();
  header_ = header;
  is_loaded_ = true;
}

void MapFile::Content::read_header() {
  const State state = read_state();
  file_.read(kHeader, state.num_settings, [&](std::string_view bytes, const std::string&) {
    const auto equals = bytes.find('=');
    header_.emplace(bytes.substr(0, equals), bytes.substr(equals + 1));
  });
}

State MapFile::Content::read_state() {
  State state;
  file_.read(kState, 1, [&](std::string_view bytes, const std::string& row) {
    state = value_of<State>(bytes, row);
  });
  return state;
}

void MapFile::Content::read_rigs() {
  rigs_.clear();
  file_.read(kRig, state_.num_rigs, [&](std::string_view bytes, const std::string& row) {
    rigs_.push_back(std::make_shared<const core::Rig>(value_of<core::Rig>(bytes, row)));
  });
}

void MapFile::Content::read_loops(const char* table, std::uint64_t count,
                                  std::vector<LoopEdge>& loops) {
  file_.read(table, count, [&](std::string_view bytes, const std::string& row) {
    loops.push_back(value_of<LoopEdge>(bytes, row));
  });
}

features::View MapFile::Content::read_view(std::string_view bytes, const std::string& row) {
  features::View view;
  std::uint64_t rig = 0;
  auto features = std::make_shared<features::Features>();
  ByteReader reader(bytes, row);
  reader(view.frame, view.stamp_s, rig, view.image_size_px.width, view.image_size_px.height,
         *features);
  reader.finish();
  if (rig >= rigs_.size()) throw core::InputError(row + " is damaged: its rig is not there");
  view.rig = rigs_[rig];
  view.features = features::paged(std::move(features), feature_memory_);
  leave_memory(*view.features);
  return view;
}

void MapFile::Content::read_keyframes(MapVersion& map) {
  const std::uint64_t count = state_.num_keyframes;
  std::vector<Keyframe> keyframes;
  file_.read(kKeyframe, count, [&](std::string_view bytes, const std::string& row) {
    keyframes.push_back(value_of<Keyframe>(bytes, row));
  });
  std::size_t next = 0;
  file_.read(kView, count, [&](std::string_view bytes, const std::string& row) {
    keyframes[next++].view = read_view(bytes, row);
  });
  next = 0;
  file_.read(kSlots, count, [&](std::string_view bytes, const std::string& row) {
    keyframes[next++].slots = value_of<std::vector<core::LandmarkId>>(bytes, row);
  });
  for (Keyframe& keyframe : keyframes) map.keyframes.push_back(std::move(keyframe));
}

void MapFile::Content::read_extras(MapExtras& extras) {
  file_.read(kFrame, state_.num_frames, [&](std::string_view bytes, const std::string& row) {
    extras.frames.push_back(value_of<core::FramePose>(bytes, row));
  });
  file_.read(kDescriptor, state_.num_descriptors,
             [&](std::string_view bytes, const std::string& row) {
               extras.descriptors.push_back(value_of<core::Descriptor>(bytes, row));
             });
  file_.read(kLedger, state_.num_ledger_rows, [&](std::string_view bytes, const std::string&) {
    extras.ledger.emplace_back(bytes);
  });
}

StoredMap MapFile::Content::load() {
  Transaction moment = file_.transaction();  // another program may write meanwhile
  state_ = read_state();
  read_rigs();
  StoredMap stored;
  stored.map.number = state_.map_number;
  read_keyframes(stored.map);
  file_.read(kLandmark, state_.num_landmarks, [&](std::string_view bytes, const std::string& row) {
    stored.map.landmarks.push_back(value_of<Landmark>(bytes, row));
  });
  read_loops(kLoop, state_.num_loops, stored.map.loops);
  read_loops(kDoubtedLoop, state_.num_doubted_loops, stored.map.doubted_loops);
  file_.read(kMerge, state_.num_merges, [&](std::string_view bytes, const std::string& row) {
    stored.map.merges.push_back(value_of<Merge>(bytes, row));
  });
  read_extras(stored.extras);
  moment.commit();
  check_map(stored.map, path().string());
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
  if (before == nullptr || bytes != bytes_of(*before)) file_.put(table, number, bytes);
}

std::uint64_t MapFile::Content::rig_number(const core::Rig& rig, State& state) {
  const std::string bytes = bytes_of(rig);
  for (std::size_t i = 0; i < rigs_.size(); ++i) {
    if (rigs_[i].get() == &rig || bytes_of(*rigs_[i]) == bytes) return i;
  }
  file_.put(kRig, static_cast<std::int64_t>(rigs_.size()), bytes);
  rigs_.push_back(std::make_shared<const core::Rig>(rig));
  return state.num_rigs++;
}

void MapFile::Content::write_keyframes(const MapVersion& after, State& state) {
  each_change(map_.keyframes, after.keyframes,
              [&](std::int64_t number, const Keyframe* before, const Keyframe& now) {
                put_change(kKeyframe, number, before, now);
                put_change(kSlots, number, before ? &before->slots : nullptr, now.slots);
                if (before == nullptr)
                  file_.put(kView, number, view_bytes(now.view, rig_number(*now.view.rig, state)));
              });
  state.num_keyframes = after.keyframes.size();
}

void MapFile::Content::write_landmarks(const MapVersion& after, State& state) {
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

void MapFile::Content::write_merges(const MapVersion& after, State& state) {
  each_change(map_.merges, after.merges,
              [&](std::int64_t number, const Merge* before, const Merge& now) {
                put_change(kMerge, number, before, now);
              });
  file_.remove_from(kMerge, static_cast<std::int64_t>(after.merges.size()));
  state.num_merges = after.merges.size();
}

void MapFile::Content::write_extras(const MapExtras& extras, State& state) {
  for (const core::FramePose& frame : extras.frames) {
    file_.put(kFrame, row_number(frame.frame), bytes_of(frame));
    if (state.last_frame && frame.frame <= *state.last_frame) continue;
    state.last_frame = frame.frame;
    ++state.num_frames;
  }
  for (const core::Descriptor& descriptor : extras.descriptors) {
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
  State state = state_;
  file_.begin_writing();
  Transaction transaction = file_.transaction();
  require_unchanged();
  write_keyframes(after, state);
  write_landmarks(after, state);
  write_loops(kLoop, map_.loops, after.loops);
  write_loops(kDoubtedLoop, map_.doubted_loops, after.doubted_loops);
  state.num_loops = after.loops.size();
  state.num_doubted_loops = after.doubted_loops.size();
  write_merges(after, state);
  write_extras(extras, state);
  state.map_number = after.number;
  file_.put(kState, 0, bytes_of(state));
  transaction.commit();
  state_ = state;
  map_ = after;
}

MapFile::MapFile(std::unique_ptr<Content> content) : content_(std::move(content)) {}
MapFile::MapFile(MapFile&&) noexcept = default;
MapFile& MapFile::operator=(MapFile&&) noexcept = default;
MapFile::~MapFile() = default;

MapFile MapFile::create(const std::filesystem::path& path, const MapHeader& header) {
  auto content = std::make_unique<Content>(RowFile::create(path, kMapKind));
  content->write_header(header);
  return MapFile(std::move(content));
}

MapFile MapFile::open(const std::filesystem::path& path, MapAccess access) {
  const OpenMode mode = access == MapAccess::kRead ? OpenMode::kRead : OpenMode::kWrite;
  auto content = std::make_unique<Content>(RowFile::open(path, kMapKind, mode));
  content->read_header();
  return MapFile(std::move(content));
}

const MapHeader& MapFile::header() const { return content_->header(); }

void MapFile::require_same_settings(const MapHeader& expected) const {
  for (const auto& [name, value] : expected) {
    const auto made_with = header().find(name);
    const std::string found = made_with == header().end() ? "unknown" : made_with->second;
    if (found == value) continue;
    throw core::InputError(fmt::format("{}: the map was made with {} = {}; this run has {}",
                                       content_->path().string(), name, found, value));
  }
}

void MapFile::begin_writing() { content_->begin_writing(); }

StoredMap MapFile::load() { return content_->load(); }

std::optional<std::string> MapFile::thumbnail(core::FrameId frame) {
  return content_->thumbnail(frame);
}

void MapFile::commit(const MapVersion& after, const MapExtras& extras) {
  content_->commit(after, extras);
}

}  // namespace samewhere::scene
