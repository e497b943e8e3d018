#include <filesystem>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>
#include <samewhere/input/test_folder.hpp>
#include <samewhere/report/compare.hpp>
#include <samewhere/report/pairs.hpp>
#include <samewhere/report/write.hpp>
#include <samewhere/run/open_source.hpp>
#include <samewhere/run/run.hpp>
#include <samewhere/view/finished_run.hpp>
#include <samewhere/view/finished_view.hpp>
#include <samewhere/view/test_client.hpp>

namespace samewhere::view {
namespace {

namespace fs = std::filesystem;

// The folder of a short walk with loops between views that are near to each other.
class FinishedRun : public testing::Test {
 protected:
  // Once: the folder has the name of a test.
  void SetUp() override {
    if (folder_ != nullptr) return;
    folder_ = new input::TestFolder;
    pipeline::Config config =
        pipeline::load_config("default", {},
                              {"retrieve.window_frames=4", "map.min_shared=1000",
                               "verify.min_look_alike_distance_m=0.3", "twin.num_frames=30"});
    config.source = "twin:office-loop?seed=5";
    const auto begin = [] { return run() / "map.sw"; };
    fs::create_directories(run());
    const run::RunOutcome outcome =
        run::run_slam(run::open_source(config), config, {.begin = begin}, true);
    report::write_run(outcome.record, run());
    accepted_ = report::accepted_rows(outcome.record.ledger).at(0)->candidate.id.index();
  }
  static void TearDownTestSuite() { delete folder_; }

  static fs::path run() { return folder_->root() / "run"; }
  // A copy, to be changed.
  static fs::path copy(const std::string& name) {
    fs::copy(run(), folder_->root() / name, fs::copy_options::recursive);
    return folder_->root() / name;
  }
  static nlohmann::json data_of(const report::PageBlocks& blocks) {
    return nlohmann::json::parse(blocks.run);
  }

  inline static input::TestFolder* folder_ = nullptr;
  inline static std::size_t accepted_ = 0;
};

int port_in(const std::string& url) { return std::stoi(url.substr(url.rfind(':') + 1)); }

std::string wish_of(std::size_t candidate, const char* as) {
  return fmt::format(R"({{"candidate":{},"as":"{}"}})", candidate, as);
}

nlohmann::json entry_of(const nlohmann::json& run, std::size_t id) {
  for (const auto& entry : run.at("candidates"))
    if (entry.at("id") == id) return entry;
  return {};
}

TEST_F(FinishedRun, HasTheDataOfItsReport) {
  const std::string html = core::read_file(run() / "report.html");
  const report::ComparedRun stored = report::read_report_html(html, "", "");
  const report::PageBlocks blocks = page_of_run(run());
  EXPECT_EQ(blocks.run, stored.run_json);
  EXPECT_EQ(blocks.pictures, stored.pictures_json);
  EXPECT_EQ(blocks.durations, stored.durations_json);
  EXPECT_EQ(blocks.title, "office-loop-seed5");
}

TEST_F(FinishedRun, IsOverriddenOnItsPage) {
  const fs::path folder = copy("overridden");
  const nlohmann::json before = data_of(page_of_run(folder));
  FinishedView view({folder}, {}, "");
  const int port = port_in(view.url());
  const std::string answer = post(port, "/override/0", wish_of(accepted_, "reject"));
  EXPECT_EQ(status_of(answer), 200) << answer;
  const nlohmann::json after = data_of(page_of_run(folder));
  EXPECT_EQ(entry_of(before, accepted_).at("verdict"), "LOOP");
  EXPECT_EQ(entry_of(after, accepted_).at("verdict"), "NOT");
  EXPECT_EQ(entry_of(after, accepted_).at("earlier").size(),
            entry_of(before, accepted_).value("earlier", nlohmann::json::array()).size() + 1);
  EXPECT_EQ(entry_of(after, accepted_).at("matches"), entry_of(before, accepted_).at("matches"));
  EXPECT_EQ(after.at("frames").at("num"), before.at("frames").at("num"));
  EXPECT_EQ(after.at("frames").at("names"), before.at("frames").at("names"));
  EXPECT_NE(ask(port, "GET /").find("withdrawn by hand"), std::string::npos);
  // it is no loop any more
  const std::string again = post(port, "/override/0", wish_of(accepted_, "reject"));
  EXPECT_EQ(status_of(again), 400);
  EXPECT_NE(again.find("is no loop closure"), std::string::npos) << again;
}

TEST_F(FinishedRun, RefusesWishesThatAreNone) {
  const fs::path folder = copy("kept");
  const std::string loops = core::read_file(folder / "loops.json");
  FinishedView view({folder}, {}, "");
  for (const char* bad :
       {"", "{}", "[]", R"({"candidate":-1,"as":"reject"})", R"({"candidate":1,"as":"../map"})",
        R"({"candidate":"1","as":"force"})", R"({"candidate":99999999,"as":"force"})"})
    EXPECT_EQ(status_of(post(port_in(view.url()), "/override/0", bad)), 400) << bad;
  EXPECT_EQ(status_of(post(port_in(view.url()), "/override/1", wish_of(accepted_, "reject"))), 404);
  EXPECT_EQ(core::read_file(folder / "loops.json"), loops);
}

TEST_F(FinishedRun, StandsBesideOthers) {
  FinishedView view({run(), run() / "map.sw"}, {}, "secret-token");
  const int port = std::stoi(view.url().substr(view.url().find(':', 7) + 1));
  const std::string index = ask(port, "GET /?token=secret-token");
  EXPECT_NE(index.find("/run/0?token=secret-token"), std::string::npos);
  EXPECT_NE(index.find("/run/1?token=secret-token"), std::string::npos);
  EXPECT_EQ(index.find("/compare"), std::string::npos) << "a map file has no report";
  EXPECT_EQ(status_of(ask(port, "GET /run/1?token=secret-token")), 200);
  EXPECT_EQ(status_of(ask(port, "GET /run/0")), 403);
  EXPECT_EQ(status_of(ask(port, "GET /run/2?token=secret-token")), 404);
}

TEST_F(FinishedRun, IsComparedWithOthersOnOnePage) {
  FinishedView view({run(), run()}, {}, "");
  EXPECT_EQ(status_of(ask(port_in(view.url()), "GET /compare")), 200);
}

TEST_F(FinishedRun, MapFileAloneShowsItsKeyframes) {
  const nlohmann::json data = data_of(page_of_map(run() / "map.sw"));
  EXPECT_GT(data.at("frames").at("num").get<int>(), 3);
  EXPECT_GT(data.at("points").at("num_in_map").get<int>(), 100);
  EXPECT_FALSE(data.at("candidates").empty());
  EXPECT_EQ(data.at("title"), "map.sw");
}

TEST_F(FinishedRun, SaysWhatIsMissing) {
  EXPECT_THROW(page_of_run(folder_->root() / "nowhere"), core::InputError);
  EXPECT_THROW(page_of_map(folder_->root() / "nowhere.sw"), core::InputError);
  const fs::path folder = copy("damaged");
  core::replace_file(folder / "report.html", "<p>no report</p>");
  EXPECT_THROW(page_of_run(folder), core::InputError);
}

}  // namespace
}  // namespace samewhere::view
