#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include <samewhere/core/file_kind.hpp>

namespace samewhere::features {

bool looks_like_gzip(std::string_view bytes);

// What gzip has compressed. Throws InputError naming `path` if it is cut short, damaged, or holds
// more than `limit`: memory grows with what comes out, not with what a size in it says.
std::string gunzip(std::string_view bytes, const core::SizeLimit& limit,
                   const std::filesystem::path& path);

}  // namespace samewhere::features
