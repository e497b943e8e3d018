#include <csignal>
#include <cstdlib>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <unistd.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>
#include <samewhere/twin/front/test_source.hpp>
#include <samewhere/twin/render/picture_cache.hpp>

namespace samewhere::twin {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Optional;

constexpr std::uintmax_t kPlenty = 1'000'000'000;

class PictureCacheTest : public testing::Test {
 protected:
  PictureCacheTest() {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    root_ = std::filesystem::path(testing::TempDir()) /
            ("samewhere_cache_" + std::string(test->name()) + "_" + std::to_string(getpid()));
  }
  ~PictureCacheTest() override { std::filesystem::remove_all(root_); }

  PictureCache open(const std::string& key, std::uintmax_t max_bytes = kPlenty) const {
    return PictureCache(key, CachePlace{root_, max_bytes});
  }

  static Pictures pictures(std::uint64_t seed) {
    core::Random random(seed);
    return {{TestSource::random_picture(random), TestSource::random_picture(random)},
            TestSource::random_depth(random)};
  }

  // All files below the root that are no keys.
  std::vector<std::filesystem::path> files() const {
    std::vector<std::filesystem::path> found;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(root_)) {
      if (entry.is_regular_file() && entry.path().filename() != "key.txt") {
        found.push_back(entry.path());
      }
    }
    return found;
  }

  std::filesystem::path root_;
};

void expect_same(const std::optional<Pictures>& found, const Pictures& expected) {
  ASSERT_TRUE(found);
  ASSERT_EQ(found->images.size(), expected.images.size());
  for (std::size_t i = 0; i < expected.images.size(); ++i) {
    EXPECT_EQ(found->images[i].type(), expected.images[i].type());
    EXPECT_EQ(cv::norm(found->images[i], expected.images[i], cv::NORM_INF), 0.0);
  }
  ASSERT_EQ(found->depth_m.has_value(), expected.depth_m.has_value());
  if (!expected.depth_m) return;
  EXPECT_EQ(found->depth_m->type(), CV_32FC1);
  EXPECT_EQ(cv::norm(*found->depth_m, *expected.depth_m, cv::NORM_INF), 0.0);
}

TEST_F(PictureCacheTest, WhatIsStoredComesBackBitForBit) {
  const PictureCache cache = open("hotel");
  EXPECT_FALSE(cache.load(0));
  for (int i = 0; i < 40; ++i) EXPECT_EQ(cache.store(i, pictures(100 + i)), std::nullopt);
  Pictures without_depth = pictures(7);
  without_depth.depth_m.reset();
  EXPECT_EQ(cache.store(40, without_depth), std::nullopt);
  const PictureCache later = open("hotel");
  for (int i = 0; i < 40; ++i) expect_same(later.load(i), pictures(100 + i));
  expect_same(later.load(40), without_depth);
  EXPECT_FALSE(later.load(41));
  EXPECT_FALSE(open("hotel?seed=2").load(0));
  EXPECT_EQ(later.refusal(), std::nullopt);
}

TEST_F(PictureCacheTest, WithoutAFolderThereIsNone) {
  ASSERT_EQ(unsetenv("SAMEWHERE_CACHE"), 0);
  const PictureCache cache("hotel");
  EXPECT_EQ(cache.store(0, pictures(1)), std::nullopt);
  EXPECT_FALSE(cache.load(0));
  EXPECT_EQ(cache.refusal(), std::nullopt);
}

TEST_F(PictureCacheTest, TheEnvironmentSaysWhereAndHowMuch) {
  ASSERT_EQ(setenv("SAMEWHERE_CACHE", root_.c_str(), 1), 0);
  ASSERT_EQ(unsetenv("SAMEWHERE_CACHE_MB"), 0);
  EXPECT_EQ(cache_place_from_environment()->max_bytes, 8'192'000'000U);
  ASSERT_EQ(setenv("SAMEWHERE_CACHE_MB", "12", 1), 0);
  EXPECT_EQ(cache_place_from_environment()->max_bytes, 12'000'000U);
  EXPECT_EQ(cache_place_from_environment()->root, root_);
  ASSERT_EQ(PictureCache("hotel").store(3, pictures(1)), std::nullopt);
  expect_same(PictureCache("hotel").load(3), pictures(1));
  for (const char* wrong : {"", "-1", "12 MB", "1e3", "99999999999999999999"}) {
    ASSERT_EQ(setenv("SAMEWHERE_CACHE_MB", wrong, 1), 0);
    EXPECT_THROW(cache_place_from_environment(), core::InputError) << wrong;
  }
  ASSERT_EQ(setenv("SAMEWHERE_CACHE", "", 1), 0);
  EXPECT_FALSE(cache_place_from_environment());
}

TEST_F(PictureCacheTest, ADamagedFileCountsAsAbsentAndIsReplaced) {
  const PictureCache cache = open("hotel");
  ASSERT_EQ(cache.store(0, pictures(1)), std::nullopt);
  ASSERT_EQ(files().size(), 1U);
  const std::filesystem::path file = files().front();
  const std::string good = core::read_file(file);
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    core::Random random(seed);
    std::string bytes = good.substr(0, seed % 2 == 0 ? good.size() : random.index(good.size()));
    if (seed % 2 == 0) bytes[random.index(bytes.size())] ^= static_cast<char>(1);
    core::write_file(file, bytes);
    const auto found = cache.load(0);
    // what stands beside the pixels may be harmed
    if (found) {
      expect_same(found, pictures(1));
    }
    EXPECT_TRUE(!found || bytes.size() == good.size()) << "cut short, seed " << seed;
  }
  core::write_file(file, "");
  EXPECT_FALSE(cache.load(0));
  ASSERT_EQ(cache.store(0, pictures(1)), std::nullopt);
  expect_same(cache.load(0), pictures(1));
}

