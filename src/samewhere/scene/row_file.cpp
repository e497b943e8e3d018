#include <cstdlib>
#include <fstream>
#include <set>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <unistd.h>

#include <samewhere/core/checksum.hpp>
#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>
#include <samewhere/core/text_file.hpp>
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

std::string table_sql(const char* table) {
  return fmt::format(
      "CREATE TABLE {} (number INTEGER PRIMARY KEY, bytes BLOB NOT NULL, checksum INTEGER NOT "
      "NULL)",
      table);
}

void make_tables(core::Database& database, const FileKind& kind) {
  core::Transaction transaction(database);
  for (const char* table : kind.tables) database.execute(table_sql(table));
  database.execute(fmt::format("PRAGMA application_id={}", kind.magic));
  database.execute(fmt::format("PRAGMA user_version={}", kind.version));
  transaction.commit();
}

// What a file of this name that is gone has left: it would be taken for the log of a new one.
void remove_logs(const std::filesystem::path& path) {
  for (const char* suffix : {"-wal", "-shm", "-journal"}) {
    std::error_code ignored;
    const std::string log = path.string() + suffix;
    if (std::filesystem::is_regular_file(log, ignored)) std::filesystem::remove(log, ignored);
  }
}

// A million keyframes take less. It bounds the time and the memory that a look at all pages takes.
constexpr std::uintmax_t kMaxFile_bytes = std::uintmax_t{64} << 30;

// Before SQLite touches it: a pipe would never end to be opened.
void check_is_file(const std::filesystem::path& path, const FileKind& kind) {
  std::error_code why_not;
  if (!std::filesystem::exists(path, why_not)) {
    refuse(path, why_not ? "cannot be opened: " + why_not.message()
                         : fmt::format("no such file; expected a {}", kind.name));
  }
  if (!std::filesystem::is_regular_file(path) || !is_sqlite(path))
    refuse(path, fmt::format("is no {}", kind.name));
  const std::uintmax_t size = std::filesystem::file_size(path);
  if (size > kMaxFile_bytes) {
    refuse(path, fmt::format("is damaged: it has {} GiB; expected {} at most", size >> 30,
                             kMaxFile_bytes >> 30));
  }
}

// The kind with the version of the file: `kind` or the one before.
const FileKind& kind_of(core::Database& database, const FileKind& kind, core::OpenMode mode) {
  if (database.number("PRAGMA application_id") != kind.magic)
    refuse(database.path(), fmt::format("is no {} but another SQLite file", kind.name));
  const std::int64_t version = database.number("PRAGMA user_version");
  if (version == kind.version) return kind;
  const bool is_before = kind.before != nullptr && version == kind.before->version;
  if (is_before && mode == core::OpenMode::kRead) return *kind.before;
  const std::string found = fmt::format("is a {} of version {}", kind.name, version);
  if (is_before)
    refuse(database.path(), fmt::format("{}, which is read only; expected version {}: {}", found,
                                        kind.version, kind.remedy));
  refuse(database.path(), kind.before == nullptr
                              ? fmt::format("{}; expected version {}", found, kind.version)
                              : fmt::format("{}; expected version {} or {}", found,
                                            kind.before->version, kind.version));
}

// Nothing but the tables, each as it was made: no trigger, view, index or column beside them.
void check_schema(core::Database& database, const FileKind& kind) {
  std::set<std::string> expected;
  for (const char* table : kind.tables) expected.insert(table_sql(table));
  core::Statement select = database.prepare("SELECT type, name, sql FROM sqlite_schema");
  while (select.step()) {
    if (expected.erase(std::string(select.bytes(2))) == 1) continue;
    refuse(database.path(), fmt::format("is damaged: it has a {} {} that no {} has",
                                        core::printable(std::string(select.bytes(0))),
                                        core::printable(std::string(select.bytes(1))), kind.name));
  }
  if (!expected.empty())
    refuse(database.path(), fmt::format("is damaged: it lacks {} of its tables", expected.size()));
}

