// `samewhere info` on a download of a known data set.

#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "program.hpp"
#include <samewhere/input/test_folder.hpp>

namespace samewhere::test {
namespace {

using testing::ContainsRegex;
using testing::HasSubstr;
using testing::Not;

class InfoCommand : public testing::Test {
 protected:
  static constexpr int kNumImages = 45;

  void write_lip6() const {
    for (int i = 0; i < kNumImages; ++i)
      folder_.write_jpeg(fmt::format("Lip6Indoor/Images/lip6kennedy_bigdoubleloop_{:06}.jpg", i),
                         input::picture(32, 24));
  }

  // Image 40 shows the place of image 5.
  void write_matrix() const {
    std::string text;
    for (int row = 0; row < kNumImages; ++row) {
      for (int column = 0; column < kNumImages; ++column)
        text += row == 40 && column == 5 ? "1 " : "0 ";
      text += '\n';
    }
    folder_.write("Lip6Indoor/Lip6IndoorGroundTruth.txt", text);
  }

  std::string info(const std::string& rest = "") const {
    const Outcome outcome =
        run_program("info " + quoted(folder_.root() / "Lip6Indoor") + " " + rest, folder_.root());
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return outcome.out;
  }

  input::TestFolder folder_;
};

TEST_F(InfoCommand, TellsInOneLineWhatADownloadLacks) {
  write_lip6();
  EXPECT_THAT(info(), ContainsRegex("missing +343 of 388 images; truth of places: Lip6Indoor"));
  write_matrix();
  const std::string out = info();
  EXPECT_THAT(out, ContainsRegex("missing +343 of 388 images\n"));
  EXPECT_THAT(out, ContainsRegex("data set +Lip6 Indoor"));
  EXPECT_THAT(out, ContainsRegex("exclusion window +30 s, 30 frames"));
  EXPECT_THAT(out, ContainsRegex("tolerance of the truth +10 frames"));
  EXPECT_THAT(out, ContainsRegex("truth of places +1 of 45 queries have a loop"));
}

TEST_F(InfoCommand, AWindowOfTheUserReplacesThatOfTheProtocol) {
  write_lip6();
  write_matrix();
  EXPECT_THAT(info("--set retrieve.window_frames=36 --set input.truth_tolerance_frames=0"),
              ContainsRegex("truth of places +0 of 45 queries have a loop"));
}

TEST_F(InfoCommand, OtherFoldersHaveNoProtocol) {
  folder_.write_jpeg("mine/1.jpg", input::picture(32, 24));
  const Outcome outcome = run_program("info " + quoted(folder_.root() / "mine"), folder_.root());
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, Not(HasSubstr("missing")));
}

}  // namespace
}  // namespace samewhere::test
