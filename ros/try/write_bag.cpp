// samewhere-write-bag SOURCE OUT [FRAMES]: frames of a recording, or of a rendered building, as a
// bag of images, camera info and depth: OUT.mcap, with the messages of ROS 2, or OUT.bag, with
// those of ROS 1. SOURCE may be such a bag, too.

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <samewhere/bags/bag.hpp>
#include <samewhere/core/errors.hpp>
#include <samewhere/core/program.hpp>
#include <samewhere/core/terminal.hpp>
#include <samewhere/recording.hpp>

namespace samewhere {
namespace {

constexpr const char* kFrameName = "camera_optical";

messages::Image message_of(const Image& image, const messages::Header& header) {
  const bool is_depth = image.format == PixelFormat::kDepthFloat;
  const bool is_grey = image.format == PixelFormat::kGray8;
  const std::size_t pixel_bytes = is_depth ? 4 : is_grey ? 1 : 3;
  const std::size_t row_bytes = pixel_bytes * static_cast<std::size_t>(image.width_px);
  const std::size_t stride = image.stride_bytes > 0 ? image.stride_bytes : row_bytes;
  messages::Image message{.header = header,
                          .height = static_cast<std::uint32_t>(image.height_px),
                          .width = static_cast<std::uint32_t>(image.width_px),
                          .encoding = is_depth  ? "32FC1"
                                      : is_grey ? "mono8"
                                                : "bgr8",
                          .step = static_cast<std::uint32_t>(row_bytes)};
  message.data.resize(row_bytes * message.height);
  for (std::size_t y = 0; y < message.height; ++y) {
    std::memcpy(message.data.data() + y * row_bytes,
                static_cast<const char*>(image.data) + y * stride, row_bytes);
  }
  return message;
}

messages::CameraInfo message_of(const Camera& camera, const messages::Header& header) {
  messages::CameraInfo info{
      .header = header,
      .height = static_cast<std::uint32_t>(camera.height_px),
      .width = static_cast<std::uint32_t>(camera.width_px),
      .distortion_model = camera.lens == Lens::kFisheye ? "equidistant" : "rational_polynomial",
      .d = camera.distortion,
      .k = {camera.fx_px, 0, camera.cx_px, 0, camera.fy_px, camera.cy_px, 0, 0, 1}};
  if (camera.lens != Lens::kFisheye) info.d.resize(8);
  return info;
}

std::unique_ptr<bags::BagWriter> bag_for(const std::filesystem::path& out) {
  const bool is_ros1 = out.extension() == ".bag";
  return bags::make_bag(out, is_ros1 ? bags::BagFormat::kRos1 : bags::BagFormat::kMcap,
                        bags::Compression::kNone);
}

template <class M>
void copy_message(bags::BagWriter& bag, const bags::Message& message, messages::Layout layout) {
  bag.write_message(message.topic, message.log_time_ns,
                    messages::read_message<M>(message.bytes, layout));
}

int convert(const std::string& source, const std::filesystem::path& out) {
  const auto bag = bags::open_bag(source);
  const auto copy = bag_for(out);
  std::vector<int> topics;
  for (const bags::Topic& topic : bag->topics()) {
    topics.push_back(static_cast<int>(topics.size()));
    copy->add_topic(topic.name, *messages::find_message_type(topic.type), false);
  }
  bag->start(topics);
  while (const auto message = bag->next()) {
    const bags::Topic& topic = bag->topics()[static_cast<std::size_t>(message->topic)];
    const messages::Layout layout = *bags::layout_of(topic);
    if (topic.type == messages::Image::kType)
      copy_message<messages::Image>(*copy, *message, layout);
    if (topic.type == messages::CameraInfo::kType)
      copy_message<messages::CameraInfo>(*copy, *message, layout);
  }
  copy->finish();
  return core::kDone;
}

int write(const std::string& source, const std::filesystem::path& out, int num_frames) {
  if (bags::is_bag(source)) return convert(source, out);
  Recording recording(source);
  const Calibration calibration = recording.calibration();
  const auto bag = bag_for(out);
  const int image = bag->add_topic<messages::Image>("/camera/image");
  const int info = bag->add_topic<messages::CameraInfo>("/camera/camera_info");
  const int depth = bag->add_topic<messages::Image>("/camera/depth");
  int num_written = 0;
  while (num_written < num_frames) {
    const std::optional<Frame> frame = recording.next();
    if (!frame) break;
    const messages::Header header{messages::time_of(frame->stamp_s), kFrameName};
    const std::int64_t time_ns = messages::nanoseconds(header.stamp);
    bag->write_message(info, time_ns, message_of(calibration.cameras[0], header));
    bag->write_message(image, time_ns, message_of(frame->images[0], header));
    if (frame->depth) bag->write_message(depth, time_ns, message_of(*frame->depth, header));
    ++num_written;
  }
  bag->finish();
  core::print("{}: {} frames\n", out.string(), num_written);
  return core::kDone;
}

}  // namespace
}  // namespace samewhere

int main(int argc, char** argv) {
  using namespace samewhere;
  return core::run_program("samewhere-write-bag", [&] {
    if (argc < 3) throw core::InputError("expected SOURCE OUT [FRAMES]");
    return write(argv[1], argv[2], argc > 3 ? std::atoi(argv[3]) : 1000000);
  });
}
