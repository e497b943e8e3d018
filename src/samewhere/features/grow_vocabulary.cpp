#include <algorithm>
#include <numeric>
#include <set>
#include <utility>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/random.hpp>
#include <samewhere/features/grow_vocabulary.hpp>
#include <samewhere/features/hamming.hpp>

namespace samewhere::features {
namespace {

using Centre = std::array<std::uint8_t, kDescriptorBytes>;
using Node = Vocabulary::Node;

// Descriptors of one node.
using Members = std::vector<const unsigned char*>;

Centre copy_of(const unsigned char* descriptor) {
  Centre centre;
  std::copy_n(descriptor, kDescriptorBytes, centre.begin());
  return centre;
}

// The first is drawn evenly, each further one by the square of its distance from those before.
// Fewer than asked for if there are not so many different ones.
std::vector<Centre> first_centres(const Members& members, int count, core::Random& random) {
  std::vector<Centre> centres{copy_of(members[random.index(members.size())])};
  std::vector<double> squared(members.size(), 1e9);
  while (static_cast<int>(centres.size()) < count) {
    double sum = 0.0;
    for (std::size_t i = 0; i < members.size(); ++i) {
      const double bits = distance_bits(members[i], centres.back().data());
      squared[i] = std::min(squared[i], bits * bits);
      sum += squared[i];
    }
    if (sum == 0.0) return centres;
    double left = random.uniform() * sum;
    std::size_t drawn = 0;
    while (drawn + 1 < members.size() && (left -= squared[drawn]) >= 0.0) ++drawn;
    while (squared[drawn] == 0.0) --drawn;  // rounding ran past the last that may be drawn
    centres.push_back(copy_of(members[drawn]));
  }
  return centres;
}

std::size_t nearest(const std::vector<Centre>& centres, const unsigned char* descriptor) {
  std::size_t best = 0;
  int best_bits = 8 * kDescriptorBytes + 1;
  for (std::size_t i = 0; i < centres.size(); ++i) {
    const int bits = distance_bits(descriptor, centres[i].data());
    if (bits >= best_bits) continue;
    best_bits = bits;
    best = i;
  }
  return best;
}

// Of a majority of descriptors; a bit that half of them have is 0.
Centre median_of(const Members& members) {
  std::array<std::size_t, std::size_t{8} * kDescriptorBytes> num_set{};
  for (const unsigned char* descriptor : members) {
    for (std::size_t bit = 0; bit < num_set.size(); ++bit)
      num_set[bit] += (descriptor[bit / 8] >> (bit % 8)) & 1U;
  }
  Centre centre{};
  for (std::size_t bit = 0; bit < num_set.size(); ++bit) {
    const unsigned is_set = 2 * num_set[bit] > members.size() ? 1U : 0U;
    centre[bit / 8] = static_cast<std::uint8_t>(centre[bit / 8] | (is_set << (bit % 8)));
  }
  return centre;
}

struct Cluster {
  Centre centre;
  Members members;
};

std::vector<Cluster> share_out_by(const std::vector<Centre>& centres, const Members& members) {
  std::vector<Cluster> clusters;
  for (const Centre& centre : centres) clusters.push_back({centre, {}});
  for (const unsigned char* descriptor : members)
    clusters[nearest(centres, descriptor)].members.push_back(descriptor);
  std::erase_if(clusters, [](const Cluster& cluster) { return cluster.members.empty(); });
  return clusters;
}

std::vector<Cluster> clusters_of(const Members& members, const GrowSettings& settings,
                                 core::Random& random) {
  std::vector<Centre> centres = first_centres(members, settings.branching, random);
  for (int round = 0; round < settings.max_rounds; ++round) {
    std::vector<Centre> better;
    for (const Cluster& cluster : share_out_by(centres, members))
      better.push_back(median_of(cluster.members));
    if (better == centres) break;
    centres = std::move(better);
  }
  return share_out_by(centres, members);
}

// A node that still has to be shared out.
struct Open {
  std::size_t node;
  int depth;
  Members members;
};

std::vector<Node> tree_of(Members all, const GrowSettings& settings) {
  core::Random random(core::seed_of(settings.seed, "vocabulary", all.size()));
  std::vector<Node> nodes(1);
  std::vector<Open> open{{0, 0, std::move(all)}};
  for (std::size_t next = 0; next < open.size(); ++next) {
    const Open at = std::exchange(open[next], {});
    if (at.depth == settings.depth) continue;
    auto clusters = clusters_of(at.members, settings, random);
    if (clusters.size() < 2) continue;
    nodes[at.node].first_child = static_cast<std::uint32_t>(nodes.size());
    nodes[at.node].num_children = static_cast<std::uint32_t>(clusters.size());
    for (Cluster& cluster : clusters) {
      open.push_back({nodes.size(), at.depth + 1, std::move(cluster.members)});
      nodes.push_back({.centre = cluster.centre});
    }
  }
  Word num_words = 0;
  for (Node& node : nodes) {
    if (node.num_children == 0) node.word = num_words++;
  }
  return nodes;
}

}  // namespace

Vocabulary grow_vocabulary(const std::vector<cv::Mat>& pictures, const GrowSettings& settings) {
  Members all;
  for (const cv::Mat& descriptors : pictures) {
    for (int i = 0; i < descriptors.rows; ++i) all.push_back(descriptors.ptr(i));
  }
  core::require(!all.empty(), "a vocabulary is grown of at least one descriptor");
  std::vector<Node> nodes = tree_of(std::move(all), settings);
  const auto num_words = static_cast<std::size_t>(
      std::count_if(nodes.begin(), nodes.end(), [](const Node& n) { return n.num_children == 0; }));
  const Vocabulary unweighted(nodes, std::vector<std::uint32_t>(num_words, 0), 0);
  std::vector<std::uint32_t> pictures_with(num_words, 0);
  for (const cv::Mat& descriptors : pictures) {
    const std::vector<Word> words = unweighted.words_of(descriptors);
    for (const Word word : std::set<Word>(words.begin(), words.end())) ++pictures_with[word];
  }
  return {std::move(nodes), std::move(pictures_with), static_cast<std::uint32_t>(pictures.size())};
}

}  // namespace samewhere::features