// A folder of this program alone, removed with its last owner.
std::shared_ptr<const std::filesystem::path> temporary_folder(const std::filesystem::path& of) {
  std::string name = (std::filesystem::temp_directory_path() / "samewhere-map-XXXXXX").string();
  if (::mkdtemp(name.data()) == nullptr) refuse(of, "cannot be copied to be put in order");
  return {new std::filesystem::path(name), [](const std::filesystem::path* folder) {
            std::error_code ignored;
            std::filesystem::remove_all(*folder, ignored);
            delete folder;
          }};
}

// With what a killed program left beside it.
void copy_files(const std::filesystem::path& from, const std::filesystem::path& to) {
  for (const char* suffix : {"", "-wal", "-journal"}) {
    std::error_code error;
    const std::string part = from.string() + suffix;
    if (!std::filesystem::exists(part, error)) continue;
    if (!std::filesystem::copy_file(part, to.string() + suffix, error))
      refuse(from, "cannot be copied to be put in order: " + error.message());
  }
}

// What was begun is taken back, what was committed is written into the file itself.
void put_in_order(const std::filesystem::path& path, const std::filesystem::path& location) {
  core::Database database(path, location, core::OpenMode::kWrite);
  database.number("PRAGMA application_id");  // takes back
  database.execute("PRAGMA journal_mode=DELETE");
}

}  // namespace

RowFile::RowFile(std::unique_ptr<core::Database> database, std::unique_ptr<WriterLock> lock)
    : lock_(std::move(lock)), database_(std::move(database)) {
  if (lock_) database_->execute("PRAGMA synchronous=NORMAL");
}

RowFile RowFile::create(const std::filesystem::path& path, const FileKind& kind, const Fill& fill) {
  RowFile draft(std::make_unique<core::Database>(core::Database::in_memory(path)), nullptr);
  make_tables(*draft.database_, kind);
  fill(draft);
  if (!core::write_new_file(path, draft.database_->file_bytes()))
    refuse(path, "is there already; expected a new file");
  try {
    auto lock = std::make_unique<WriterLock>(path, WriterLock::File::kIsThere);
    remove_logs(path);
    RowFile file(std::make_unique<core::Database>(path, core::OpenMode::kWrite), std::move(lock));
    file.version_ = kind.version;
    file.begin_writing();
    return file;
  } catch (const core::InputError&) {
    remove_logs(path);
    std::error_code ignored;
    std::filesystem::remove(path, ignored);
    throw;
  }
}

// A program may have been killed while it wrote.
RowFile RowFile::open_to_read(const std::filesystem::path& path) {
  const auto opened = [&](const std::filesystem::path& location) {
    auto database = std::make_unique<core::Database>(path, location, core::OpenMode::kRead);
    database->number("PRAGMA application_id");  // the first look at the file
    return RowFile(std::move(database), nullptr);
  };
  try {
    return opened(path);
  } catch (const core::NeedsRepair&) {
    if (WriterLock::is_held(path)) throw;
  }
  try {
    const WriterLock lock(path, WriterLock::File::kIsThere);
    put_in_order(path, path);
  } catch (const core::InputError&) {
    // its folder cannot be written
    const auto folder = temporary_folder(path);
    const std::filesystem::path copy = *folder / "map.sw";
    copy_files(path, copy);
    put_in_order(path, copy);
    RowFile file = opened(copy);
    file.copy_ = folder;
    return file;
  }
  return opened(path);
}

RowFile RowFile::open(const std::filesystem::path& path, const FileKind& kind,
                      core::OpenMode mode) {
  check_is_file(path, kind);
  const auto opened = [&] {
    if (mode == core::OpenMode::kRead) return open_to_read(path);
    auto lock = std::make_unique<WriterLock>(path, WriterLock::File::kIsThere);
    return RowFile(std::make_unique<core::Database>(path, mode), std::move(lock));
  };
  RowFile file = opened();
  const FileKind& found = kind_of(*file.database_, kind, mode);
  check_schema(*file.database_, found);
  file.version_ = found.version;
  file.database_->check_pages();
  return file;
}

