#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/model_file.hpp>

namespace samewhere::core {
namespace {

namespace fs = std::filesystem;

// In a working directory of its own that holds files of any content.
class ModelFile : public testing::Test {
 protected:
  ModelFile() {
    fs::create_directories(folder_ / "mine");
    fs::current_path(folder_);
    for (const char* name : {"words.bin", "other.bin", "mine/words.bin"})
      std::ofstream(folder_ / name) << "forged";
  }
  ~ModelFile() override {
    fs::current_path(before_);
    fs::remove_all(folder_);
  }
  ModelFile(const ModelFile&) = delete;
  ModelFile& operator=(const ModelFile&) = delete;

  static fs::path found(const std::string& file) {
    return find_model("retrieve.vocabulary", file, "a vocabulary");
  }

  fs::path before_ = fs::current_path();
  fs::path folder_ =
      fs::path(testing::TempDir()) / ("samewhere_model_file_" + std::to_string(getpid()));
};

TEST_F(ModelFile, OfTheWorkingDirectoryIsNotTakenForAShippedOne) {
  testing::internal::CaptureStdout();
  const fs::path words = found("words.bin");
  EXPECT_THAT(testing::internal::GetCapturedStdout(),
              testing::HasSubstr("./words.bin is that one"));
  EXPECT_TRUE(words.is_absolute()) << words;
  EXPECT_FALSE(fs::equivalent(words, folder_ / "words.bin"));
}

TEST_F(ModelFile, APathIsThatFile) {
  EXPECT_EQ(found("./words.bin"), "./words.bin");
  EXPECT_EQ(found("mine/words.bin"), "mine/words.bin");
  EXPECT_EQ(found("other.bin"), "other.bin") << "there is none with the program";
}

TEST_F(ModelFile, OneThatIsNowhereIsNamedWithItsSetting) {
  for (const char* name : {"nowhere.bin", "mine/nowhere.bin", ""}) {
    try {
      found(name);
      ADD_FAILURE() << name;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr("there is no such file"));
    }
  }
}

}  // namespace
}  // namespace samewhere::core
