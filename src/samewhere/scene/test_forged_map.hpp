#pragma once

#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <sqlite3.h>

#include <samewhere/core/checksum.hpp>

namespace samewhere::scene {

// What a stranger can do to a map file: any SQL, on a connection without our restrictions. Gives
// the first column of the rows.
inline std::vector<std::string> run_sql(const std::filesystem::path& path, const std::string& sql) {
  sqlite3* connection = nullptr;
  sqlite3_open(path.c_str(), &connection);
  std::vector<std::string> rows;
  const auto keep = [](void* kept, int, char** values, char**) {
    static_cast<std::vector<std::string>*>(kept)->emplace_back(values[0] ? values[0] : "");
    return 0;
  };
  char* message = nullptr;
  const std::string quick = "PRAGMA synchronous=OFF; PRAGMA journal_mode=MEMORY; ";
  sqlite3_exec(connection, quick.c_str(), nullptr, nullptr, nullptr);
  sqlite3_exec(connection, sql.c_str(), keep, &rows, &message);
  const std::string failed = message == nullptr ? "" : message;
  sqlite3_free(message);
  sqlite3_close(connection);
  if (!failed.empty()) throw std::runtime_error(failed + " in " + sql);
  return rows;
}

// As row_file.cpp makes it.
inline std::int64_t forged_checksum(std::string_view table, std::int64_t number,
                                    std::string_view bytes) {
  return static_cast<std::int64_t>(
      core::checksum(fmt::format("{} {} {}", table, number, core::checksum(bytes))));
}

inline std::string hex_of(std::string_view bytes) {
  std::string hex;
  for (const char c : bytes) hex += fmt::format("{:02x}", static_cast<unsigned char>(c));
  return hex;
}

// The bytes of a row become others, with a checksum that fits.
inline void forge_row(const std::filesystem::path& path, std::string_view table,
                      std::int64_t number, std::string_view bytes) {
  run_sql(path, fmt::format("INSERT OR REPLACE INTO {} VALUES ({}, x'{}', {})", table, number,
                            hex_of(bytes), forged_checksum(table, number, bytes)));
}

}  // namespace samewhere::scene
