#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/features/vocabulary_tree.hpp>

namespace samewhere::features {
namespace {

// The children of all nodes, those of a node one behind the other in the order of the file.
struct Children {
  std::vector<std::uint32_t> begin;  // by parent, and one more
  std::vector<std::uint32_t> nodes;

  std::uint32_t num_of(std::uint32_t parent) const { return begin[parent + 1] - begin[parent]; }
};

Children children_of(const std::vector<ForeignNode>& nodes, const std::filesystem::path& path) {
  Children children;
  children.begin.assign(nodes.size() + 1, 0);
  children.nodes.resize(nodes.size() - 1);
  for (std::size_t i = 1; i < nodes.size(); ++i) {
    if (nodes[i].parent >= nodes.size()) {
      refuse_vocabulary(path, fmt::format("node {} has the parent {}; expected one of its {} nodes",
                                          i, nodes[i].parent, nodes.size()));
    }
    ++children.begin[nodes[i].parent + 1];
  }
  for (std::size_t i = 0; i < nodes.size(); ++i) children.begin[i + 1] += children.begin[i];
  std::vector<std::uint32_t> next(children.begin.begin(), children.begin.end() - 1);
  for (std::size_t i = 1; i < nodes.size(); ++i)
    children.nodes[next[nodes[i].parent]++] = static_cast<std::uint32_t>(i);
  return children;
}

void check_node(const ForeignTree& tree, std::uint32_t node, std::uint32_t num_children,
                const std::filesystem::path& path) {
  const ForeignNode& found = tree.nodes[node];
  if (num_children > tree.max_children) {
    refuse_vocabulary(path, fmt::format("node {} has {} children; expected at most {}", node,
                                        num_children, tree.max_children));
  }
  if (found.is_word && num_children > 0)
    refuse_vocabulary(path, fmt::format("node {} is a word, yet it has children", node));
  if (!found.is_word && num_children == 0) {
    refuse_vocabulary(path, fmt::format("is cut short or damaged: node {} has no children and is "
                                        "no word",
                                        node));
  }
  if (!std::isfinite(found.weight) || found.weight < 0.0) {
    refuse_vocabulary(
        path, fmt::format("node {} has the weight {}; expected 0 or more", node, found.weight));
  }
}

// Nodes as they are reached from the root, level by level.
std::vector<std::uint32_t> level_order(const ForeignTree& tree, const Children& children,
                                       const std::filesystem::path& path) {
  std::vector<std::uint32_t> order{0};
  std::size_t level_end = 1;
  std::uint32_t depth = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (i == level_end) {
      level_end = order.size();
      if (++depth > tree.max_depth) {
        refuse_vocabulary(path,
                          fmt::format("has more levels than the {} expected", tree.max_depth));
      }
    }
    const std::uint32_t node = order[i];
    check_node(tree, node, children.num_of(node), path);
    order.insert(order.end(), children.nodes.begin() + children.begin[node],
                 children.nodes.begin() + children.begin[node + 1]);
  }
  return order;
}

std::uint32_t pictures_of_weight(double weight) {
  const double pictures = std::round(kForeignPictures * std::exp(-weight));
  return static_cast<std::uint32_t>(std::max(1.0, pictures));
}

}  // namespace

void refuse_vocabulary(const std::filesystem::path& path, std::string_view why) {
  throw core::InputError(fmt::format("{}: {}", path.string(), why));
}

Vocabulary vocabulary_of(const ForeignTree& tree, const std::filesystem::path& path) {
  if (tree.nodes.size() < 2) refuse_vocabulary(path, "is a vocabulary without words");
  const Children children = children_of(tree.nodes, path);
  const std::vector<std::uint32_t> order = level_order(tree, children, path);
  if (order.size() != tree.nodes.size()) {
    refuse_vocabulary(path, fmt::format("{} of its {} nodes are not below the root",
                                        tree.nodes.size() - order.size(), tree.nodes.size()));
  }
  std::vector<Vocabulary::Node> nodes;
  nodes.reserve(order.size());
  std::vector<std::uint32_t> pictures_with;
  std::uint32_t next_child = 1;
  for (const std::uint32_t from : order) {
    Vocabulary::Node node{.centre = tree.nodes[from].centre};
    node.num_children = children.num_of(from);
    if (node.num_children > 0) {
      node.first_child = next_child;
      next_child += node.num_children;
    } else {
      node.word = static_cast<Word>(pictures_with.size());
      pictures_with.push_back(pictures_of_weight(tree.nodes[from].weight));
    }
    nodes.push_back(node);
  }
  return {std::move(nodes), std::move(pictures_with), kForeignPictures};
}

}  // namespace samewhere::features
