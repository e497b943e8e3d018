#include "readers.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <limits>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

#include <opencv2/core.hpp>
#include <unistd.h>

#include <samewhere/bags/bag.hpp>
#include <samewhere/bags/survey.hpp>
#include <samewhere/core/errors.hpp>
#include <samewhere/input/message_image.hpp>
#include <samewhere/messages/messages.hpp>

namespace samewhere::test {
namespace {

using core::InputError;
using core::require;
using messages::Layout;

constexpr double kUnitsPerMetre = 1000.0;

// Lets InputErrors pass.
template <class Action>
void read_or_refuse(const Action& action) {
  try {
    action();
  } catch (const InputError&) {
    // one line, and the program goes on
  }
}

void require_picture(const cv::Mat& image) {
  require(!image.empty() && (image.type() == CV_8UC1 || image.type() == CV_8UC3),
          "a picture is grey or BGR");
}

void require_depth(const cv::Mat& depth_m) {
  require(depth_m.type() == CV_32FC1, "depth is 32-bit floats");
  require(cv::checkRange(depth_m, true, nullptr, 0.0, std::numeric_limits<double>::infinity()),
          "depth is a distance, or 0");
}

template <class Picture>
void decode_picture(const Picture& message) {
  read_or_refuse([&message] { require_picture(input::image_of(message, "image")); });
  read_or_refuse([&message] { require_depth(input::depth_of(message, "depth", kUnitsPerMetre)); });
}

// What the program makes of a message that was read; nothing of most types.
template <class Payload>
void use(const Payload& /*message*/) {}
void use(const messages::Image& message) { decode_picture(message); }
void use(const messages::CompressedImage& message) { decode_picture(message); }
void use(const messages::CameraInfo& message) {
  for (const bool is_rectified : {false, true}) {
    read_or_refuse([&message, is_rectified] {
      const auto camera = input::camera_of(message, is_rectified, "camera");
      if (camera) input::camera_info_of(*camera);
    });
  }
}

template <class Payload>
void decode(std::string_view bytes, Layout layout) {
  const auto message = messages::read_message<Payload>(bytes, layout);
  const std::string written = messages::write_message(message, layout);
  const auto again = messages::read_message<Payload>(written, layout);
  require(messages::write_message(again, layout) == written, "a message is read as it was written");
  use(message);
}

struct Decoder {
  std::string_view type;
  void (*decode)(std::string_view bytes, Layout layout);
};

template <class... Payloads>
constexpr std::array<Decoder, sizeof...(Payloads)> decoders_of() {
  return {Decoder{Payloads::kType, &decode<Payloads>}...};
}

constexpr auto kDecoders =
    decoders_of<messages::Image, messages::CompressedImage, messages::CameraInfo, messages::Imu,
                messages::Odometry, messages::TFMessage, messages::Path, messages::PoseStamped,
                messages::PoseWithCovarianceStamped, messages::TransformStamped,
                messages::PointCloud2, messages::OccupancyGrid, messages::DiagnosticArray,
                messages::String, messages::Header>();
constexpr std::array kLayouts = {Layout::kCdr, Layout::kRos1};

// Position in kDecoders; the number of them: not known.
std::size_t decoder_of(std::string_view type) {
  const auto found = std::find_if(kDecoders.begin(), kDecoders.end(),
                                  [type](const Decoder& decoder) { return decoder.type == type; });
  return static_cast<std::size_t>(found - kDecoders.begin());
}

// A file in a folder of its own, since SQLite may put others beside it. TMPDIR chooses where.
class TemporaryFile {
 public:
  explicit TemporaryFile(std::string_view bytes)
      : folder_(std::filesystem::temp_directory_path() /
                ("samewhere_fuzz_" + std::to_string(getpid()))) {
    std::filesystem::create_directories(folder_);
    std::ofstream(path(), std::ios::binary) << bytes;
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile() { std::filesystem::remove_all(folder_); }

  std::filesystem::path path() const { return folder_ / "recording"; }

 private:
  std::filesystem::path folder_;
};

void read_all(bags::BagReader& bag) {
  read_or_refuse([&bag] { bags::survey(bag); });  // a damaged one is read up to there
  bags::rosbag2_metadata(bag, "recording");
  std::vector<int> topics(bag.topics().size());
  std::iota(topics.begin(), topics.end(), 0);
  bag.start(topics);
  while (const auto message = bag.next()) {
    const bags::Topic& topic = bag.topics().at(static_cast<std::size_t>(message->topic));
    const std::size_t decoder = decoder_of(topic.type);
    const auto layout = bags::layout_of(topic);
    if (decoder == kDecoders.size() || !layout) continue;
    read_or_refuse([&] { kDecoders[decoder].decode(message->bytes, *layout); });
  }
}

}  // namespace

void read_as_bag(std::string_view bytes) {
  const TemporaryFile file(bytes);
  try {
    read_all(*bags::open_bag(file.path()));
  } catch (const InputError& error) {
    require(std::string_view(error.what()).starts_with(file.path().string()),
            "an error begins with the path");
  }
}

void read_as_message(std::string_view bytes) {
  if (bytes.empty()) return;
  const auto choice = static_cast<unsigned char>(bytes.front());
  const Decoder& decoder = kDecoders[choice / kLayouts.size() % kDecoders.size()];
  const Layout layout = kLayouts[choice % kLayouts.size()];
  read_or_refuse([&] { decoder.decode(bytes.substr(1), layout); });
}

std::string message_input(std::string_view type, Layout layout, std::string_view bytes) {
  const std::size_t decoder = decoder_of(type);
  require(decoder < kDecoders.size(), "the type of a message is known");
  const std::size_t choice = decoder * kLayouts.size() + (layout == kLayouts[0] ? 0 : 1);
  return std::string(1, static_cast<char>(choice)).append(bytes);
}

}  // namespace samewhere::test
