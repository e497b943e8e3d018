#include "bindings.hpp"

namespace samewhere::python {
namespace {

std::string name_of(const FrameKey& key) {
  const std::string session = key.session == 0 ? "" : " of session " + std::to_string(key.session);
  return std::to_string(key.index) + session;
}

void bind_verdict(py::module_& module) {
  py::enum_<LoopDecision>(module, "LoopDecision",
                          "WITHDRAWN: accepted before, contradicted by a later loop.")
      .value("ACCEPTED", LoopDecision::kAccepted)
      .value("REJECTED", LoopDecision::kRejected)
      .value("AMBIGUOUS", LoopDecision::kAmbiguous)
      .value("WITHDRAWN", LoopDecision::kWithdrawn);
  py::class_<LoopScores>(module, "LoopScores",
                         R"(What the verification of a candidate measured; None: not measured.

similarity: of the global descriptors, in [-1, 1]. overlap_ratio: share of each image that the
other one shows. correction_m, correction_rad: of the query's pose, by the candidate.
odometry_chi_square: of the correction under odometry, 6 degrees of freedom. sigma_m: of the
odometry between match and query.)")
      .def_readonly("similarity", &LoopScores::similarity)
      .def_readonly("num_matches", &LoopScores::num_matches)
      .def_readonly("num_inliers", &LoopScores::num_inliers)
      .def_readonly("inlier_ratio", &LoopScores::inlier_ratio)
      .def_readonly("overlap_ratio", &LoopScores::overlap_ratio)
      .def_readonly("reprojection_rmse_px", &LoopScores::reprojection_rmse_px)
      .def_readonly("correction_m", &LoopScores::correction_m)
      .def_readonly("correction_rad", &LoopScores::correction_rad)
      .def_readonly("odometry_chi_square", &LoopScores::odometry_chi_square)
      .def_readonly("sigma_m", &LoopScores::sigma_m);
  py::class_<LoopVerdict>(
      module, "LoopVerdict",
      R"(A verdict on a loop candidate. A later verdict on the same candidate replaces it.

query, match: frames, the match is older. check: that decided, as in loops.json. reason: one
sentence with the score and the threshold. match_from_query: 4 x 4, of the body; None: not
measured. scale: what is 1 long at the query is so long at the match. covariance: 6 x 6 of
match_from_query, [m; rad]; of accepted ones.)")
      .def_readonly("candidate", &LoopVerdict::candidate)
      .def_readonly("query", &LoopVerdict::query)
      .def_readonly("match", &LoopVerdict::match)
      .def_readonly("decision", &LoopVerdict::decision)
      .def_readonly("is_relocalization", &LoopVerdict::is_relocalization)
      .def_readonly("check", &LoopVerdict::check)
      .def_readonly("reason", &LoopVerdict::reason)
      .def_readonly("scores", &LoopVerdict::scores)
      .def_property_readonly("match_from_query",
                             [](const LoopVerdict& v) { return v.match_from_query; })
      .def_readonly("scale", &LoopVerdict::scale)
      .def_property_readonly("covariance", [](const LoopVerdict& v) { return v.covariance; })
      .def("__repr__", [](const LoopVerdict& v) {
        return "<samewhere.LoopVerdict " + name_of(v.query) + " to " + name_of(v.match) + " " +
               py::str(py::cast(v.decision).attr("name")).cast<std::string>() + ": " + v.reason +
               ">";
      });
}

void bind_changes(py::module_& module) {
  py::class_<KeyframeInserted>(module, "KeyframeInserted",
                               "The keyframe is part of the map that frames are tracked in.")
      .def_readonly("keyframe", &KeyframeInserted::keyframe)
      .def_readonly("frame", &KeyframeInserted::frame)
      .def_readonly("stamp_s", &KeyframeInserted::stamp_s)
      .def_property_readonly("map_from_camera",
                             [](const KeyframeInserted& k) { return k.map_from_camera; });
  py::class_<TrackingLost>(module, "TrackingLost", "Tracking is lost.")
      .def_readonly("last_pose_stamp_s", &TrackingLost::last_pose_stamp_s);
  py::enum_<RelocalizationStep>(
      module, "RelocalizationStep",
      R"(PROVISIONAL: found, not confirmed. CONFIRMED: the pose is used from here on.
TAKEN_BACK: the provisional one was wrong; the camera is lost again.)")
      .value("PROVISIONAL", RelocalizationStep::kProvisional)
      .value("CONFIRMED", RelocalizationStep::kConfirmed)
      .value("TAKEN_BACK", RelocalizationStep::kTakenBack);
  py::class_<Relocalized>(module, "Relocalized", "A step of relocalization.")
      .def_readonly("step", &Relocalized::step);
  py::class_<MapCorrected> corrected(
      module, "MapCorrected",
      "Loop closures or a full bundle adjustment moved keyframes. Local bundle adjustment is not "
      "told.");
  py::class_<MapCorrected::Move>(corrected, "Move", "A keyframe's pose before and after, 4 x 4.")
      .def_readonly("keyframe", &MapCorrected::Move::keyframe)
      .def_property_readonly("old_map_from_camera",
                             [](const MapCorrected::Move& m) { return m.old_map_from_camera; })
      .def_property_readonly("new_map_from_camera",
                             [](const MapCorrected::Move& m) { return m.new_map_from_camera; });
  corrected.def_readonly("map_version", &MapCorrected::map_version)
      .def_property_readonly("moves", [](const MapCorrected& m) { return m.moves; });
  py::class_<MapDiscarded>(
      module, "MapDiscarded",
      "Re-initialization: the map so far, with all its poses, is replaced by a new one.");
}

}  // namespace

void bind_events(py::module_& module) {
  py::class_<FrameKey>(module, "FrameKey",
                       "A frame: its 0-based position in its session. Sessions count from 0.")
      .def(py::init([](std::uint64_t index, std::uint16_t session) {
             return FrameKey{index, session};
           }),
           py::arg("index"), py::arg("session") = 0)
      .def_readonly("index", &FrameKey::index)
      .def_readonly("session", &FrameKey::session)
      .def(
          "__eq__", [](const FrameKey& a, const FrameKey& b) { return a == b; }, py::is_operator())
      .def("__hash__",
           [](const FrameKey& key) { return py::hash(py::make_tuple(key.index, key.session)); })
      .def("__repr__",
           [](const FrameKey& key) { return "<samewhere.FrameKey " + name_of(key) + ">"; });
  bind_verdict(module);
  bind_changes(module);
  py::class_<Event>(module, "Event", R"(Told with the frame at which it takes effect.

what: a KeyframeInserted, LoopVerdict, TrackingLost, Relocalized, MapCorrected or MapDiscarded.)")
      .def_readonly("frame", &Event::frame, "0-based position of the frame.")
      .def_readonly("stamp_s", &Event::stamp_s, "Seconds.")
      .def_property_readonly("what", [](const Event& event) { return event.what; })
      .def("__repr__", [](const Event& event) {
        return "<samewhere.Event frame " + std::to_string(event.frame) + ": " +
               py::repr(py::cast(event.what)).cast<std::string>() + ">";
      });
}

}  // namespace samewhere::python
