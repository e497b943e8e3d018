#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <samewhere/core/descriptor.hpp>
#include <samewhere/core/verdict.hpp>
#include <samewhere/retrieve/config.hpp>
#include <samewhere/retrieve/segmented_store.hpp>

namespace samewhere::retrieve {

// Which earlier views look like this one? By appearance alone.
class Retriever {
 public:
  // config.window_frames says the window: whoever knows the frame rate has resolved window_s into
  // it. Throws InputError on settings that do not fit each other.
  Retriever(const Config& config, std::uint64_t seed);

  // Remembers a view. Frames ascend strictly. Throws ContractError on any other order, and on a
  // descriptor of another describer or length, or one that is neither of unit length nor zero.
  void add(const core::Descriptor& descriptor);

  // The best candidates, most similar first, of equals the older first; never one that is
  // config.window_frames old or younger. similarity is the NCC, eq. (8)-(13); ids are left invalid,
  // the ledger gives them. Exact search knows no threshold: what is alike enough, verification
  // decides. Sampled search may find nothing; its draws depend on seed and query frame only.
  // The query need not have been added. Throws ContractError as add().
  std::vector<core::Candidate> query(const core::Descriptor& descriptor) const;

  int num_views() const { return store_.num_vectors(); }

 private:
  void check(const core::Descriptor& descriptor) const;
  std::vector<float> comparable(const core::Descriptor& descriptor) const;

  Config config_;
  std::uint64_t seed_;
  std::optional<std::uint64_t> describer_checksum_;  // of the first view
  SegmentedStore store_;                             // of comparable() vectors
};

}  // namespace samewhere::retrieve
