#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <opencv2/core/mat.hpp>

#include <samewhere/core/truth.hpp>
#include <samewhere/network/trunk.hpp>
#include <samewhere/train/head_config.hpp>

namespace samewhere::train {

// Size of a feature map.
struct MapShape {
  int channels = 0;
  int rows = 0;
  int columns = 0;

  int size() const { return channels * rows * columns; }
  friend bool operator==(const MapShape&, const MapShape&) = default;
};

// The feature maps of one source: a rendered walk, whose places are known, or single images, each
// followed by distorted views of it.
struct HeadSource {
  std::string name;
  MapShape shape;
  std::vector<cv::Mat> maps;                   // one a view: one row of half floats
  int views_per_image = 1;                     // 1: a rendered walk
  int frames_per_view = 1;                     // of a rendered walk
  core::PlaceTruthMatrix places;               // over the views of a rendered walk
  std::vector<core::FramePair> aliased_pairs;  // of its views

  bool is_walk() const { return places.num_frames > 0; }
  int num_views() const { return static_cast<int>(maps.size()); }
};

enum class Relation : std::uint8_t { kIgnored, kSame, kDifferent };

// Of two views of one source. Single images: the same image; ignored if they are at most 10 further
// in the order of the source, where they may show the same; otherwise different.
Relation relation_of(const HeadSource& source, int a, int b);

// Views done, of all.
using HeadProgress = std::function<void(int done, int total)>;

// Reads a recording's or list's images, or renders a walk, and runs the trunk on each view. With a
// folder `cache` the result is written there and read again by the next call with the same source,
// trunk and settings. Images that cannot be read are skipped. Throws InputError as read_images, and
// on a walk that is too long to know its places; Interrupted after Ctrl-C.
HeadSource read_head_source(const std::string& name, network::Trunk& trunk,
                            const HeadConfig& config, const std::filesystem::path& cache,
                            const HeadProgress& on_progress);

}  // namespace samewhere::train
