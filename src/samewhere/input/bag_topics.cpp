#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <string_view>

#include <fmt/format.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/input/bag_topics.hpp>
#include <samewhere/input/message_image.hpp>

namespace samewhere::input {
namespace {

using bags::Topic;
using core::InputError;

constexpr std::string_view kNone = "none";

// A role, and the types that topics of it have.
struct Role {
  std::string_view name;
  int BagTopics::*place;
  std::vector<std::string_view> types;
};

const std::vector<Role>& roles() {
  static const std::vector<std::string_view> images = {"sensor_msgs/Image",
                                                       "sensor_msgs/CompressedImage"};
  static const std::vector<Role> all = {
      {"color", &BagTopics::color, images},
      {"right", &BagTopics::right, images},
      {"depth", &BagTopics::depth, images},
      {"camera_info", &BagTopics::camera_info, {"sensor_msgs/CameraInfo"}},
      {"right_camera_info", &BagTopics::right_camera_info, {"sensor_msgs/CameraInfo"}},
      {"imu", &BagTopics::imu, {"sensor_msgs/Imu"}},
      {"odometry", &BagTopics::odometry, {"nav_msgs/Odometry"}},
      {"truth",
       &BagTopics::truth,
       {"geometry_msgs/PoseStamped", "geometry_msgs/PoseWithCovarianceStamped",
        "geometry_msgs/TransformStamped", "nav_msgs/Odometry", "tf2_msgs/TFMessage",
        "tf/tfMessage"}}};
  return all;
}

bool has_type(const Topic& topic, const std::vector<std::string_view>& types) {
  return std::find(types.begin(), types.end(), topic.type) != types.end();
}

bool is_read(const Topic& topic) { return bags::layout_of(topic).has_value(); }

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

bool has_any(const std::string& name, std::initializer_list<std::string_view> parts) {
  const std::string text = lower(name);
  return std::any_of(parts.begin(), parts.end(), [&text](std::string_view part) {
    return text.find(part) != std::string::npos;
  });
}

// Ground truth is never taken for odometry unless it is named.
bool is_truth_name(const std::string& name) {
  return has_any(name, {"ground_truth", "groundtruth", "ground-truth", "/gt", "vicon", "mocap",
                        "optitrack", "vrpn", "leica"});
}

// Roles with the topics that the user named for them; "none" for those to leave out.
std::map<std::string, std::string> read_wanted(const std::filesystem::path& path,
                                               const std::string& wanted) {
  std::map<std::string, std::string> named;
  std::size_t position = 0;
  while ((position = wanted.find_first_not_of(" ,", position)) != std::string::npos) {
    const std::size_t end = std::min(wanted.find_first_of(" ,", position), wanted.size());
    const std::string entry = wanted.substr(position, end - position);
    const std::size_t sign = entry.find('=');
    std::string role = entry.substr(0, sign);
    if (role == "image" || role == "left" || role == "colour") role = "color";
    const bool is_role = std::any_of(roles().begin(), roles().end(),
                                     [&role](const Role& known) { return known.name == role; });
    if (sign == std::string::npos || !is_role) {
      std::string known;
      for (const Role& each : roles()) known.append(known.empty() ? "" : ", ").append(each.name);
      throw InputError(fmt::format("{}: --topics '{}': expected ROLE=TOPIC with the role one of {}",
                                   path.string(), entry, known));
    }
    named[role] = entry.substr(sign + 1);
    position = end;
  }
  return named;
}

std::string listed(const std::vector<Topic>& topics, const std::vector<int>& positions) {
  std::string text;
  for (const int position : positions)
    text.append(text.empty() ? "" : ", ").append(topics[static_cast<std::size_t>(position)].name);
  return text;
}

std::string topics_with(const std::vector<Topic>& topics,
                        const std::vector<std::string_view>& types) {
  std::string fitting;
  for (const Topic& topic : topics) {
    if (has_type(topic, types)) fitting.append(fitting.empty() ? "" : ", ").append(topic.name);
  }
  return fitting.empty() ? fmt::format("a topic of the type {}", types.front())
                         : "one of " + fitting;
}

// Of topics with one name but several types the one with a type of the role.
int find_named(const std::filesystem::path& path, const std::vector<Topic>& topics,
               const Role& role, const std::string& name) {
  std::string found = "there is no such topic";
  for (std::size_t i = 0; i < topics.size(); ++i) {
    if (topics[i].name != name) continue;
    if (has_type(topics[i], role.types) && is_read(topics[i])) return static_cast<int>(i);
    found = "that topic has " +
            (topics[i].type.empty() ? "no schema" : topics[i].type + ", " + topics[i].encoding);
  }
  throw InputError(fmt::format("{}: --topics {}={}: {}, expected {}", path.string(), role.name,
                               name, found, topics_with(topics, role.types)));
}

// Topics of pictures, parted by what they show.
struct Pictures {
  std::vector<int> color;
  std::vector<int> depth;
};

class Choice {
 public:
  Choice(const std::filesystem::path& path, const std::vector<Topic>& topics,
         const std::vector<std::optional<FirstImage>>& first, const std::string& wanted)
      : path_(path), topics_(topics), first_(first), named_(read_wanted(path, wanted)) {}

