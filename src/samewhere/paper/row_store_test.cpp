#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <samewhere/core/file.hpp>
#include <samewhere/input/test_folder.hpp>
#include <samewhere/paper/row_store.hpp>

namespace samewhere::paper {
namespace {

TEST(RowStore, FindsRowsOfTheSameSettingsAlone) {
  const input::TestFolder folder;
  const RowStore store(folder.root());
  RowSettings settings = settings_of(pipeline::profile("paper"));
  store.keep("hall", settings, {1, 2});
  EXPECT_EQ(store.find("hall", settings), nlohmann::json({1, 2}));
  EXPECT_FALSE(store.find("kitchen", settings).has_value());
  EXPECT_FALSE(RowStore(folder.root(), /*is_fresh=*/true).find("hall", settings).has_value());
  settings["retrieve.num_draws"] = "51";
  EXPECT_FALSE(store.find("hall", settings).has_value());
}

TEST(RowStore, ANewSettingMayHaveItsDefault) {
  const input::TestFolder folder;
  const RowStore store(folder.root());
  const RowSettings settings = settings_of(pipeline::profile("paper"));
  RowSettings older = settings;
  ASSERT_EQ(older.erase("verify.min_inliers"), 1u);
  store.keep("hall", older, 3);
  EXPECT_TRUE(store.find("hall", settings).has_value());
  RowSettings changed = settings;
  changed["verify.min_inliers"] = "77";
  EXPECT_FALSE(store.find("hall", changed).has_value());
  RowSettings gone = settings;
  gone["no.such.setting"] = "1";
  store.keep("hall", gone, 3);
  EXPECT_FALSE(store.find("hall", settings).has_value());
}

TEST(RowStore, AFileThatIsNoneCountsAsNone) {
  const input::TestFolder folder;
  const RowStore store(folder.root());
  for (const char* content : {"", "{\"version\"", "[]", "{\"version\": 1}", "{}"}) {
    core::write_file(folder.root() / "hall.json", content);
    EXPECT_FALSE(store.find("hall", {}).has_value()) << content;
  }
  EXPECT_FALSE(RowStore("").find("hall", {}).has_value());
}

}  // namespace
}  // namespace samewhere::paper
