// fuzz_seeds FOLDER: small good inputs to begin with, in FOLDER/bag and FOLDER/message.

#include <filesystem>
#include <string>
#include <vector>

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "readers.hpp"
#include <samewhere/bags/bag.hpp>
#include <samewhere/bags/mcap_format.hpp>
#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>
#include <samewhere/core/program.hpp>
#include <samewhere/messages/types.hpp>

namespace samewhere::test {
namespace {

using bags::BagFormat;
using bags::Compression;
using messages::Layout;
using std::filesystem::path;

constexpr std::int64_t kStart_ns = 1'700'000'000'000'000'000;

messages::Header header() {
  return {.stamp = messages::time_of_nanoseconds(kStart_ns), .frame_id = "camera"};
}

messages::Image image(const std::string& encoding, std::uint32_t pixel_size) {
  messages::Image message{
      .header = header(), .height = 2, .width = 4, .encoding = encoding, .step = 4 * pixel_size};
  for (std::uint32_t i = 0; i < 2 * message.step; ++i)
    message.data.push_back(static_cast<std::uint8_t>(40 + i));
  return message;
}

// `before`: bytes in front of the picture.
messages::CompressedImage picture(const std::string& format, const std::string& ending, int type,
                                  std::size_t before = 0) {
  cv::Mat pixels(4, 4, type, cv::Scalar::all(1000.0));
  std::vector<std::uint8_t> bytes;
  cv::imencode(ending, pixels, bytes);
  bytes.insert(bytes.begin(), before, std::uint8_t{0x40});
  return {.header = header(), .format = format, .data = std::move(bytes)};
}

messages::CameraInfo calibration(const std::string& model, std::vector<double> d) {
  messages::CameraInfo info{.header = header(),
                            .height = 480,
                            .width = 640,
                            .distortion_model = model,
                            .d = std::move(d),
                            .k = {500, 0, 320, 0, 500, 240, 0, 0, 1},
                            .r = {1, 0, 0, 0, 1, 0, 0, 0, 1},
                            .p = {500, 0, 320, 0, 0, 500, 240, 0, 0, 0, 1, 0}};
  info.roi = {.x_offset = 20, .y_offset = 10, .height = 400, .width = 600};
  return info;
}

messages::DiagnosticArray diagnostics() {
  messages::DiagnosticStatus status{.name = "a", .message = "b"};
  status.values.push_back({"key", "value"});
  return {.header = header(), .status = {status}};
}

messages::PointCloud2 cloud() {
  messages::PointCloud2 message{.header = header(), .width = 1, .point_step = 4, .row_step = 4};
  message.fields_of_point.push_back({.name = "x"});
  message.data.assign(4, 1);
  return message;
}

// Calls add("name", message) with messages of every type.
template <class Add>
void for_each_message(const Add& add) {
  for (const char* encoding : {"mono8", "bayer_rggb8"}) add(encoding, image(encoding, 1));
  for (const char* encoding : {"mono16", "16UC1", "uyvy", "yuyv", "bayer_grbg16"})
    add(encoding, image(encoding, 2));
  for (const char* encoding : {"bgr8", "rgb8"}) add(encoding, image(encoding, 3));
  for (const char* encoding : {"bgra8", "32FC1"}) add(encoding, image(encoding, 4));
  for (const char* encoding : {"bgr16", "rgb16"}) add(encoding, image(encoding, 6));
  add("jpeg", picture("bgr8; jpeg compressed bgr8", ".jpg", CV_8UC3));
  add("png", picture("png", ".png", CV_8UC3));
  add("depth_png", picture("16UC1; compressedDepth png", ".png", CV_16UC1, 12));
  add("inverse_depth", picture("32FC1; compressedDepth png", ".png", CV_16UC1, 12));
  add("bmp", picture("bmp", ".bmp", CV_8UC1));
  add("plumb_bob", calibration("plumb_bob", {0.1, -0.2, 0.0, 0.0, 0.0}));
  add("rational", calibration("rational_polynomial", std::vector<double>(8, 0.01)));
  add("equidistant", calibration("equidistant", {0.1, 0.0, 0.0, 0.0}));
  add("imu", messages::Imu{.header = header()});
  add("odometry", messages::Odometry{.header = header(), .child_frame_id = "base"});
  add("tf", messages::TFMessage{{{.header = header(), .child_frame_id = "base"}}});
  add("path", messages::Path{.header = header(), .poses = {{.header = header()}}});
  add("pose", messages::PoseStamped{.header = header()});
  add("pose_with_covariance", messages::PoseWithCovarianceStamped{.header = header()});
  add("transform", messages::TransformStamped{.header = header()});
  add("cloud", cloud());
  add("grid", messages::OccupancyGrid{.header = header(), .data = {0, 100, -1}});
  add("diagnostics", diagnostics());
  add("string", messages::String{"text"});
  add("header", header());
}

void write_messages(const path& folder) {
  for_each_message([&folder](const std::string& name, const auto& message) {
    using Payload = std::decay_t<decltype(message)>;
    for (const Layout layout : {Layout::kCdr, Layout::kRos1}) {
      const std::string bytes = messages::write_message(message, layout);
      core::write_file(folder / (name + (layout == Layout::kCdr ? "_cdr" : "_ros1")),
                       message_input(Payload::kType, layout, bytes));
    }
  });
}

// Two topics, one message of each.
void write_bag(const path& file, BagFormat format, Compression compression) {
  const auto bag = bags::make_bag(file, format, compression);
  const int images = bag->add_topic<messages::Image>("/image");
  const int names = bag->add_topic<messages::String>("/name", true);
  bag->write_message(images, kStart_ns, image("mono8", 1));
  bag->write_message(names, kStart_ns + 1, messages::String{"text"});
  bag->finish();
}

// Checksums hinder a fuzzer: what it changes is refused before it is read. 0 says that there is
// none. The chunk is the record behind the header.
void forget_checksum(const path& file) {
  std::string whole = core::read_file(file);
  bags::ByteReader rest(std::string_view(whole).substr(bags::mcap::kMagic.size()));
  while (!rest.is_empty()) {
    const auto kind = static_cast<bags::mcap::Kind>(rest.number<std::uint8_t>());
    const std::string_view content = rest.bytes(rest.number<std::uint64_t>());
    if (kind != bags::mcap::Kind::kChunk) continue;
    constexpr std::size_t kPlace = 3 * sizeof(std::uint64_t);  // times and size before it
    whole.replace(static_cast<std::size_t>(content.data() - whole.data()) + kPlace,
                  sizeof(std::uint32_t), sizeof(std::uint32_t), '\0');
    break;
  }
  core::write_file(file, whole);
}

// Without chunks, and without an index.
std::string loose_messages() {
  using bags::mcap::Kind;
  const messages::MessageType& type = messages::type_of<messages::String>();
  bags::ByteWriter schema, channel, message;
  schema.number(std::uint16_t{1}).text(type.ros2_name()).text("ros2msg").text(type.fields);
  channel.number(std::uint16_t{1}).number(std::uint16_t{1}).text("/name").text("cdr");
  channel.number(std::uint32_t{0});
  message.number(std::uint16_t{1}).number(std::uint32_t{0}).number(kStart_ns).number(kStart_ns);
  message.bytes(messages::write_message(messages::String{"text"}, Layout::kCdr));
  return std::string(bags::mcap::kMagic) + bags::mcap::record(Kind::kSchema, schema.view()) +
         bags::mcap::record(Kind::kChannel, channel.view()) +
         bags::mcap::record(Kind::kMessage, message.view()) +
         bags::mcap::record(Kind::kMessage, message.view());
}

void write_bags(const path& folder) {
  struct Seed {
    const char* name;
    BagFormat format;
    Compression compression;
  };
  constexpr Seed kSeeds[] = {{"plain.mcap", BagFormat::kMcap, Compression::kNone},
                             {"lz4.mcap", BagFormat::kMcap, Compression::kLz4},
                             {"zstd.mcap", BagFormat::kMcap, Compression::kZstd},
                             {"plain.db3", BagFormat::kSqlite, Compression::kNone},
                             {"plain.bag", BagFormat::kRos1, Compression::kNone},
                             {"lz4.bag", BagFormat::kRos1, Compression::kLz4},
                             {"bz2.bag", BagFormat::kRos1, Compression::kBz2}};
  for (const Seed& seed : kSeeds) {
    write_bag(folder / seed.name, seed.format, seed.compression);
    if (seed.format == BagFormat::kMcap) forget_checksum(folder / seed.name);
  }
  core::write_file(folder / "loose.mcap", loose_messages());
}

}  // namespace
}  // namespace samewhere::test

int main(int argc, char** argv) {
  return samewhere::core::run_program("fuzz_seeds", [&] {
    if (argc != 2) throw samewhere::core::InputError("expected FOLDER");
    const std::filesystem::path folder = argv[1];
    for (const char* name : {"bag", "message"}) std::filesystem::create_directories(folder / name);
    samewhere::test::write_bags(folder / "bag");
    samewhere::test::write_messages(folder / "message");
    return samewhere::core::kDone;
  });
}
