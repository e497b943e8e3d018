#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <samewhere/messages/wire.hpp>

// The messages of ROS that recordings and nodes of samewhere read or write. Fields have the names,
// units and order of the published definitions (std_msgs, geometry_msgs, sensor_msgs, nav_msgs,
// tf2_msgs, diagnostic_msgs), which are equal in ROS 1 and ROS 2 but for Header.seq.
namespace samewhere::messages {

struct Time {
  std::int32_t sec = 0;
  std::uint32_t nanosec = 0;

  friend bool operator==(const Time&, const Time&) = default;
};
template <class Wire>
void fields(Wire& wire, Time& m) {
  wire(m.sec, m.nanosec);
}

// Seconds as a double and back. A number of seconds with nine decimals or fewer comes back
// unchanged.
double seconds(const Time& time);
Time time_of(double seconds);
std::int64_t nanoseconds(const Time& time);
Time time_of_nanoseconds(std::int64_t nanoseconds);

struct Header {
  static constexpr std::string_view kType = "std_msgs/Header";

  Time stamp;
  std::string frame_id;
};
template <class Wire>
void fields(Wire& wire, Header& m) {
  std::uint32_t sequence = 0;  // of ROS 1 alone, and of no use
  if (wire.layout() == Layout::kRos1) wire(sequence);
  wire(m.stamp, m.frame_id);
}

struct Vector3 {
  double x = 0.0, y = 0.0, z = 0.0;
};
template <class Wire>
void fields(Wire& wire, Vector3& m) {
  wire(m.x, m.y, m.z);
}

struct Quaternion {
  double x = 0.0, y = 0.0, z = 0.0, w = 1.0;
};
template <class Wire>
void fields(Wire& wire, Quaternion& m) {
  wire(m.x, m.y, m.z, m.w);
}

struct Pose {
  Vector3 position;
  Quaternion orientation;
};
template <class Wire>
void fields(Wire& wire, Pose& m) {
  wire(m.position, m.orientation);
}

struct PoseStamped {
  static constexpr std::string_view kType = "geometry_msgs/PoseStamped";

  Header header;
  Pose pose;
};
template <class Wire>
void fields(Wire& wire, PoseStamped& m) {
  wire(m.header, m.pose);
}

struct PoseWithCovariance {
  Pose pose;
  std::array<double, 36> covariance = {};  // row by row: x y z, rotation about x y z; m, rad
};
template <class Wire>
void fields(Wire& wire, PoseWithCovariance& m) {
  wire(m.pose, m.covariance);
}

struct PoseWithCovarianceStamped {
  static constexpr std::string_view kType = "geometry_msgs/PoseWithCovarianceStamped";

  Header header;
  PoseWithCovariance pose;
};
template <class Wire>
void fields(Wire& wire, PoseWithCovarianceStamped& m) {
  wire(m.header, m.pose);
}

struct Twist {
  Vector3 linear;   // m/s
  Vector3 angular;  // rad/s
};
template <class Wire>
void fields(Wire& wire, Twist& m) {
  wire(m.linear, m.angular);
}

struct TwistWithCovariance {
  Twist twist;
  std::array<double, 36> covariance = {};
};
template <class Wire>
void fields(Wire& wire, TwistWithCovariance& m) {
  wire(m.twist, m.covariance);
}

struct Odometry {
  static constexpr std::string_view kType = "nav_msgs/Odometry";

  Header header;               // frame of the pose
  std::string child_frame_id;  // frame of the twist, and whose pose it is
  PoseWithCovariance pose;
  TwistWithCovariance twist;
};
template <class Wire>
void fields(Wire& wire, Odometry& m) {
  wire(m.header, m.child_frame_id, m.pose, m.twist);
}

struct Path {
  static constexpr std::string_view kType = "nav_msgs/Path";

  Header header;
  std::vector<PoseStamped> poses;
};
template <class Wire>
void fields(Wire& wire, Path& m) {
  wire(m.header, m.poses);
}

struct Transform {
  Vector3 translation;
  Quaternion rotation;
};
template <class Wire>
void fields(Wire& wire, Transform& m) {
  wire(m.translation, m.rotation);
}

// Maps points of child_frame_id to header.frame_id.
struct TransformStamped {
  static constexpr std::string_view kType = "geometry_msgs/TransformStamped";

  Header header;
  std::string child_frame_id;
  Transform transform;
};
template <class Wire>
void fields(Wire& wire, TransformStamped& m) {
  wire(m.header, m.child_frame_id, m.transform);
}

struct TFMessage {
  static constexpr std::string_view kType = "tf2_msgs/TFMessage";

  std::vector<TransformStamped> transforms;
};
template <class Wire>
void fields(Wire& wire, TFMessage& m) {
  wire(m.transforms);
}

struct Image {
  static constexpr std::string_view kType = "sensor_msgs/Image";

  Header header;
  std::uint32_t height = 0;
  std::uint32_t width = 0;
  std::string encoding;  // sensor_msgs/image_encodings: mono8, bgr8, 16UC1, ...
  std::uint8_t is_bigendian = 0;
  std::uint32_t step = 0;          // bytes of a row
  std::vector<std::uint8_t> data;  // height rows
};
template <class Wire>
void fields(Wire& wire, Image& m) {
  wire(m.header, m.height, m.width, m.encoding, m.is_bigendian, m.step, m.data);
}

struct CompressedImage {
  static constexpr std::string_view kType = "sensor_msgs/CompressedImage";