  BagTopics choose() {
    for (const Role& role : roles()) {
      const auto named = named_.find(std::string(role.name));
      if (named != named_.end() && named->second != kNone)
        chosen_.*role.place = find_named(path_, topics_, role, named->second);
    }
    choose_pictures();
    chosen_.camera_info = info_of(chosen_.color, chosen_.camera_info, "camera_info");
    chosen_.right_camera_info =
        info_of(chosen_.right, chosen_.right_camera_info, "right_camera_info");
    if (is_open("imu", chosen_.imu)) chosen_.imu = only_of("sensor_msgs/Imu");
    if (is_open("odometry", chosen_.odometry)) chosen_.odometry = only_of("nav_msgs/Odometry");
    if (is_open("truth", chosen_.truth)) chosen_.truth = named_truth();
    return chosen_;
  }

 private:
  const Topic& topic(int position) const { return topics_[static_cast<std::size_t>(position)]; }
  const FirstImage& first_of(int position) const {
    return *first_[static_cast<std::size_t>(position)];
  }
  bool is_open(const char* role, int place) const { return place < 0 && !named_.contains(role); }

  bool is_depth(int position) const {
    const FirstImage& first = first_of(position);
    if (is_compressed_topic(topic(position)))
      return is_depth_format(first.encoding) ||
             (first.encoding.starts_with("16UC1") || first.encoding.starts_with("32FC1"));
    return is_depth_encoding(first.encoding) ||
           (first.encoding == "mono16" && has_any(topic(position).name, {"depth"}));
  }

  // A compressed topic beside the same uncompressed one is left out: it is the same, and less
  // exact.
  bool has_plain_twin(int position) const {
    const std::string& name = topic(position).name;
    const std::size_t end = name.rfind('/');
    if (!is_compressed_topic(topic(position)) || end == std::string::npos) return false;
    for (std::size_t i = 0; i < topics_.size(); ++i) {
      if (topics_[i].name == name.substr(0, end) && first_[i]) return true;
    }
    return false;
  }

  Pictures find_pictures() const {
    Pictures found;
    for (std::size_t i = 0; i < topics_.size(); ++i) {
      const int position = static_cast<int>(i);
      if (!first_[i] || has_plain_twin(position)) continue;
      (is_depth(position) ? found.depth : found.color).push_back(position);
    }
    return found;
  }

  // Those whose names have one of the parts, if there are such; else all.
  std::vector<int> preferred(const std::vector<int>& positions,
                             std::initializer_list<std::string_view> parts) const {
    std::vector<int> found;
    for (const int position : positions) {
      if (has_any(topic(position).name, parts)) found.push_back(position);
    }
    return found.empty() ? positions : found;
  }
  std::vector<int> without(const std::vector<int>& positions,
                           std::initializer_list<std::string_view> parts) const {
    std::vector<int> found;
    for (const int position : positions) {
      if (!has_any(topic(position).name, parts)) found.push_back(position);
    }
    return found.empty() ? positions : found;
  }

  void choose_pictures() {
    const Pictures found = find_pictures();
    if (is_open("color", chosen_.color)) choose_color(found.color);
    if (chosen_.right < 0 && is_open("depth", chosen_.depth)) choose_depth(found.depth);
  }

  void choose_color(std::vector<int> positions) {
    positions = preferred(positions, {"color", "colour", "rgb"});
    if (positions.size() > 1) positions = without(positions, {"_rect", "theora", "thumbnail"});
    if (positions.size() == 1) {
      chosen_.color = positions.front();
    } else if (positions.size() == 2 && is_open("right", chosen_.right) && is_pair(positions)) {
      chosen_.color = positions[0];
      chosen_.right = positions[1];
    } else if (positions.empty()) {
      throw InputError(
          path_.string() +
          ": has no pictures, expected a topic of sensor_msgs/Image or CompressedImage "
          "with messages");
    } else {
      throw InputError(fmt::format(
          "{}: has several topics of pictures: {}; expected one to be chosen: --topics color={}",
          path_.string(), listed(topics_, positions), topic(positions.front()).name));
    }
  }

  // Puts the left one first. Names that differ in left and right, or in a number 0 and 1, 1 and 2.
  bool is_pair(std::vector<int>& positions) const {
    constexpr std::array<std::pair<std::string_view, std::string_view>, 4> kNames = {
        {{"left", "right"}, {"cam0", "cam1"}, {"infra1", "infra2"}, {"cam1", "cam2"}}};
    const std::string first = lower(topic(positions[0]).name);
    const std::string second = lower(topic(positions[1]).name);
    for (const auto& [left, right] : kNames) {
      const std::size_t in_first = first.find(left);
      const std::size_t in_second = second.find(left);
      if (in_first != std::string::npos &&
          std::string(first).replace(in_first, left.size(), right) == second)
        return true;
      if (in_second == std::string::npos ||
          std::string(second).replace(in_second, left.size(), right) != first)
        continue;
      std::swap(positions[0], positions[1]);
      return true;
    }
    return false;
  }

