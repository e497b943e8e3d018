#pragma once

#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string_view>

#include <samewhere/core/sqlite.hpp>
#include <samewhere/scene/writer_lock.hpp>

namespace samewhere::scene {

// What a kind of file is and how messages call it.
struct FileKind {
  std::string_view name;                // "samewhere map"
  std::int64_t magic = 0;               // SQLite's application_id
  std::int64_t version = 0;             // SQLite's user_version
  std::span<const char* const> tables;  // a message calls a row "TABLE NUMBER"
  const FileKind* before = nullptr;     // the version before, which can be read and not written
  std::string_view remedy = {};         // how a file of that version becomes one of this
};

// An SQLite file of tables of numbered rows of bytes, each with a checksum. One program writes to
// it at a time, any number may read. Whatever goes wrong is an InputError of one line that begins
// with the path.
class RowFile {
 public:
  // A new file with the rows that `fill` puts into it; it must not be there. It appears under its
  // name with these rows or not at all, and nothing is left behind if it cannot be made.
  using Fill = std::function<void(RowFile& file)>;
  static RowFile create(const std::filesystem::path& path, const FileKind& kind, const Fill& fill);
  // Of a file from anywhere: its kind, its tables and their columns, and its pages are checked.
  // What a killed program left is put in order, in place or, where the folder cannot be written, in
  // a copy.
  static RowFile open(const std::filesystem::path& path, const FileKind& kind, core::OpenMode mode);

  // Writes into the file what a killed program left beside it. The caller holds the writer's lock.
  static void recover(const std::filesystem::path& path);

  RowFile(RowFile&&) = default;
  RowFile& operator=(RowFile&&) = delete;
  ~RowFile();

  // To be called before the first row is put: the log comes beside the file. Until then a file that
  // was opened keeps its bytes.
  void begin_writing();
  core::Transaction transaction() { return core::Transaction(*database_); }
  // Commits, if the disk has room for all that the file holds then: the log can always be written
  // into the file, and its own space given back.
  void commit(core::Transaction& transaction);
  // Writes the log into the file, for its room on the disk. Whether it could.
  bool shrink_log();
  // Adds the row or replaces it.
  void put(const char* table, std::int64_t number, std::string_view bytes);
  void remove_from(const char* table, std::int64_t first_number);

  // A row as it is read. `name` is how a message calls it ("m.sw: landmark 7").
  struct Row {
    std::int64_t number = 0;
    std::string_view bytes;
    std::string name;
  };
  // Calls `use` for each row, numbers ascending. Throws InputError if a row does not fit its
  // checksum or there are not `count` of them.
  using Use = std::function<void(const Row& row)>;
  void read(const char* table, std::uint64_t count, const Use& use);
  // The same of rows that are numbered from 0 on without a gap.
  void read_list(const char* table, std::uint64_t count, const Use& use);
  // One row, or nothing if it is not there. Throws InputError if it does not fit its checksum.
  std::optional<std::string> find(const char* table, std::int64_t number);

  const std::filesystem::path& path() const { return database_->path(); }
  // Of its kind.
  std::int64_t version() const { return version_; }

 private:
  // With a lock it is written.
  RowFile(std::unique_ptr<core::Database> database, std::unique_ptr<WriterLock> lock);
  static RowFile open_to_read(const std::filesystem::path& path);
  core::Statement& statement(const std::string& sql);
  std::string name_of(const char* table, std::int64_t number) const;

  std::shared_ptr<const void> copy_;  // that is read instead; removed with the last owner
  std::unique_ptr<WriterLock> lock_;  // of the writer; released after the connection
  std::unique_ptr<core::Database> database_;
  std::int64_t version_ = 0;
  bool has_log_ = false;
  std::map<std::string, core::Statement> statements_;  // by their text; gone before the database
};

}  // namespace samewhere::scene
