#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/median.hpp>
#include <samewhere/input/bag_message.hpp>
#include <samewhere/input/bag_opening.hpp>
#include <samewhere/input/bag_picture.hpp>
#include <samewhere/input/bag_poses.hpp>

namespace samewhere::input {
namespace {

using bags::Message;
using bags::Topic;
using std::filesystem::path;

// Of so many pictures the rate is measured.
constexpr std::size_t kNumForRate = 100;

bool tells_of_cameras(const Topic& topic) {
  const bool is_told = is_image_topic(topic) || topic.type == messages::CameraInfo::kType;
  return is_told && topic.num_messages > 0 && bags::layout_of(topic);
}

FirstImage read_first_image(const path& file, const Topic& topic, const Message& message) {
  if (is_compressed_topic(topic)) {
    const auto image = read_payload<messages::CompressedImage>(file, topic, message);
    return {image.format, image.header.frame_id};
  }
  const auto image = read_payload<messages::Image>(file, topic, message);
  return {image.encoding, image.header.frame_id};
}

void read_first_messages(const path& file, bags::BagReader& bag, BagOpening& opening) {
  const std::vector<Topic>& topics = bag.topics();
  opening.first_images.resize(topics.size());
  std::vector<int> wanted;
  for (std::size_t i = 0; i < topics.size(); ++i)
    if (tells_of_cameras(topics[i])) wanted.push_back(static_cast<int>(i));
  bag.start(wanted);
  std::size_t num_missing = wanted.size();
  while (num_missing > 0) {
    const auto message = bag.next();
    if (!message) break;
    const auto position = static_cast<std::size_t>(message->topic);
    const Topic& topic = topics[position];
    if (opening.first_images[position] || opening.infos.contains(message->topic)) continue;
    --num_missing;
    if (is_image_topic(topic)) {
      opening.first_images[position] = read_first_image(file, topic, *message);
    } else {
      opening.infos[message->topic] = read_payload<messages::CameraInfo>(file, topic, *message);
    }
  }
}

// Sizes belong to cameras, and the rate to what is counted in frames.
void look_at_first_pictures(const path& file, bags::BagReader& bag, BagOpening& opening) {
  std::vector<int> wanted = {opening.topics.color};
  if (opening.topics.right >= 0) wanted.push_back(opening.topics.right);
  std::vector<double> steps_s;
  std::optional<double> before_s;
  bag.start(wanted);
  while (steps_s.size() < kNumForRate || opening.pictures.size() < wanted.size()) {
    const auto message = bag.next();
    if (!message) break;
    const BagPicture picture =
        read_picture(file, bag.topics()[static_cast<std::size_t>(message->topic)], *message);
    if (!opening.pictures.contains(message->topic))
      opening.pictures[message->topic] = {picture.name, picture.image().size()};
    if (message->topic != opening.topics.color) continue;
    if (before_s && picture.stamp_s > *before_s) steps_s.push_back(picture.stamp_s - *before_s);
    before_s = picture.stamp_s;
  }
  if (const auto step_s = core::median(std::move(steps_s))) opening.frame_rate_hz = 1.0 / *step_s;
}

}  // namespace

BagOpening read_opening(const path& file, bags::BagReader& bag, const Config& config) {
  BagOpening opening;
  opening.transforms = read_transforms(bag, false);
  read_first_messages(file, bag, opening);
  opening.topics = choose_topics(file, bag.topics(), opening.first_images, config.topics);
  if (!config.depth) opening.topics.depth = -1;
  for (const std::string& note : opening.topics.notes) spdlog::warn("{}: {}", file.string(), note);
  const auto color = static_cast<std::size_t>(opening.topics.color);
  // named by the user where it has none in the opening: it has no messages
  if (!opening.first_images[color]) {
    throw core::InputError(
        fmt::format("{}: {} has no messages", file.string(), bag.topics()[color].name));
  }
  look_at_first_pictures(file, bag, opening);
  return opening;
}

}  // namespace samewhere::input
