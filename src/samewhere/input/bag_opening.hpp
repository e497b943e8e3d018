#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <opencv2/core/types.hpp>

#include <samewhere/bags/bag.hpp>
#include <samewhere/input/bag_topics.hpp>
#include <samewhere/input/config.hpp>
#include <samewhere/input/transforms.hpp>

namespace samewhere::input {

struct FirstPicture {
  std::string name;
  cv::Size size_px;
};

// What a recording of messages says before its first frame.
struct BagOpening {
  BagTopics topics;
  std::vector<std::optional<FirstImage>> first_images;  // of each topic of the recording
  std::map<int, messages::CameraInfo> infos;            // by their topics, the first of each
  std::map<int, FirstPicture> pictures;                 // of topics.color and topics.right
  Transforms transforms;                                // of /tf_static
  double frame_rate_hz = 0.0;                           // 0: there are fewer than two pictures

  const FirstImage& first_image(int topic) const {
    return *first_images[static_cast<std::size_t>(topic)];
  }
};

// Reads until every topic of pictures and of calibrations has shown its first message, chooses the
// topics, and looks at so many pictures of them as the frame rate needs. Warns of the choice where
// it has notes. Throws InputError as choose_topics does, for a topic without messages, and for a
// message or picture that cannot be read.
BagOpening read_opening(const std::filesystem::path& file, bags::BagReader& bag,
                        const Config& config);

}  // namespace samewhere::input
