#pragma once

#include <optional>
#include <vector>

#include <samewhere/twin/building/surface.hpp>

namespace samewhere::twin {

// Where a thing is and which way it looks. In its coordinates x runs to the right and y upwards, as
// seen from the front, and z out towards them.
struct Stance {
  Eigen::Vector3f origin_m = Eigen::Vector3f::Zero();
  Eigen::Matrix3f axes = Eigen::Matrix3f::Identity();  // columns: right, up, out

  Eigen::Vector3f at(const Eigen::Vector3f& point_m) const { return origin_m + axes * point_m; }
};

Stance stand_of(const Eigen::Vector3f& origin_m, const Eigen::Vector3f& right,
                const Eigen::Vector3f& up);

struct Cladding {
  Material front;
  Material sides;
};

// A round bar as a prism of flat sides.
struct Bar {
  Eigen::Vector3f from_m = Eigen::Vector3f::Zero();
  Eigen::Vector3f to_m = Eigen::Vector3f::UnitY();
  float radius_m = 0.01F;
  int num_sides = 10;
  bool has_ends = false;
};

// A flat piece that is seen from its front.
struct Panel {
  Eigen::Vector3f corner_m = Eigen::Vector3f::Zero();
  Eigen::Vector3f right = Eigen::Vector3f::UnitX();
  Eigen::Vector3f up = Eigen::Vector3f::UnitY();
  Eigen::Vector2f size_m = Eigen::Vector2f::Ones();
  std::optional<Eigen::Vector2f> pattern_m;             // where patterns start, if not by place
  Eigen::Vector2f turns_rad = Eigen::Vector2f::Zero();  // as of Rectangle
};

// A round post that stands upright, its section an ellipse, as a prism of flat sides.
struct Post {
  float low_m = 0.0F;
  float high_m = 1.0F;
  Eigen::Vector2f middle_m = Eigen::Vector2f::Zero();  // x and z
  Eigen::Vector2f half_m = Eigen::Vector2f::Ones();    // x and z
  int num_sides = 12;
  bool has_lid = false;
};

// Shapes made of rectangles, appended in the coordinates of a stand. Patterns run on over the faces
// of a thing.
class Shapes {
 public:
  Shapes(std::vector<Rectangle>& rectangles, const Stance& stand)
      : rectangles_(rectangles), stand_(stand) {}

  // Fixed to something behind it: five faces.
  void add_box(const Box& box, const Cladding& cladding);
  // All around the same: six faces.
  void add_block(const Box& box, const Material& material);
  void add_bar(const Bar& bar, const Material& material);
  void add_post(const Post& post, const Material& material);
  void add_panel(const Panel& panel, const Material& material);
  // A thin sheet, seen from both sides.
  void add_sheet(const Panel& panel, const Material& material);

  // What follows belongs to this object.
  void set_object(int object) { object_ = object; }
  const Stance& stand() const { return stand_; }

 private:
  void add_lid(const Post& post, const Material& material);
  void add_face(const Box& box, int axis, float facing, const Material& material);
  void add_end(const Bar& bar, const Eigen::Vector3f& along, const Eigen::Vector3f& side,
               const Material& material);

  std::vector<Rectangle>& rectangles_;
  Stance stand_;
  int object_ = -1;
};

}  // namespace samewhere::twin
