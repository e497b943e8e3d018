#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include <samewhere/features/dbow2_vocabulary.hpp>

namespace samewhere::features {
namespace {

using Path = std::filesystem::path;

constexpr int kMaxBranching = 100;
constexpr int kMaxDbow2Depth = 20;
constexpr std::string_view kBlanks = " \t\r";

// Takes a number from the beginning of the text, with blanks before it.
template <class Number>
std::optional<Number> take_number(std::string_view& text) {
  const std::size_t begin = text.find_first_not_of(kBlanks);
  if (begin == std::string_view::npos) return std::nullopt;
  Number number{};
  const char* end = text.data() + text.size();
  const auto [next, error] = std::from_chars(text.data() + begin, end, number);
  if (error != std::errc()) return std::nullopt;
  text.remove_prefix(static_cast<std::size_t>(next - text.data()));
  return number;
}

bool is_blank(std::string_view text) {
  return text.find_first_not_of(kBlanks) == std::string_view::npos;
}

std::string_view take_line(std::string_view& text) {
  const std::size_t end = std::min(text.find('\n'), text.size());
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(std::min(end + 1, text.size()));
  return line;
}

bool take_descriptor(std::string_view& text, ForeignNode& node) {
  for (std::uint8_t& byte : node.centre) {
    const std::optional<std::uint8_t> value = take_number<std::uint8_t>(text);
    if (!value) return false;
    byte = *value;
  }
  return true;
}

bool set_limits(ForeignTree& tree, std::optional<int> branching, std::optional<int> depth) {
  if (!branching || *branching < 2 || *branching > kMaxBranching) return false;
  if (!depth || *depth < 1 || *depth > kMaxDbow2Depth) return false;
  tree.max_children = static_cast<std::uint32_t>(*branching);
  tree.max_depth = static_cast<std::uint32_t>(*depth);
  return true;
}

[[noreturn]] void refuse_limits(const Path& path) {
  refuse_vocabulary(path, fmt::format("is a DBoW2 vocabulary of another branching or depth; "
                                      "expected k from 2 to {} and L from 1 to {}",
                                      kMaxBranching, kMaxDbow2Depth));
}

// A line "parent is_word 32 bytes weight".
std::optional<ForeignNode> node_of_line(std::string_view line, std::size_t num_before) {
  ForeignNode node;
  const auto parent = take_number<std::uint32_t>(line);
  const auto is_word = take_number<int>(line);
  if (!parent || *parent >= num_before || !is_word || !take_descriptor(line, node))
    return std::nullopt;
  const auto weight = take_number<double>(line);
  if (!weight || !is_blank(line)) return std::nullopt;
  node.parent = *parent;
  node.is_word = *is_word > 0;
  node.weight = *weight;
  return node;
}

// One "key: value" of the YAML that DBoW2 writes. A key that opens a list has no value.
struct Pair {
  std::string_view key;
  std::string_view value;
};

constexpr std::string_view kStructure = " \t\r\n{}[],-";

bool is_of_key(char letter) {
  return (letter >= 'a' && letter <= 'z') || (letter >= 'A' && letter <= 'Z');
}

// Takes the next pair from the text. Nothing at its end, or where it is none; that is then left.
std::optional<Pair> take_pair(std::string_view& text) {
  text.remove_prefix(std::min(text.find_first_not_of(kStructure), text.size()));
  const auto key_end = std::find_if_not(text.begin(), text.end(), is_of_key);
  if (key_end == text.begin() || key_end == text.end() || *key_end != ':') return std::nullopt;
  Pair pair{.key = text.substr(0, static_cast<std::size_t>(key_end - text.begin())), .value = {}};
  std::string_view rest = text.substr(pair.key.size() + 1);
  rest.remove_prefix(std::min(rest.find_first_not_of(" \t"), rest.size()));
  const bool is_quoted = rest.starts_with('"');
  if (is_quoted) rest.remove_prefix(1);
  const std::size_t end = rest.find_first_of(is_quoted ? "\"" : ",}]{[\r\n");
  if (end == std::string_view::npos) return std::nullopt;
  pair.value = rest.substr(0, end);
  text = rest.substr(end + (is_quoted ? 1 : 0));
  return pair;
}

template <class Number>
std::optional<Number> number_of(std::string_view value) {
  const std::optional<Number> number = take_number<Number>(value);
  return is_blank(value) ? number : std::nullopt;
}

struct YamlNode {
  ForeignNode node;
  std::uint32_t id = 0;
};

// "nodeId, parentId, weight, descriptor", in this order.
std::optional<YamlNode> take_yaml_node(std::string_view& text) {
  YamlNode found;
  const auto id = take_pair(text);
  const auto parent = take_pair(text);
  const auto weight = take_pair(text);
  const auto descriptor = take_pair(text);
  if (!id || !parent || !weight || !descriptor) return std::nullopt;
  if (id->key != "nodeId" || parent->key != "parentId" || weight->key != "weight" ||
      descriptor->key != "descriptor")
    return std::nullopt;
  const auto id_number = number_of<std::uint32_t>(id->value);
  const auto parent_number = number_of<std::uint32_t>(parent->value);
  const auto weight_number = number_of<double>(weight->value);
  std::string_view bytes = descriptor->value;
  if (!id_number || !parent_number || !weight_number || !take_descriptor(bytes, found.node) ||
      !is_blank(bytes))
    return std::nullopt;
  found.id = *id_number;
  found.node.parent = *parent_number;
  found.node.weight = *weight_number;
  return found;
}

bool next_key_is(std::string_view text, std::string_view key) {
  const std::optional<Pair> pair = take_pair(text);
  return pair && pair->key == key;
}

// By their ids, which have to be 1 .. how many there are.
void place_nodes(const std::vector<YamlNode>& found, ForeignTree& tree, const Path& path) {
  tree.nodes.resize(found.size() + 1);
  std::vector<char> is_taken(tree.nodes.size(), 0);
  for (const YamlNode& node : found) {
    if (node.id == 0 || node.id >= tree.nodes.size() || is_taken[node.id] != 0) {
      refuse_vocabulary(path, fmt::format("has a second node of nodeId {}, or one beyond its {} "
                                          "nodes",
                                          node.id, found.size()));
    }
    is_taken[node.id] = 1;
    tree.nodes[node.id] = node.node;
  }
}

// Each word names its node.
void mark_words(std::string_view text, ForeignTree& tree, const Path& path) {
  while (next_key_is(text, "wordId")) {
    take_pair(text);
    const std::optional<Pair> node = take_pair(text);
    const auto id = node && node->key == "nodeId" ? number_of<std::uint32_t>(node->value)
                                                  : std::optional<std::uint32_t>();
    if (!id || *id == 0 || *id >= tree.nodes.size()) {
      refuse_vocabulary(path,
                        "is cut short or damaged: expected a nodeId of a node behind each "
                        "wordId");
    }
    tree.nodes[*id].is_word = true;
  }
}

}  // namespace

bool looks_like_dbow2_text(std::string_view text) {
  std::string_view line = take_line(text);
  for (int i = 0; i < 4; ++i) {
    if (!take_number<int>(line)) return false;
  }
  return is_blank(line);
}

bool looks_like_dbow2_yaml(std::string_view text) { return text.starts_with("%YAML"); }

ForeignTree read_dbow2_text(std::string_view text, const std::filesystem::path& path) {
  std::string_view first = take_line(text);
  ForeignTree tree;
  const std::optional<int> branching = take_number<int>(first);
  const std::optional<int> depth = take_number<int>(first);
  if (!set_limits(tree, branching, depth)) refuse_limits(path);
  tree.nodes.emplace_back();
  for (std::size_t line_number = 2; !text.empty(); ++line_number) {
    const std::string_view line = take_line(text);
    if (is_blank(line)) continue;
    const std::optional<ForeignNode> node = node_of_line(line, tree.nodes.size());
    if (!node) {
      refuse_vocabulary(path, fmt::format("line {} is cut short or damaged; expected the number of "
                                          "a node before it, 0 or 1, 32 bytes and a weight",
                                          line_number));
    }
    tree.nodes.push_back(*node);
  }
  return tree;
}

ForeignTree read_dbow2_yaml(std::string_view text, const std::filesystem::path& path) {
  ForeignTree tree;
  std::optional<int> branching;
  std::optional<int> depth;
  text.remove_prefix(std::min(text.find("vocabulary:"), text.size()));
  while (!text.empty() && !next_key_is(text, "nodes")) {
    const std::optional<Pair> pair = take_pair(text);
    if (!pair) text = {};
    if (pair && pair->key == "k") branching = number_of<int>(pair->value);
    if (pair && pair->key == "L") depth = number_of<int>(pair->value);
  }
  if (text.empty()) refuse_vocabulary(path, "is no DBoW2 vocabulary; expected its nodes");
  if (!set_limits(tree, branching, depth)) refuse_limits(path);
  take_pair(text);
  std::vector<YamlNode> found;
  while (!next_key_is(text, "words")) {
    const std::optional<YamlNode> node = take_yaml_node(text);
    if (!node) {
      refuse_vocabulary(path, fmt::format("is cut short or damaged behind its {} first nodes; "
                                          "expected nodeId, parentId, weight, descriptor",
                                          found.size()));
    }
    found.push_back(*node);
  }
  take_pair(text);
  place_nodes(found, tree, path);
  mark_words(text, tree, path);
  return tree;
}

}  // namespace samewhere::features
