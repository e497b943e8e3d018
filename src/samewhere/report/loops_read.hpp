#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <samewhere/core/ledger.hpp>

namespace samewhere::report {

// The ledger of a finished run from its loops.json, one row per candidate, numbered in the order of
// the file. Everything that was measured is there; the uncertainty of a loop is not. Throws
// InputError for a file that is missing, cut, of another version, or has an entry that misses a
// field or has one of another kind, naming the entry.
core::Ledger read_loops_json(const std::filesystem::path& path);

// Rows of a ledger as report::ledger_row_json wrote them, numbered in their order. Throws
// InputError as above; `name` is how a message calls where they are from.
core::Ledger read_ledger_rows(const std::vector<std::string>& rows, const std::string& name);

}  // namespace samewhere::report
