#include <string>

#include <samewhere/bags/readers.hpp>
#include <samewhere/core/draft.hpp>
#include <samewhere/core/errors.hpp>
#include <samewhere/core/sqlite.hpp>

namespace samewhere::bags {
namespace {

// The tables of rosbag2 (schema 3), which all its versions read.
constexpr const char* kTables =
    "CREATE TABLE schema(schema_version INTEGER PRIMARY KEY, ros_distro TEXT NOT NULL);"
    "CREATE TABLE metadata(id INTEGER PRIMARY KEY, metadata_version INTEGER NOT NULL,"
    " metadata TEXT NOT NULL);"
    "CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL,"
    " serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL);"
    "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL,"
    " timestamp INTEGER NOT NULL, data BLOB NOT NULL);"
    "CREATE INDEX timestamp_idx ON messages (timestamp ASC);"
    "INSERT INTO schema(schema_version, ros_distro) VALUES (3, 'rolling');";

std::filesystem::path partial_of(const std::filesystem::path& path) {
  std::filesystem::path partial = path;
  partial += std::string(core::kPartial) + "sqlite";
  std::filesystem::remove(partial);
  return partial;
}

class SqliteWriter : public BagWriter {
 public:
  explicit SqliteWriter(const std::filesystem::path& path)
      : path_(path),
        partial_(partial_of(path)),
        database_(std::make_unique<core::Database>(path, partial_, core::OpenMode::kCreate)) {
    // a file that is cut off is not published
    database_->execute("PRAGMA journal_mode=OFF");
    database_->execute("PRAGMA synchronous=OFF");
    database_->execute(kTables);
    database_->execute("BEGIN");
    insert_ = std::make_unique<core::Statement>(
        database_->prepare("INSERT INTO messages(topic_id, timestamp, data) VALUES (?1, ?2, ?3)"));
  }
  ~SqliteWriter() override {
    insert_.reset();
    database_.reset();
    std::error_code error;  // after finish() there is none
    std::filesystem::remove(partial_, error);
  }

  messages::Layout layout() const override { return messages::Layout::kCdr; }

  int add_topic(const std::string& name, const messages::MessageType& type,
                bool is_static) override {
    core::Statement insert = database_->prepare(
        "INSERT INTO topics(id, name, type, serialization_format, offered_qos_profiles)"
        " VALUES (?1, CAST(?2 AS TEXT), CAST(?3 AS TEXT), 'cdr', CAST(?4 AS TEXT))");
    const std::string type_name = type.ros2_name();
    insert.bind(1, ++num_topics_);
    insert.bind_bytes(2, name);
    insert.bind_bytes(3, type_name);
    insert.bind_bytes(
        4, is_static ? "- history: 1\n  depth: 1\n  reliability: 1\n  durability: 1\n" : "");
    insert.step();
    return static_cast<int>(num_topics_) - 1;
  }

  void write(int topic, std::int64_t log_time_ns, std::string_view bytes) override {
    insert_->bind(1, topic + 1);
    insert_->bind(2, log_time_ns);
    insert_->bind_bytes(3, bytes);
    insert_->step();
  }

  void finish() override {
    database_->execute("COMMIT");
    insert_.reset();
    database_.reset();
    std::error_code error;
    std::filesystem::rename(partial_, path_, error);
    if (error) throw core::InputError(path_.string() + ": cannot be written: " + error.message());
    core::sync_folder_of(path_);
  }

 private:
  std::filesystem::path path_;
  std::filesystem::path partial_;
  std::unique_ptr<core::Database> database_;
  std::unique_ptr<core::Statement> insert_;
  std::int64_t num_topics_ = 0;
};

}  // namespace

std::unique_ptr<BagWriter> make_sqlite(const std::filesystem::path& path) {
  return std::make_unique<SqliteWriter>(path);
}

}  // namespace samewhere::bags
