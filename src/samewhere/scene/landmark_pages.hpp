#pragma once

#include <memory>
#include <vector>

#include <samewhere/core/paged_memory.hpp>
#include <samewhere/scene/map_version.hpp>

namespace samewhere::scene {

// Pages landmarks that were not changed for a while to a temporary file. Reading one loads its page
// until the next round; changing one takes its chunk out of the file until it is unchanged for a
// round again. For the owner of a map, in its thread.
class LandmarkPages {
 public:
  // One of `num_steps` steps (0: one) of a round through all landmarks. A chunk unchanged since the
  // round before goes to the file; without room there it stays in memory. The map stays equal.
  void step(ChunkedVector<Landmark>& landmarks, std::size_t num_steps);

 private:
  using Chunk = ChunkedVector<Landmark>::Chunk;
  // A second owner: a change of an element copies the chunk, which shows the change.
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
