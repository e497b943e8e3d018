#include <algorithm>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <samewhere/bags/bag.hpp>
#include <samewhere/bags/chunked_reader.hpp>
#include <samewhere/bags/compression.hpp>
#include <samewhere/bags/mcap_format.hpp>
#include <samewhere/bags/ros1_format.hpp>
#include <samewhere/bags/test_bag.hpp>
#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>

namespace samewhere::bags {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr std::int64_t kStart_ns = 1'700'000'000'000'000'000;
constexpr int kNumImages = 40;

// Two topics; images of 200 KB, so that there are several chunks, each second one recorded late.
std::vector<ReadMessage> write_recording(const std::filesystem::path& path, const BagKind& kind) {
  const auto bag = make_bag(path, kind.format, kind.compression);
  const int images = bag->add_topic<messages::Image>("/camera/image_raw");
  const int names = bag->add_topic<messages::String>("/name", true);
  std::vector<ReadMessage> written;
  for (int i = 0; i < kNumImages; ++i) {
    const int turn = i % 2 == 0 ? i + 1 : i - 1;
    const std::int64_t time_ns = kStart_ns + turn * std::int64_t{100'000'000};
    messages::Image image;
    image.header.stamp = messages::time_of_nanoseconds(time_ns);
    image.encoding = "mono8";
    image.data.assign(200'000, static_cast<std::uint8_t>(i));
    bag->write_message(images, time_ns, image);
    written.push_back({"/camera/image_raw", time_ns, write_message(image, bag->layout())});
    if (i % 10 != 0) continue;
    const messages::String name{std::to_string(i)};
    bag->write_message(names, time_ns, name);
    written.push_back({"/name", time_ns, write_message(name, bag->layout())});
  }
  bag->finish();
  std::stable_sort(written.begin(), written.end(), [](const ReadMessage& a, const ReadMessage& b) {
    return a.log_time_ns < b.log_time_ns;
  });
  return written;
}

TEST(Bag, ReadsWhatItWritesInTheOrderOfTime) {
  const BagFolder folder;
  for (const BagKind& kind : all_bag_kinds()) {
    const auto written = write_recording(folder.at("bag"), kind);
    EXPECT_TRUE(is_bag(folder.at("bag")));
    const auto bag = open_bag(folder.at("bag"));
    SCOPED_TRACE(bag->info().format + " " + bag->info().compression);
    EXPECT_TRUE(bag->info().is_closed);
    EXPECT_EQ(bag->info().damage, "");
    EXPECT_EQ(bag->info().num_messages, written.size());
    EXPECT_EQ(bag->info().first_ns, kStart_ns);
    EXPECT_EQ(bag->info().last_ns, kStart_ns + (kNumImages - 1) * std::int64_t{100'000'000});
    ASSERT_THAT(bag->topics(), SizeIs(2));
    EXPECT_EQ(bag->topics()[0].type, "sensor_msgs/Image");
    EXPECT_EQ(bag->topics()[0].num_messages, 40U);
    EXPECT_EQ(bag->topics()[1].num_messages, 4U);
    EXPECT_TRUE(all_messages(*bag) == written);
    EXPECT_TRUE(all_messages(*bag) == written) << "once more";
  }
}

TEST(Bag, GivesTheChosenTopicsAlone) {
  const BagFolder folder;
  for (const BagKind& kind : all_bag_kinds()) {
    write_recording(folder.at("bag"), kind);
    const auto bag = open_bag(folder.at("bag"));
    EXPECT_FALSE(bag->next()) << "before it is started";
    bag->start({1});
    int count = 0;
    while (const auto message = bag->next()) {
      EXPECT_EQ(message->topic, 1);
      ++count;
    }
    EXPECT_EQ(count, 4);
  }
}

TEST(Bag, WhatWasNotFinishedLeavesNoFile) {
  const BagFolder folder;
  for (const BagKind& kind : all_bag_kinds()) {
    make_bag(folder.at("bag"), kind.format, kind.compression)->add_topic<messages::String>("/name");
    EXPECT_TRUE(std::filesystem::is_empty(folder.at("")));
  }
}

// Cut anywhere, a file is refused, or gives a beginning of what was written and says that it is
// cut.
TEST(Bag, ACutFileGivesItsBeginningAndSaysSo) {
  const BagFolder folder;
  for (const BagKind& kind : all_bag_kinds()) {
    if (kind.format == BagFormat::kSqlite) continue;  // SQLite's own business
    auto written = write_recording(folder.at("bag"), kind);
    const std::string whole = core::read_file(folder.at("bag"));
    for (int part = 1; part < 20; ++part) {
      core::write_file(folder.at("cut"), whole.substr(0, whole.size() * part / 20));
      const auto bag = open_bag(folder.at("cut"));
      EXPECT_FALSE(bag->info().is_closed);
      const auto found = all_messages(*bag);
      // whole chunks are read: of MCAP, 4 MB each, one of two
      if (kind.compression == Compression::kNone && part == 15) {
        EXPECT_GT(found.size(), written.size() / 4);
        EXPECT_LT(found.size(), written.size());
      }
      for (const ReadMessage& message : found)
        EXPECT_NE(std::find(written.begin(), written.end(), message), written.end());
    }
  }
}

TEST(Bag, AWrongChecksumIsFound) {
  const BagFolder folder;
  write_recording(folder.at("bag"), {BagFormat::kMcap, Compression::kNone});
  std::string bytes = core::read_file(folder.at("bag"));
  bytes[2'000'000] = static_cast<char>(bytes[2'000'000] ^ 1);
  core::write_file(folder.at("bag"), bytes);
  const auto bag = open_bag(folder.at("bag"));
  try {
    all_messages(*bag);
    FAIL() << "expected InputError";
  } catch (const core::InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("checksum"));
    EXPECT_THAT(error.what(), HasSubstr(folder.at("bag").string()));
  }
}

TEST(Bag, NoByteThatIsChangedDoesMoreThanAnError) {
  const BagFolder folder;
  for (const BagKind& kind : all_bag_kinds()) {
    const auto bag = make_bag(folder.at("bag"), kind.format, kind.compression);
    const int names = bag->add_topic<messages::String>("/name");
    for (int i = 0; i < 3; ++i) bag->write_message(names, i, messages::String{std::to_string(i)});
    bag->finish();
    const std::string whole = core::read_file(folder.at("bag"));
    const std::size_t step = kind.format == BagFormat::kMcap ? 3 : 31;
    for (std::size_t i = 0; i < whole.size(); i += step) {
      std::string changed = whole;
      changed[i] = static_cast<char>(~changed[i]);
      core::write_file(folder.at("changed"), changed);
      try {
        all_messages(*open_bag(folder.at("changed")));
      } catch (const core::InputError&) {
        // one line, and the program goes on
      }
    }
  }
}

std::string mcap_chunk(std::uint64_t size, std::string_view compression, std::string_view packed) {
  ByteWriter chunk;
  chunk.number(std::int64_t{0}).number(std::int64_t{1}).number(size);
  chunk.number(std::uint32_t{0}).text(compression).number(std::uint64_t{packed.size()});
  return mcap::record(mcap::Kind::kChunk, chunk.bytes(packed).view());
}

// A chunk that claims 4 GB takes no memory.
TEST(Bag, AChunkThatClaimsTooMuchIsRefused) {
  const BagFolder folder;
  core::write_file(folder.at("bag"),
                   std::string(mcap::kMagic) + mcap_chunk(4'000'000'000, "zstd", "abcd"));
  const auto bag = open_bag(folder.at("bag"));
  EXPECT_THAT(bag->info().damage, HasSubstr("4000000000"));
  EXPECT_THROW(all_messages(*bag), core::InputError);
}

// Each of a thousand chunks claims 500 MB and has a few bytes: what is claimed is not filled, which
// would take minutes.
TEST(Bag, ManyChunksThatClaimTooMuchAreTold) {
  const BagFolder folder;
  for (const Compression method : {Compression::kLz4, Compression::kZstd, Compression::kBz2}) {
    const std::string packed = compress("abcd", method);
    std::string whole(mcap::kMagic);
    for (int i = 0; i < 1000; ++i) whole += mcap_chunk(500'000'000, name_of(method), packed);
    core::write_file(folder.at("bag"), whole);
    EXPECT_THAT(open_bag(folder.at("bag"))->info().damage, HasSubstr("is damaged"));
  }
}

TEST(Compression, WhatUnpacksToMuchMoreIsReadWhole) {
  const std::string zeros(20'000'000, '\0');
  for (const Compression method : {Compression::kLz4, Compression::kZstd, Compression::kBz2}) {
    const std::string packed = compress(zeros, method);
    const std::string_view name = name_of(method);
    EXPECT_TRUE(decompress(packed, name, zeros.size()) == zeros) << name;
    EXPECT_THROW(decompress(packed, name, zeros.size() - 1), core::InputError) << name;
    EXPECT_THROW(decompress(packed, name, zeros.size() + 1), core::InputError) << name;
    EXPECT_THROW(decompress(packed.substr(0, packed.size() / 2), name, zeros.size()),
                 core::InputError)
        << name;
    EXPECT_THROW(decompress("", name, 1), core::InputError) << name;
  }
}

// A message without chunks around it that is too short for its header, and one without a time.
TEST(Bag, AMessageThatIsDamagedIsLeftOutAndSaid) {
  const BagFolder folder;
  ByteWriter channel, good, late;
  channel.number(std::uint16_t{1}).number(std::uint16_t{0}).text("/name").text("cdr");
  good.number(std::uint16_t{1}).number(std::uint32_t{0}).number(std::int64_t{7}).number(7LL);
  late.number(std::uint16_t{1}).number(std::uint32_t{0}).number(~std::uint64_t{0}).number(7LL);
  const std::string whole =
      std::string(mcap::kMagic) + mcap::record(mcap::Kind::kChannel, channel.view()) +
      mcap::record(mcap::Kind::kMessage, "short") + mcap::record(mcap::Kind::kMessage, good.view());
  for (const std::string& after : {mcap::record(mcap::Kind::kMessage, late.view()),
                                   mcap::record(mcap::Kind::kSchema, "short")}) {
    core::write_file(folder.at("bag"), whole + after);
    const auto bag = open_bag(folder.at("bag"));
    EXPECT_THAT(bag->info().damage, HasSubstr("is damaged at byte"));
    EXPECT_EQ(bag->info().last_ns, 7);
    EXPECT_THAT(all_messages(*bag), SizeIs(1));
  }
}

// An index that names one chunk many times would have it unpacked as often.
TEST(Bag, ChunksThatOverlapAreNotReadByTheIndex) {
  EXPECT_FALSE(do_overlap({{.offset = 100, .length = 50}, {.offset = 0, .length = 100}}));
  EXPECT_TRUE(do_overlap({{.offset = 100, .length = 50}, {.offset = 0, .length = 101}}));
  EXPECT_TRUE(do_overlap({{.offset = 100, .length = 50}, {.offset = 100, .length = 50}}));
}

TEST(Bag, FieldsOfTooManyBytesAreRefused) {
  EXPECT_THROW(ros1::read_fields(std::string(ros1::kMaxHeaderSize + 1, '\0')), core::InputError);
}

TEST(Bag, TimesOfSqliteBeforeZeroAreRefused) {
  const BagFolder folder;
  const auto bag = make_bag(folder.at("bag"), BagFormat::kSqlite, Compression::kNone);
  const int names = bag->add_topic<messages::String>("/name");
  bag->write_message(names, std::numeric_limits<std::int64_t>::min(), messages::String{"a"});
  bag->write_message(names, 7, messages::String{"b"});
  bag->finish();
  EXPECT_THROW(open_bag(folder.at("bag")), core::InputError);
}

// 64 GB without a disk for them: nothing is read twice, and no memory is taken.
TEST(Bag, ASparseFileIsToldAtOnce) {
  const BagFolder folder;
  for (const std::string_view magic : {mcap::kMagic, std::string_view("#ROSBAG V2.0\n")}) {
    core::write_file(folder.at("sparse"), magic);
    std::filesystem::resize_file(folder.at("sparse"), std::uintmax_t{64} << 30);
    const auto bag = open_bag(folder.at("sparse"));
    EXPECT_THAT(bag->info().damage, HasSubstr("is cut or damaged at byte"));
    EXPECT_THAT(all_messages(*bag), IsEmpty());
  }
  core::write_file(folder.at("sparse"), std::string("SQLite format 3\0", 16));
  std::filesystem::resize_file(folder.at("sparse"), std::uintmax_t{64} << 30);
  EXPECT_THROW(open_bag(folder.at("sparse")), core::InputError);
}

TEST(Bag, FilesOfOtherKindsAreRefused) {
  const BagFolder folder;
  core::write_file(folder.at("text"), "a text");
  EXPECT_FALSE(is_bag(folder.at("text")));
  EXPECT_THROW(open_bag(folder.at("text")), core::InputError);
  EXPECT_THROW(open_bag(folder.at("missing")), core::InputError);
  core::write_file(folder.at("old.bag"), "#ROSBAG V1.2\n");
  EXPECT_TRUE(is_bag(folder.at("old.bag")));
  EXPECT_THROW(open_bag(folder.at("old.bag")), core::InputError);
  core::write_file(folder.at("packed"), "\x28\xb5\x2f\xfd and so on");
  EXPECT_THROW(open_bag(folder.at("packed")), core::InputError);
  EXPECT_THROW(make_bag(folder.at("x"), BagFormat::kMcap, Compression::kBz2), core::InputError);
  EXPECT_THROW(make_bag(folder.at("x"), BagFormat::kRos1, Compression::kZstd), core::InputError);
  EXPECT_THROW(make_bag(folder.at("x"), BagFormat::kSqlite, Compression::kZstd), core::InputError);
}

TEST(Bag, AFolderOfRosbag2ListsItsFiles) {
  const BagFolder folder;
  const auto first = write_recording(folder.at("a_0.mcap"), {});
  const auto second = write_recording(folder.at("a_1.mcap"), {});
  core::write_file(folder.at("metadata.yaml"),
                   "rosbag2_bagfile_information:\n  relative_file_paths:\n"
                   "    - a_0.mcap\n    - a/a_1.mcap\n");
  ASSERT_TRUE(is_bag(folder.at("")));
  const auto bag = open_bag(folder.at(""));
  EXPECT_EQ(bag->info().num_messages, first.size() + second.size());
  EXPECT_EQ(bag->topics()[0].num_messages, 80U);
  auto both = first;
  both.insert(both.end(), second.begin(), second.end());
  EXPECT_TRUE(all_messages(*bag) == both);
}

TEST(Bag, TheMetadataOfAFileIsReadBack) {
  const BagFolder folder;
  const auto written = write_recording(folder.at("a.db3"), {BagFormat::kSqlite, {}});
  core::write_file(folder.at("metadata.yaml"),
                   rosbag2_metadata(*open_bag(folder.at("a.db3")), "a.db3"));
  EXPECT_TRUE(all_messages(*open_bag(folder.at(""))) == written);
}

TEST(Bag, TimesMayBeginAtZero) {
  const BagFolder folder;
  for (const BagKind& kind : all_bag_kinds()) {
    const auto bag = make_bag(folder.at("bag"), kind.format, kind.compression);
    const int names = bag->add_topic<messages::String>("/name");
    for (const std::int64_t time_ns : {0, 7})
      bag->write_message(names, time_ns, messages::String{"a"});
    bag->finish();
    EXPECT_EQ(open_bag(folder.at("bag"))->info().first_ns, 0);
    EXPECT_EQ(open_bag(folder.at("bag"))->info().last_ns, 7);
    if (kind.format != BagFormat::kRos1) continue;
    const std::string bytes = core::read_file(folder.at("bag"));
    EXPECT_EQ(bytes.find(std::string("time=") + std::string(8, '\0')), std::string::npos)
        << "rosbag leaves out messages of time 0";
  }
}

TEST(Bag, APublisherWithoutMessagesIsATopic) {
  const BagFolder folder;
  for (const BagKind& kind : all_bag_kinds()) {
    const auto bag = make_bag(folder.at("bag"), kind.format, kind.compression);
    bag->add_topic<messages::String>("/name");
    bag->finish();
    const auto back = open_bag(folder.at("bag"));
    ASSERT_THAT(back->topics(), SizeIs(1)) << back->info().format;
    EXPECT_EQ(back->topics()[0].num_messages, 0U);
    EXPECT_THAT(all_messages(*back), IsEmpty());
  }
}

}  // namespace
}  // namespace samewhere::bags
