#include <fmt/format.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/messages/wire.hpp>

namespace samewhere::messages {
namespace {

// What stands before the fields in CDR: a byte of 0, the byte order, two bytes of options.
constexpr std::size_t kEncapsulationSize = 4;

std::size_t padding_to(std::size_t position, std::size_t size) {
  return (size - position % size) % size;
}

}  // namespace

WireReader::WireReader(std::string_view bytes, Layout layout) : bytes_(bytes), layout_(layout) {
  if (layout_ == Layout::kRos1) return;
  require_rest(1, kEncapsulationSize);
  if (bytes_[0] != 0 || (bytes_[1] != 0 && bytes_[1] != 1)) {
    throw core::InputError(
        fmt::format("has the representation {:02x}{:02x}, expected CDR: 0000 or 0001",
                    static_cast<unsigned char>(bytes_[0]), static_cast<unsigned char>(bytes_[1])));
  }
  is_swapped_ = bytes_[1] == 0;
  position_ = origin_ = kEncapsulationSize;
}

void WireReader::read(std::string& text) {
  const std::uint32_t length = read_count();
  require_rest(length, 1);
  const std::string_view bytes = bytes_.substr(position_, length);
  position_ += length;
  // CDR counts the zero byte at the end
  const bool has_end = layout_ == Layout::kCdr && !bytes.empty() && bytes.back() == '\0';
  text.assign(bytes.substr(0, bytes.size() - (has_end ? 1 : 0)));
}

void WireReader::read(std::vector<std::uint8_t>& bytes) {
  const std::uint32_t count = read_count();
  require_rest(count, 1);
  const char* const first = bytes_.data() + position_;
  bytes.assign(first, first + count);
  position_ += count;
}

void WireReader::align(std::size_t size) {
  if (layout_ == Layout::kCdr) position_ += padding_to(position_ - origin_, size);
}

void WireReader::require_rest(std::uint64_t count, std::size_t size) const {
  const std::size_t rest = position_ <= bytes_.size() ? bytes_.size() - position_ : 0;
  if (position_ <= bytes_.size() && count <= rest / size) return;
  throw core::InputError(fmt::format("has {} bytes, expected {} of {} bytes each at byte {}",
                                     bytes_.size(), count, size, position_));
}

WireWriter::WireWriter(Layout layout) : layout_(layout) {
  if (layout_ == Layout::kRos1) return;
  bytes_.assign({0, 1, 0, 0});
  origin_ = kEncapsulationSize;
}

void WireWriter::write(const std::string& text) {
  const std::size_t end = layout_ == Layout::kCdr ? 1 : 0;
  number(static_cast<std::uint32_t>(text.size() + end));
  bytes_.append(text);
  bytes_.append(end, '\0');
}

void WireWriter::write(const std::vector<std::uint8_t>& bytes) {
  number(static_cast<std::uint32_t>(bytes.size()));
  bytes_.append(bytes.begin(), bytes.end());
}

void WireWriter::align(std::size_t size) {
  if (layout_ == Layout::kCdr) bytes_.append(padding_to(bytes_.size() - origin_, size), '\0');
}

}  // namespace samewhere::messages
