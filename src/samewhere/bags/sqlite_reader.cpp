#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <zstd.h>

#include <samewhere/bags/compression.hpp>
#include <samewhere/bags/readers.hpp>
#include <samewhere/core/errors.hpp>
#include <samewhere/core/sqlite.hpp>

namespace samewhere::bags {
namespace {

using core::InputError;

constexpr std::string_view kZstdMagic = "\x28\xb5\x2f\xfd";

// The storage "sqlite3" of rosbag2: tables `topics` and `messages`.
class SqliteReader : public BagReader {
 public:
  explicit SqliteReader(const std::filesystem::path& path)
      : database_(path, core::OpenMode::kRead) {
    database_.limit_work();
    require_tables();
    info_ = {.format = "rosbag2 (SQLite)", .compression = "none", .damage = {}};
    read_topics();
    if (info_.num_messages == 0) return;
    info_.first_ns = time_ns(database_.number("SELECT min(timestamp) FROM messages"));
    info_.last_ns = time_ns(database_.number("SELECT max(timestamp) FROM messages"));
    if (first_bytes().starts_with(kZstdMagic)) info_.compression = "zstd";
  }

  const BagInfo& info() const override { return info_; }
  const std::vector<Topic>& topics() const override { return topics_; }

  void start(const std::vector<int>& topics) override {
    is_selected_.assign(topics_.size(), false);
    for (const int topic : topics) is_selected_.at(static_cast<std::size_t>(topic)) = true;
    // Sorted by numbers alone: the messages may be larger than the memory. By rowid, which `id` is:
    // where it is not the key of the table, each message would be searched in all of it.
    order_.emplace(
        database_.prepare("SELECT rowid, topic_id, timestamp FROM messages "
                          "ORDER BY timestamp, rowid"));
    data_.emplace(database_.prepare("SELECT data FROM messages WHERE rowid = ?1"));
  }

  std::optional<Message> next() override {
    if (!order_) return std::nullopt;
    while (order_->step()) {
      const auto topic = topic_of_id_.find(order_->number(1));
      if (topic == topic_of_id_.end()) fail("a message of a topic that is not in its table");
      if (!is_selected_[static_cast<std::size_t>(topic->second)]) continue;
      return Message{.topic = topic->second,
                     .log_time_ns = time_ns(order_->number(2)),
                     .bytes = read_data(order_->number(0))};
    }
    order_.reset();
    return std::nullopt;
  }

 private:
  [[noreturn]] void fail(std::string_view reason) const {
    throw InputError(fmt::format("{}: {}", database_.path().string(), reason));
  }

  std::int64_t time_ns(std::int64_t stored) const {
    if (stored < 0) fail(fmt::format("has a message of time {} ns, expected 0 or later", stored));
    return stored;
  }

  void require_tables() {
    const auto count = database_.number(
        "SELECT count(*) FROM sqlite_schema WHERE type = 'table' AND name IN ('topics', "
        "'messages')");
    if (count != 2)
      fail(
          "is an SQLite file, but no recording of rosbag2: it has no tables `topics` and "
          "`messages`");
  }

  void read_topics() {
    std::vector<std::pair<std::int64_t, Topic>> rows;
    core::Statement select = database_.prepare(
        "SELECT id, name, type, serialization_format FROM topics ORDER BY name, id");
    while (select.step()) {
      rows.emplace_back(select.number(0), Topic{.name = std::string(select.bytes(1)),
                                                .type = messages::plain_type_name(select.bytes(2)),
                                                .encoding = std::string(select.bytes(3)),
                                                .definition = {}});
    }
    for (const auto& [id, topic] : rows) {
      const auto same =
          std::find_if(topics_.begin(), topics_.end(), [&topic = topic](const Topic& known) {
            return known.name == topic.name && known.type == topic.type;
          });
      topic_of_id_[id] = static_cast<int>(same - topics_.begin());
      if (same == topics_.end()) topics_.push_back(topic);
    }
    // not `count(*)` of all: SQLite counts that without end where pages of a forged file do not end
    core::Statement counts =
        database_.prepare("SELECT topic_id, count(*) FROM messages GROUP BY topic_id");
    while (counts.step()) {
      const auto count = static_cast<std::uint64_t>(counts.number(1));
      info_.num_messages += count;
      const auto topic = topic_of_id_.find(counts.number(0));
      if (topic == topic_of_id_.end()) continue;  // told when it is read
      topics_[static_cast<std::size_t>(topic->second)].num_messages += count;
    }
  }

  std::string first_bytes() {
    core::Statement first = database_.prepare("SELECT data FROM messages LIMIT 1");
    return first.step() ? std::string(first.bytes(0)) : std::string();
  }

  // Messages may be compressed one by one (compression_mode: MESSAGE); no other begins so.
  std::string_view read_data(std::int64_t id) {
    data_->bind(1, id);
    if (!data_->step()) fail("a message is gone");
    message_ = data_->bytes(0);
    while (data_->step()) {
      // to its end, so that it may be bound again
    }
    if (!message_.starts_with(kZstdMagic)) return message_;
    const auto size = ZSTD_getFrameContentSize(message_.data(), message_.size());
    if (size == ZSTD_CONTENTSIZE_UNKNOWN || size == ZSTD_CONTENTSIZE_ERROR)
      fail("a message that was compressed by zstd does not tell its size");
    try {
      message_ = decompress(message_, "zstd", size);
    } catch (const InputError& error) {
      fail(error.what());
    }
    return message_;
  }

  core::Database database_;
  BagInfo info_;
  std::vector<Topic> topics_;
  std::map<std::int64_t, int> topic_of_id_;
  std::vector<bool> is_selected_;
  std::optional<core::Statement> order_;
  std::optional<core::Statement> data_;
  std::string message_;
};

}  // namespace

bool is_sqlite(std::string_view beginning) {
  return beginning.starts_with(std::string_view("SQLite format 3\0", 16));
}

std::unique_ptr<BagReader> open_sqlite(const std::filesystem::path& path) {
  return std::make_unique<SqliteReader>(path);
}

}  // namespace samewhere::bags
