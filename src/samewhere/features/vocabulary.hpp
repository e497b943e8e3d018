#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <vector>

#include <opencv2/core/mat.hpp>

#include <samewhere/features/describe.hpp>

namespace samewhere::features {

// A visual word: the leaf of the vocabulary that a descriptor falls into.
using Word = std::uint32_t;

// A tree of binary descriptors (Nister and Stewenius 2006, for binary ones Galvez-Lopez and Tardos
// 2012): a descriptor falls from the root to whichever child is nearest, of equals the first; the
// leaves are the words.
class Vocabulary {
 public:
  struct Node {
    std::array<std::uint8_t, kDescriptorBytes> centre{};
    std::uint32_t first_child = 0;  // the others follow it
    std::uint32_t num_children = 0;
    Word word = 0;  // of a leaf
  };

  // Node 0 is the root; children come after their parent. `pictures_with` says of each word in how
  // many of `num_pictures` pictures it was seen when the vocabulary was grown. Throws ContractError
  // unless that is a tree with as many leaves.
  Vocabulary(std::vector<Node> nodes, std::vector<std::uint32_t> pictures_with,
             std::uint32_t num_pictures);

  int num_words() const { return static_cast<int>(pictures_with_.size()); }
  // Of one descriptor, kDescriptorBytes long.
  Word word_of(const unsigned char* descriptor) const;
  // Of each row.
  std::vector<Word> words_of(const cv::Mat& descriptors) const;

  // How common words are elsewhere.
  std::uint32_t num_pictures() const { return num_pictures_; }
  std::uint32_t pictures_with(Word word) const { return pictures_with_[word]; }

  const std::vector<Node>& nodes() const { return nodes_; }

 private:
  std::vector<Node> nodes_;
  std::vector<std::uint32_t> pictures_with_;
  std::uint32_t num_pictures_;
};

// A vocabulary on disk, little-endian: "samewhere words " (16 bytes), version (u32, now 1), number
// of nodes, of words and of pictures (u32 each); the nodes (centre, first child, number of
// children, word: 32 bytes and three u32), pictures_with (u32 each), and core::checksum of all
// bytes before (u64). Throws InputError if it cannot be written.
void save_vocabulary(const Vocabulary& vocabulary, const std::filesystem::path& path);

// A file of save_vocabulary, or of another program, told apart by what it holds: DBoW2's text and
// YAML (dbow2_vocabulary.hpp), FBoW's (fbow_vocabulary.hpp), each also compressed by gzip. Words of
// others fit only descriptors of the same comparisons of pixels: those of OpenCV's ORB are not ours
// (pattern.hpp). Throws InputError naming the file and what was expected if it is none, cut short,
// damaged or of another version.
Vocabulary load_vocabulary(const std::filesystem::path& path);

}  // namespace samewhere::features
