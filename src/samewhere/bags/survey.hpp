#pragma once

#include <cstdint>
#include <vector>

#include <samewhere/bags/bag.hpp>

namespace samewhere::bags {

// When the messages of a topic were recorded.
struct TopicTimes {
  std::uint64_t num_messages = 0;
  std::int64_t first_ns = 0;
  std::int64_t last_ns = 0;
  std::int64_t longest_gap_ns = 0;  // between one message and the next
  std::int64_t gap_from_ns = 0;     // when it began
};

// Reads the recording once; an entry for each topic. A recording that is damaged is read up to
// there.
std::vector<TopicTimes> survey(BagReader& bag);

}  // namespace samewhere::bags
