#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <samewhere/bags/bag.hpp>

namespace samewhere::input {

// The topics of a recording that a run reads; positions in BagReader::topics(), -1: none.
struct BagTopics {
  int color = -1;  // or the left camera, or grey
  int right = -1;
  int depth = -1;
  int camera_info = -1;        // of `color`
  int right_camera_info = -1;  // of `right`
  int imu = -1;
  int odometry = -1;
  int truth = -1;                       // ground truth: poses, odometry or /tf
  std::vector<std::string> notes = {};  // what a user may want to know of the choice
};

// What the first picture of a topic says of it.
struct FirstImage {
  std::string encoding;  // of an Image; the format of a CompressedImage
  std::string frame_id;
};

// Chooses by types, names and first pictures where there is one answer. `wanted` names topics by
// their roles: "color=/a depth=/b camera_info=/c right=/d right_camera_info=/e imu=/f odometry=/g
// truth=/h"; `depth=none` leaves a role out. Throws InputError, which begins with the path: a topic
// that is not there or has another type, a role that is none, or several answers, which it lists.
// `first` has an entry for each topic, nothing where it has no pictures.
BagTopics choose_topics(const std::filesystem::path& path, const std::vector<bags::Topic>& topics,
                        const std::vector<std::optional<FirstImage>>& first,
                        const std::string& wanted);
// The same of odometry alone.
int choose_odometry(const std::filesystem::path& path, const std::vector<bags::Topic>& topics,
                    const std::string& wanted);

bool is_image_topic(const bags::Topic& topic);       // Image or CompressedImage
bool is_compressed_topic(const bags::Topic& topic);  // CompressedImage

// Whether the pictures of a topic are rectified, by its name: image_rect, image_rect_color, ...
bool is_rectified_name(const std::string& topic);

}  // namespace samewhere::input
