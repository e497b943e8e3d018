#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <samewhere/bags/bag.hpp>
#include <samewhere/core/file_reader.hpp>

namespace samewhere::bags {

// A part of the file that is read at once, with the log times of its messages.
struct Chunk {
  std::uint64_t offset = 0;
  std::uint64_t length = 0;
  std::int64_t first_ns = 0;
  std::int64_t last_ns = 0;
};

// Whether bytes of the file belong to two chunks. No recorder writes that; a forged index would
// have one chunk unpacked any number of times.
bool do_overlap(std::vector<Chunk> chunks);

// A message in a chunk that was read.
struct ChunkEntry {
  std::int64_t log_time_ns = 0;
  int topic = 0;
  std::size_t begin = 0;  // in the chunk's bytes
  std::size_t size = 0;
};

struct LoadedChunk {
  std::string bytes;
  std::vector<ChunkEntry> entries;  // in the order of the file
};

// A recording in chunks, put into the order of time: a chunk is read when a message of it may be
// the next, and forgotten after its last.
class ChunkedReader : public BagReader {
 public:
  const BagInfo& info() const override { return info_; }
  const std::vector<Topic>& topics() const override { return topics_; }
  void start(const std::vector<int>& topics) override;
  std::optional<Message> next() override;

 protected:
  explicit ChunkedReader(const std::filesystem::path& path) : file_(path) {}

  const core::FileReader& file() const { return file_; }
  [[noreturn]] void fail(std::string_view reason) const;
  bool is_selected(int topic) const { return is_selected_[static_cast<std::size_t>(topic)]; }
  // Reads a chunk with its messages of the selected topics; may throw InputError without the path.
  virtual LoadedChunk load(const Chunk& chunk) = 0;
  // To be called once, when all is known: topics get their order, chunks theirs. Returns for each
  // topic its position.
  std::vector<int> set_content(BagInfo info, std::vector<Topic> topics, std::vector<Chunk> chunks);

 private:
  struct Active {
    LoadedChunk chunk;
    std::size_t next = 0;
    std::size_t order = 0;

    std::int64_t time_ns() const { return chunk.entries[next].log_time_ns; }
  };
  void activate_next();
  void activate_due();
  std::size_t earliest() const;

  core::FileReader file_;
  BagInfo info_;
  std::vector<Topic> topics_;
  std::vector<Chunk> chunks_;  // by their first messages
  bool is_started_ = false;
  std::vector<bool> is_selected_;
  std::vector<Active> active_;
  std::size_t next_chunk_ = 0;
  std::size_t active_size_ = 0;  // bytes
};

}  // namespace samewhere::bags
