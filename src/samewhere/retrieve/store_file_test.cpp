#include <algorithm>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <samewhere/core/checksum.hpp>
#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>
#include <samewhere/core/random.hpp>
#include <samewhere/core/similarity.hpp>
#include <samewhere/retrieve/retriever.hpp>
#include <samewhere/retrieve/store_file.hpp>

namespace samewhere::retrieve {
namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr std::uint64_t kDescriber = 0xabcdef0123456789ULL;
constexpr std::size_t kVersionOffset = 16;
constexpr std::size_t kFirstFrameOffset = 40;

std::vector<float> random_unit(core::Random& random, std::size_t length) {
  std::vector<float> vector(length);
  for (float& value : vector) value = static_cast<float>(random.gaussian());
  return core::unit(vector);
}

SegmentedStore random_store(std::uint64_t seed, int num_views, std::size_t length = 7) {
  core::Random random(seed);
  SegmentedStore store(100, 10);
  std::uint64_t frame = 0;
  for (int i = 0; i < num_views; ++i) {
    frame += 1 + random.index(5);
    const std::uint16_t session = i < num_views / 2 ? 0 : 3;
    const bool is_black = i == 1;
    store.append(core::FrameId(frame, session),
                 is_black ? std::vector<float>(length) : random_unit(random, length));
  }
  return store;
}

class StoreFile : public testing::Test {
 protected:
  StoreFile()
      : folder_(std::filesystem::temp_directory_path() /
                ("samewhere-store-" + std::to_string(getpid()))) {
    std::filesystem::create_directories(folder_);
  }
  ~StoreFile() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path path() const { return folder_ / "places.sw"; }
  const std::filesystem::path& folder() const { return folder_; }

  // What is said of a file with these bytes, which must name it.
  std::string complaint(const std::string& bytes) const {
    std::ofstream(path(), std::ios::binary) << bytes;
    try {
      load_store(path(), kDescriber, {});
    } catch (const core::InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr("places.sw: "));
      EXPECT_THAT(error.what(), testing::Not(HasSubstr("\n")));
      return error.what();
    }
    return "nothing";
  }

  std::string saved(const SegmentedStore& store) const {
    save_store(store, kDescriber, path());
    return core::read_file(path());
  }

  // The same with another checksum at its end, so that what else is wrong shows.
  static std::string sealed(std::string bytes) {
    bytes.resize(bytes.size() - 8);
    const std::uint64_t checksum = core::checksum(bytes);
    bytes.append(reinterpret_cast<const char*>(&checksum), sizeof checksum);
    return bytes;
  }

 private:
  std::filesystem::path folder_;
};

TEST_F(StoreFile, GivesBackFramesAndVectorsToTheBit) {
  for (const int num_views : {1, 2, 99, 100, 101, 257}) {
    const SegmentedStore store = random_store(static_cast<std::uint64_t>(num_views), num_views);
    save_store(store, kDescriber, path());
    const SegmentedStore loaded = load_store(path(), kDescriber, {.group_size = 30});
    ASSERT_EQ(loaded.num_vectors(), num_views);
    EXPECT_EQ(loaded.num_groups(), (num_views + 29) / 30);
    for (int i = 0; i < num_views; ++i) {
      EXPECT_EQ(loaded.frame(i), store.frame(i));
      EXPECT_TRUE(std::ranges::equal(loaded.vector(i), store.vector(i))) << i;
    }
  }
  for (const auto& entry : std::filesystem::directory_iterator(folder())) {
    EXPECT_EQ(entry.path(), path()) << "something else was left behind";
  }
}

TEST_F(StoreFile, TheSameStoreGivesTheSameBytes) {
  EXPECT_EQ(saved(random_store(1, 50)), saved(random_store(1, 50)));
  EXPECT_NE(saved(random_store(1, 50)), saved(random_store(2, 50)));
}

TEST_F(StoreFile, AStoreOfAnotherDescriberIsRefusedAndBothAreNamed) {
  save_store(random_store(1, 20), 0x1111, path());
  EXPECT_THAT(complaint(core::read_file(path())),
              AllOf(HasSubstr("describer 0000000000001111"), HasSubstr("abcdef0123456789")));
}

TEST_F(StoreFile, AFileCutAnywhereIsRefused) {
  const std::string whole = saved(random_store(1, 9));
  for (std::size_t length = 0; length < whole.size(); ++length) {
    EXPECT_THAT(complaint(whole.substr(0, length)),
                testing::AnyOf(HasSubstr("cut short"), HasSubstr("no store of places")))
        << length << " of " << whole.size() << " bytes";
  }
  EXPECT_THAT(complaint(whole + "x"), HasSubstr("cut short or damaged"));
}

TEST_F(StoreFile, ADamagedByteAnywhereIsFound) {
  const std::string whole = saved(random_store(1, 9));
  for (std::size_t i = 0; i < whole.size(); ++i) {
    std::string damaged = whole;
    damaged[i] = static_cast<char>(damaged[i] ^ 4);
    EXPECT_NE(complaint(damaged), "nothing") << "byte " << i;
  }
}

