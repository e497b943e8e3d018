#include <cstring>

#include <gmock/gmock.h>
#include <opencv2/core.hpp>
#include <unistd.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>
#include <samewhere/core/random.hpp>
#include <samewhere/features/grow_vocabulary.hpp>
#include <samewhere/features/hamming.hpp>

namespace samewhere::features {
namespace {

using testing::HasSubstr;

cv::Mat random_descriptors(core::Random& random, int count) {
  cv::Mat descriptors(count, kDescriptorBytes, CV_8U);
  for (int i = 0; i < count; ++i) {
    for (int k = 0; k < kDescriptorBytes; ++k)
      descriptors.at<std::uint8_t>(i, k) = static_cast<std::uint8_t>(random.index(256));
  }
  return descriptors;
}

// Each row of `kinds` so many times, with a few bits flipped.
cv::Mat seen_again(const cv::Mat& kinds, int times, core::Random& random) {
  constexpr int kNumFlipped = 8;
  cv::Mat descriptors(0, kDescriptorBytes, CV_8U);
  for (int i = 0; i < kinds.rows * times; ++i) {
    cv::Mat row = kinds.row(i % kinds.rows).clone();
    for (int flip = 0; flip < kNumFlipped; ++flip) {
      const std::uint64_t bit = random.index(8 * kDescriptorBytes);
      row.at<std::uint8_t>(0, static_cast<int>(bit / 8)) ^=
          static_cast<std::uint8_t>(1U << bit % 8);
    }
    descriptors.push_back(row);
  }
  return descriptors;
}

TEST(Hamming, CountsTheBitsThatDiffer) {
  core::Random random(1);
  const cv::Mat all = random_descriptors(random, 50);
  std::vector<std::int16_t> bits(50);
  distances_bits(all.ptr(3), all.ptr(), bits);
  for (int i = 0; i < all.rows; ++i) {
    int expected = 0;
    for (int bit = 0; bit < 8 * kDescriptorBytes; ++bit)
      expected += ((all.ptr(3)[bit / 8] ^ all.ptr(i)[bit / 8]) >> bit % 8) & 1;
    EXPECT_EQ(bits[static_cast<std::size_t>(i)], expected);
    EXPECT_EQ(distance_bits(all.ptr(3), all.ptr(i)), expected);
  }
  EXPECT_EQ(bits[3], 0);
}

TEST(Vocabulary, WhatLooksAlikeIsOneWord) {
  core::Random random(2);
  const cv::Mat kinds = random_descriptors(random, 20);
  const Vocabulary vocabulary =
      grow_vocabulary({seen_again(kinds, 30, random)}, {.branching = 5, .depth = 3});
  EXPECT_LE(vocabulary.num_words(), 125);
  const std::vector<Word> words = vocabulary.words_of(kinds);
  EXPECT_EQ(std::set<Word>(words.begin(), words.end()).size(), 20U);
  const cv::Mat again = seen_again(kinds, 10, random);
  int num_same = 0;
  for (int i = 0; i < again.rows; ++i)
    num_same += vocabulary.word_of(again.ptr(i)) == words[static_cast<std::size_t>(i % 20)] ? 1 : 0;
  EXPECT_GE(num_same, 100) << "of 200; the rest falls to neighbours that split one kind";
}

TEST(Vocabulary, KnowsInHowManyPicturesAWordIs) {
  core::Random random(3);
  const cv::Mat kinds = random_descriptors(random, 2);
  const cv::Mat common = kinds.row(0);
  cv::Mat both = kinds.clone();
  both.push_back(common);  // twice in one picture
  const Vocabulary vocabulary =
      grow_vocabulary({common, both, common}, {.branching = 2, .depth = 4});
  ASSERT_EQ(vocabulary.num_words(), 2);
  EXPECT_EQ(vocabulary.num_pictures(), 3U);
  EXPECT_EQ(vocabulary.pictures_with(vocabulary.word_of(kinds.ptr(0))), 3U);
  EXPECT_EQ(vocabulary.pictures_with(vocabulary.word_of(kinds.ptr(1))), 1U);
}

TEST(Vocabulary, OfDescriptorsThatAreAllTheSameIsOneWord) {
  core::Random random(4);
  const cv::Mat same = cv::repeat(random_descriptors(random, 1), 12, 1);
  EXPECT_EQ(grow_vocabulary({same}, {}).num_words(), 1);
}

class VocabularyFile : public testing::Test {
 protected:
  ~VocabularyFile() override { std::filesystem::remove(path_); }

  std::string complaint(const std::string& bytes) const {
    core::write_file(path_, bytes);
    try {
      load_vocabulary(path_);
    } catch (const core::InputError& error) {
      return error.what();
    }
    return "none";
  }

  std::filesystem::path path_ = testing::TempDir() + "vocabulary_" + std::to_string(getpid());
};

TEST_F(VocabularyFile, IsReadAsItWasWrittenAndDamageIsNamed) {
  core::Random random(5);
  const cv::Mat kinds = random_descriptors(random, 30);
  const Vocabulary written =
      grow_vocabulary({seen_again(kinds, 5, random)}, {.branching = 3, .depth = 3});
  save_vocabulary(written, path_);
  const Vocabulary found = load_vocabulary(path_);
  EXPECT_EQ(found.words_of(kinds), written.words_of(kinds));
  EXPECT_EQ(found.num_pictures(), written.num_pictures());
  for (Word word = 0; word < static_cast<Word>(written.num_words()); ++word)
    EXPECT_EQ(found.pictures_with(word), written.pictures_with(word));

  const std::string whole = core::read_file(path_);
  EXPECT_THAT(complaint("a text that is no vocabulary"), HasSubstr("is no vocabulary"));
  for (const std::size_t size : {std::size_t{20}, whole.size() / 2, whole.size() - 1})
    EXPECT_THAT(complaint(whole.substr(0, size)), HasSubstr("is cut short"));
  for (int i = 0; i < 50; ++i) {
    std::string hurt = whole;
    const std::uint64_t at = 20 + random.index(whole.size() - 20);
    hurt[at] = static_cast<char>(hurt[at] ^ 1);
    EXPECT_THAT(complaint(hurt), HasSubstr("damaged")) << "byte " << at;
  }
  std::string newer = whole;
  newer[16] = 9;
  EXPECT_THAT(complaint(newer), HasSubstr("of version 9; expected version 1"));
}

}  // namespace
}  // namespace samewhere::features
