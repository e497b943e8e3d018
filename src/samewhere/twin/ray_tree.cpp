#include <algorithm>
#include <array>
#include <limits>

#include <samewhere/core/errors.hpp>
#include <samewhere/twin/ray_tree.hpp>

namespace samewhere::twin {
namespace {

constexpr int kMaxLeaf = 4;
constexpr int kMaxDepth = 24;
constexpr int kMaxWaiting = 3 * kMaxDepth + 4;
// boxes around flat things get some thickness, or rays along their plane would divide 0 by 0
constexpr float kPadding_m = 1e-4F;
// a ray does not meet the surface that it starts on
constexpr float kMinReach = 1e-5F;

}  // namespace

std::optional<float> reach_of(const Ray& ray, const Rectangle& rectangle) {
  const int axis = rectangle.axis;
  const float reach = (rectangle.plane_m - ray.origin[axis]) / ray.direction[axis];
  if (!(reach > kMinReach)) return std::nullopt;
  const Eigen::Vector2f at = rectangle.on_plane(ray.origin + reach * ray.direction);
  const bool is_inside = (at.array() >= rectangle.low_m.array()).all() &&
                         (at.array() <= rectangle.high_m.array()).all();
  return is_inside ? std::optional(reach) : std::nullopt;
}

struct RayTree::Bounds {
  Eigen::Vector3f low = Eigen::Vector3f::Constant(std::numeric_limits<float>::max());
  Eigen::Vector3f high = Eigen::Vector3f::Constant(std::numeric_limits<float>::lowest());

  void add(const Leaf& leaf) {
    Eigen::Vector3f corner;
    corner[leaf.axis] = leaf.plane;
    for (const auto* ends : {&leaf.low, &leaf.high}) {
      corner[leaf.first_axis] = (*ends)[0];
      corner[leaf.second_axis] = (*ends)[1];
      low = low.cwiseMin(corner);
      high = high.cwiseMax(corner);
    }
  }

  float area() const {
    const Eigen::Vector3f size = (high - low).cwiseMax(kPadding_m);
    return size.x() * size.y() + size.y() * size.z() + size.z() * size.x();
  }
};

RayTree::RayTree(const std::vector<Rectangle>& rectangles) {
  core::require(!rectangles.empty(), "a building has surfaces");
  for (std::size_t i = 0; i < rectangles.size(); ++i) {
    const Rectangle& r = rectangles[i];
    leaves_.push_back({.axis = r.axis,
                       .first_axis = r.first_axis(),
                       .second_axis = r.second_axis(),
                       .rectangle = static_cast<int>(i),
                       .plane = r.plane_m,
                       .low = {r.low_m.x(), r.low_m.y()},
                       .high = {r.high_m.x(), r.high_m.y()}});
  }
  build({0, static_cast<int>(leaves_.size())}, 0);
}

RayTree::Bounds RayTree::bounds_of(const Range& range) const {
  Bounds bounds;
  for (int i = range.first; i < range.first + range.count; ++i) {
    bounds.add(leaves_[static_cast<std::size_t>(i)]);
  }
  return bounds;
}

void RayTree::sort_along(int axis, const Range& range) {
  const auto doubled_centre = [axis](const Leaf& leaf) {
    if (axis == leaf.axis) return 2.0F * leaf.plane;
    const int side = axis == leaf.first_axis ? 0 : 1;
    return leaf.low[side] + leaf.high[side];
  };
  const auto first = leaves_.begin() + range.first;
  std::sort(first, first + range.count, [&](const Leaf& a, const Leaf& b) {
    const float centre_a = doubled_centre(a);
    const float centre_b = doubled_centre(b);
    return centre_a != centre_b ? centre_a < centre_b : a.rectangle < b.rectangle;
  });
}

// Orders the range along the best axis and answers how many go to the left.
int RayTree::best_left_count(const Range& range) {
  float best_cost = std::numeric_limits<float>::max();
  int best_axis = 0;
  int best_count = 1;
  std::vector<float> right_area(static_cast<std::size_t>(range.count));
  for (int axis = 0; axis < 3; ++axis) {
    sort_along(axis, range);
    Bounds right;
    for (int i = range.count - 1; i > 0; --i) {
      right.add(leaves_[static_cast<std::size_t>(range.first + i)]);
      right_area[static_cast<std::size_t>(i)] = right.area();
    }
    Bounds left;
    for (int i = 1; i < range.count; ++i) {
      left.add(leaves_[static_cast<std::size_t>(range.first + i - 1)]);
      const float cost =
          left.area() * static_cast<float>(i) +
          right_area[static_cast<std::size_t>(i)] * static_cast<float>(range.count - i);
      if (cost >= best_cost) continue;
      best_cost = cost;
      best_axis = axis;
      best_count = i;
    }
  }
  sort_along(best_axis, range);
  return best_count;
}

// Splits the part with the largest surface until there are four, or only leaves.
std::vector<RayTree::Range> RayTree::split_in_four(const Range& range) {
  std::vector<Range> parts{range};
  while (parts.size() < 4) {
    std::size_t largest = parts.size();
    float largest_area = -1.0F;
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const float area = bounds_of(parts[i]).area();
      if (parts[i].count <= kMaxLeaf || area <= largest_area) continue;
      largest = i;
      largest_area = area;
    }
    if (largest == parts.size()) break;
    const Range split = parts[largest];
    const int num_left = best_left_count(split);
    parts[largest] = {split.first, num_left};
    parts.push_back({split.first + num_left, split.count - num_left});
  }
  return parts;
}

