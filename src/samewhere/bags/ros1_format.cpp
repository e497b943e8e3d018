#include <algorithm>

#include <samewhere/bags/ros1_format.hpp>

namespace samewhere::bags::ros1 {

Fields read_fields(std::string_view bytes) {
  if (bytes.size() > kMaxHeaderSize)
    throw core::InputError(
        fmt::format("fields of {} bytes, expected at most {}", bytes.size(), kMaxHeaderSize));
  Fields fields;
  ByteReader rest(bytes);
  while (!rest.is_empty()) {
    const std::string_view entry = rest.text();
    const std::size_t sign = entry.find('=');
    if (sign == std::string_view::npos) throw core::InputError("a field without '='");
    fields.emplace(entry.substr(0, sign), entry.substr(sign + 1));
  }
  return fields;
}

Record take_record(ByteReader& rest) {
  Record record;
  record.header = read_fields(rest.text());
  record.data = rest.text();
  return record;
}

std::string_view field(const Fields& header, std::string_view name) {
  const auto found = header.find(name);
  if (found == header.end()) throw core::InputError(fmt::format("a record without '{}'", name));
  return found->second;
}

Op op_of(const Fields& header) { return static_cast<Op>(number_of<std::uint8_t>(header, "op")); }

std::int64_t time_ns_of(const Fields& header, std::string_view name) {
  ByteReader bytes(field(header, name));
  const auto seconds = bytes.number<std::uint32_t>();
  const std::int64_t time_ns =
      std::int64_t{seconds} * 1'000'000'000 + bytes.number<std::uint32_t>();
  return time_ns == kLeastTime_ns ? 0 : time_ns;
}

messages::Time recorded_time(std::int64_t time_ns) {
  return messages::time_of_nanoseconds(std::max(time_ns, kLeastTime_ns));
}

HeaderWriter& HeaderWriter::text(std::string_view name, std::string_view value) {
  bytes_.number(static_cast<std::uint32_t>(name.size() + 1 + value.size()));
  bytes_.bytes(name).bytes("=").bytes(value);
  return *this;
}

HeaderWriter& HeaderWriter::time(std::string_view name, std::int64_t time_ns) {
  const messages::Time time = recorded_time(time_ns);
  ByteWriter value;
  value.number(time.sec).number(time.nanosec);
  return text(name, value.view());
}

std::string HeaderWriter::record(std::string_view data) const {
  ByteWriter whole;
  return whole.text(bytes_.view()).text(data).take();
}

}  // namespace samewhere::bags::ros1
