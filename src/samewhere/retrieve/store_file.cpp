#include <bit>
#include <cstring>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include <fmt/format.h>

#include <samewhere/core/checksum.hpp>
#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>
#include <samewhere/core/similarity.hpp>
#include <samewhere/retrieve/store_file.hpp>

namespace samewhere::retrieve {
namespace {

static_assert(std::endian::native == std::endian::little, "the file is written as memory has it");

constexpr std::string_view kMagic = "samewhere places";
constexpr std::uint32_t kVersion = 1;
constexpr std::uint32_t kMaxVectorLength = 1'000'000;
constexpr std::uint64_t kMaxViews = std::numeric_limits<int>::max();

struct Header {
  std::uint32_t version = kVersion;
  std::uint32_t vector_length = 0;
  std::uint64_t describer_checksum = 0;
  std::uint64_t num_views = 0;
};
static_assert(sizeof(Header) == 24 && std::is_trivially_copyable_v<Header>);

constexpr std::size_t kHeaderEnd = kMagic.size() + sizeof(Header);

template <class T>
void put(std::string& bytes, const T& value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

template <class T>
T get(std::string_view bytes, std::size_t offset) {
  T value;
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}

[[noreturn]] void refuse(const std::filesystem::path& path, std::string_view why) {
  throw core::InputError(fmt::format("{}: {}", path.string(), why));
}

std::uint64_t file_size_of(const Header& header) {
  const std::uint64_t per_view =
      sizeof(std::uint64_t) + sizeof(float) * std::uint64_t{header.vector_length};
  return kHeaderEnd + header.num_views * per_view + sizeof(std::uint64_t);
}

// The header of a file that is whole.
Header checked_header(std::string_view bytes, const std::filesystem::path& path) {
  if (!bytes.starts_with(kMagic)) {
    refuse(path, "is no store of places; expected a file that samewhere has saved");
  }
  if (bytes.size() < kHeaderEnd + sizeof(std::uint64_t)) refuse(path, "is cut short");
  const auto header = get<Header>(bytes, kMagic.size());
  if (header.version != kVersion) {
    refuse(path, fmt::format("is a store of places of version {}; expected version {}",
                             header.version, kVersion));
  }
  if (header.vector_length == 0 || header.vector_length > kMaxVectorLength ||
      header.num_views > kMaxViews) {
    refuse(path, fmt::format("is damaged: it speaks of {} views of {} numbers", header.num_views,
                             header.vector_length));
  }
  if (bytes.size() != file_size_of(header)) {
    refuse(path,
           fmt::format("is cut short or damaged: {} bytes; expected {} for {} views of {} "
                       "numbers",
                       bytes.size(), file_size_of(header), header.num_views, header.vector_length));
  }
  const std::size_t content_size = bytes.size() - sizeof(std::uint64_t);
  if (get<std::uint64_t>(bytes, content_size) != core::checksum(bytes.substr(0, content_size))) {
    refuse(path, "is damaged: its checksum does not fit what it holds");
  }
  return header;
}

}  // namespace

void save_store(const SegmentedStore& store, std::uint64_t describer_checksum,
                const std::filesystem::path& path) {
  const Header header{.vector_length = static_cast<std::uint32_t>(store.vector_length()),
                      .describer_checksum = describer_checksum,
                      .num_views = static_cast<std::uint64_t>(store.num_vectors())};
  std::string bytes;
  bytes.reserve(file_size_of(header));
  bytes += kMagic;
  put(bytes, header);
  for (int i = 0; i < store.num_vectors(); ++i) put(bytes, store.frame(i).value());
  for (int i = 0; i < store.num_vectors(); ++i) {
    const std::span<const float> vector = store.vector(i);
    bytes.append(reinterpret_cast<const char*>(vector.data()), vector.size_bytes());
  }
  put(bytes, core::checksum(bytes));
  core::write_file(path, bytes);
}

SegmentedStore load_store(const std::filesystem::path& path, std::uint64_t describer_checksum,
                          const StoreLayout& layout) {
  const std::string bytes = core::read_file(path, core::kDataLimit);
  const Header header = checked_header(bytes, path);
  if (header.describer_checksum != describer_checksum) {
    refuse(path, fmt::format("was written by describer {:016x}; expected {:016x}, the one of these "
                             "settings: the vectors of two describers do not compare",
                             header.describer_checksum, describer_checksum));
  }
  SegmentedStore store(layout.group_size, layout.queue_size);
  std::vector<float> vector(header.vector_length);
  const std::size_t vectors = kHeaderEnd + header.num_views * sizeof(std::uint64_t);
  std::optional<core::FrameId> last;
  for (std::size_t i = 0; i < header.num_views; ++i) {
    const auto frame = core::FrameId::from_value(
        get<std::uint64_t>(bytes, kHeaderEnd + i * sizeof(std::uint64_t)));
    const std::size_t size = vector.size() * sizeof(float);
    std::memcpy(vector.data(), bytes.data() + vectors + i * size, size);
    const bool is_next = frame.is_valid() && (!last || *last < frame);
    if (!is_next || !core::is_unit_or_zero(vector)) {
      refuse(path, fmt::format("is damaged: view {} is out of order or not of unit length", i));
    }
    last = frame;
    store.append(frame, vector);
  }
  return store;
}

}  // namespace samewhere::retrieve
