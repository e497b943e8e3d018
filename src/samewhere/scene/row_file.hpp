#pragma once

#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string_view>

#include <samewhere/scene/sqlite.hpp>
#include <samewhere/scene/writer_lock.hpp>

namespace samewhere::scene {

// What a kind of file is and how messages call it.
struct FileKind {
  std::string_view name;                // "samewhere map"
  std::int64_t magic = 0;               // SQLite's application_id
  std::int64_t version = 0;             // SQLite's user_version
  std::span<const char* const> tables;  // a message calls a row "TABLE NUMBER"
};

// An SQLite file of tables of numbered rows of bytes, each with a checksum. One program writes to
// it at a time, any number may read. Whatever goes wrong is an InputError of one line that begins
// with the path.
class RowFile {
 public:
  // A new file; it must not be there. Nothing is left behind if it cannot be made.
  static RowFile create(const std::filesystem::path& path, const FileKind& kind);
  static RowFile open(const std::filesystem::path& path, const FileKind& kind, OpenMode mode);

  RowFile(RowFile&&) = default;
  RowFile& operator=(RowFile&&) = delete;
  ~RowFile();

  // To be called before the first row is put: the log comes beside the file. Until then a file that
  // was opened keeps its bytes.
  void begin_writing();
  Transaction transaction() { return Transaction(*database_); }
  // Adds the row or replaces it.
  void put(const char* table, std::int64_t number, std::string_view bytes);
  void remove_from(const char* table, std::int64_t first_number);

  // Calls `use` for each row, numbers ascending, with the row as a message calls it
  // ("m.sw: landmark 7"). Throws InputError if a row does not fit its checksum or there are not
  // `count` of them.
  using Use = std::function<void(std::string_view bytes, const std::string& row)>;
  void read(const char* table, std::uint64_t count, const Use& use);
  // One row, or nothing if it is not there. Throws InputError if it does not fit its checksum.
  std::optional<std::string> find(const char* table, std::int64_t number);

  const std::filesystem::path& path() const { return database_->path(); }

 private:
  // Without a lock it is read only.
  RowFile(const std::filesystem::path& path, OpenMode mode, std::unique_ptr<WriterLock> lock);
  Statement& statement(const std::string& sql);
  std::string name_of(const char* table, std::int64_t number) const;

  std::unique_ptr<WriterLock> lock_;  // of who may write; released after the connection
  std::unique_ptr<Database> database_;
  bool has_log_ = false;
  std::map<std::string, Statement> statements_;  // by their text; gone before the database
};

}  // namespace samewhere::scene
