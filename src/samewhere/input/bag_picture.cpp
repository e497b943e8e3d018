#include <utility>

#include <fmt/format.h>

#include <samewhere/input/bag_message.hpp>
#include <samewhere/input/bag_picture.hpp>
#include <samewhere/input/bag_topics.hpp>
#include <samewhere/input/message_image.hpp>

namespace samewhere::input {
namespace {

template <class Payload>
BagPicture picture_from(Payload payload, const bags::Topic& topic, std::int64_t log_time_ns) {
  const messages::Time zero;
  const messages::Time stamp = payload.header.stamp == zero
                                   ? messages::time_of_nanoseconds(log_time_ns)
                                   : payload.header.stamp;
  BagPicture picture{.stamp_s = messages::seconds(stamp), .frame_id = payload.header.frame_id};
  picture.name = fmt::format("{} {}.{:09}", topic.name, stamp.sec, stamp.nanosec);
  picture.content = std::move(payload);
  return picture;
}

}  // namespace

cv::Mat BagPicture::image() const {
  return std::visit([this](const auto& message) { return image_of(message, name); }, content);
}

cv::Mat BagPicture::depth_m(double units_per_m) const {
  return std::visit(
      [this, units_per_m](const auto& message) { return depth_of(message, name, units_per_m); },
      content);
}

BagPicture read_picture(const std::filesystem::path& file, const bags::Topic& topic,
                        const bags::Message& message) {
  if (is_compressed_topic(topic))
    return picture_from(read_payload<messages::CompressedImage>(file, topic, message), topic,
                        message.log_time_ns);
  return picture_from(read_payload<messages::Image>(file, topic, message), topic,
                      message.log_time_ns);
}

}  // namespace samewhere::input
