#include <fstream>

#include <fmt/format.h>

#include <samewhere/core/checksum.hpp>
#include <samewhere/core/errors.hpp>
#include <samewhere/scene/row_file.hpp>

namespace samewhere::scene {
namespace {

// Of the content and of where it stands: rows that changed places are found out.
std::int64_t row_checksum(const char* table, std::int64_t number, std::string_view bytes) {
  return static_cast<std::int64_t>(
      core::checksum(fmt::format("{} {} {}", table, number, core::checksum(bytes))));
}

[[noreturn]] void refuse(const std::filesystem::path& path, std::string_view why) {
  throw core::InputError(fmt::format("{}: {}", path.string(), why));
}

bool is_sqlite(const std::filesystem::path& path) {
  constexpr std::string_view kSqlite = "SQLite format 3";
  std::ifstream file(path, std::ios::binary);
  std::string start(kSqlite.size(), '\0');
  file.read(start.data(), static_cast<std::streamsize>(start.size()));
  return file && start == kSqlite;
}

void make_tables(Database& database, const FileKind& kind) {
  database.execute("PRAGMA journal_mode=WAL");
  Transaction transaction(database);
  for (const char* table : kind.tables) {
    database.execute(
        fmt::format("CREATE TABLE {} (number INTEGER PRIMARY KEY, bytes BLOB NOT NULL, "
                    "checksum INTEGER NOT NULL)",
                    table));
  }
  // last: a file without them is none of ours
  database.execute(fmt::format("PRAGMA application_id={}", kind.magic));
  database.execute(fmt::format("PRAGMA user_version={}", kind.version));
  transaction.commit();
}

void remove_files(const std::filesystem::path& path) {
  for (const char* suffix : {"", "-wal", "-shm"}) {
    std::error_code ignored;
    std::filesystem::remove(path.string() + suffix, ignored);
  }
}

}  // namespace

RowFile::RowFile(const std::filesystem::path& path, OpenMode mode, std::unique_ptr<WriterLock> lock)
    : lock_(std::move(lock)), database_(std::make_unique<Database>(path, mode)) {
  if (lock_) database_->execute("PRAGMA synchronous=NORMAL");
}

RowFile RowFile::create(const std::filesystem::path& path, const FileKind& kind) {
  if (std::filesystem::exists(path)) refuse(path, "is there already; expected a new file");
  auto lock = std::make_unique<WriterLock>(path, WriterLock::File::kIsMade);
  try {
    RowFile file(path, OpenMode::kCreate, std::move(lock));
    make_tables(*file.database_, kind);
    return file;
  } catch (const core::InputError&) {
    remove_files(path);
    throw;
  }
}

RowFile RowFile::open(const std::filesystem::path& path, const FileKind& kind, OpenMode mode) {
  std::error_code why_not;
  if (!std::filesystem::exists(path, why_not)) {
    refuse(path, why_not ? "cannot be opened: " + why_not.message()
                         : fmt::format("no such file; expected a {}", kind.name));
  }
  if (!std::filesystem::is_regular_file(path) || !is_sqlite(path))
    refuse(path, fmt::format("is no {}", kind.name));
  auto lock = mode == OpenMode::kRead
                  ? nullptr
                  : std::make_unique<WriterLock>(path, WriterLock::File::kIsThere);
  RowFile file(path, mode, std::move(lock));
  if (file.database_->number("PRAGMA application_id") != kind.magic)
    refuse(path, fmt::format("is no {} but another SQLite file", kind.name));
  const std::int64_t version = file.database_->number("PRAGMA user_version");
  if (version != kind.version) {
    refuse(path, fmt::format("is a {} of version {}; expected version {}", kind.name, version,
                             kind.version));
  }
  return file;
}

void RowFile::begin_writing() {
  if (has_log_) return;
  database_->execute("PRAGMA journal_mode=WAL");
  has_log_ = true;
}

RowFile::~RowFile() {
  if (!database_ || !lock_) return;
  statements_.clear();
  try {
    // into one plain file: one with a log needs a folder that can be written, even to be read
    database_->execute("PRAGMA journal_mode=DELETE");
  } catch (const core::InputError&) {
    // somebody reads it, or the disk is full: the log stays beside the file and is read with it
  }
}

Statement& RowFile::statement(const std::string& sql) {
  const auto known = statements_.find(sql);
  if (known != statements_.end()) return known->second;
  return statements_.emplace(sql, database_->prepare(sql)).first->second;
}

void RowFile::put(const char* table, std::int64_t number, std::string_view bytes) {
  Statement& insert =
      statement(fmt::format("INSERT OR REPLACE INTO {} VALUES (?1, ?2, ?3)", table));
  insert.bind(1, number);
  insert.bind_bytes(2, bytes);
  insert.bind(3, row_checksum(table, number, bytes));
  insert.step();
}

void RowFile::remove_from(const char* table, std::int64_t first_number) {
  Statement& remove = statement(fmt::format("DELETE FROM {} WHERE number >= ?1", table));
  remove.bind(1, first_number);
  remove.step();
}

namespace {

// The bytes of a row (number, bytes, checksum) that `select` stands on; `name` is how a message
// calls it.
std::string_view checked_bytes(const Statement& select, const char* table,
                               const std::string& name) {
  const std::string_view bytes = select.bytes(1);
  if (select.number(2) != row_checksum(table, select.number(0), bytes))
    throw core::InputError(name + " is damaged: its checksum does not fit what it holds");
  return bytes;
}

}  // namespace

std::string RowFile::name_of(const char* table, std::int64_t number) const {
  return fmt::format("{}: {} {}", path().string(), table, number);
}

std::optional<std::string> RowFile::find(const char* table, std::int64_t number) {
  Statement select = database_->prepare(
      fmt::format("SELECT number, bytes, checksum FROM {} WHERE number = ?1", table));
  select.bind(1, number);
  if (!select.step()) return std::nullopt;
  return std::string(checked_bytes(select, table, name_of(table, number)));
}

void RowFile::read(const char* table, std::uint64_t count, const Use& use) {
  Statement select = database_->prepare(
      fmt::format("SELECT number, bytes, checksum FROM {} ORDER BY number", table));
  std::uint64_t num_read = 0;
  while (select.step()) {
    const std::string row = name_of(table, select.number(0));
    const std::string_view bytes = checked_bytes(select, table, row);
    if (num_read == count)
      refuse(path(), fmt::format("is damaged: more than {} rows of {}", count, table));
    use(bytes, row);
    ++num_read;
  }
  if (num_read != count) {
    refuse(path(),
           fmt::format("is damaged: {} of {} rows of {} are gone", count - num_read, count, table));
  }
}

}  // namespace samewhere::scene
