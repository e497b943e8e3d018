#include <algorithm>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include <samewhere/bags/chunked_reader.hpp>
#include <samewhere/core/errors.hpp>

namespace samewhere::bags {
namespace {

// Of chunks that overlap in time. A recorder writes them one after another; what needs more was
// sorted by topic and not by time.
constexpr std::size_t kMaxActiveSize = std::size_t{2} << 30;

}  // namespace

bool do_overlap(std::vector<Chunk> chunks) {
  std::sort(chunks.begin(), chunks.end(),
            [](const Chunk& a, const Chunk& b) { return a.offset < b.offset; });
  return std::adjacent_find(chunks.begin(), chunks.end(), [](const Chunk& a, const Chunk& b) {
           return b.offset - a.offset < a.length;
         }) != chunks.end();
}

void ChunkedReader::fail(std::string_view reason) const {
  throw core::InputError(fmt::format("{}: {}", file_.path().string(), reason));
}

std::vector<int> ChunkedReader::set_content(BagInfo info, std::vector<Topic> topics,
                                            std::vector<Chunk> chunks) {
  std::vector<int> by_name(topics.size());
  std::iota(by_name.begin(), by_name.end(), 0);
  std::stable_sort(by_name.begin(), by_name.end(), [&topics](int a, int b) {
    return topics[static_cast<std::size_t>(a)].name < topics[static_cast<std::size_t>(b)].name;
  });
  std::vector<int> positions(topics.size());
  for (std::size_t i = 0; i < by_name.size(); ++i) {
    positions[static_cast<std::size_t>(by_name[i])] = static_cast<int>(i);
    topics_.push_back(std::move(topics[static_cast<std::size_t>(by_name[i])]));
  }
  info_ = std::move(info);
  chunks_ = std::move(chunks);
  std::stable_sort(chunks_.begin(), chunks_.end(), [](const Chunk& a, const Chunk& b) {
    return std::pair(a.first_ns, a.offset) < std::pair(b.first_ns, b.offset);
  });
  return positions;
}

void ChunkedReader::start(const std::vector<int>& topics) {
  is_selected_.assign(topics_.size(), false);
  for (const int topic : topics) is_selected_.at(static_cast<std::size_t>(topic)) = true;
  active_.clear();
  active_size_ = 0;
  next_chunk_ = 0;
  is_started_ = true;
}

void ChunkedReader::activate_next() {
  const std::size_t order = next_chunk_++;
  LoadedChunk loaded;
  try {
    loaded = load(chunks_[order]);
  } catch (const core::InputError& error) {
    const std::string_view reason = error.what();
    if (reason.starts_with(file_.path().string())) throw;
    fail(fmt::format("at byte {}: {}", chunks_[order].offset, reason));
  }
  if (loaded.entries.empty()) return;
  std::stable_sort(
      loaded.entries.begin(), loaded.entries.end(),
      [](const ChunkEntry& a, const ChunkEntry& b) { return a.log_time_ns < b.log_time_ns; });
  active_size_ += loaded.bytes.size();
  if (active_size_ > kMaxActiveSize) {
    fail(
        fmt::format("its chunks overlap in time by more than {} bytes, expected a recording that "
                    "is sorted by time",
                    kMaxActiveSize));
  }
  active_.push_back({.chunk = std::move(loaded), .next = 0, .order = order});
}

std::size_t ChunkedReader::earliest() const {
  const auto found =
      std::min_element(active_.begin(), active_.end(), [](const Active& a, const Active& b) {
        return std::pair(a.time_ns(), a.order) < std::pair(b.time_ns(), b.order);
      });
  return static_cast<std::size_t>(found - active_.begin());
}

void ChunkedReader::activate_due() {
  while (next_chunk_ < chunks_.size() &&
         (active_.empty() || chunks_[next_chunk_].first_ns <= active_[earliest()].time_ns())) {
    activate_next();
  }
}

std::optional<Message> ChunkedReader::next() {
  if (!is_started_) return std::nullopt;
  std::erase_if(active_, [this](const Active& active) {
    const bool is_done = active.next == active.chunk.entries.size();
    if (is_done) active_size_ -= active.chunk.bytes.size();
    return is_done;
  });
  activate_due();
  if (active_.empty()) return std::nullopt;
  Active& active = active_[earliest()];
  const ChunkEntry& entry = active.chunk.entries[active.next++];
  return Message{.topic = entry.topic,
                 .log_time_ns = entry.log_time_ns,
                 .bytes = std::string_view(active.chunk.bytes).substr(entry.begin, entry.size)};
}

}  // namespace samewhere::bags
