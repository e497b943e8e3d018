#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <variant>

#include <samewhere/messages/messages.hpp>

namespace samewhere::node {

// An image as it came; it is decoded when it is used.
struct Picture {
  double stamp_s = 0.0;
  std::string frame_id;
  std::variant<messages::Image, messages::CompressedImage> message;
};

// The images of one moment: camera 0, and depth or the right camera.
struct FrameSet {
  Picture first;
  std::optional<Picture> second;
};

// Pairs two streams of images by their stamps: an image of the first stream and the nearest of the
// second, if they differ by the tolerance at most. Images of one stream come in the order of their
// stamps; one that does not is dropped, unless time went back by more than a second: then the
// streams begin again. Holds so many images per stream; above, the oldest is dropped.
class Pairing {
 public:
  Pairing(bool has_second, double tolerance_s, std::size_t capacity);

  void add_first(Picture picture);
  void add_second(Picture picture);
  // The oldest that is complete.
  std::optional<FrameSet> next();

  // Images that were not given out: late, too many, or without a partner.
  std::uint64_t num_dropped() const { return num_dropped_; }

 private:
  struct Stream {
    std::deque<Picture> waiting;
    std::optional<double> newest_s;
  };

  void add(Stream& stream, Picture picture);
  void drop_oldest(Stream& stream);
  // Position in the second stream of the nearest within the tolerance.
  std::optional<std::size_t> partner_of(const Picture& picture) const;

  bool has_second_;
  double tolerance_s_;
  std::size_t capacity_;
  Stream first_;
  Stream second_;
  std::uint64_t num_dropped_ = 0;
};

}  // namespace samewhere::node
