#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <samewhere/core/file.hpp>
#include <samewhere/input/test_folder.hpp>
#include <samewhere/train/checkpoint.hpp>

namespace samewhere::train {
namespace {

using input::complaint;
using testing::AllOf;
using testing::HasSubstr;

Checkpoint small_checkpoint() {
  return {.settings = "batch: 4\n",
          .network = "one layer",
          .images_sha256 = "12ab",
          .commits = {"abc", "def"},
          .history = {{1, 0.5, 0.625}, {2, 0.25, 0.75}},
          .learner = std::string("state\n\0\xff", 8),
          .best_parameters = {1.0F, -2.5F, 3e-20F},
          .best_codes = {0.0F, 7.0F}};
}

TEST(Checkpoint, ReadsBackAsItWasWritten) {
  const input::TestFolder folder;
  const Checkpoint written = small_checkpoint();
  write_checkpoint(folder.at("checkpoint"), written);
  const Checkpoint read = read_checkpoint(folder.at("checkpoint"));
  EXPECT_EQ(read.settings, written.settings);
  EXPECT_EQ(read.network, written.network);
  EXPECT_EQ(read.images_sha256, written.images_sha256);
  EXPECT_EQ(read.commits, written.commits);
  ASSERT_EQ(read.history.size(), 2U);
  EXPECT_EQ(read.history[1].epoch, 2);
  EXPECT_EQ(read.history[1].training_error, 0.25);
  EXPECT_EQ(read.history[1].validation_error, 0.75);
  EXPECT_EQ(read.learner, written.learner);
  EXPECT_EQ(read.best_parameters, written.best_parameters);
  EXPECT_EQ(read.best_codes, written.best_codes);
}

TEST(Checkpoint, ADamagedByteOrACutAnywhereIsFound) {
  const input::TestFolder folder;
  write_checkpoint(folder.at("checkpoint"), small_checkpoint());
  const std::string good = core::read_file(folder.at("checkpoint"));
  const auto complaint_of = [&](const std::string& bytes) {
    std::ofstream(folder.at("damaged"), std::ios::binary) << bytes;  // sooner done than write_file
    return complaint([&] { read_checkpoint(folder.at("damaged")); });
  };
  for (std::size_t i = 0; i < good.size(); ++i) {
    std::string flipped = good;
    flipped[i] = static_cast<char>(flipped[i] ^ 1);
    EXPECT_THAT(complaint_of(flipped), AllOf(HasSubstr("/damaged: "), HasSubstr("remove it")))
        << "byte " << i;
    EXPECT_THAT(complaint_of(good.substr(0, i)), HasSubstr("/damaged: ")) << i << " bytes";
  }
  EXPECT_THAT(complaint_of(good + "x"), HasSubstr("/damaged: "));
}

TEST(Checkpoint, AForeignFileIsOfAnotherFormat) {
  const input::TestFolder folder;
  for (const char* text : {"", "\n", "a shopping list", "{}", R"({"format": 1})", "[1]"}) {
    folder.write("foreign", text);
    EXPECT_THAT(complaint([&] { read_checkpoint(folder.at("foreign")); }),
                AllOf(HasSubstr("/foreign: "), HasSubstr("another format")))
        << text;
  }
}

}  // namespace
}  // namespace samewhere::train
