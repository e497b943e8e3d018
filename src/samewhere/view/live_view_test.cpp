#include <algorithm>
#include <chrono>
#include <set>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <samewhere/core/stage_thread.hpp>
#include <samewhere/core/tum_file.hpp>
#include <samewhere/report/frames.hpp>
#include <samewhere/report/funnel.hpp>
#include <samewhere/report/loops.hpp>
#include <samewhere/report/pairs.hpp>
#include <samewhere/run/open_source.hpp>
#include <samewhere/run/run.hpp>
#include <samewhere/view/live_view.hpp>
#include <samewhere/view/test_page.hpp>

namespace samewhere::view {
namespace {

using nlohmann::json;

constexpr int kNumFrames = 40;

// A short walk with loops between views that are near to each other.
pipeline::Config walk_config(bool has_threads) {
  pipeline::Config config = pipeline::load_config(
      "default", {},
      {"retrieve.window_frames=4", "map.min_shared=1000", "verify.min_look_alike_distance_m=0.3"});
  config.source = "twin:office-loop?seed=5";
  config.twin.num_frames = kNumFrames;
  config.threads = has_threads;
  return config;
}

run::RunOutcome run_walk(run::Watcher* watcher, bool has_threads = true) {
  const pipeline::Config config = walk_config(has_threads);
  return run::run_slam(run::open_source(config), config, {}, true, watcher);
}

// The files of a run that do not hold times.
std::string bytes_of(const run::RunOutcome& outcome) {
  const report::RunRecord& record = outcome.record;
  return core::tum_text(report::measured_trajectory(record.frames)) +
         report::loops_json(record.ledger) + report::frames_csv(record.frames) +
         core::tum_text(record.odometry);
}

// What a page of the walk is sent from before its first frame to its end, in order.
struct SeenWalk {
  run::RunOutcome outcome;
  std::vector<Event> events;
};

SeenWalk seen_walk() {
  SeenWalk seen;
  LiveView view({}, "");
  std::string text;
  core::WorkerThread page([&, port = port_of(view)] {
    TestClient client(port);
    text = open_events(client, port);
    text += client.receive(60.0, "event: finished");
    text += client.receive(0.5);
  });
  while (view.num_pages() == 0) rest(0.01);
  seen.outcome = run_walk(&view);
  rest(0.5);
  view.finish(report::page_blocks(seen.outcome.record));
  page.join();
  seen.events = events_in(text);
  return seen;
}

const SeenWalk& walk_that_was_seen() {
  static const SeenWalk seen = seen_walk();
  return seen;
}

TEST(LiveView, LeavesTheResultAsItIs) {
  const run::RunOutcome unseen = run_walk(nullptr);
  EXPECT_EQ(bytes_of(walk_that_was_seen().outcome), bytes_of(unseen));
  EXPECT_GT(report::accepted_rows(unseen.record.ledger).size(), 0U);
}

TEST(LiveView, TellsAPageOfTheRunFromItsStartToItsEnd) {
  const std::vector<Event>& events = walk_that_was_seen().events;
  ASSERT_FALSE(events.empty());
  EXPECT_EQ(events.front().name, "start");
  EXPECT_EQ(events.front().data.at("num_expected"), kNumFrames);
  EXPECT_EQ(events.back().name, "finished");
  std::size_t num = 0;
  std::set<std::string> names;
  for (const Event& event : events) {
    names.insert(event.name);
    if (event.name != "frames") continue;
    EXPECT_LE(event.data.at("from"), num) << "a gap";
    num = event.data.at("from").get<std::size_t>() + event.data.at("num").get<std::size_t>();
  }
  // the last ones come with the report
  EXPECT_GT(num, static_cast<std::size_t>(kNumFrames) / 2);
  for (const char* name : {"points", "pictures", "candidates", "image", "status", "pace"})
    EXPECT_TRUE(names.contains(name)) << name;
}

TEST(LiveView, TellsOfEveryVerdict) {
  std::set<std::uint64_t> told;
  for (const Event& event : walk_that_was_seen().events) {
    if (event.name != "candidates") continue;
    for (const json& candidate : event.data) told.insert(candidate.at("id").get<std::uint64_t>());
  }
  const core::Ledger& ledger = walk_that_was_seen().outcome.record.ledger;
  // but those that came after the last frame
  EXPECT_GT(told.size(), ledger.size() / 2);
  for (const std::uint64_t id : told)
    EXPECT_TRUE(std::any_of(ledger.begin(), ledger.end(),
                            [&](const auto& row) { return row.candidate.id.index() == id; }));
}

TEST(LiveView, ShowsTheReportAfterwards) {
  LiveView view({}, "");
  EXPECT_NE(ask(port_of(view), "GET /").find(R"(id="live">{"mode":"live"})"), std::string::npos);
  view.finish({.title = "walk", .run = "{}"});
  const std::string page = ask(port_of(view), "GET /");
  EXPECT_NE(page.find("<title>walk</title>"), std::string::npos);
  EXPECT_NE(page.find(R"(id="live">{"mode":"finished"})"), std::string::npos);
  EXPECT_NE(page.find("connect-src 'self'"), std::string::npos);
  view.wait_for_pages();  // there is none
}

TEST(LiveView, PausesStepsAndGoesOn) {
  LiveView view({}, "");
  const int port = port_of(view);
  TestClient page(port);
  core::Guarded<bool> has_ended;
  open_events(page, port);
  core::WorkerThread drain([&] { page.receive(60.0, "event: finished"); });
  core::WorkerThread running([&] {
    run_walk(&view, false);
    has_ended.set(true);
  });
  while (status_of(post(port, "/control", R"({"is_paused":true})")) != 200) rest(0.02);
  EXPECT_EQ(status_of(post(port, "/control", R"({"step":true})")), 200);
  rest(4.0);  // twice what the whole walk takes
  EXPECT_FALSE(has_ended.get());
  for (const char* bad : {"", "[]", R"({"speed":"fast"})", R"({"is_paused":1})"})
    EXPECT_EQ(status_of(post(port, "/control", bad)), 400) << bad;
  EXPECT_EQ(status_of(post(port, "/control", R"({"is_paused":false})")), 200);
  running.join();
  view.finish({});
  drain.join();
}

TEST(LiveView, GoesOnWhenTheLastPageIsClosedInAPause) {
  LiveView view({}, "");
  const int port = port_of(view);
  {
    TestClient page(port);
    open_events(page, port);
    view.begin({.name = "walk"}, walk_config(false), false);
    EXPECT_EQ(status_of(post(port, "/control", R"({"is_paused":true})")), 200);
  }
  run_walk(&view, false);
}

TEST(LiveView, LetsNoLiveCameraWait) {
  LiveView view({}, "");
  view.begin({.name = "camera", .is_live = true}, walk_config(false), false);
  EXPECT_EQ(status_of(post(port_of(view), "/control", R"({"is_paused":true})")), 400);
}

run::RunOutcome recognize_walk(run::Watcher* watcher, bool has_threads) {
  constexpr int kFew = 20;
  pipeline::Config config =
      pipeline::load_config("recognition", {}, {"retrieve.window_frames=4", "verify.min_views=1"});
  config.source = "twin:office-loop?seed=5";
  config.twin.num_frames = kFew;
  config.threads = has_threads;
  return run::run_recognition(run::open_source(config), config, {}, true, watcher);
}

// The files of recognition that do not hold times.
std::string bytes_of_recognition(const run::RunOutcome& outcome) {
  return report::loops_json(outcome.record.ledger) + report::pairs_text(outcome.matches) +
         report::pairs_text(outcome.accepted);
}

TEST(LiveView, ShowsRecognitionAndLeavesItAsItIs) {
  const std::string unseen = bytes_of_recognition(recognize_walk(nullptr, true));
  for (const bool has_threads : {true, false}) {
    LiveView view({}, "");
    const TestPage page(view);
    const run::RunOutcome seen = recognize_walk(&view, has_threads);
    EXPECT_EQ(bytes_of_recognition(seen), unseen);
    rest(0.5);
    const std::vector<Event> events = page.events();
    ASSERT_FALSE(events.empty());
    EXPECT_EQ(events.front().name, "start");
    EXPECT_EQ(events.front().data.at("is_recognition"), true);
    std::set<std::uint64_t> told;
    std::set<std::string> names;
    for (const Event& event : events) {
      names.insert(event.name);
      if (event.name != "candidates") continue;
      for (const json& candidate : event.data) told.insert(candidate.at("id").get<std::uint64_t>());
    }
    EXPECT_EQ(names, (std::set<std::string>{"start", "pace", "pictures", "candidates", "image",
                                            "status"}));
    // but those that are decided at the end
    EXPECT_GT(told.size(), report::final_rows(seen.record.ledger).size() / 2);
  }
}

TEST(LiveView, ForgetsASessionWhereAnotherBegins) {
  LiveView view({}, "");
  const TestPage page(view);
  const pipeline::Config config = walk_config(false);
  view.begin({.name = "monday"}, config, false);
  view.see_thumbnails({{core::FrameId(7), "picture"}});
  rest(0.5);
  view.begin({.name = "tuesday"}, config, false);
  view.see_thumbnails({{core::FrameId(9), "picture"}});
  rest(0.5);
  std::vector<std::string> told;
  for (const Event& event : page.events()) {
    if (event.name == "start") told.push_back(event.data.at("title"));
    if (event.name == "pictures")
      for (const json& picture : event.data)
        told.push_back(std::to_string(picture.at("frame").get<int>()));
  }
  EXPECT_EQ(told, (std::vector<std::string>{"monday", "7", "tuesday", "9"}));
}

TEST(Pace, IsThatOfTheRecording) {
  Pace pace;
  const auto seconds_for = [&](double first_s) {
    const auto begin = std::chrono::steady_clock::now();
    for (int i = 0; i < 5; ++i) pace.wait(first_s + 0.1 * i, [] { return false; });
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  };
  EXPECT_LT(seconds_for(0.0), 0.2);
  pace.set({.speed = 0.5});
  EXPECT_GT(seconds_for(0.5), 0.75);
}

TEST(Pace, EndsWithThePage) {
  Pace pace;
  pace.set({.is_paused = true});
  int num_looks = 0;
  pace.wait(0.0, [&] { return ++num_looks > 3; });
  EXPECT_EQ(num_looks, 4);
}

}  // namespace
}  // namespace samewhere::view
