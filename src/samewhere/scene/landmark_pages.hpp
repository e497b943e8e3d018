#pragma once

#include <memory>
#include <vector>

#include <samewhere/core/paged_memory.hpp>
#include <samewhere/scene/map_version.hpp>

namespace samewhere::scene {

// Landmarks that nobody has changed for a while leave memory for a file without a name. Whoever
// reads one brings its page back until the next round; whoever changes one takes it, and those of
// its chunk, out of the file until they rest again. For the owner of a map, in its thread.
class LandmarkPages {
 public:
  // Goes on with a round through all landmarks that takes `num_steps` such steps (0: one). A chunk
  // that is as it was in the round before goes to the file; where there is no room it stays. The
  // map is equal to what it was.
  void step(ChunkedVector<Landmark>& landmarks, std::size_t num_steps);

 private:
  using Chunk = ChunkedVector<Landmark>::Chunk;
  // Held here, too: so whoever changes an element changes a copy, and it shows.
  struct Seen {
    std::shared_ptr<const Chunk> chunk;
    std::shared_ptr<const core::PagedBlock> pages;  // none: in memory
  };

  void visit(ChunkedVector<Landmark>& landmarks, std::size_t k);

  core::PagedMemory memory_;
  std::vector<Seen> seen_;  // per chunk, in the last round
  std::size_t next_ = 0;
  std::size_t due_ = 0;  // chunks, times the steps of a round
};

}  // namespace samewhere::scene
