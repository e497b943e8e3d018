#include <utility>

#include <fmt/format.h>
#include <sqlite3.h>

#include <samewhere/core/sqlite.hpp>

namespace samewhere::core {
namespace {

constexpr int kBusyTimeout_ms = 5000;

int flags_of(OpenMode mode) {
  switch (mode) {
    case OpenMode::kRead:
      return SQLITE_OPEN_READONLY;
    case OpenMode::kWrite:
      return SQLITE_OPEN_READWRITE;
    case OpenMode::kCreate:
      break;
  }
  return SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE;
}

// SQLite's messages quote the file.
std::string printable(std::string_view message) {
  constexpr std::size_t kMaxLength = 200;
  std::string text(message.substr(0, kMaxLength));
  for (char& c : text)
    if (c < ' ' || c > '~') c = '?';
  return text;
}

// Meaning of the code for the user.
std::string meaning_of(int code, const char* message) {
  switch (code & 0xff) {
    case SQLITE_IOERR:
      return fmt::format("cannot be read or written: {}", message);
    case SQLITE_READONLY:
    case SQLITE_PERM:
    case SQLITE_CANTOPEN:
      return fmt::format("cannot be opened: {}", message);
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      return "another program is writing it";
    case SQLITE_INTERRUPT:
      return "is damaged: its pages refer to each other without an end";
    default:
      return fmt::format("is damaged: {}", message);
  }
}

}  // namespace

void Database::Close::operator()(sqlite3* connection) const { sqlite3_close(connection); }

Database::Database(const std::filesystem::path& path, OpenMode mode) : Database(path, path, mode) {}

Database::Database(const std::filesystem::path& path, const std::filesystem::path& location,
                   OpenMode mode)
    : path_(path), mode_(mode) {
  sqlite3* connection = nullptr;
  const int code = sqlite3_open_v2(location.c_str(), &connection, flags_of(mode), nullptr);
  connection_.reset(connection);
  if (code != SQLITE_OK) fail(code);
  sqlite3_extended_result_codes(connection, 1);
  sqlite3_busy_timeout(connection, kBusyTimeout_ms);
  restrict_to_data();
}

Database Database::in_memory(const std::filesystem::path& path) {
  return {path, ":memory:", OpenMode::kCreate};
}

// As https://sqlite.org/security.html asks for files from elsewhere.
void Database::restrict_to_data() {
  constexpr int kOff[] = {SQLITE_DBCONFIG_TRUSTED_SCHEMA, SQLITE_DBCONFIG_ENABLE_TRIGGER,
                          SQLITE_DBCONFIG_ENABLE_VIEW, SQLITE_DBCONFIG_ENABLE_LOAD_EXTENSION};
  constexpr std::pair<int, int> kLimits[] = {{SQLITE_LIMIT_LENGTH, kMaxValue_bytes},
                                             {SQLITE_LIMIT_SQL_LENGTH, 100'000},
                                             {SQLITE_LIMIT_COLUMN, 16},
                                             {SQLITE_LIMIT_EXPR_DEPTH, 10},
                                             {SQLITE_LIMIT_COMPOUND_SELECT, 3},
                                             {SQLITE_LIMIT_FUNCTION_ARG, 8},
                                             {SQLITE_LIMIT_ATTACHED, 0},
                                             {SQLITE_LIMIT_LIKE_PATTERN_LENGTH, 50},
                                             {SQLITE_LIMIT_VARIABLE_NUMBER, 10},
                                             {SQLITE_LIMIT_TRIGGER_DEPTH, 1},
                                             {SQLITE_LIMIT_WORKER_THREADS, 0}};
  sqlite3_db_config(connection_.get(), SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
  for (const int off : kOff) sqlite3_db_config(connection_.get(), off, 0, nullptr);
  for (const auto& [limit, value] : kLimits) sqlite3_limit(connection_.get(), limit, value);
  execute("PRAGMA cell_size_check=ON");
  execute("PRAGMA mmap_size=0");
}

void Database::fail(int code) const {
  if ((code & 0xff) == SQLITE_FULL) throw NoSpace(path_);
  const char* message = connection_ ? sqlite3_errmsg(connection_.get()) : "out of memory";
  const std::string text = path_.string() + ": " + meaning_of(code, printable(message).c_str());
  const int kind = code & 0xff;
  if (mode_ == OpenMode::kRead && (kind == SQLITE_READONLY || kind == SQLITE_CANTOPEN))
    throw NeedsRepair(text);
  throw InputError(text);
}

void Database::execute(const std::string& sql) {
  const int code = sqlite3_exec(connection_.get(), sql.c_str(), nullptr, nullptr, nullptr);
  if (code != SQLITE_OK) fail(code);
}

Statement Database::prepare(const std::string& sql) {
  sqlite3_stmt* statement = nullptr;
  const int code = sqlite3_prepare_v2(connection_.get(), sql.c_str(), -1, &statement, nullptr);
  if (code != SQLITE_OK) fail(code);
  return {*this, statement};
}

std::int64_t Database::number(const std::string& sql) {
  Statement statement = prepare(sql);
  if (!statement.step()) throw InputError(path_.string() + ": is damaged: a number is gone");
  return statement.number(0);
}

void Database::limit_work() {
  constexpr int kUnit_instructions = 100'000;
  constexpr std::int64_t kLeast_units = 50;      // below a second
  constexpr std::int64_t kBytesPerUnit = 1'000;  // 100 instructions a byte; sorting takes about one
  const std::int64_t size_bytes = number("PRAGMA page_count") * number("PRAGMA page_size");
  work_ = std::make_unique<Work>();
  work_->max_units = kLeast_units + size_bytes / kBytesPerUnit;
  const auto count = [](void* work) {
    auto* const done = static_cast<Work*>(work);
    return ++done->num_units > done->max_units ? 1 : 0;
  };
  sqlite3_progress_handler(connection_.get(), kUnit_instructions, count, work_.get());
}

void Database::check_pages() {
  Statement check = prepare("PRAGMA quick_check(1)");
  const std::string_view found = check.step() ? check.bytes(0) : "";
  if (found == "ok") return;
  // some of its sentences have several lines
  throw InputError(fmt::format("{}: is damaged: {}", path_.string(),
                               printable(found.substr(found.rfind('\n') + 1))));
}

std::string Database::file_bytes() {
  sqlite3_int64 size = 0;
  const std::unique_ptr<unsigned char, decltype(&sqlite3_free)> bytes(
      sqlite3_serialize(connection_.get(), "main", &size, 0), &sqlite3_free);
  if (!bytes) fail(SQLITE_NOMEM);
  return {reinterpret_cast<const char*>(bytes.get()), static_cast<std::size_t>(size)};
}

Statement::Statement(const Database& database, sqlite3_stmt* statement)
    : database_(&database), statement_(statement) {}

void Statement::Finalize::operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }

void Statement::check(int code) const {
  if (code != SQLITE_OK) database_->fail(code);
}

void Statement::bind(int parameter, std::int64_t value) {
  check(sqlite3_bind_int64(statement_.get(), parameter, value));
}

void Statement::bind_bytes(int parameter, std::string_view bytes) {
  check(
      sqlite3_bind_blob64(statement_.get(), parameter, bytes.data(), bytes.size(), SQLITE_STATIC));
}

bool Statement::step() {
  if (database_->work_) database_->work_->num_units = 0;
  const int code = sqlite3_step(statement_.get());
  if (code == SQLITE_ROW) return true;
  sqlite3_reset(statement_.get());
  if (code != SQLITE_DONE) database_->fail(code);
  return false;
}

ColumnKind Statement::kind(int column) const {
  const int type = sqlite3_column_type(statement_.get(), column);
  if (type == SQLITE_INTEGER) return ColumnKind::kNumber;
  return type == SQLITE_BLOB ? ColumnKind::kBytes : ColumnKind::kOther;
}

std::int64_t Statement::number(int column) const {
  return sqlite3_column_int64(statement_.get(), column);
}

std::string_view Statement::bytes(int column) const {
  const auto* data = static_cast<const char*>(sqlite3_column_blob(statement_.get(), column));
  const int size = sqlite3_column_bytes(statement_.get(), column);
  return {data, static_cast<std::size_t>(size)};
}

Transaction::~Transaction() {
  if (!is_open_) return;
  try {
    database_.execute("ROLLBACK");
  } catch (const InputError&) {
    // the failure that brought us here has rolled back already
  }
}

void Transaction::commit() {
  database_.execute("COMMIT");
  is_open_ = false;
}

}  // namespace samewhere::core
