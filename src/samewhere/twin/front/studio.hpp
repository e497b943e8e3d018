#pragma once

#include <deque>
#include <vector>

#include <samewhere/twin/front/walkthrough.hpp>
#include <samewhere/twin/render/exposure.hpp>
#include <samewhere/twin/render/picture_cache.hpp>
#include <samewhere/twin/render/renderer.hpp>

namespace samewhere::twin {

// How many threads the settings ask for, at least 1.
int num_threads(const Config& config);

// Takes the pictures of a walk.
class Studio {
 public:
  // The walk must outlive it. Computes the light of each visit: some seconds for a large building.
  Studio(const Walkthrough& walk, const Config& config);

  // Of the same frame always the same. Any number of threads may ask at once.
  Pictures pictures(int index) const;

 private:
  const Renderer& renderer_of(int visit) const {
    return renderers_[static_cast<std::size_t>(visit)];
  }
  View view(int index, int camera) const;
  cv::Mat picture(const View& view, int index, int camera) const;
  std::vector<float> mean_radiances() const;

  const Walkthrough& walk_;
  bool has_ideal_depth_;
  std::deque<Renderer> renderers_;   // one per visit
  std::vector<Exposure> exposures_;  // one per frame
};

}  // namespace samewhere::twin
