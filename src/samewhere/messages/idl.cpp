#include <array>
#include <string_view>
#include <utility>

#include <samewhere/core/errors.hpp>
#include <samewhere/messages/idl.hpp>

namespace samewhere::messages {
namespace {

// As the generators of ROS 2 map them.
constexpr std::array<std::pair<std::string_view, std::string_view>, 8> kPrimitives = {
    {{"bool", "boolean"},
     {"byte", "octet"},
     {"int8", "octet"},
     {"uint8", "octet"},
     {"int32", "long"},
     {"uint32", "unsigned long"},
     {"float32", "float"},
     {"float64", "double"}}};

std::string idl_type(std::string_view type) {
  if (type == "string") return "string";
  for (const auto& [ros, idl] : kPrimitives)
    if (ros == type) return std::string(idl);
  const std::size_t slash = type.find('/');
  core::require(slash != std::string_view::npos, "a field is a primitive or of a package");
  return std::string(type.substr(0, slash))
      .append("::msg::dds_::")
      .append(type.substr(slash + 1))
      .append("_");
}

// `float64[9] k` as `double k_[9]`, `uint8[] data` as `sequence<octet> data_`.
std::string idl_field(std::string_view type, std::string_view name) {
  const std::size_t bracket = type.find('[');
  const std::string element = idl_type(type.substr(0, bracket));
  const std::string field = std::string(name).append("_");
  if (bracket == std::string_view::npos) return element + " " + field;
  const std::string_view size = type.substr(bracket);
  if (size == "[]") return "sequence<" + element + "> " + field;
  return element + " " + field + std::string(size);
}

}  // namespace

std::string idl_of(std::span<const MessageType> types) {
  std::string text;
  for (const MessageType& type : types) {
    text.append("module ").append(type.package).append(" { module msg { module dds_ {\n");
    text.append("  struct ").append(type.name).append("_ {\n");
    for (const FieldLine& field : fields_of(type))
      text.append("    ").append(idl_field(field.type, field.name)).append(";\n");
    text.append("  };\n}; }; };\n");
  }
  return text;
}

}  // namespace samewhere::messages
