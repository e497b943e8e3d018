#pragma once

#include <filesystem>
#include <string>
#include <variant>

#include <opencv2/core/mat.hpp>

#include <samewhere/bags/bag.hpp>
#include <samewhere/messages/messages.hpp>

namespace samewhere::input {

// A picture of a recording of messages, not yet decoded.
struct BagPicture {
  double stamp_s = 0.0;
  std::string frame_id;
  std::string name;  // for messages: topic and stamp
  std::variant<messages::Image, messages::CompressedImage> content;

  // Decoded, as image_of and depth_of do (message_image.hpp).
  cv::Mat image() const;
  cv::Mat depth_m(double units_per_m) const;
};

// Its stamp is that of the header, or of the recording where the header has none. Throws InputError
// for bytes that are no such message.
BagPicture read_picture(const std::filesystem::path& file, const bags::Topic& topic,
                        const bags::Message& message);

}  // namespace samewhere::input
