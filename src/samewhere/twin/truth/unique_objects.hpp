#pragma once

#include <optional>
#include <string>
#include <vector>

#include <samewhere/core/rig.hpp>
#include <samewhere/twin/truth/sight.hpp>

namespace samewhere::twin {

// A unique object that a frame shows well enough to be recognised.
struct ShownObject {
  int id = 0;
  float size_px = 0.0F;  // the shortest side of its front in the picture
};

// The unique objects of a building in all its states (Object::is_unique), by their fronts: the
// largest rectangle of each. Objects of two visits are one, with one id, if they have the same
// name, hang within 5 cm of each other and bear the same print: a new poster is another object.
class UniqueObjects {
 public:
  explicit UniqueObjects(const std::vector<Visit>& visits);

  // What a camera in a visit (its index) sees at 20 pixels or more: the front turned to it, whole
  // in the picture, with nothing before it. Ids ascend.
  std::vector<ShownObject> shown_to(const core::Camera& camera,
                                    const core::Rigid3& world_from_camera, int visit) const;

  const std::string& name(int id) const { return names_[static_cast<std::size_t>(id)]; }

 private:
  struct Front {
    int id = 0;
    int rectangle = 0;  // index
  };

  void add(int visit, const std::string& name, int rectangle);
  const Rectangle& rectangle(int visit, const Front& front) const;

  std::vector<Visit> visits_;
  std::vector<std::vector<Front>> fronts_;  // per visit; ids ascend
  std::vector<std::string> names_;          // by id
};

// The id of the object that both show, the one whose smaller showing is the largest; nothing if
// there is none. Ids ascend in both.
std::optional<int> best_shared(const std::vector<ShownObject>& a,
                               const std::vector<ShownObject>& b);

}  // namespace samewhere::twin
