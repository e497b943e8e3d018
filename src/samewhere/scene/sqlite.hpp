#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

struct sqlite3;
struct sqlite3_stmt;

namespace samewhere::scene {

enum class OpenMode { kRead, kWrite, kCreate };

class Statement;

// A connection to an SQLite file. Whatever goes wrong is an InputError of one line that begins with
// the path.
class Database {
 public:
  Database(const std::filesystem::path& path, OpenMode mode);

  // Runs statements that give no rows.
  void execute(const std::string& sql);
  Statement prepare(const std::string& sql);
  // The first column of the first row.
  std::int64_t number(const std::string& sql);

  const std::filesystem::path& path() const { return path_; }
  [[noreturn]] void fail(int code) const;

 private:
  struct Close {
    void operator()(sqlite3* connection) const;
  };
  std::filesystem::path path_;
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

}  // namespace samewhere::scene
