#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <opencv2/core/mat.hpp>

#include <samewhere/core/descriptor.hpp>
#include <samewhere/core/verdict.hpp>
#include <samewhere/describe/describer.hpp>
#include <samewhere/features/features.hpp>
#include <samewhere/pipeline/config.hpp>
#include <samewhere/retrieve/retriever.hpp>
#include <samewhere/verify/map_context.hpp>

namespace samewhere::pipeline {

// Global descriptors and visual words of the views so far: describe, retrieve, remember. Frames
// ascend. describe() shares no state with the others, so that it can run in a thread of its own.
class PlaceIndex {
 public:
  explicit PlaceIndex(const Config& config);

  core::Descriptor describe(core::FrameId frame, const cv::Mat& image) const;
  void remember(const core::Descriptor& descriptor, const features::View& view);

  void forget() { retriever_.forget(); }  // all views

  // The views to compare for recognition alone, at most retrieve.num_candidates and
  // retrieve.word_candidates outside the exclusion window; then the view is remembered.
  std::vector<retrieve::FoundView> search(const core::Descriptor& descriptor,
                                          const features::View& view);

  // The loop candidates of a keyframe, most similar first; then it is remembered. Connected
  // keyframes are none; where the map knows places, each gives its best views only.
  std::vector<core::Candidate> retrieve(const core::Descriptor& descriptor,
                                        const features::View& view, const verify::MapContext& map);

  // The candidates for relocalization: of all places, without exclusion window.
  std::vector<core::Candidate> retrieve_places(const core::Descriptor& descriptor,
                                               const features::View& view) const;

  // The model file of the describer.
  std::uint64_t describer_checksum() const { return describer_->checksum(); }
  // Of the remembered views, oldest first.
  int num_descriptors() const { return retriever_.num_views(); }
  core::Descriptor descriptor(int position) const { return retriever_.view(position); }

 private:
  std::unique_ptr<describe::Describer> describer_;
  retrieve::Config config_;
  retrieve::Retriever retriever_;
};

}  // namespace samewhere::pipeline