  Header header;
  std::string format;  // as image_transport writes it: "jpeg", "bgr8; jpeg compressed bgr8", ...
  std::vector<std::uint8_t> data;
};
template <class Wire>
void fields(Wire& wire, CompressedImage& m) {
  wire(m.header, m.format, m.data);
}

struct RegionOfInterest {
  std::uint32_t x_offset = 0;
  std::uint32_t y_offset = 0;
  std::uint32_t height = 0;
  std::uint32_t width = 0;
  bool do_rectify = false;
};
template <class Wire>
void fields(Wire& wire, RegionOfInterest& m) {
  wire(m.x_offset, m.y_offset, m.height, m.width, m.do_rectify);
}

// The fields that are called D, K, R and P in ROS 1.
struct CameraInfo {
  static constexpr std::string_view kType = "sensor_msgs/CameraInfo";

  Header header;
  std::uint32_t height = 0;
  std::uint32_t width = 0;
  std::string distortion_model;  // plumb_bob, rational_polynomial, equidistant
  std::vector<double> d;
  std::array<double, 9> k = {};   // of the raw image
  std::array<double, 9> r = {};   // rectification
  std::array<double, 12> p = {};  // of the rectified image
  std::uint32_t binning_x = 0;
  std::uint32_t binning_y = 0;
  RegionOfInterest roi;
};
template <class Wire>
void fields(Wire& wire, CameraInfo& m) {
  wire(m.header, m.height, m.width, m.distortion_model, m.d, m.k, m.r, m.p, m.binning_x,
       m.binning_y, m.roi);
}

struct Imu {
  static constexpr std::string_view kType = "sensor_msgs/Imu";

  Header header;
  Quaternion orientation;
  std::array<double, 9> orientation_covariance = {};
  Vector3 angular_velocity;  // rad/s
  std::array<double, 9> angular_velocity_covariance = {};
  Vector3 linear_acceleration;  // m/s^2
  std::array<double, 9> linear_acceleration_covariance = {};
};
template <class Wire>
void fields(Wire& wire, Imu& m) {
  wire(m.header, m.orientation, m.orientation_covariance, m.angular_velocity,
       m.angular_velocity_covariance, m.linear_acceleration, m.linear_acceleration_covariance);
}

struct PointField {
  static constexpr std::uint8_t kUint32 = 6;
  static constexpr std::uint8_t kFloat32 = 7;

  std::string name;
  std::uint32_t offset = 0;
  std::uint8_t datatype = kFloat32;
  std::uint32_t count = 1;
};
template <class Wire>
void fields(Wire& wire, PointField& m) {
  wire(m.name, m.offset, m.datatype, m.count);
}

struct PointCloud2 {
  static constexpr std::string_view kType = "sensor_msgs/PointCloud2";

  Header header;
  std::uint32_t height = 1;
  std::uint32_t width = 0;
  std::vector<PointField> fields_of_point;  // `fields` in the definition
  bool is_bigendian = false;
  std::uint32_t point_step = 0;  // bytes
  std::uint32_t row_step = 0;    // bytes
  std::vector<std::uint8_t> data;
  bool is_dense = true;
};
template <class Wire>
void fields(Wire& wire, PointCloud2& m) {
  wire(m.header, m.height, m.width, m.fields_of_point, m.is_bigendian, m.point_step, m.row_step,
       m.data, m.is_dense);
}

struct MapMetaData {
  Time map_load_time;
  float resolution = 0.0F;  // m per cell
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  Pose origin;  // of the lower left corner
};
template <class Wire>
void fields(Wire& wire, MapMetaData& m) {
  wire(m.map_load_time, m.resolution, m.width, m.height, m.origin);
}

struct OccupancyGrid {
  static constexpr std::string_view kType = "nav_msgs/OccupancyGrid";

  Header header;
  MapMetaData info;
  std::vector<std::int8_t> data;  // row by row from the origin: 0 free, 100 occupied, -1 unknown
};
template <class Wire>
void fields(Wire& wire, OccupancyGrid& m) {
  wire(m.header, m.info, m.data);
}

struct KeyValue {
  std::string key;
  std::string value;
};
template <class Wire>
void fields(Wire& wire, KeyValue& m) {
  wire(m.key, m.value);
}

struct DiagnosticStatus {
  static constexpr std::uint8_t kOk = 0;
  static constexpr std::uint8_t kWarn = 1;
  static constexpr std::uint8_t kError = 2;

  std::uint8_t level = kOk;
  std::string name;
  std::string message;
  std::string hardware_id;
  std::vector<KeyValue> values;
};
template <class Wire>
void fields(Wire& wire, DiagnosticStatus& m) {
  wire(m.level, m.name, m.message, m.hardware_id, m.values);
}

struct DiagnosticArray {
  static constexpr std::string_view kType = "diagnostic_msgs/DiagnosticArray";

  Header header;
  std::vector<DiagnosticStatus> status;
};
template <class Wire>
void fields(Wire& wire, DiagnosticArray& m) {
  wire(m.header, m.status);
}

struct String {
  static constexpr std::string_view kType = "std_msgs/String";

  std::string data;
};
template <class Wire>
void fields(Wire& wire, String& m) {
  wire(m.data);
}

}  // namespace samewhere::messages
