#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string_view>
#include <vector>

#include <samewhere/features/vocabulary.hpp>

namespace samewhere::features {

// A node of a vocabulary of another program, as its file tells of it.
struct ForeignNode {
  std::array<std::uint8_t, kDescriptorBytes> centre{};
  std::uint32_t parent = 0;  // index; of the root nothing
  double weight = 0.0;       // inverse document frequency; of a word
  bool is_word = false;
};

// Nodes of one vocabulary, the root first. More children of a node or more levels than these are
// refused.
struct ForeignTree {
  std::vector<ForeignNode> nodes;
  std::uint32_t max_children = 0;
  std::uint32_t max_depth = 0;
};

// Pictures that a vocabulary of another program is taken to be grown of: a word of weight w was
// seen in exp(-w) of them.
inline constexpr std::uint32_t kForeignPictures = 1'000'000'000;

// "PATH: WHY".
[[noreturn]] void refuse_vocabulary(const std::filesystem::path& path, std::string_view why);

// The vocabulary of a foreign tree, its words numbered from the root outwards. Throws InputError
// naming the file if its nodes are no tree whose leaves are the words, or a weight is negative.
Vocabulary vocabulary_of(const ForeignTree& tree, const std::filesystem::path& path);

}  // namespace samewhere::features
