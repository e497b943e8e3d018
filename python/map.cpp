#include "bindings.hpp"

namespace samewhere::python {
namespace {

// Map::Landmark as a row of a numpy array.
struct LandmarkRow {
  std::uint64_t id;
  std::array<double, 3> in_map;
  std::array<std::uint8_t, 3> rgb;
  std::int32_t num_observations;
};

py::array_t<LandmarkRow> rows_of(const Map& map) {
  std::vector<Map::Landmark> landmarks;
  {
    const py::gil_scoped_release release;
    landmarks = map.landmarks();
  }
  py::array_t<LandmarkRow> rows(static_cast<py::ssize_t>(landmarks.size()));
  LandmarkRow* out = rows.mutable_data();
  for (const Map::Landmark& landmark : landmarks) {
    const Eigen::Vector3d& at = landmark.in_map;
    *out++ = {landmark.id, {at.x(), at.y(), at.z()}, landmark.rgb, landmark.num_observations};
  }
  return rows;
}

void bind_parts(py::class_<Map, std::shared_ptr<Map>>& map) {
  py::class_<Map::Keyframe>(map, "Keyframe",
                            "map_from_camera: 4 x 4. is_culled: no longer observes landmarks; its "
                            "pose follows its neighbours.")
      .def_readonly("id", &Map::Keyframe::id)
      .def_readonly("frame", &Map::Keyframe::frame)
      .def_readonly("stamp_s", &Map::Keyframe::stamp_s)
      .def_property_readonly("map_from_camera",
                             [](const Map::Keyframe& k) { return k.map_from_camera; })
      .def_readonly("is_culled", &Map::Keyframe::is_culled);
  py::class_<Map::Edge>(map, "Edge", R"(An edge of the pose graph, of the bodies of two keyframes.

from_pose_to: 4 x 4, body of `from_` from body of `to`. covariance: 6 x 6, [m; rad]. candidate:
of a loop; None: odometry.)")
      .def_readonly("from_", &Map::Edge::from)
      .def_readonly("to", &Map::Edge::to)
      .def_property_readonly("from_pose_to", [](const Map::Edge& e) { return e.from_pose_to; })
      .def_property_readonly("covariance", [](const Map::Edge& e) { return e.covariance; })
      .def_readonly("candidate", &Map::Edge::candidate);
}

}  // namespace

void bind_map(py::module_& module) {
  PYBIND11_NUMPY_DTYPE(LandmarkRow, id, in_map, rgb, num_observations);
  using NoGil = py::call_guard<py::gil_scoped_release>;
  py::class_<Map, std::shared_ptr<Map>> map(
      module, "Map",
      R"(A map at one moment. Immutable: any thread may read it while tracking goes on.

Taking a snapshot shares the map's memory; the lists are made when they are asked for.)");
  bind_parts(map);
  map.def_property_readonly("version", &Map::version,
                            "Rises with every change; maps of one session with equal versions are "
                            "equal.")
      .def_property_readonly("num_keyframes", &Map::num_keyframes, "With culled ones.")
      .def_property_readonly("is_metric", &Map::is_metric, "Whether lengths are metres.")
      .def("keyframes", &Map::keyframes, NoGil(), "Ascending by id.")
      .def("landmarks", &rows_of,
           "A structured array: id, in_map (3, metres), rgb (3, uint8), num_observations.")
      .def("odometry", &Map::odometry, NoGil(), "Edges between consecutive keyframes.")
      .def("loops", &Map::loops, NoGil(), "Edges of loops, accepted and not withdrawn.")
      .def("__repr__", [](const Map& m) {
        return "<samewhere.Map version " + std::to_string(m.version()) + ", " +
               std::to_string(m.num_keyframes()) + " keyframes>";
      });
}

}  // namespace samewhere::python
