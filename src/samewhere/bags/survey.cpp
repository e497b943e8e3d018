#include <numeric>

#include <samewhere/bags/survey.hpp>
#include <samewhere/core/interrupt.hpp>

namespace samewhere::bags {

std::vector<TopicTimes> survey(BagReader& bag) {
  std::vector<TopicTimes> times(bag.topics().size());
  std::vector<int> all(times.size());
  std::iota(all.begin(), all.end(), 0);
  bag.start(all);
  while (const auto message = bag.next()) {
    core::stop_if_interrupted();
    TopicTimes& topic = times[static_cast<std::size_t>(message->topic)];
    if (topic.num_messages == 0) {
      topic.first_ns = message->log_time_ns;
    } else if (message->log_time_ns - topic.last_ns > topic.longest_gap_ns) {
      topic.longest_gap_ns = message->log_time_ns - topic.last_ns;
      topic.gap_from_ns = topic.last_ns;
    }
    topic.last_ns = message->log_time_ns;
    ++topic.num_messages;
  }
  return times;
}

}  // namespace samewhere::bags
