#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>

#include <samewhere/bags/bytes.hpp>
#include <samewhere/messages/messages.hpp>

// Records of a ROS 1 bag, as its format 2.0 is described (wiki.ros.org/Bags/Format/2.0): a header
// of fields `name=value` and data, each with its length of four bytes before it.
namespace samewhere::bags::ros1 {

inline constexpr std::string_view kVersion = "#ROSBAG V2.0\n";
// The record after it is filled up with blanks to this size, so that it can be written at the end.
inline constexpr std::size_t kBagHeaderSize = 4096;

// More than the fields of any record. Each takes several times its bytes of memory.
inline constexpr std::uint64_t kMaxHeaderSize = std::uint64_t{16} << 20;

enum class Op : std::uint8_t {
  kMessage = 0x02,
  kBagHeader = 0x03,
  kIndex = 0x04,
  kChunk = 0x05,
  kChunkInfo = 0x06,
  kConnection = 0x07,
};

using Fields = std::map<std::string, std::string, std::less<>>;

struct Record {
  Fields header;
  std::string_view data;
};

// They throw InputError, without the name of the file, where bytes end too early or a field is
// missing.
Fields read_fields(std::string_view bytes);
Record take_record(ByteReader& rest);
Op op_of(const Fields& header);
std::string_view field(const Fields& header, std::string_view name);
template <class T>
T number_of(const Fields& header, std::string_view name) {
  return ByteReader(field(header, name)).number<T>();
}
// Time 0 stands for no time in ROS 1, and rosbag leaves out its messages: it is written as the
// least time, and read back as 0.
inline constexpr std::int64_t kLeastTime_ns = 1;
messages::Time recorded_time(std::int64_t time_ns);
std::int64_t time_ns_of(const Fields& header, std::string_view name);

class HeaderWriter {
 public:
  explicit HeaderWriter(Op op) { number("op", static_cast<std::uint8_t>(op)); }
  HeaderWriter() = default;  // fields of data, such as those of a connection
  HeaderWriter& text(std::string_view name, std::string_view value);
  template <class T>
  HeaderWriter& number(std::string_view name, T value) {
    return text(name, {reinterpret_cast<const char*>(&value), sizeof(T)});
  }
  HeaderWriter& time(std::string_view name, std::int64_t time_ns);
  std::string_view view() const { return bytes_.view(); }
  std::string record(std::string_view data) const;

 private:
  ByteWriter bytes_;
};

}  // namespace samewhere::bags::ros1
