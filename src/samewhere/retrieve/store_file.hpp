#pragma once

#include <cstdint>
#include <filesystem>

#include <samewhere/retrieve/segmented_store.hpp>

namespace samewhere::retrieve {

// A store on disk, little-endian, in this order:
//   "samewhere places"        16 bytes
//   version                   u32, now 1
//   length of a vector        u32
//   checksum of the describer u64: vectors of two describers are never mixed
//   number of views           u64
//   frame id                  u64 each, ascending
//   vectors                   f32, view by view, of length 1 or zero
//   checksum                  u64, core::checksum of all bytes before
// Groups and queues are not in it: they are the reader's settings.

// Writes the whole file or nothing. Throws InputError if it cannot be written.
void save_store(const SegmentedStore& store, std::uint64_t describer_checksum,
                const std::filesystem::path& path);

// How a store lays out its views.
struct StoreLayout {
  int group_size = 100;
  int queue_size = 10;
};

// The store of the file. Throws InputError naming the file and what was expected: if it is no such
// file, cut short or damaged, of another version, or written with another describer.
SegmentedStore load_store(const std::filesystem::path& path, std::uint64_t describer_checksum,
                          const StoreLayout& layout);

}  // namespace samewhere::retrieve
