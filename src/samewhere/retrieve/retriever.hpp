#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <samewhere/core/descriptor.hpp>
#include <samewhere/core/verdict.hpp>
#include <samewhere/retrieve/config.hpp>
#include <samewhere/retrieve/search.hpp>
#include <samewhere/retrieve/segmented_store.hpp>
#include <samewhere/retrieve/word_index.hpp>

namespace samewhere::retrieve {

// A stored view that the search found, with the data for the exact similarity: a value, independent
// of later changes of the store.
struct FoundView {
  core::FrameId frame;
  std::vector<float> unit;
  core::Origin origin = core::Origin::kRetrieved;  // or kVisualWords
};

// Exact similarity of the views found: candidates with their NCC, eq. (8)-(13), most similar first,
// of equals the older first; ids are left invalid, the ledger assigns them. Throws ContractError if
// the vectors differ in length.
std::vector<core::Candidate> compare(const core::Descriptor& query,
                                     const std::vector<FoundView>& found);

// Place recognition by appearance: retrieves similar earlier views.
class Retriever {
 public:
  // config.window_frames is the window: the caller has converted window_s by the frame rate. Throws
  // InputError on settings that do not fit each other.
  Retriever(const Config& config, std::uint64_t seed);

  // Adds a view with its image descriptor and its ORB descriptors, one per row (none: the view is
  // never found by visual words). Frames ascend strictly. Throws ContractError on any other order,
  // and on a descriptor of another describer or length, or one that is neither of unit length nor
  // zero.
  void add(const core::Descriptor& descriptor, const cv::Mat& features = {});

  // All views, as if none had been added. Later frames are still later than theirs.
  void forget();

  // At most config.num_candidates views by image descriptor, and behind them at most
  // config.word_candidates others by visual words, none within the window. Exact search has no
  // threshold; verification decides. The other searches may find nothing; their draws depend on
  // seed and query frame only. The query need not have been added. Throws ContractError as add().
  std::vector<FoundView> search(const core::Descriptor& descriptor,
                                const cv::Mat& features = {}) const;
  // For relocalization: no window, since the camera may be where it was a moment ago;
  // relocalization_candidates of either kind, of different places by
  // relocalization_place_frames.
  std::vector<FoundView> search_places(const core::Descriptor& descriptor,
                                       const cv::Mat& features = {}) const;
  // For a map that groups views by common landmarks: so many more of either kind that search()
  // retrieves, config.shortlist at most.
  std::vector<FoundView> shortlist(const core::Descriptor& descriptor,
                                   const cv::Mat& features = {}) const;

  int num_views() const { return store_.num_vectors(); }
  // As it was added; position 0 is the oldest.
  core::Descriptor view(int position) const;

 private:
  void check(const core::Descriptor& descriptor) const;
  std::vector<ScoredPosition> scored(const core::Descriptor& descriptor, int num_allowed) const;
  std::vector<FoundView> found_by(const core::Descriptor& descriptor, const cv::Mat& features,
                                  int num_allowed, const Config& config) const;
  FoundView view_at(int position) const;

  Config config_;
  std::uint64_t seed_;
  std::optional<std::uint64_t> describer_checksum_;  // of the first view
  SegmentedStore store_;
  std::optional<WordIndex> words_;  // of the same views
};

}  // namespace samewhere::retrieve
