#pragma once

#include <filesystem>
#include <memory>
#include <string_view>

#include <samewhere/bags/bag.hpp>

namespace samewhere::bags {

// One for each format, told by the first bytes of the file.
bool is_mcap(std::string_view beginning);
bool is_sqlite(std::string_view beginning);
bool is_ros1_bag(std::string_view beginning);  // of any version
inline constexpr std::size_t kBeginningSize = 64;

// Each throws InputError as open_bag does.
std::unique_ptr<BagReader> open_mcap(const std::filesystem::path& path);
std::unique_ptr<BagReader> open_sqlite(const std::filesystem::path& path);
std::unique_ptr<BagReader> open_ros1_bag(const std::filesystem::path& path);
// The files of one recording, one after another.
std::unique_ptr<BagReader> open_split_bag(std::vector<std::unique_ptr<BagReader>> parts);

std::unique_ptr<BagWriter> make_mcap(const std::filesystem::path& path, Compression compression);
std::unique_ptr<BagWriter> make_sqlite(const std::filesystem::path& path);
std::unique_ptr<BagWriter> make_ros1_bag(const std::filesystem::path& path,
                                         Compression compression);

}  // namespace samewhere::bags