void RowFile::recover(const std::filesystem::path& path) { put_in_order(path, path); }

void RowFile::begin_writing() {
  if (has_log_) return;
  database_->execute("PRAGMA journal_mode=WAL");
  // after a large commit: what is written before it goes into the file
  database_->execute("PRAGMA journal_size_limit=4194304");
  has_log_ = true;
}

RowFile::~RowFile() {
  if (!database_ || !lock_) return;
  statements_.clear();
  try {
    // into one plain file: one with a log needs a folder that can be written, even to be read
    database_->execute("PRAGMA journal_mode=DELETE");
  } catch (const core::InputError&) {
    // another program reads it, or the disk is full: the log stays beside the file and is read with
    // it
  }
  lock_->give_back_room();
}

bool RowFile::shrink_log() {
  constexpr std::int64_t kDone = 0;  // another program may be reading from it
  return has_log_ && database_->number("PRAGMA wal_checkpoint(TRUNCATE)") == kDone;
}

void RowFile::commit(core::Transaction& transaction) {
  if (lock_) {
    const std::int64_t num_bytes =
        database_->number("PRAGMA page_count") * database_->number("PRAGMA page_size");
    lock_->reserve(static_cast<std::uint64_t>(num_bytes));
  }
  transaction.commit();
}

core::Statement& RowFile::statement(const std::string& sql) {
  const auto known = statements_.find(sql);
  if (known != statements_.end()) return known->second;
  return statements_.emplace(sql, database_->prepare(sql)).first->second;
}

void RowFile::put(const char* table, std::int64_t number, std::string_view bytes) {
  core::Statement& insert =
      statement(fmt::format("INSERT OR REPLACE INTO {} VALUES (?1, ?2, ?3)", table));
  insert.bind(1, number);
  insert.bind_bytes(2, bytes);
  insert.bind(3, row_checksum(table, number, bytes));
  insert.step();
}

void RowFile::remove_from(const char* table, std::int64_t first_number) {
  core::Statement& remove = statement(fmt::format("DELETE FROM {} WHERE number >= ?1", table));
  remove.bind(1, first_number);
  remove.step();
}

namespace {

// The bytes of a row (number, bytes, checksum) that `select` stands on; `name` is how a message
// calls it.
std::string_view checked_bytes(const core::Statement& select, const char* table,
                               const std::string& name) {
  if (select.kind(1) != core::ColumnKind::kBytes || select.kind(2) != core::ColumnKind::kNumber)
    throw core::InputError(name + " is damaged: it holds values of another type");
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
  core::Statement select = database_->prepare(
      fmt::format("SELECT number, bytes, checksum FROM {} WHERE number = ?1", table));
  select.bind(1, number);
  if (!select.step()) return std::nullopt;
  return std::string(checked_bytes(select, table, name_of(table, number)));
}

void RowFile::read(const char* table, std::uint64_t count, const Use& use) {
  core::Statement select = database_->prepare(
      fmt::format("SELECT number, bytes, checksum FROM {} ORDER BY number", table));
  std::uint64_t num_read = 0;
  while (select.step()) {
    Row row{select.number(0), {}, name_of(table, select.number(0))};
    row.bytes = checked_bytes(select, table, row.name);
    if (num_read == count)
      refuse(path(), fmt::format("is damaged: more than {} rows of {}", count, table));
    use(row);
    ++num_read;
  }
  if (num_read != count) {
    refuse(path(),
           fmt::format("is damaged: {} of {} rows of {} are gone", count - num_read, count, table));
  }
}

void RowFile::read_list(const char* table, std::uint64_t count, const Use& use) {
  std::int64_t next = 0;
  read(table, count, [&](const Row& row) {
    if (row.number != next)
      throw core::InputError(
          fmt::format("{} is damaged: it has another number than {}", row.name, next));
    ++next;
    use(row);
  });
}

}  // namespace samewhere::scene
