#include <algorithm>
#include <memory>

#include <bzlib.h>
#include <fmt/format.h>
#include <lz4frame.h>
#include <zlib.h>
#include <zstd.h>

#include <samewhere/bags/compression.hpp>
#include <samewhere/core/errors.hpp>

namespace samewhere::bags {
namespace {

using core::InputError;

[[noreturn]] void fail_packed(std::string_view method, std::string_view reason) {
  throw InputError(fmt::format("a chunk is damaged ({}: {})", method, reason));
}

void require_size(std::string_view method, std::uint64_t got, std::uint64_t expected) {
  if (got != expected) {
    fail_packed(method, fmt::format("it has {} bytes, its header says {}", got, expected));
  }
}

// Memory is taken for what the bytes can become, not for what is claimed.
void require_possible(std::string_view method, std::string_view packed, std::size_t size,
                      std::size_t max_ratio) {
  if (size / max_ratio <= packed.size()) return;
  fail_packed(method, fmt::format("its header says that {} bytes become {}", packed.size(), size));
}

std::string unpack_lz4(std::string_view packed, std::size_t size) {
  constexpr std::size_t kMaxRatio = 255;  // a byte of a length adds so many
  require_possible("lz4", packed, size, kMaxRatio);
  LZ4F_dctx* made = nullptr;
  core::require(LZ4F_isError(LZ4F_createDecompressionContext(&made, LZ4F_VERSION)) == 0,
                "lz4 gives a decoder");
  const std::unique_ptr<LZ4F_dctx, decltype(&LZ4F_freeDecompressionContext)> decoder(
      made, &LZ4F_freeDecompressionContext);
  std::string bytes(size, '\0');
  std::size_t filled = 0;
  while (true) {
    std::size_t room = bytes.size() - filled;
    std::size_t taken = packed.size();
    const std::size_t hint = LZ4F_decompress(decoder.get(), bytes.data() + filled, &room,
                                             packed.data(), &taken, nullptr);
    if (LZ4F_isError(hint) != 0) fail_packed("lz4", LZ4F_getErrorName(hint));
    filled += room;
    packed.remove_prefix(taken);
    if (hint == 0) break;
    if (room == 0 && taken == 0) fail_packed("lz4", "it does not end where its header says");
  }
  require_size("lz4", filled, size);
  return bytes;
}

std::string unpack_zstd(std::string_view packed, std::size_t size) {
  constexpr std::size_t kMaxRatio = 128 * 1024 / 4;  // the smallest block and what it becomes
  require_possible("zstd", packed, size, kMaxRatio);
  std::string bytes(size, '\0');
  // more frames than one are allowed, and padding behind them
  const std::size_t got = ZSTD_decompress(bytes.data(), size, packed.data(), packed.size());
  if (ZSTD_isError(got) == 0) {
    require_size("zstd", got, size);
    return bytes;
  }
  const std::size_t frame = ZSTD_findFrameCompressedSize(packed.data(), packed.size());
  if (ZSTD_isError(frame) != 0 || frame == packed.size())
    fail_packed("zstd", ZSTD_getErrorName(got));
  return unpack_zstd(packed.substr(0, frame), size);
}

// Few bytes may become 46 MB, so that memory is taken as they come out.
std::string unpack_bz2(std::string_view packed, std::size_t size) {
  constexpr std::size_t kUsualRatio = 32;
  bz_stream stream{};
  core::require(BZ2_bzDecompressInit(&stream, 0, 0) == BZ_OK, "bz2 gives a decoder");
  const std::unique_ptr<bz_stream, decltype(&BZ2_bzDecompressEnd)> decoder(&stream,
                                                                           &BZ2_bzDecompressEnd);
  std::string bytes(std::min(size, kUsualRatio * packed.size()), '\0');
  std::size_t filled = 0;
  stream.next_in = const_cast<char*>(packed.data());  // read alone
  stream.avail_in = static_cast<unsigned>(packed.size());
  while (true) {
    if (filled == bytes.size()) bytes.resize(std::min(size, 2 * bytes.size()));
    const unsigned left = stream.avail_in;
    stream.next_out = bytes.data() + filled;
    stream.avail_out = static_cast<unsigned>(bytes.size() - filled);
    const int code = BZ2_bzDecompress(&stream);
    const auto filled_now = bytes.size() - stream.avail_out;
    const bool is_stuck = filled_now == filled && stream.avail_in == left;
    filled = filled_now;
    if (code == BZ_STREAM_END) break;
    if (code != BZ_OK) fail_packed("bz2", fmt::format("error {}", code));
    if (is_stuck) fail_packed("bz2", "it does not end where its header says");
  }
  require_size("bz2", filled, size);
  return bytes;
}

// ROS 1 reads frames of independent blocks with a checksum of the content alone (roslz4).
std::string pack_lz4(std::string_view bytes) {
  LZ4F_preferences_t preferences{};
  preferences.frameInfo.blockSizeID = LZ4F_max256KB;
  preferences.frameInfo.blockMode = LZ4F_blockIndependent;
  preferences.frameInfo.contentChecksumFlag = LZ4F_contentChecksumEnabled;
  std::string packed(LZ4F_compressFrameBound(bytes.size(), &preferences), '\0');
  const std::size_t size =
      LZ4F_compressFrame(packed.data(), packed.size(), bytes.data(), bytes.size(), &preferences);
  core::require(LZ4F_isError(size) == 0, "lz4 packs into a buffer of its bound");
  packed.resize(size);
  return packed;
}

std::string pack_zstd(std::string_view bytes) {
  constexpr int kLevel = 3;  // zstd's own
  std::string packed(ZSTD_compressBound(bytes.size()), '\0');
  const std::size_t size =
      ZSTD_compress(packed.data(), packed.size(), bytes.data(), bytes.size(), kLevel);
  core::require(ZSTD_isError(size) == 0, "zstd packs into a buffer of its bound");
  packed.resize(size);
  return packed;
}

std::string pack_bz2(std::string_view bytes) {
  constexpr int kBlockSize = 9;                                       // 900 KB, as rosbag has it
  std::string packed(bytes.size() + bytes.size() / 100 + 600, '\0');  // the bound of its manual
  auto size = static_cast<unsigned>(packed.size());
  const int code = BZ2_bzBuffToBuffCompress(packed.data(), &size, const_cast<char*>(bytes.data()),
                                            static_cast<unsigned>(bytes.size()), kBlockSize, 0, 0);
  core::require(code == BZ_OK, "bz2 packs into a buffer of its bound");
  packed.resize(size);
  return packed;
}

}  // namespace

std::string decompress(std::string_view packed, std::string_view method, std::uint64_t size) {
  if (size > kMaxChunkSize) {
    throw InputError(
        fmt::format("a chunk claims {} bytes, expected at most {}", size, kMaxChunkSize));
  }
  const auto expected = static_cast<std::size_t>(size);
  if (method.empty() || method == "none") {
    require_size("none", packed.size(), size);
    return std::string(packed);
  }
  if (method == "lz4") return unpack_lz4(packed, expected);
  if (method == "zstd") return unpack_zstd(packed, expected);
  if (method == "bz2") return unpack_bz2(packed, expected);
  throw InputError(fmt::format("a chunk is compressed by '{}', expected none, lz4, zstd or bz2",
                               method.substr(0, 40)));
}

std::string compress(std::string_view bytes, Compression method) {
  switch (method) {
    case Compression::kLz4:
      return pack_lz4(bytes);
    case Compression::kZstd:
      return pack_zstd(bytes);
    case Compression::kBz2:
      return pack_bz2(bytes);
    case Compression::kNone:
      break;
  }
  return std::string(bytes);
}

std::string_view name_of(Compression method) {
  switch (method) {
    case Compression::kLz4:
      return "lz4";
    case Compression::kZstd:
      return "zstd";
    case Compression::kBz2:
      return "bz2";
    case Compression::kNone:
      break;
  }
  return "";
}

std::uint32_t crc32_of(std::string_view bytes, std::uint32_t crc_before) {
  return static_cast<std::uint32_t>(
      ::crc32_z(crc_before, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size()));
}

}  // namespace samewhere::bags
