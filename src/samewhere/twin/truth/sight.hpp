#pragma once

#include <array>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include <samewhere/core/rig.hpp>
#include <samewhere/twin/building/building.hpp>
#include <samewhere/twin/render/ray_scene.hpp>

namespace samewhere::twin {

// A building in one of its states, with its rays. Both must outlive what is made of them.
struct Visit {
  const Building* building = nullptr;
  const RayScene* rays = nullptr;
};

struct Viewpoint {
  Eigen::Matrix3f camera_from_world = Eigen::Matrix3f::Identity();  // rotation
  Eigen::Vector3f position_m = Eigen::Vector3f::Zero();             // in the world

  Eigen::Vector3f looks_along() const { return camera_from_world.row(2); }
};

Viewpoint viewpoint_of(const core::Rigid3& world_from_camera);

struct SeenPoint {
  Eigen::Vector3f in_world_m = Eigen::Vector3f::Zero();
  Eigen::Vector3f normal = Eigen::Vector3f::UnitZ();  // of its surface
  int surface = -1;                                   // index in Building::rectangles
};

struct SeenCell {
  int surface = -1;  // at its middle; -1: nothing, or outside of the picture
  // The surfaces that it and the eight cells around show, in Sight::around; none if it is but one.
  int first_around = 0;
  int num_around = 0;
};

// What one frame sees: points to ask others about, and surfaces to answer with.
struct Sight {
  const Building* building = nullptr;  // none: it was dark, nothing is seen
  const RayScene* rays = nullptr;
  Viewpoint viewpoint;
  std::vector<SeenPoint> points;  // where the 20 x 15 asking rays end
  std::vector<SeenCell> cells;    // of the eye's raster, row by row
  std::vector<int> around;        // surfaces
  Eigen::AlignedBox3f reach_m;    // around everything that is seen
};

// Answers how much of what one frame sees another sees too, by the exact geometry of the building
// (docs/evaluation.md, pr-v2). Rays are cast once per frame; pairs of frames cost next to none.
// What is narrower than 8 pixels may be overlooked where it hides a point.
class Eye {
 public:
  explicit Eye(const core::Camera& camera);

  Sight look(const core::Rigid3& world_from_camera, const Visit& visit) const;

  // Share of the query's points, 0 to 1, that the match sees: in its picture, from the side that
  // the surface is seen from, and what the match sees there is as far away within 5 cm + 4 %.
  double overlap(const Sight& query, const Sight& match) const;

  // Share of the query's points, 0 to 1, that the match would see if it stood at `match_in_query`,
  // a viewpoint in the query's world, with everything that it does see, and that look alike there:
  // same finish, same number or design, same pattern, at most half of it a surface's own. 0 where
  // it is below `least`.
  double alike(const Sight& query, const Sight& match, const Viewpoint& match_in_query,
               double least = 0.0) const;

 private:
  enum class Part { kOutside, kRim, kInside };  // of the picture

  Eigen::Vector2f at_of(int cell, const Eigen::Vector2f& in_cell) const;
  Part part_of_picture(int cell) const;
  std::array<std::size_t, 9> block_around(int cell) const;
  void list_around(Sight& sight) const;
  std::optional<int> cell_at(const Eigen::Vector2f& at) const;
  int surface_found(const Sight& match, const Viewpoint& viewpoint, const SeenPoint& point,
                    bool is_in_same_world) const;

  core::Camera camera_;
  // A raster over the plane z = 1 before the camera, where looking up a point needs no distortion.
  Eigen::Vector2f half_size_ = Eigen::Vector2f::Zero();
  int num_columns_ = 0;
  int num_rows_ = 0;
  std::vector<Part> parts_;  // of all cells
  std::vector<int> cells_in_picture_;
  std::vector<Eigen::Vector3f> directions_;  // in the camera: of these cells, then the asking rays
};

}  // namespace samewhere::twin
