#include <algorithm>
#include <map>
#include <utility>

#include <samewhere/bags/readers.hpp>
#include <samewhere/core/errors.hpp>

namespace samewhere::bags {
namespace {

class SplitReader : public BagReader {
 public:
  explicit SplitReader(std::vector<std::unique_ptr<BagReader>> parts) : parts_(std::move(parts)) {
    core::require(!parts_.empty(), "a split recording has a part");
    info_ = parts_.front()->info();
    info_.num_messages = 0;
    for (const auto& part : parts_) {
      add(part->info());
      for (const Topic& topic : part->topics()) add(topic);
    }
    std::sort(topics_.begin(), topics_.end(), [](const Topic& a, const Topic& b) {
      return std::pair(a.name, a.type) < std::pair(b.name, b.type);
    });
  }

  const BagInfo& info() const override { return info_; }
  const std::vector<Topic>& topics() const override { return topics_; }

  void start(const std::vector<int>& topics) override {
    selected_ = topics;
    part_ = 0;
    start_part();
  }

  std::optional<Message> next() override {
    while (part_ < parts_.size()) {
      if (auto message = parts_[part_]->next()) {
        message->topic = topic_of_part_[static_cast<std::size_t>(message->topic)];
        return message;
      }
      ++part_;
      start_part();
    }
    return std::nullopt;
  }

 private:
  int position_of(const Topic& topic) const {
    const auto same = std::find_if(topics_.begin(), topics_.end(), [&topic](const Topic& known) {
      return known.name == topic.name && known.type == topic.type &&
             known.encoding == topic.encoding;
    });
    return static_cast<int>(same - topics_.begin());
  }

  void add(const Topic& topic) {
    const auto position = static_cast<std::size_t>(position_of(topic));
    if (position == topics_.size()) {
      topics_.push_back(topic);
    } else {
      topics_[position].num_messages += topic.num_messages;
    }
  }

  void add(const BagInfo& part) {
    if (part.num_messages == 0) return;
    info_.first_ns =
        info_.num_messages == 0 ? part.first_ns : std::min(info_.first_ns, part.first_ns);
    info_.last_ns = info_.num_messages == 0 ? part.last_ns : std::max(info_.last_ns, part.last_ns);
    info_.num_messages += part.num_messages;
    info_.is_closed = info_.is_closed && part.is_closed;
    if (info_.damage.empty()) info_.damage = part.damage;
  }

  void start_part() {
    if (part_ == parts_.size()) return;
    const std::vector<Topic>& topics = parts_[part_]->topics();
    topic_of_part_.clear();
    std::vector<int> selected;
    for (std::size_t i = 0; i < topics.size(); ++i) {
      topic_of_part_.push_back(position_of(topics[i]));
      const bool is_selected =
          std::find(selected_.begin(), selected_.end(), topic_of_part_.back()) != selected_.end();
      if (is_selected) selected.push_back(static_cast<int>(i));
    }
    parts_[part_]->start(selected);
  }

  std::vector<std::unique_ptr<BagReader>> parts_;
  BagInfo info_;
  std::vector<Topic> topics_;
  std::vector<int> selected_;
  std::size_t part_ = 0;
  std::vector<int> topic_of_part_;  // of the part that is read
};

}  // namespace

std::unique_ptr<BagReader> open_split_bag(std::vector<std::unique_ptr<BagReader>> parts) {
  if (parts.size() == 1) return std::move(parts.front());
  return std::make_unique<SplitReader>(std::move(parts));
}

}  // namespace samewhere::bags
