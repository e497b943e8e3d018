#include <memory>

#include <fmt/format.h>
#include <zlib.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/features/gunzip.hpp>

namespace samewhere::features {
namespace {

constexpr int kGzipOnly = 15 + 16;  // largest window, header of gzip
constexpr std::size_t kChunkBytes = 1 << 20;

struct EndInflate {
  void operator()(z_stream* stream) const { inflateEnd(stream); }
};

}  // namespace

bool looks_like_gzip(std::string_view bytes) { return bytes.starts_with("\x1f\x8b"); }

std::string gunzip(std::string_view bytes, const core::SizeLimit& limit,
                   const std::filesystem::path& path) {
  z_stream stream{};
  core::require(inflateInit2(&stream, kGzipOnly) == Z_OK, "zlib is there");
  const std::unique_ptr<z_stream, EndInflate> end_inflate(&stream);
  core::require(bytes.size() <= limit.num_bytes, "the compressed file keeps the limit, too");
  std::string compressed(bytes);  // zlib does not promise to leave it as it is
  stream.next_in = reinterpret_cast<Bytef*>(compressed.data());
  stream.avail_in = static_cast<uInt>(compressed.size());
  std::string chunk(kChunkBytes, '\0');
  std::string content;
  int status = Z_OK;
  while (status == Z_OK) {
    stream.next_out = reinterpret_cast<Bytef*>(chunk.data());
    stream.avail_out = static_cast<uInt>(chunk.size());
    status = inflate(&stream, Z_NO_FLUSH);
    content.append(chunk, 0, chunk.size() - stream.avail_out);
    if (content.size() > limit.num_bytes) {
      throw core::InputError(fmt::format("{}: holds more than the {} bytes that {} may have",
                                         path.string(), limit.num_bytes, limit.kind));
    }
  }
  if (status != Z_STREAM_END) {
    throw core::InputError(
        fmt::format("{}: is cut short or damaged; expected a file of gzip", path.string()));
  }
  return content;
}

}  // namespace samewhere::features
