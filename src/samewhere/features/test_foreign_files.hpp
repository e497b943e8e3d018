#pragma once

#include <cmath>
#include <cstring>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <opencv2/core/mat.hpp>
#include <unistd.h>
#include <zlib.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>
#include <samewhere/core/random.hpp>
#include <samewhere/features/grow_vocabulary.hpp>

namespace samewhere::features {

// Files of vocabularies as other programs write them, for tests only.
class ForeignFiles : public testing::Test {
 protected:
  ForeignFiles() {
    core::Random random(11);
    for (int i = 0; i < kinds.rows; ++i) {
      for (int k = 0; k < kinds.cols; ++k)
        kinds.at<std::uint8_t>(i, k) = static_cast<std::uint8_t>(random.index(256));
    }
    vocabulary = std::make_shared<const Vocabulary>(grow_vocabulary(
        {kinds, kinds.rowRange(0, 3), kinds.rowRange(2, 9)}, {.branching = 3, .depth = 4}));
  }

  ~ForeignFiles() override { std::filesystem::remove(path_); }

  const std::vector<Vocabulary::Node>& nodes() const { return vocabulary->nodes(); }

  // ln(pictures / pictures with the word), as DBoW2 has it.
  double weight_of(const Vocabulary::Node& node) const {
    if (node.num_children > 0) return 0.0;
    return std::log(static_cast<double>(vocabulary->num_pictures()) /
                    vocabulary->pictures_with(node.word));
  }

  std::vector<std::uint32_t> parents() const {
    std::vector<std::uint32_t> parents(nodes().size(), 0);
    for (std::uint32_t i = 0; i < nodes().size(); ++i) {
      for (std::uint32_t k = 0; k < nodes()[i].num_children; ++k)
        parents[nodes()[i].first_child + k] = i;
    }
    return parents;
  }

  static std::string bytes_of(const Vocabulary::Node& node) {
    std::string text;
    for (const std::uint8_t byte : node.centre) text += fmt::format("{} ", byte);
    return text;
  }

  std::string dbow2_text() const {
    std::string text = "3 4  0 0\n";
    const auto parent = parents();
    for (std::size_t i = 1; i < nodes().size(); ++i) {
      const Vocabulary::Node& node = nodes()[i];
      text += fmt::format("{} {} {} {:.6}\n", parent[i], node.num_children == 0 ? 1 : 0,
                          bytes_of(node), weight_of(node));
    }
    return text;
  }

  std::string dbow2_yaml() const {
    std::string text =
        "%YAML:1.0\n---\nvocabulary:\n   k: 3\n   L: 4\n   scoringType: 0\n   weightingType: 0\n"
        "   nodes:\n";
    std::string words = "   words:\n";
    const auto parent = parents();
    for (std::size_t i = 1; i < nodes().size(); ++i) {
      const Vocabulary::Node& node = nodes()[i];
      text += fmt::format(
          "      - {{ nodeId:{}, parentId:{}, weight:{:.17e},\n          descriptor:\"{}\" }}\n", i,
          parent[i], weight_of(node), bytes_of(node));
      if (node.num_children == 0)
        words += fmt::format("      - {{ wordId:{}, nodeId:{} }}\n", node.word, i);
    }
    return text + words;
  }

  template <class T>
  static void put(std::string& bytes, std::size_t at, T value) {
    std::memcpy(bytes.data() + at, &value, sizeof value);
  }

  // One block per inner node, in the order of the nodes.
  std::string fbow() const {
    constexpr std::size_t kBlock = 8 + 3 * 32 + 3 * 8;
    std::vector<std::uint32_t> block_of(nodes().size(), 0);
    std::uint32_t num_blocks = 0;
    for (std::size_t i = 0; i < nodes().size(); ++i) {
      if (nodes()[i].num_children > 0) block_of[i] = num_blocks++;
    }
    std::string bytes(128 + num_blocks * kBlock, '\0');
    put<std::uint64_t>(bytes, 0, 55824124);
    put<std::uint32_t>(bytes, 60, 8);
    put<std::uint32_t>(bytes, 64, num_blocks);
    put<std::uint64_t>(bytes, 72, 32);
    put<std::uint64_t>(bytes, 80, kBlock);
    put<std::uint64_t>(bytes, 88, 8);
    put<std::uint64_t>(bytes, 96, 8 + 3 * 32);
    put<std::uint64_t>(bytes, 104, num_blocks * kBlock);
    put<std::int32_t>(bytes, 116, 32);
    put<std::uint32_t>(bytes, 120, 3);
    for (std::size_t i = 0; i < nodes().size(); ++i) {
      const Vocabulary::Node& node = nodes()[i];
      const std::size_t begin = 128 + block_of[i] * kBlock;
      if (node.num_children > 0) put(bytes, begin, static_cast<std::uint16_t>(node.num_children));
      for (std::uint32_t k = 0; k < node.num_children; ++k) {
        const Vocabulary::Node& child = nodes()[node.first_child + k];
        std::memcpy(bytes.data() + begin + 8 + k * 32, child.centre.data(), 32);
        put(bytes, begin + 8 + 96 + k * 8,
            child.num_children == 0 ? 0x8000'0000U | child.word : block_of[node.first_child + k]);
        put(bytes, begin + 8 + 96 + k * 8 + 4, static_cast<float>(weight_of(child)));
      }
    }
    return bytes;
  }

  static std::string gzip(std::string text) {
    z_stream stream{};
    deflateInit2(&stream, 6, Z_DEFLATED, 15 + 16, 8, Z_DEFAULT_STRATEGY);
    std::string out(deflateBound(&stream, text.size()), '\0');
    stream.next_in = reinterpret_cast<Bytef*>(text.data());
    stream.avail_in = static_cast<uInt>(text.size());
    stream.next_out = reinterpret_cast<Bytef*>(out.data());
    stream.avail_out = static_cast<uInt>(out.size());
    deflate(&stream, Z_FINISH);
    const std::size_t num_bytes = out.size() - stream.avail_out;
    deflateEnd(&stream);
    return out.substr(0, num_bytes);
  }

  Vocabulary load(const std::string& bytes) const {
    core::write_file(path_, bytes);
    return load_vocabulary(path_);
  }

  // Whether a vocabulary says the same of descriptors and of words as the one that was written.
  void expect_same(const Vocabulary& found) const {
    ASSERT_EQ(found.num_words(), vocabulary->num_words());
    for (int i = 0; i < kinds.rows; ++i) {
      const double expected = vocabulary->pictures_with(vocabulary->word_of(kinds.ptr(i)));
      EXPECT_NEAR(found.pictures_with(found.word_of(kinds.ptr(i))) / 1e9,
                  expected / vocabulary->num_pictures(), 1e-5);
    }
    for (std::size_t i = 0; i < nodes().size(); ++i)
      EXPECT_EQ(found.nodes()[i].centre, nodes()[i].centre);
  }

  std::string complaint(const std::string& bytes) const {
    try {
      load(bytes);
    } catch (const core::InputError& error) {
      const std::string what = error.what();
      return what.find('\n') == std::string::npos ? what : "of several lines: " + what;
    }
    return "none";
  }

  cv::Mat kinds = cv::Mat(60, kDescriptorBytes, CV_8U);
  std::shared_ptr<const Vocabulary> vocabulary;

  std::filesystem::path path_ =
      testing::TempDir() + "foreign_vocabulary_" + std::to_string(getpid());
};

}  // namespace samewhere::features
