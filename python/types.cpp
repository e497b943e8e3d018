#include "bindings.hpp"

namespace samewhere::python {
namespace {

std::string text(double value) { return py::str(py::float_(value)).cast<std::string>(); }

void bind_enums(py::module_& module) {
  py::enum_<Lens>(module, "Lens",
                  "Lens model: k1 k2 p1 p2 [k3 [k4 k5 k6]], or fisheye k1 k2 k3 k4.")
      .value("RADIAL_TANGENTIAL", Lens::kRadialTangential)
      .value("FISHEYE", Lens::kFisheye);
  py::enum_<Prior>(module, "Prior", R"(The place prior.

REPETITIVE: two places may look alike, so that appearance alone accepts no loop.
UNIQUE: no two places do.)")
      .value("REPETITIVE", Prior::kRepetitive)
      .value("UNIQUE", Prior::kUnique);
}

void bind_camera(py::module_& module) {
  py::class_<Camera>(module, "Camera",
                     R"(A camera. Pixels; the centre of the upper left pixel is (0, 0).

distortion: of the lens model, empty: none. body_from_camera: 4 x 4, metres.)")
      .def(py::init([](int width_px, int height_px, double fx_px, double fy_px, double cx_px,
                       double cy_px, Lens lens, std::vector<double> distortion,
                       const py::object& body_from_camera) {
             Camera camera{width_px, height_px, fx_px, fy_px,
                           cx_px,    cy_px,     lens,  std::move(distortion)};
             if (!body_from_camera.is_none())
               camera.body_from_camera = pose_from("body_from_camera", body_from_camera);
             return camera;
           }),
           py::arg("width_px"), py::arg("height_px"), py::arg("fx_px"), py::arg("fy_px"),
           py::arg("cx_px"), py::arg("cy_px"), py::kw_only(),
           py::arg_v("lens", Lens::kRadialTangential, "Lens.RADIAL_TANGENTIAL"),
           py::arg("distortion") = std::vector<double>{}, py::arg("body_from_camera") = py::none())
      .def_readwrite("width_px", &Camera::width_px)
      .def_readwrite("height_px", &Camera::height_px)
      .def_readwrite("fx_px", &Camera::fx_px)
      .def_readwrite("fy_px", &Camera::fy_px)
      .def_readwrite("cx_px", &Camera::cx_px)
      .def_readwrite("cy_px", &Camera::cy_px)
      .def_readwrite("lens", &Camera::lens)
      .def_readwrite("distortion", &Camera::distortion)
      .def_property(
          "body_from_camera", [](const Camera& c) { return c.body_from_camera; },
          [](Camera& c, const py::object& pose) {
            c.body_from_camera = pose_from("body_from_camera", pose);
          })
      .def("__repr__", [](const Camera& c) {
        return "<samewhere.Camera " + std::to_string(c.width_px) + " x " +
               std::to_string(c.height_px) + " px, fx_px=" + text(c.fx_px) + ">";
      });
  module.def("read_camera", &read_camera, py::arg("file"), py::arg("width_px"),
             py::arg("height_px"),
             "A camera file of any format that `samewhere run --camera` reads, for images of this "
             "size. Raises InputError.");
}

void bind_options(py::module_& module) {
  py::enum_<MapUse>(module, "MapUse",
                    "EXTEND: the map grows in its file. LOCALIZE: it stays as it is.")
      .value("EXTEND", MapUse::kExtend)
      .value("LOCALIZE", MapUse::kLocalize);
  using Callback = std::function<void(const Event&)>;
  py::class_<Options>(module, "Options", R"(Options of Slam.

profile: 'default', 'recognition' or 'paper'. settings: 'section.key=value', docs/config.md.
threads: mapping, loop closing and full bundle adjustment in a thread each; the results are
identical. never_wait: track() does not wait for them, so that a session cannot be repeated to
the bit. map: a saved map to begin in, lost. save_to: a new file in which a new map grows.
on_event: called with each Event at the end of track() and finish(), in their thread, with the
GIL. It must not call the session. What it raises, track() raises; the frame has been tracked.)")
      .def(py::init([](std::string profile, std::vector<std::string> settings,
                       std::optional<Prior> prior, bool threads, bool never_wait,
                       const std::optional<std::filesystem::path>& map, MapUse map_use,
                       const std::optional<std::filesystem::path>& save_to, Callback on_event) {
             return Options{std::move(profile),
                            std::move(settings),
                            prior,
                            threads,
                            never_wait,
                            map.value_or(std::filesystem::path()),
                            map_use,
                            save_to.value_or(std::filesystem::path()),
                            std::move(on_event)};
           }),
           py::kw_only(), py::arg("profile") = "default",
           py::arg("settings") = std::vector<std::string>{}, py::arg("prior") = py::none(),
           py::arg("threads") = true, py::arg("never_wait") = false, py::arg("map") = py::none(),
           py::arg_v("map_use", MapUse::kExtend, "MapUse.EXTEND"), py::arg("save_to") = py::none(),
           py::arg("on_event") = py::none())
      .def_readwrite("profile", &Options::profile)
      .def_readwrite("settings", &Options::settings)
      .def_readwrite("prior", &Options::prior)
      .def_readwrite("threads", &Options::threads)
      .def_readwrite("never_wait", &Options::never_wait)
      .def_readwrite("map", &Options::map)
      .def_readwrite("map_use", &Options::map_use)
      .def_readwrite("save_to", &Options::save_to)
      .def_readwrite("on_event", &Options::on_event);
}

void bind_closer_options(py::module_& module) {
  py::enum_<OdometrySensor>(module, "OdometrySensor",
                            "What measured the odometry: the row of the drift model. COVARIANCES: "
                            "each keyframe comes with the covariance of its increment.")
      .value("COVARIANCES", OdometrySensor::kCovariances)
      .value("WHEEL", OdometrySensor::kWheel)
      .value("LEG", OdometrySensor::kLeg)
      .value("INERTIAL", OdometrySensor::kInertial)
      .value("VISUAL", OdometrySensor::kVisual)
      .value("POOR", OdometrySensor::kPoor);
  py::class_<LoopCloserOptions>(module, "LoopCloserOptions", R"(Options of LoopCloser.

are_keyframes: all that is given is used. False: frames of a camera, of which keyframes are
chosen as `samewhere run --odometry` does. The others as in Options.)")
      .def(
          py::init([](OdometrySensor sensor, std::string profile, std::vector<std::string> settings,
                      std::optional<Prior> prior, bool threads, bool are_keyframes) {
            return LoopCloserOptions{sensor,  std::move(profile), std::move(settings), prior,
                                     threads, are_keyframes};
          }),
          py::kw_only(), py::arg_v("sensor", OdometrySensor::kWheel, "OdometrySensor.WHEEL"),
          py::arg("profile") = "default", py::arg("settings") = std::vector<std::string>{},
          py::arg("prior") = py::none(), py::arg("threads") = true, py::arg("are_keyframes") = true)
      .def_readwrite("sensor", &LoopCloserOptions::sensor)
      .def_readwrite("profile", &LoopCloserOptions::profile)
      .def_readwrite("settings", &LoopCloserOptions::settings)
      .def_readwrite("prior", &LoopCloserOptions::prior)
      .def_readwrite("threads", &LoopCloserOptions::threads)
      .def_readwrite("are_keyframes", &LoopCloserOptions::are_keyframes);
}

}  // namespace

void bind_types(py::module_& module) {
  bind_enums(module);
  bind_camera(module);
  py::class_<Calibration>(module, "Calibration", R"(Cameras of a session.

cameras: one, or the left and the right one of a stereo pair. has_depth: whether frames come
with depth. frame_rate_hz: of the frames given; turns times of the settings into frames.)")
      .def(py::init([](std::vector<Camera> cameras, bool has_depth, double frame_rate_hz) {
             return Calibration{std::move(cameras), has_depth, frame_rate_hz};
           }),
           py::arg("cameras"), py::kw_only(), py::arg("has_depth") = false,
           py::arg("frame_rate_hz") = 30.0)
      .def_readwrite("cameras", &Calibration::cameras)
      .def_readwrite("has_depth", &Calibration::has_depth)
      .def_readwrite("frame_rate_hz", &Calibration::frame_rate_hz);
}

// After the events: on_event takes one.
void bind_all_options(py::module_& module) {
  bind_options(module);
  bind_closer_options(module);
}

}  // namespace samewhere::python