  // Depth has to belong to the pixels of the picture.
  bool is_registered(int depth) const {
    return has_any(topic(depth).name, {"aligned", "registered"}) ||
           first_of(depth).frame_id == first_of(chosen_.color).frame_id;
  }

  void choose_depth(std::vector<int> positions) {
    if (positions.empty() || chosen_.color < 0 || !first_[static_cast<std::size_t>(chosen_.color)])
      return;
    std::vector<int> registered;
    std::copy_if(positions.begin(), positions.end(), std::back_inserter(registered),
                 [this](int position) { return is_registered(position); });
    if (registered.size() > 1) registered = preferred(registered, {"aligned", "registered"});
    if (registered.size() > 1) registered = preferred(registered, {"_raw"});
    if (registered.size() == 1) {
      chosen_.depth = registered.front();
    } else if (registered.empty()) {
      chosen_.notes.push_back(fmt::format(
          "the depth of {} (frame {}) is not that of the pixels of {} (frame {}) and is not used; "
          "--topics depth={} uses it as if it were",
          listed(topics_, positions), first_of(positions.front()).frame_id,
          topic(chosen_.color).name, first_of(chosen_.color).frame_id,
          topic(positions.front()).name));
    } else {
      throw InputError(fmt::format(
          "{}: has several topics of depth: {}; expected one to be chosen: --topics depth={}, or "
          "depth=none",
          path_.string(), listed(topics_, registered), topic(registered.front()).name));
    }
  }

  // By the convention of image_transport: camera_info beside the picture.
  int info_of(int image, int named, const char* role) const {
    if (image < 0 || !is_open(role, named)) return named;
    std::string name = topic(image).name;
    for (int level = 0; level < 2; ++level) {
      name = name.substr(0, name.rfind('/') == std::string::npos ? 0 : name.rfind('/'));
      for (std::size_t i = 0; i < topics_.size(); ++i) {
        const bool is_beside = topics_[i].name == name + "/camera_info";
        if (is_beside && topics_[i].type == "sensor_msgs/CameraInfo" && is_read(topics_[i]) &&
            topics_[i].num_messages > 0)
          return static_cast<int>(i);
      }
      if (!is_compressed_topic(topic(image))) break;
    }
    return -1;
  }

  // -1 where there are several: none is needed.
  int only_of(std::string_view type) const {
    int found = -1;
    for (std::size_t i = 0; i < topics_.size(); ++i) {
      if (topics_[i].type != type || !is_read(topics_[i]) || topics_[i].num_messages == 0 ||
          is_truth_name(topics_[i].name))
        continue;
      if (found >= 0) return -1;
      found = static_cast<int>(i);
    }
    return found;
  }

  int named_truth() const {
    int found = -1;
    for (std::size_t i = 0; i < topics_.size(); ++i) {
      const bool is_pose = has_type(topics_[i], roles().back().types) && is_read(topics_[i]);
      if (!is_pose || topics_[i].num_messages == 0 || !is_truth_name(topics_[i].name)) continue;
      if (found >= 0) return -1;
      found = static_cast<int>(i);
    }
    return found;
  }

  const std::filesystem::path& path_;
  const std::vector<Topic>& topics_;
  const std::vector<std::optional<FirstImage>>& first_;
  std::map<std::string, std::string> named_;
  BagTopics chosen_;
};

}  // namespace

bool is_compressed_topic(const Topic& topic) { return topic.type == "sensor_msgs/CompressedImage"; }

bool is_image_topic(const Topic& topic) {
  return topic.type == "sensor_msgs/Image" || is_compressed_topic(topic);
}

bool is_rectified_name(const std::string& topic) { return has_any(topic, {"image_rect"}); }

BagTopics choose_topics(const std::filesystem::path& path, const std::vector<Topic>& topics,
                        const std::vector<std::optional<FirstImage>>& first,
                        const std::string& wanted) {
  return Choice(path, topics, first, wanted).choose();
}

int choose_odometry(const std::filesystem::path& path, const std::vector<Topic>& topics,
                    const std::string& wanted) {
  const Role& role = *std::find_if(roles().begin(), roles().end(),
                                   [](const Role& known) { return known.name == "odometry"; });
  const auto named = read_wanted(path, wanted);
  if (const auto name = named.find("odometry"); name != named.end())
    return find_named(path, topics, role, name->second);
  std::vector<int> found;
  for (std::size_t i = 0; i < topics.size(); ++i) {
    if (has_type(topics[i], role.types) && is_read(topics[i]) && topics[i].num_messages > 0 &&
        !is_truth_name(topics[i].name))
      found.push_back(static_cast<int>(i));
  }
  if (found.size() == 1) return found.front();
  throw InputError(found.empty()
                       ? path.string() + ": has no odometry, expected a topic of nav_msgs/Odometry"
                       : fmt::format("{}: has several topics of odometry: {}; expected one to be "
                                     "chosen: --topics odometry={}",
                                     path.string(), listed(topics, found),
                                     topics[static_cast<std::size_t>(found.front())].name));
}

}  // namespace samewhere::input
