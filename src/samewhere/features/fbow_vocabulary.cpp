#include <bit>
#include <cstring>
#include <vector>

#include <fmt/format.h>

#include <samewhere/features/fbow_vocabulary.hpp>

namespace samewhere::features {
namespace {

static_assert(std::endian::native == std::endian::little, "the file is read as memory has it");

constexpr std::uint64_t kSignature = 55824124;
constexpr std::uint32_t kWordBit = 0x8000'0000U;
constexpr std::uint32_t kMaxChildren = 1000;
constexpr std::uint32_t kMaxFbowDepth = 32;
constexpr std::size_t kBlocksBegin = 128;
constexpr std::size_t kChildBytes = 8;

// Where the sizes are, from the beginning of the file.
constexpr std::size_t kAtNumBlocks = 64;
constexpr std::size_t kAtDescriptorStride = 72;
constexpr std::size_t kAtBlockBytes = 80;
constexpr std::size_t kAtDescriptors = 88;
constexpr std::size_t kAtChildren = 96;
constexpr std::size_t kAtTotalBytes = 104;
constexpr std::size_t kAtDescriptorType = 112;
constexpr std::size_t kAtDescriptorBytes = 116;
constexpr std::size_t kAtBranching = 120;

template <class T>
T value_at(std::string_view bytes, std::size_t at) {
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

struct Layout {
  std::uint64_t num_blocks;
  std::uint64_t block_bytes;
  std::uint64_t stride;       // from one descriptor to the next
  std::uint64_t descriptors;  // in a block
  std::uint64_t children;     // in a block
  std::uint64_t branching;
};

// Each size is compared before it is multiplied, so that none runs over.
bool fits(const Layout& layout, std::uint64_t total_bytes) {
  if (layout.branching < 2 || layout.branching > kMaxChildren) return false;
  if (layout.block_bytes == 0 || layout.block_bytes > total_bytes) return false;
  if (layout.stride < kDescriptorBytes || layout.stride > layout.block_bytes) return false;
  if (layout.descriptors < 4 || layout.descriptors > layout.block_bytes) return false;
  if (layout.children > layout.block_bytes) return false;
  return layout.descriptors + layout.branching * layout.stride <= layout.block_bytes &&
         layout.children + layout.branching * kChildBytes <= layout.block_bytes &&
         total_bytes % layout.block_bytes == 0 &&
         layout.num_blocks == total_bytes / layout.block_bytes;
}

Layout layout_of(std::string_view bytes, const std::filesystem::path& path) {
  if (bytes.size() < kBlocksBegin) refuse_vocabulary(path, "is cut short");
  if (value_at<std::int32_t>(bytes, kAtDescriptorType) != 0 ||
      value_at<std::int32_t>(bytes, kAtDescriptorBytes) != kDescriptorBytes) {
    refuse_vocabulary(
        path, fmt::format("is an FBoW vocabulary of descriptors of {} bytes, type "
                          "{}; expected {} bytes, type 0 (ORB)",
                          value_at<std::int32_t>(bytes, kAtDescriptorBytes),
                          value_at<std::int32_t>(bytes, kAtDescriptorType), kDescriptorBytes));
  }
  const Layout layout{.num_blocks = value_at<std::uint32_t>(bytes, kAtNumBlocks),
                      .block_bytes = value_at<std::uint64_t>(bytes, kAtBlockBytes),
                      .stride = value_at<std::uint64_t>(bytes, kAtDescriptorStride),
                      .descriptors = value_at<std::uint64_t>(bytes, kAtDescriptors),
                      .children = value_at<std::uint64_t>(bytes, kAtChildren),
                      .branching = value_at<std::uint32_t>(bytes, kAtBranching)};
  const std::uint64_t total_bytes = value_at<std::uint64_t>(bytes, kAtTotalBytes);
  if (total_bytes != bytes.size() - kBlocksBegin || !fits(layout, total_bytes)) {
    refuse_vocabulary(path, fmt::format("is cut short or damaged: {} blocks of {} bytes; expected "
                                        "{} bytes behind its sizes, found {}",
                                        layout.num_blocks, layout.block_bytes, total_bytes,
                                        bytes.size() - kBlocksBegin));
  }
  return layout;
}

// A block that is to be read, and the node whose children are in it.
struct OpenBlock {
  std::uint32_t block;
  std::uint32_t parent;
};

ForeignNode child_of(std::string_view block, const Layout& layout, std::size_t child,
                     std::uint32_t parent) {
  ForeignNode node;
  std::memcpy(node.centre.data(), block.data() + layout.descriptors + child * layout.stride,
              node.centre.size());
  const std::size_t at = layout.children + child * kChildBytes;
  node.is_word = (value_at<std::uint32_t>(block, at) & kWordBit) != 0;
  node.weight = node.is_word ? value_at<float>(block, at + 4) : 0.0;
  node.parent = parent;
  return node;
}

}  // namespace

bool looks_like_fbow(std::string_view bytes) {
  return bytes.size() >= sizeof kSignature && value_at<std::uint64_t>(bytes, 0) == kSignature;
}

ForeignTree read_fbow(std::string_view bytes, const std::filesystem::path& path) {
  const Layout layout = layout_of(bytes, path);
  ForeignTree tree{.nodes = std::vector<ForeignNode>(1),
                   .max_children = static_cast<std::uint32_t>(layout.branching),
                   .max_depth = kMaxFbowDepth};
  std::vector<char> is_read(layout.num_blocks, 0);
  std::vector<OpenBlock> open{{0, 0}};
  for (std::size_t next = 0; next < open.size(); ++next) {
    const auto [number, parent] = open[next];
    if (number >= layout.num_blocks || is_read[number] != 0) {
      refuse_vocabulary(path, fmt::format("has a second parent of block {}, or none of its {} "
                                          "blocks there",
                                          number, layout.num_blocks));
    }
    is_read[number] = 1;
    const std::string_view block =
        bytes.substr(kBlocksBegin + number * layout.block_bytes, layout.block_bytes);
    const auto num_children = value_at<std::uint16_t>(block, 0);
    if (num_children > layout.branching) {
      refuse_vocabulary(path, fmt::format("block {} has {} children; expected at most {}", number,
                                          num_children, layout.branching));
    }
    for (std::size_t child = 0; child < num_children; ++child) {
      const auto node = static_cast<std::uint32_t>(tree.nodes.size());
      tree.nodes.push_back(child_of(block, layout, child, parent));
      const std::size_t at = layout.children + child * kChildBytes;
      if (!tree.nodes.back().is_word) open.push_back({value_at<std::uint32_t>(block, at), node});
    }
  }
  return tree;
}

}  // namespace samewhere::features