int RayTree::build(const Range& range, int depth) {
  core::require(depth < kMaxDepth, "a tree of surfaces is shallow");
  const std::vector<Range> parts = split_in_four(range);
  const std::size_t node = nodes_.size();
  nodes_.emplace_back();
  for (int axis = 0; axis < 3; ++axis) {
    // an absent child is a box that ends before it starts
    nodes_[node].ends[0][static_cast<std::size_t>(axis)].setConstant(
        std::numeric_limits<float>::max());
    nodes_[node].ends[1][static_cast<std::size_t>(axis)].setConstant(
        std::numeric_limits<float>::lowest());
  }
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const Bounds bounds = bounds_of(parts[i]);
    const auto lane = static_cast<Eigen::Index>(i);
    for (int axis = 0; axis < 3; ++axis) {
      nodes_[node].ends[0][static_cast<std::size_t>(axis)][lane] = bounds.low[axis] - kPadding_m;
      nodes_[node].ends[1][static_cast<std::size_t>(axis)][lane] = bounds.high[axis] + kPadding_m;
    }
    const bool is_leaf = parts[i].count <= kMaxLeaf;
    const Child child =
        is_leaf ? Child{parts[i].first, parts[i].count} : Child{build(parts[i], depth + 1), 0};
    nodes_[node].children[i] = child;  // only now: build() moves the nodes
  }
  return static_cast<int>(node);
}

// A ray on its way through the tree.
struct RayTree::Search {
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-member-init): the stack, see below
  Search(const Ray& searched, float max_reach)
      : ray(searched), inverse(searched.direction.cwiseInverse()), reach(max_reach) {}

  // Puts the children that the ray enters before `reach` on the stack, the nearest on top.
  void enter(const Node& node) {
    Eigen::Array4f near = Eigen::Array4f::Zero();
    Eigen::Array4f far = Eigen::Array4f::Constant(reach);
    for (int axis = 0; axis < 3; ++axis) {
      const std::size_t is_backwards = inverse[axis] < 0.0F ? 1 : 0;
      const auto axis_index = static_cast<std::size_t>(axis);
      near = near.max((node.ends[is_backwards][axis_index] - ray.origin[axis]) * inverse[axis]);
      far = far.min((node.ends[1 - is_backwards][axis_index] - ray.origin[axis]) * inverse[axis]);
    }
    const std::size_t bottom = num_waiting;
    for (Eigen::Index i = 0; i < 4; ++i) {
      if (near[i] > far[i]) continue;
      std::size_t at = num_waiting++;
      for (; at > bottom && waiting[at - 1].entry < near[i]; --at) waiting[at] = waiting[at - 1];
      const Child& child = node.children[static_cast<std::size_t>(i)];
      waiting[at] = {near[i], child.first, child.count};
    }
  }

  void meet(const Leaf& leaf) {
    const float t = (leaf.plane - ray.origin[leaf.axis]) * inverse[leaf.axis];
    if (!(t > kMinReach && t < reach)) return;
    const float first = ray.origin[leaf.first_axis] + t * ray.direction[leaf.first_axis];
    const float second = ray.origin[leaf.second_axis] + t * ray.direction[leaf.second_axis];
    if (first < leaf.low[0] || first > leaf.high[0]) return;
    if (second < leaf.low[1] || second > leaf.high[1]) return;
    reach = t;
    rectangle = leaf.rectangle;
  }

  // The next part of the tree that may still hold something nearer.
  std::optional<Child> next() {
    while (num_waiting > 0) {
      const Waiting& top = waiting[--num_waiting];
      if (top.entry < reach) return Child{top.first, top.count};
    }
    return std::nullopt;
  }

  // without initial values: clearing the stack for every ray would cost as much as the search
  struct Waiting {
    float entry;
    int first;
    int count;
  };
  const Ray& ray;
  Eigen::Vector3f inverse;
  float reach;
  int rectangle = -1;
  std::size_t num_waiting = 0;
  Waiting waiting[kMaxWaiting];  // only the first num_waiting mean something
};

template <bool kStopAtFirst>
std::optional<Hit> RayTree::search(const Ray& ray, float max_reach) const {
  Search search(ray, max_reach);
  search.enter(nodes_.front());
  while (const std::optional<Child> next = search.next()) {
    if (next->count == 0) search.enter(nodes_[static_cast<std::size_t>(next->first)]);
    for (int i = next->first; i < next->first + next->count; ++i) {
      search.meet(leaves_[static_cast<std::size_t>(i)]);
    }
    if (kStopAtFirst && search.rectangle >= 0) break;
  }
  if (search.rectangle < 0) return std::nullopt;
  return Hit{search.rectangle, search.reach};
}

std::optional<Hit> RayTree::first_hit(const Ray& ray) const {
  return search<false>(ray, std::numeric_limits<float>::max());
}

bool RayTree::is_blocked(const Ray& ray) const {
  constexpr float kShortOfTheEnd = 0.999F;  // what lies at the end does not block
  return search<true>(ray, kShortOfTheEnd).has_value();
}

}  // namespace samewhere::twin
