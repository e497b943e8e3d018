#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include <samewhere/core/errors.hpp>

struct sqlite3;
struct sqlite3_stmt;

namespace samewhere::core {

enum class OpenMode { kRead, kWrite, kCreate };

// What a row's column holds.
enum class ColumnKind { kNumber, kBytes, kOther };

// The largest value of a row, bytes: 50 times what a view with the most features (20,000) takes. A
// file that says more is forged.
inline constexpr int kMaxValue_bytes = 64 << 20;

// A file that cannot be opened to be read alone: a program was killed while it wrote, and what it
// left is to be put in order first.
class NeedsRepair : public InputError {
 public:
  using InputError::InputError;
};

// The disk is full.
class NoSpace : public InputError {
 public:
  explicit NoSpace(const std::filesystem::path& path)
      : InputError(path.string() + ": cannot be written: no space left on the disk") {}
};

class Statement;

// A connection to an SQLite file, which may come from anywhere: nothing in its schema is run
// (triggers, views, functions), and values and statements have limits. Whatever goes wrong is an
// InputError of one line that begins with the path.
class Database {
 public:
  Database(const std::filesystem::path& path, OpenMode mode);
  // The file lies at `location`; messages call it `path`.
  Database(const std::filesystem::path& path, const std::filesystem::path& location, OpenMode mode);
  // One in memory alone, which messages call `path`.
  static Database in_memory(const std::filesystem::path& path);

  // Runs statements that give no rows.
  void execute(const std::string& sql);
  Statement prepare(const std::string& sql);
  // The first column of the first row.
  std::int64_t number(const std::string& sql);
  // From here on each step of a statement ends with an InputError if it takes more work than a file
  // of this size can need: in a forged one a page has itself as a part any number of times.
  void limit_work();
  // Every page belongs to one thing, and each says what it should. Reads all of the file.
  void check_pages();
  // All of it as the bytes of a file.
  std::string file_bytes();

  const std::filesystem::path& path() const { return path_; }
  [[noreturn]] void fail(int code) const;

 private:
  friend class Statement;
  struct Close {
    void operator()(sqlite3* connection) const;
  };
  // Of the step that runs; at a place of its own, which the connection knows.
  struct Work {
    std::int64_t num_units = 0;
    std::int64_t max_units = 0;
  };
  void restrict_to_data();

  std::filesystem::path path_;
  OpenMode mode_;
  std::unique_ptr<Work> work_;
  std::unique_ptr<sqlite3, Close> connection_;
};

// One statement with its parameters. The database outlives it.
class Statement {
 public:
  Statement(const Database& database, sqlite3_stmt* statement);

  // Parameters count from 1. Bytes are read when step() runs.
  void bind(int parameter, std::int64_t value);
  void bind_bytes(int parameter, std::string_view bytes);
  // Goes to the next row; false: there is none, and the statement may be bound again.
  bool step();

  // Columns of the row count from 0. Bytes live until the next step().
  ColumnKind kind(int column) const;
  std::int64_t number(int column) const;
  std::string_view bytes(int column) const;

 private:
  struct Finalize {
    void operator()(sqlite3_stmt* statement) const;
  };
  void check(int code) const;

  const Database* database_;
  std::unique_ptr<sqlite3_stmt, Finalize> statement_;
};

// Everything between construction and commit() happens, or nothing.
class Transaction {
 public:
  explicit Transaction(Database& database) : database_(database) { database_.execute("BEGIN"); }
  Transaction(const Transaction&) = delete;
  Transaction& operator=(const Transaction&) = delete;
  ~Transaction();
  void commit();

 private:
  Database& database_;
  bool is_open_ = true;
};

}  // namespace samewhere::core
