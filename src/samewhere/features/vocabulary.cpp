#include <bit>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

#include <fmt/format.h>

#include <samewhere/core/checksum.hpp>
#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>
#include <samewhere/features/dbow2_vocabulary.hpp>
#include <samewhere/features/fbow_vocabulary.hpp>
#include <samewhere/features/gunzip.hpp>
#include <samewhere/features/hamming.hpp>
#include <samewhere/features/vocabulary.hpp>
#include <samewhere/features/vocabulary_tree.hpp>

namespace samewhere::features {
namespace {

using Node = Vocabulary::Node;

static_assert(std::endian::native == std::endian::little, "the file is written as memory has it");
static_assert(sizeof(Node) == kDescriptorBytes + 12 && std::is_trivially_copyable_v<Node>);

constexpr std::string_view kMagic = "samewhere words ";
constexpr std::uint32_t kVersion = 1;

struct Header {
  std::uint32_t version = kVersion;
  std::uint32_t num_nodes = 0;
  std::uint32_t num_words = 0;
  std::uint32_t num_pictures = 0;
};
static_assert(sizeof(Header) == 16);

constexpr std::size_t kHeaderEnd = kMagic.size() + sizeof(Header);

// Whether every node but the root is the child of exactly one before it, and the leaves are the
// words.
bool is_tree(const std::vector<Node>& nodes, std::size_t num_words) {
  if (nodes.empty()) return false;
  std::vector<char> is_word(num_words, 0);
  std::uint64_t next_child = 1;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const Node& node = nodes[i];
    if (node.num_children == 0) {
      if (node.word >= num_words || is_word[node.word] != 0) return false;
      is_word[node.word] = 1;
    } else {
      if (node.first_child != next_child || next_child <= i) return false;
      next_child += node.num_children;
    }
  }
  return next_child == nodes.size() &&
         std::string_view(is_word.data(), num_words).find('\0') == std::string_view::npos;
}

template <class T>
std::string_view bytes_of(const std::vector<T>& values) {
  return {reinterpret_cast<const char*>(values.data()), sizeof(T) * values.size()};
}

template <class T>
std::vector<T> values_of(std::string_view bytes, std::size_t count) {
  std::vector<T> values(count);
  std::memcpy(static_cast<void*>(values.data()), bytes.data(), sizeof(T) * count);
  return values;
}

Vocabulary read_own(std::string_view bytes, const std::filesystem::path& path) {
  if (bytes.size() < kHeaderEnd + sizeof(std::uint64_t)) refuse_vocabulary(path, "is cut short");
  Header header;
  std::memcpy(&header, bytes.data() + kMagic.size(), sizeof header);
  if (header.version != kVersion) {
    refuse_vocabulary(path, fmt::format("is a vocabulary of version {}; expected version {}",
                                        header.version, kVersion));
  }
  const std::uint64_t content_end = kHeaderEnd + std::uint64_t{header.num_nodes} * sizeof(Node) +
                                    std::uint64_t{header.num_words} * sizeof(std::uint32_t);
  if (bytes.size() != content_end + sizeof(std::uint64_t)) {
    refuse_vocabulary(
        path, fmt::format("is cut short or damaged: {} bytes; expected {} for {} words",
                          bytes.size(), content_end + sizeof(std::uint64_t), header.num_words));
  }
  if (values_of<std::uint64_t>(bytes.substr(content_end), 1)[0] !=
      core::checksum(bytes.substr(0, content_end)))
    refuse_vocabulary(path, "is damaged: its checksum does not fit what it holds");
  auto nodes = values_of<Node>(bytes.substr(kHeaderEnd), header.num_nodes);
  if (!is_tree(nodes, header.num_words))
    refuse_vocabulary(path, "is damaged: its words are no tree");
  const std::size_t words_begin = kHeaderEnd + sizeof(Node) * nodes.size();
  return {std::move(nodes), values_of<std::uint32_t>(bytes.substr(words_begin), header.num_words),
          header.num_pictures};
}

}  // namespace

Vocabulary::Vocabulary(std::vector<Node> nodes, std::vector<std::uint32_t> pictures_with,
                       std::uint32_t num_pictures)
    : nodes_(std::move(nodes)),
      pictures_with_(std::move(pictures_with)),
      num_pictures_(num_pictures) {
  core::require(is_tree(nodes_, pictures_with_.size()), "a vocabulary is a tree of its words");
}

Word Vocabulary::word_of(const unsigned char* descriptor) const {
  const Node* node = nodes_.data();
  while (node->num_children > 0) {
    const Node* child = nodes_.data() + node->first_child;
    const Node* best = child;
    int best_bits = distance_bits(descriptor, child->centre.data());
    for (std::uint32_t i = 1; i < node->num_children; ++i) {
      const int bits = distance_bits(descriptor, child[i].centre.data());
      if (bits >= best_bits) continue;
      best_bits = bits;
      best = child + i;
    }
    node = best;
  }
  return node->word;
}

std::vector<Word> Vocabulary::words_of(const cv::Mat& descriptors) const {
  std::vector<Word> words;
  for (int i = 0; i < descriptors.rows; ++i) words.push_back(word_of(descriptors.ptr(i)));
  return words;
}

void save_vocabulary(const Vocabulary& vocabulary, const std::filesystem::path& path) {
  std::vector<std::uint32_t> pictures_with;
  for (int word = 0; word < vocabulary.num_words(); ++word)
    pictures_with.push_back(vocabulary.pictures_with(static_cast<Word>(word)));
  const Header header{.num_nodes = static_cast<std::uint32_t>(vocabulary.nodes().size()),
                      .num_words = static_cast<std::uint32_t>(vocabulary.num_words()),
                      .num_pictures = vocabulary.num_pictures()};
  std::string bytes(kMagic);
  bytes.append(reinterpret_cast<const char*>(&header), sizeof header);
  bytes += bytes_of(vocabulary.nodes());
  bytes += bytes_of(pictures_with);
  const std::uint64_t checksum = core::checksum(bytes);
  bytes.append(reinterpret_cast<const char*>(&checksum), sizeof checksum);
  core::write_file(path, bytes);
}

Vocabulary load_vocabulary(const std::filesystem::path& path) {
  std::string file = core::read_file(path, core::kNetworkLimit);
  if (looks_like_gzip(file)) file = gunzip(file, core::kNetworkLimit, path);
  if (file.starts_with(kMagic)) return read_own(file, path);
  if (looks_like_fbow(file)) return vocabulary_of(read_fbow(file, path), path);
  if (looks_like_dbow2_yaml(file)) return vocabulary_of(read_dbow2_yaml(file, path), path);
  if (looks_like_dbow2_text(file)) return vocabulary_of(read_dbow2_text(file, path), path);
  refuse_vocabulary(path,
                    "is no vocabulary; expected a file of `samewhere train words`, of DBoW2 "
                    "(text or YAML) or of FBoW");
}

}  // namespace samewhere::features