TEST_F(StoreFile, AForeignFileIsRefused) {
  EXPECT_THAT(complaint(""), HasSubstr("no store of places"));
  EXPECT_THAT(complaint("version: 1\nplaces: []\n"), HasSubstr("no store of places"));
  EXPECT_THAT(complaint(std::string(1000, '\xff')), HasSubstr("no store of places"));
  EXPECT_THROW(load_store(folder() / "missing.sw", kDescriber, {}), core::InputError);
  EXPECT_THROW(load_store(folder(), kDescriber, {}), core::InputError);
}

TEST_F(StoreFile, AnotherVersionIsRefused) {
  std::string bytes = saved(random_store(1, 5));
  bytes[kVersionOffset] = 2;
  EXPECT_THAT(complaint(sealed(bytes)),
              AllOf(HasSubstr("of version 2"), HasSubstr("expected version 1")));
}

TEST_F(StoreFile, SizesThatCannotBeAreRefusedBeforeAnythingIsReserved) {
  const std::string whole = saved(random_store(1, 5));
  for (const std::size_t offset : {kVersionOffset + 4, kVersionOffset + 16}) {
    for (const char value : {'\0', '\xff'}) {
      std::string bytes = whole;
      std::fill_n(bytes.begin() + static_cast<std::ptrdiff_t>(offset), 4, value);
      EXPECT_THAT(complaint(sealed(bytes)), HasSubstr("damaged")) << offset;
    }
  }
}

TEST_F(StoreFile, ViewsOutOfOrderOrOfOtherLengthAreRefusedThoughTheChecksumFits) {
  const std::string whole = saved(random_store(1, 5));
  std::string bytes = whole;
  bytes[kFirstFrameOffset + 2] = 100;  // the first frame becomes the last
  EXPECT_THAT(complaint(sealed(bytes)), HasSubstr("view 1 is out of order"));
  bytes = whole;
  const std::size_t first_vector = kFirstFrameOffset + 5 * sizeof(std::uint64_t);
  std::memset(bytes.data() + first_vector, 0xff, sizeof(float));  // not a number
  EXPECT_THAT(complaint(sealed(bytes)), HasSubstr("view 0 is out of order or not of unit length"));
}

TEST_F(StoreFile, WhereNothingCanBeWrittenThatIsSaidAndAnOldFileStays) {
  const std::string before = saved(random_store(1, 5));
  EXPECT_THROW(save_store(random_store(2, 5), kDescriber, folder() / "no" / "such.sw"),
               core::InputError);
  rlimit limit{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &limit), 0);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{100, limit.rlim_max};  // as a disk that is full
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  EXPECT_THROW(save_store(random_store(2, 5), kDescriber, path()), core::InputError);
  setrlimit(RLIMIT_FSIZE, &limit);
  std::signal(SIGXFSZ, handler);
  EXPECT_EQ(core::read_file(path()), before);
}

TEST_F(StoreFile, AnEarlierSessionIsSearchedAsIfItHadJustBeenSeen) {
  for (const Search search : {Search::kExact, Search::kSampled}) {
    const Config config{.search = search, .window_frames = 50, .min_similarity = 0.1};
    core::Random random(1);
    Retriever earlier(config, 1);
    Retriever together(config, 1);
    for (std::uint64_t i = 0; i < 60; ++i) {
      const core::Descriptor view{core::FrameId(i), random_unit(random, 12), kDescriber};
      earlier.add(view);
      together.add(view);
    }
    earlier.save(path());
    Retriever later(config, 1);
    later.load(path(), kDescriber);
    EXPECT_EQ(later.num_views(), 60);
    for (std::uint64_t i = 0; i < 20; ++i) {
      const core::Descriptor view{core::FrameId(i, 1), random_unit(random, 12), kDescriber};
      const auto found = later.query(view);
      EXPECT_EQ(found.size(), 3U) << "all of the earlier session are older than the window";
      const auto expected = together.query(view);
      ASSERT_EQ(found.size(), expected.size());
      for (std::size_t k = 0; k < found.size(); ++k) {
        EXPECT_EQ(found[k].match, expected[k].match);
        EXPECT_EQ(found[k].similarity, expected[k].similarity);
      }
      later.add(view);
      together.add(view);
    }
  }
}

TEST_F(StoreFile, ARetrieverWithViewsLoadsNoneAndOneWithoutSavesNone) {
  const Config config{.window_frames = 0};
  Retriever retriever(config, 1);
  EXPECT_THROW(retriever.save(path()), core::ContractError);
  retriever.add({core::FrameId(1), {0.6F, 0.8F}, kDescriber});
  retriever.save(path());
  EXPECT_THROW(retriever.load(path(), kDescriber), core::ContractError);
  Retriever other(config, 1);
  other.load(path(), kDescriber);
  EXPECT_THROW(other.add({core::FrameId(2), {0.6F, 0.8F}, kDescriber + 1}), core::ContractError);
  EXPECT_THROW(other.add({core::FrameId(2), {0.6F, 0.8F, 0.0F}, kDescriber}), core::ContractError);
}

}  // namespace
}  // namespace samewhere::retrieve
