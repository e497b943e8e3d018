#include "bindings.hpp"

namespace samewhere::python {
namespace {

using NoGil = py::call_guard<py::gil_scoped_release>;

// A class of the library that does not refuse a second thread by itself.
template <class T>
struct OneThread : T {
  using T::T;
  bool is_busy = false;
};

// For the life of a call; begins and ends with the GIL. Throws UsageError if another one is there.
class Turn {
 public:
  Turn(bool& is_busy, const std::string& call) : is_busy_(is_busy) {
    if (is_busy_) {
      throw UsageError(call +
                       ": another call of this object is in progress; expected one thread at a "
                       "time");
    }
    is_busy_ = true;
  }
  Turn(const Turn&) = delete;
  Turn& operator=(const Turn&) = delete;
  ~Turn() { is_busy_ = false; }

 private:
  bool& is_busy_;
};

// pybind11 holds no pointer to const; the bound classes cannot change a map.
std::shared_ptr<Map> shared(const std::shared_ptr<const Map>& map) {
  return std::const_pointer_cast<Map>(map);
}

void bind_recording(py::module_& module) {
  using Class = OneThread<Recording>;
  py::class_<Class>(
      module, "Recording",
      R"(Frames of a recording of any format that `samewhere run` reads, or of twin:PRESET.

for frame in recording: ...   Each Frame has arrays of its own. Raises InputError.)")
      .def(py::init<const std::string&, const std::vector<std::string>&>(), py::arg("source"),
           py::arg("settings") = std::vector<std::string>{}, NoGil())
      .def(
          "calibration",
          [](Class& recording) {
            const Turn turn(recording.is_busy, "calibration()");
            const py::gil_scoped_release release;
            return recording.calibration();
          },
          "Reads the first frame. Raises InputError if there is none, or no calibration.")
      .def("__iter__", [](py::object self) { return self; })
      .def("__next__", [](Class& recording) {
        const Turn turn(recording.is_busy, "next()");
        std::optional<Frame> frame;
        {
          const py::gil_scoped_release release;
          frame = recording.next();
        }
        if (!frame) throw py::stop_iteration();
        return copy_of(*frame);
      });
}

void bind_tracked(py::module_& module) {
  py::enum_<Status>(module, "Status",
                    R"(INITIALIZING: there is no map yet. WEAK: few inliers. LOST: no pose.
PROVISIONAL: relocalized, not confirmed; it may be a look-alike place.)")
      .value("INITIALIZING", Status::kInitializing)
      .value("TRACKING", Status::kTracking)
      .value("WEAK", Status::kWeak)
      .value("LOST", Status::kLost)
      .value("PROVISIONAL", Status::kProvisional);
  py::class_<Tracked>(module, "Tracked",
                      R"(The camera at one frame; camera 0 as it was given. Poses are 4 x 4, metres.

odom_from_camera: the chain of relative poses; smooth, never moved by a correction.
map_from_odom: changes with loop closures, bundle adjustment and relocalization (REP-105).
covariance: 6 x 6, [m; rad], of the body relative to its reference keyframe; None: no pose.)")
      .def_readonly("frame", &Tracked::frame)
      .def_readonly("stamp_s", &Tracked::stamp_s)
      .def_readonly("status", &Tracked::status)
      .def_property_readonly("odom_from_camera",
                             [](const Tracked& t) { return t.odom_from_camera; })
      .def_property_readonly("map_from_odom", [](const Tracked& t) { return t.map_from_odom; })
      .def_property_readonly("provisional_map_from_camera",
                             [](const Tracked& t) { return t.provisional_map_from_camera; })
      .def_property_readonly("covariance", [](const Tracked& t) { return t.covariance; })
      .def_readonly("num_inliers", &Tracked::num_inliers)
      .def_readonly("map_version", &Tracked::map_version)
      .def_property_readonly("map_from_camera", &Tracked::map_from_camera,
                             "map_from_odom @ odom_from_camera.")
      .def_property_readonly("has_pose", &Tracked::has_pose)
      .def("__repr__", [](const Tracked& t) {
        return "<samewhere.Tracked frame " + std::to_string(t.frame) + " " +
               py::str(py::cast(t.status).attr("name")).cast<std::string>() + ", " +
               std::to_string(t.num_inliers) + " inliers>";
      });
}

py::object trajectory_of_slam(const Slam& slam) {
  std::vector<double> stamps_s;
  std::vector<Pose> poses;
  for (const StampedPose& pose : slam.trajectory()) {
    stamps_s.push_back(pose.stamp_s);
    poses.push_back(pose.map_from_camera);
  }
  return trajectory_of(stamps_s, poses);
}

void bind_slam(py::module_& module) {
  py::class_<Slam, Session<Slam>>(
      module, "Slam",
      R"(Visual SLAM, frame by frame. Slam(calibration, Options(...)), or the fields as keywords.

On recorded input it gives the poses and verdicts of `samewhere run`, to the bit, unless
never_wait is set. One thread at a time calls it; map() and take_events() from any. A frame that
is refused (InputError) changes nothing. After an internal error calls raise UsageError until
reset().)")
      .def(py::init([](const Calibration& calibration, const py::object& options,
                       const py::kwargs& keywords) {
             const auto given = options_from<Options>(options, keywords);
             const py::gil_scoped_release release;
             return Session<Slam>(new Slam(calibration, given));
           }),
           py::arg("calibration"), py::arg("options") = py::none())
      .def(
          "track",
          [](Slam& slam, const ArrayFrame& frame) {
            const py::gil_scoped_release release;
            return slam.track(frame.frame);
          },
          py::arg("frame"),
          "Tracks the next frame. Raises InputError on a frame that does not fit the calibration "
          "or the stamps before; UsageError after finish(), or if another thread is in a call.")
      .def("take_events", &Slam::take_events, NoGil(), "Events since the last call, oldest first.")
      .def(
          "map", [](const Slam& slam) { return shared(slam.map()); },
          "The map as the newest frame saw it.")
      .def("save", &Slam::save, py::arg("file"), NoGil(),
           "A new file with the map as of the newest keyframe that mapping has completed.")
      .def("load", &Slam::load, py::arg("file"), py::arg("use"), NoGil(),
           "Ends the session and begins one in a saved map, lost until relocalized.")
      .def("reset", &Slam::reset, NoGil(),
           "Ends the session and begins a new one with an empty map.")
      .def("pause_mapping", &Slam::pause_mapping, NoGil(),
           "No keyframe is inserted from the next frame on.")
      .def("resume_mapping", &Slam::resume_mapping, NoGil())
      .def("finish", &Slam::finish, NoGil(), "The input has ended: completes what is in progress.")
      .def_property_readonly("is_finished", &Slam::is_finished)
      .def(
          "trajectory", &trajectory_of_slam,
          "samewhere.Trajectory of camera 0 in the map, of each frame with a confirmed pose, after "
          "all corrections. Raises UsageError before finish().");
}

void bind_loop_closer(py::module_& module) {
  struct OwnedOdometryFrame {
    OdometryFrame frame;
    ArrayFrame arrays;
  };
  py::class_<OwnedOdometryFrame>(module, "OdometryFrame", R"(Images and odometry of one moment.

odom_from_body: 4 x 4, metres. covariance: 6 x 6 of the body now in that at the frame before,
[m; rad]; for OdometrySensor.COVARIANCES, not of the first. Raises InputError.)")
      .def(py::init([](const ArrayFrame& frame, const py::object& odom_from_body,
                       const py::object& covariance) {
             return OwnedOdometryFrame{{frame.frame, pose_from("odom_from_body", odom_from_body),
                                        covariance_from("covariance", covariance)},
                                       frame};
           }),
           py::arg("frame"), py::arg("odom_from_body"), py::arg("covariance") = py::none())
      .def_property_readonly("frame", [](const OwnedOdometryFrame& f) { return f.arrays; })
      .def_property_readonly("odom_from_body",
                             [](const OwnedOdometryFrame& f) { return f.frame.odom_from_body; })
      .def_property_readonly("covariance",
                             [](const OwnedOdometryFrame& f) { return f.frame.covariance; });
  py::class_<LoopCloser, Session<LoopCloser>>(
      module, "LoopCloser",
      R"(Loop closures for odometry from elsewhere: wheels, legs, lidar, a VIO.

LoopCloser(calibration, LoopCloserOptions(...)), or the fields as keywords. Keyframes and
odometry in; verdicts and corrected poses out, those of `samewhere run --odometry`.)")
      .def(py::init([](const Calibration& calibration, const py::object& options,
                       const py::kwargs& keywords) {
             const auto given = options_from<LoopCloserOptions>(options, keywords);
             const py::gil_scoped_release release;
             return Session<LoopCloser>(new LoopCloser(calibration, given));
           }),
           py::arg("calibration"), py::arg("options") = py::none())
      .def(
          "add",
          [](LoopCloser& closer, const OwnedOdometryFrame& keyframe) {
            const py::gil_scoped_release release;
            return closer.add(keyframe.frame);
          },
          py::arg("keyframe"),
          "Verdicts that are known now, of this keyframe or earlier ones. Raises InputError.")
      .def("finish", &LoopCloser::finish, NoGil(), "The verdicts that are left.")
      .def(
          "poses",
          [](const LoopCloser& closer) {
            std::vector<double> stamps_s;
            std::vector<Pose> poses;
            for (const CorrectedPose& pose : closer.poses()) {
              stamps_s.push_back(pose.stamp_s);
              poses.push_back(pose.map_from_body);
            }
            return trajectory_of(stamps_s, poses);
          },
          "samewhere.Trajectory of the body in the map, which begins where the odometry of its "
          "first frame is; before finish() without the newest few.")
      .def("map", [](const LoopCloser& closer) { return shared(closer.map()); });
}

void bind_loop_detector(py::module_& module) {
  py::class_<LoopDetector, Session<LoopDetector>>(
      module, "LoopDetector",
      R"(Place recognition alone: which images show a place of an earlier image.

Needs neither calibration nor depth. Gives the verdicts of `samewhere loops`.)")
      .def(py::init([](const std::vector<std::string>& settings, std::optional<Prior> prior,
                       double frame_rate_hz) {
             const py::gil_scoped_release release;
             return Session<LoopDetector>(new LoopDetector(settings, prior, frame_rate_hz));
           }),
           py::arg("settings") = std::vector<std::string>{}, py::arg("prior") = py::none(),
           py::arg("frame_rate_hz") = 30.0)
      .def(
          "add",
          [](LoopDetector& detector, const py::object& image,
             const std::optional<std::string>& format) {
            const Image view = image_from("image", image, format);
            const py::gil_scoped_release release;
            return detector.add(view);
          },
          py::arg("image"), py::kw_only(), py::arg("format") = py::none(),
          "The next image, of any size, as in Frame; frames are numbered from 0. Verdicts that are "
          "known now, on it and on earlier ones. Raises InputError.")
      .def("finish", &LoopDetector::finish, NoGil(), "The verdicts that are left.");
}

void bind_loop_verifier(py::module_& module) {
  py::class_<OdometryBetween>(module, "OdometryBetween",
                              "What odometry knows of two keyframes: match_from_query, 4 x 4, of "
                              "the bodies; covariance, 6 x 6, [m; rad]. Raises InputError.")
      .def(py::init([](const py::object& match_from_query, const py::object& covariance) {
             OdometryBetween odometry{pose_from("match_from_query", match_from_query)};
             if (const auto given = covariance_from("covariance", covariance))
               odometry.covariance = *given;
             return odometry;
           }),
           py::arg("match_from_query"), py::arg("covariance"))
      .def_property_readonly("match_from_query",
                             [](const OdometryBetween& o) { return o.match_from_query; })
      .def_property_readonly("covariance", [](const OdometryBetween& o) { return o.covariance; });
  using Class = OneThread<LoopVerifier>;
  py::class_<Class, Session<Class>>(
      module, "LoopVerifier",
      R"(Verification of one loop candidate, for a pose graph kept elsewhere (GTSAM, g2o).

Holds no state between calls. One thread at a time calls it.)")
      .def(py::init([](const Calibration& calibration, const std::vector<std::string>& settings,
                       std::optional<Prior> prior) {
             const py::gil_scoped_release release;
             return Session<Class>(new Class(calibration, settings, prior));
           }),
           py::arg("calibration"), py::arg("settings") = std::vector<std::string>{},
           py::arg("prior") = py::none())
      .def(
          "verify",
          [](Class& verifier, const ArrayFrame& match, const ArrayFrame& query,
             const std::optional<OdometryBetween>& odometry) {
            const Turn turn(verifier.is_busy, "verify()");
            const py::gil_scoped_release release;
            return verifier.verify(match.frame, query.frame, odometry);
          },
          py::arg("match"), py::arg("query"), py::arg("odometry") = py::none(),
          "Whether both frames show the same place. Without depth or a second camera nothing is "
          "accepted; without odometry Prior.REPETITIVE accepts nothing. Raises InputError.");
}

}  // namespace

void bind_sessions(py::module_& module) {
  bind_recording(module);
  bind_tracked(module);
  bind_slam(module);
  bind_loop_closer(module);
  bind_loop_detector(module);
  bind_loop_verifier(module);
}

}  // namespace samewhere::python
