#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <samewhere/messages/wire.hpp>
#include <samewhere/node/node.hpp>
#include <samewhere/node/test_messages.hpp>
#include <samewhere/view/test_page.hpp>

namespace samewhere::node {
namespace {

// All that a node gives for the walk, twice with a reset in between, as bytes.
std::string played_bytes(run::Watcher* watcher, bool has_threads) {
  const MessageWalk walk;
  TestPublisher publisher;
  Options options = test_node_options();
  options.threads = has_threads;
  Node node(test_node_config(), options, publisher, watcher);
  play(node, walk);
  node.take(CommandIn{{CommandKind::kReset, {}}, nullptr});
  play(node, walk);
  node.finish();
  std::string bytes;
  const auto add = [&](const auto& messages) {
    for (const auto& message : messages)
      bytes += messages::write_message(message, messages::Layout::kCdr);
  };
  add(publisher.of_transforms);
  add(publisher.of_poses);
  add(publisher.of_paths);
  add(publisher.of_landmarks);
  EXPECT_EQ(publisher.of_transforms.size(), 2 * walk.size());
  return bytes;
}

TEST(NodeView, LeavesWhatTheNodeGivesAsItIs) {
  for (const bool has_threads : {false, true}) {
    view::LiveView view({}, "");
    const view::TestPage page(view);
    EXPECT_EQ(played_bytes(&view, has_threads), played_bytes(nullptr, has_threads));
  }
}

TEST(NodeView, ShowsEachSessionAndLetsNoneWait) {
  view::LiveView view({}, "");
  const view::TestPage page(view);
  played_bytes(&view, false);
  view::rest(0.5);
  std::size_t num_starts = 0;
  std::vector<std::string> names;
  for (const view::Event& event : page.events()) {
    names.push_back(event.name);
    if (event.name != "start") continue;
    ++num_starts;
    EXPECT_EQ(event.data.at("may_wait"), false);
    EXPECT_EQ(event.data.at("is_recognition"), false);
  }
  EXPECT_EQ(num_starts, 2U);
  for (const char* name : {"frames", "points", "pictures", "image", "status"})
    EXPECT_NE(std::find(names.begin(), names.end(), name), names.end()) << name;
  const int port = view::port_of(view);
  EXPECT_EQ(view::status_of(view::post(port, "/control", R"({"is_paused":true})")), 400);
}

}  // namespace
}  // namespace samewhere::node
