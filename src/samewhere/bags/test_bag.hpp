#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <unistd.h>

#include <samewhere/bags/bag.hpp>

namespace samewhere::bags {

// An empty folder for one test, removed after it. For tests only.
class BagFolder {
 public:
  BagFolder() {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    root_ = std::filesystem::path(testing::TempDir()) /
            (std::string("samewhere_bags_") + test->name() + "_" + std::to_string(getpid()));
    std::filesystem::remove_all(root_);
    std::filesystem::create_directories(root_);
  }
  BagFolder(const BagFolder&) = delete;
  BagFolder& operator=(const BagFolder&) = delete;
  ~BagFolder() { std::filesystem::remove_all(root_); }
  std::filesystem::path at(const std::string& name) const { return root_ / name; }

 private:
  std::filesystem::path root_;
};

struct BagKind {
  BagFormat format = BagFormat::kMcap;
  Compression compression = Compression::kNone;
};

inline const std::vector<BagKind>& all_bag_kinds() {
  static const std::vector<BagKind> kinds = {
      {BagFormat::kMcap, Compression::kNone}, {BagFormat::kMcap, Compression::kLz4},
      {BagFormat::kMcap, Compression::kZstd}, {BagFormat::kSqlite, Compression::kNone},
      {BagFormat::kRos1, Compression::kNone}, {BagFormat::kRos1, Compression::kLz4},
      {BagFormat::kRos1, Compression::kBz2}};
  return kinds;
}

struct ReadMessage {
  std::string topic;
  std::int64_t log_time_ns = 0;
  std::string bytes;

  friend bool operator==(const ReadMessage&, const ReadMessage&) = default;
};

inline std::vector<ReadMessage> all_messages(BagReader& bag) {
  std::vector<int> topics;
  for (std::size_t i = 0; i < bag.topics().size(); ++i) topics.push_back(static_cast<int>(i));
  bag.start(topics);
  std::vector<ReadMessage> messages;
  while (const auto message = bag.next()) {
    messages.push_back({bag.topics()[static_cast<std::size_t>(message->topic)].name,
                        message->log_time_ns, std::string(message->bytes)});
  }
  return messages;
}

}  // namespace samewhere::bags
