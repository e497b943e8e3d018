#pragma once

#include <array>
#include <optional>
#include <vector>

#include <samewhere/twin/surface.hpp>

namespace samewhere::twin {

struct Ray {
  Eigen::Vector3f origin = Eigen::Vector3f::Zero();      // metres
  Eigen::Vector3f direction = Eigen::Vector3f::UnitX();  // of any length
};

struct Hit {
  int rectangle = 0;   // index
  float reach = 0.0F;  // in lengths of the direction
};

// Where the ray meets the rectangle, in lengths of the direction; nothing if it misses it.
std::optional<float> reach_of(const Ray& ray, const Rectangle& rectangle);

// Answers which rectangle a ray meets first: a tree of bounding boxes with four children, tested at
// once, split where the surface area heuristic expects the least work (MacDonald and Booth 1990;
// four children as in Dammertz, Hanika and Keller 2008).
class RayTree {
 public:
  explicit RayTree(const std::vector<Rectangle>& rectangles);

  std::optional<Hit> first_hit(const Ray& ray) const;
  // Whether anything stands between the origin and origin + direction.
  bool is_blocked(const Ray& ray) const;

 private:
  // Rectangles of a leaf, or a node.
  struct Child {
    int first = 0;  // of its rectangles in leaves_, or the node's index
    int count = 0;  // of its rectangles, 0 for a node
  };
  struct Node {
    // [0] the lower, [1] the upper ends of the four children's boxes along x, y, z
    std::array<std::array<Eigen::Array4f, 3>, 2> ends;
    std::array<Child, 4> children;
  };
  // What the search needs of a rectangle, side by side in memory.
  struct Leaf {
    int axis = 0;
    int first_axis = 0;
    int second_axis = 0;
    int rectangle = 0;
    float plane = 0.0F;
    float low[2] = {};
    float high[2] = {};
  };
  struct Range {
    int first = 0;
    int count = 0;
  };
  struct Bounds;
  struct Search;

  int build(const Range& range, int depth);
  Bounds bounds_of(const Range& range) const;
  void sort_along(int axis, const Range& range);
  int best_left_count(const Range& range);
  std::vector<Range> split_in_four(const Range& range);
  template <bool kStopAtFirst>
  std::optional<Hit> search(const Ray& ray, float max_reach) const;

  std::vector<Node> nodes_;
  std::vector<Leaf> leaves_;
};

}  // namespace samewhere::twin