TEST_F(PictureCacheTest, TheKeysUsedLongestAgoGoFirstButNeverThisOne) {
  for (const char* key : {"a", "b", "c"}) ASSERT_EQ(open(key).store(0, pictures(1)), std::nullopt);
  const std::uintmax_t num_bytes = std::filesystem::file_size(files().front());
  open("a");  // now b is the oldest
  const auto limit = static_cast<std::uintmax_t>(2.5 * static_cast<double>(num_bytes));
  open("d", limit);
  EXPECT_FALSE(open("b").load(0));
  EXPECT_TRUE(open("c").load(0));
  EXPECT_TRUE(open("a").load(0));
  // the one in use stays although it alone leaves no room for others
  const PictureCache a = open("a", num_bytes + 100);
  EXPECT_TRUE(a.load(0));
  EXPECT_FALSE(open("c").load(0));
}

TEST_F(PictureCacheTest, WhatWouldPassTheLimitAloneIsNotKept) {
  const std::uintmax_t limit = 100'000;
  const PictureCache cache = open("hotel", limit);
  std::optional<std::string> said;
  for (int i = 0; i < 100 && !said; ++i) said = cache.store(i, pictures(1));
  EXPECT_THAT(said, Optional(HasSubstr("SAMEWHERE_CACHE_MB")));
  std::uintmax_t num_bytes = 0;
  for (const auto& file : files()) num_bytes += std::filesystem::file_size(file);
  EXPECT_LE(num_bytes, limit);
  EXPECT_GT(num_bytes, limit / 2);
}

TEST_F(PictureCacheTest, OtherThingsInTheFolderAreLeftAlone) {
  std::filesystem::create_directories(root_ / "0123456789abcdef");
  core::write_file(root_ / "0123456789abcdef" / "photo.png", std::string(5000, 'x'));
  core::write_file(root_ / "letter.txt", std::string(5000, 'x'));
  open("a", 10);
  open("b", 10);
  EXPECT_TRUE(std::filesystem::exists(root_ / "0123456789abcdef" / "photo.png"));
  EXPECT_TRUE(std::filesystem::exists(root_ / "letter.txt"));
}

TEST_F(PictureCacheTest, AFolderThatCannotBeMadeSwitchesItOff) {
  std::filesystem::create_directories(root_);
  core::write_file(root_ / "file", "");
  const PictureCache cache("hotel", CachePlace{root_ / "file" / "cache", kPlenty});
  EXPECT_THAT(cache.refusal(), Optional(HasSubstr("pictures are not cached")));
  EXPECT_EQ(cache.store(0, pictures(1)), std::nullopt);
  EXPECT_FALSE(cache.load(0));
}

TEST_F(PictureCacheTest, AFullDiskIsToldAndLeavesNothingBehind) {
  const PictureCache cache = open("hotel");
  ASSERT_EQ(cache.store(0, pictures(1)), std::nullopt);
  const FullDisk full;
  EXPECT_THAT(cache.store(1, pictures(2)), Optional(HasSubstr("000001.pictures")));
  EXPECT_EQ(files().size(), 1U);
  expect_same(cache.load(0), pictures(1));
}

TEST_F(PictureCacheTest, AClearedFolderBeginsAgain) {
  const PictureCache cache = open("hotel");
  ASSERT_EQ(cache.store(0, pictures(1)), std::nullopt);
  std::filesystem::remove_all(root_);
  EXPECT_FALSE(cache.load(0));
  EXPECT_EQ(cache.store(1, pictures(2)), std::nullopt);
  EXPECT_EQ(cache.store(2, pictures(3)), std::nullopt);
  expect_same(cache.load(2), pictures(3));
}

TEST_F(PictureCacheTest, AKeyFileThatIsCutForeignOrGoneCostsItsPicturesAndIsTold) {
  for (const char* content : {"", "hot", "a text of the same hash", "gone"}) {
    ASSERT_EQ(open("hotel").store(0, pictures(1)), std::nullopt);
    ASSERT_EQ(open("hotel").notice(), std::nullopt);
    const std::filesystem::path key_file = files().front().parent_path() / "key.txt";
    core::write_file(key_file, content);
    if (content == std::string("gone")) std::filesystem::remove(key_file);
    const PictureCache cache = open("hotel");
    EXPECT_EQ(cache.refusal(), std::nullopt);
    EXPECT_THAT(cache.notice(), Optional(AllOf(HasSubstr("key.txt"), HasSubstr("anew"))));
    EXPECT_FALSE(cache.load(0)) << content;
    ASSERT_EQ(cache.store(0, pictures(2)), std::nullopt);
    expect_same(open("hotel").load(0), pictures(2));
    EXPECT_EQ(open("hotel").notice(), std::nullopt);
  }
}

TEST_F(PictureCacheTest, AKeyFileThatCannotBeSetRightSwitchesItOff) {
  ASSERT_EQ(open("hotel").store(0, pictures(1)), std::nullopt);
  const std::filesystem::path key_file = files().front().parent_path() / "key.txt";
  std::filesystem::remove(key_file);
  std::filesystem::create_directories(key_file / "within");
  EXPECT_THAT(open("hotel").refusal(), Optional(HasSubstr("key.txt")));
}

}  // namespace
}  // namespace samewhere::twin
