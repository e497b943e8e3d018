#include <algorithm>
#include <array>
#include <vector>

#include <samewhere/core/errors.hpp>
#include <samewhere/messages/types.hpp>

namespace samewhere::messages {
namespace {

// The checksums are those of the ROS 1 packages; a test compares them with the packages of Debian.
constexpr std::array kTypes = {
    MessageType{"builtin_interfaces", "Time", "int32 sec\nuint32 nanosec\n", ""},
    MessageType{"std_msgs", "Header", "builtin_interfaces/Time stamp\nstring frame_id\n",
                "2176decaecbce78abc3b96ef049fabed"},
    MessageType{"std_msgs", "String", "string data\n", "992ce8a1687cec8c8bd883ec73ca41d1"},
    MessageType{"geometry_msgs", "Vector3", "float64 x\nfloat64 y\nfloat64 z\n",
                "4a842b65f413084dc2b10fb484ea7f17"},
    MessageType{"geometry_msgs", "Point", "float64 x\nfloat64 y\nfloat64 z\n",
                "4a842b65f413084dc2b10fb484ea7f17"},
    MessageType{"geometry_msgs", "Quaternion", "float64 x\nfloat64 y\nfloat64 z\nfloat64 w\n",
                "a779879fadf0160734f906b8c19c7004"},
    MessageType{"geometry_msgs", "Pose",
                "geometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n",
                "e45d45a5a1ce597b249e23fb30fc871f"},
    MessageType{"geometry_msgs", "PoseStamped", "std_msgs/Header header\ngeometry_msgs/Pose pose\n",
                "d3812c3cbc69362b77dc0b19b345f8f5"},
    MessageType{"geometry_msgs", "PoseWithCovariance",
                "geometry_msgs/Pose pose\nfloat64[36] covariance\n",
                "c23e848cf1b7533a8d7c259073a97e6f"},
    MessageType{"geometry_msgs", "PoseWithCovarianceStamped",
                "std_msgs/Header header\ngeometry_msgs/PoseWithCovariance pose\n",
                "953b798c0f514ff060a53a3498ce6246"},
    MessageType{"geometry_msgs", "Twist",
                "geometry_msgs/Vector3 linear\ngeometry_msgs/Vector3 angular\n",
                "9f195f881246fdfa2798d1d3eebca84a"},
    MessageType{"geometry_msgs", "TwistWithCovariance",
                "geometry_msgs/Twist twist\nfloat64[36] covariance\n",
                "1fe8a28e6890a4cc3ae4c3ca5c7d82e6"},
    MessageType{"geometry_msgs", "Transform",
                "geometry_msgs/Vector3 translation\ngeometry_msgs/Quaternion rotation\n",
                "ac9eff44abf714214112b05d54a3cf9b"},
    MessageType{
        "geometry_msgs", "TransformStamped",
        "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/Transform transform\n",
        "b5764a33bfeb3588febc2682852579b0"},
    MessageType{"tf2_msgs", "TFMessage", "geometry_msgs/TransformStamped[] transforms\n",
                "94810edda583a504dfda3829e70d7eec"},
    MessageType{"nav_msgs", "Odometry",
                "std_msgs/Header header\nstring child_frame_id\n"
                "geometry_msgs/PoseWithCovariance pose\ngeometry_msgs/TwistWithCovariance twist\n",
                "cd5e73d190d741a2f92e81eda573aca7"},
    MessageType{"nav_msgs", "Path", "std_msgs/Header header\ngeometry_msgs/PoseStamped[] poses\n",
                "6227e2b7e9cce15051f669a5e197bbf7"},
    MessageType{"nav_msgs", "MapMetaData",
                "builtin_interfaces/Time map_load_time\nfloat32 resolution\nuint32 width\n"
                "uint32 height\ngeometry_msgs/Pose origin\n",
                "10cfc8a2818024d3248802c00c95f11b"},
    MessageType{"nav_msgs", "OccupancyGrid",
                "std_msgs/Header header\nnav_msgs/MapMetaData info\nint8[] data\n",
                "3381f2d731d4076ec5c71b0759edbe4e"},
    MessageType{"sensor_msgs", "Image",
                "std_msgs/Header header\nuint32 height\nuint32 width\nstring encoding\n"
                "uint8 is_bigendian\nuint32 step\nuint8[] data\n",
                "060021388200f6f0f447d0fcd9c64743"},
    MessageType{"sensor_msgs", "CompressedImage",
                "std_msgs/Header header\nstring format\nuint8[] data\n",
                "8f7a12909da2c9d3332d540a0977563f"},
    MessageType{"sensor_msgs", "RegionOfInterest",
                "uint32 x_offset\nuint32 y_offset\nuint32 height\nuint32 width\nbool do_rectify\n",
                "bdb633039d588fcccb441a4d43ccfe09"},
    MessageType{"sensor_msgs", "CameraInfo",
                "std_msgs/Header header\nuint32 height\nuint32 width\nstring distortion_model\n"
                "float64[] d\nfloat64[9] k\nfloat64[9] r\nfloat64[12] p\nuint32 binning_x\n"
                "uint32 binning_y\nsensor_msgs/RegionOfInterest roi\n",
                "c9a58c1b0b154e0e6da7578cb991d214"},
    MessageType{"sensor_msgs", "Imu",
                "std_msgs/Header header\ngeometry_msgs/Quaternion orientation\n"
                "float64[9] orientation_covariance\ngeometry_msgs/Vector3 angular_velocity\n"
                "float64[9] angular_velocity_covariance\n"
                "geometry_msgs/Vector3 linear_acceleration\n"
                "float64[9] linear_acceleration_covariance\n",
                "6a62c6daae103f4ff57a132d6f95cec2"},
    MessageType{"sensor_msgs", "PointField",
                "string name\nuint32 offset\nuint8 datatype\nuint32 count\n",
                "268eacb2962780ceac86cbd17e328150"},
    MessageType{"sensor_msgs", "PointCloud2",
                "std_msgs/Header header\nuint32 height\nuint32 width\n"
                "sensor_msgs/PointField[] fields\nbool is_bigendian\nuint32 point_step\n"
                "uint32 row_step\nuint8[] data\nbool is_dense\n",
                "1158d486dd51d683ce2f1be655c3c181"},
    MessageType{"diagnostic_msgs", "KeyValue", "string key\nstring value\n",
                "cf57fdc6617a881a88c16e768132149c"},
    MessageType{"diagnostic_msgs", "DiagnosticStatus",
                "byte level\nstring name\nstring message\nstring hardware_id\n"
                "diagnostic_msgs/KeyValue[] values\n",
                "d0ce08bc6e5ba34c7754f563a9cabaf1"},
    MessageType{"diagnostic_msgs", "DiagnosticArray",
                "std_msgs/Header header\ndiagnostic_msgs/DiagnosticStatus[] status\n",
                "60810da900de1dd6ddd437c3503511da"},
};

// Without the brackets of an array; empty: a type of no package.
std::string_view package_type_of(const FieldLine& line) {
  if (line.type.find('/') == std::string_view::npos) return {};
  return line.type.substr(0, line.type.find('['));
}

// In ROS 1 the matrices of a camera have large letters, and time is a type of the language.
std::string ros1_fields(const MessageType& type) {
  std::string text = type.name == "Header" ? "uint32 seq\n" : "";
  for (const FieldLine& line : fields_of(type)) {
    std::string name(line.name);
    const bool is_matrix = type.name == "CameraInfo" && name.size() == 1;
    if (is_matrix) name[0] = static_cast<char>(name[0] - 'a' + 'A');
    const bool is_time = line.type == "builtin_interfaces/Time";
    text.append(is_time ? "time" : line.type).append(" ").append(name).append("\n");
  }
  return text;
}

std::string own_definition(const MessageType& type, Layout layout) {
  return layout == Layout::kRos1 ? ros1_fields(type) : std::string(type.fields);
}

// Those in `type`, each once, in the order in which they are met.
void collect(const MessageType& type, Layout layout, std::vector<const MessageType*>& found) {
  for (const FieldLine& line : fields_of(type)) {
    const std::string_view name = package_type_of(line);
    if (name.empty() || (layout == Layout::kRos1 && name == "builtin_interfaces/Time")) continue;
    const MessageType* const part = find_message_type(name);
    core::require(part != nullptr, "every type of a known message is known");
    if (std::find(found.begin(), found.end(), part) != found.end()) continue;
    found.push_back(part);
    collect(*part, layout, found);
  }
}

}  // namespace

std::string MessageType::ros2_name() const {
  return std::string(package).append("/msg/").append(name);
}

std::string MessageType::ros1_name() const { return std::string(package).append("/").append(name); }

std::vector<FieldLine> fields_of(const MessageType& type) {
  std::vector<FieldLine> lines;
  std::string_view rest = type.fields;
  while (!rest.empty()) {
    const std::size_t blank = rest.find(' ');
    const std::size_t end = rest.find('\n');
    lines.push_back({rest.substr(0, blank), rest.substr(blank + 1, end - blank - 1)});
    rest.remove_prefix(end + 1);
  }
  return lines;
}

std::span<const MessageType> message_types() { return kTypes; }

std::string plain_type_name(std::string_view name) {
  constexpr std::string_view kDds = "::msg::dds_::";
  if (const auto at = name.find(kDds); at != std::string_view::npos && name.ends_with('_')) {
    const std::size_t first = at + kDds.size();
    return std::string(name.substr(0, at)) + "/" +
           std::string(name.substr(first, name.size() - first - 1));
  }
  const std::size_t first = name.find('/');
  const std::size_t last = name.rfind('/');
  if (first == last || name.substr(first, last - first) != "/msg") return std::string(name);
  return std::string(name.substr(0, first)) + std::string(name.substr(last));
}

const MessageType* find_message_type(std::string_view name) {
  std::string plain = plain_type_name(name);
  if (plain == "tf/tfMessage") plain = "tf2_msgs/TFMessage";  // the older name of the same
  const auto found = std::find_if(kTypes.begin(), kTypes.end(), [&plain](const MessageType& type) {
    return type.ros1_name() == plain;
  });
  return found == kTypes.end() ? nullptr : &*found;
}

std::string full_definition(const MessageType& type, Layout layout) {
  std::string text = own_definition(type, layout);
  std::vector<const MessageType*> parts;
  collect(type, layout, parts);
  for (const MessageType* part : parts) {
    text.append(80, '=').append("\nMSG: ").append(part->ros1_name()).append("\n");
    text.append(own_definition(*part, layout));
  }
  return text;
}

}  // namespace samewhere::messages
