#include "bindings.hpp"

#include <samewhere/core/errors.hpp>

namespace samewhere::python {

py::object trajectory_of(const std::vector<double>& stamps_s, const std::vector<Pose>& poses) {
  const auto num_poses = static_cast<py::ssize_t>(poses.size());
  py::array_t<double> stamps(num_poses);
  py::array_t<double> matrices({num_poses, py::ssize_t{4}, py::ssize_t{4}});
  auto stamp = stamps.mutable_unchecked<1>();
  auto entries = matrices.mutable_unchecked<3>();
  for (py::ssize_t i = 0; i < num_poses; ++i) {
    const auto at = static_cast<std::size_t>(i);
    stamp(i) = stamps_s[at];
    for (py::ssize_t row = 0; row < 4; ++row) {
      for (py::ssize_t column = 0; column < 4; ++column)
        entries(i, row, column) = poses[at].matrix()(row, column);
    }
  }
  return py::module_::import("samewhere._trajectory").attr("Trajectory")(stamps, matrices);
}

namespace {

void bind_errors(py::module_& module) {
  static const py::exception<InputError> input_error(module, "InputError", PyExc_ValueError);
  static const py::exception<UsageError> usage_error(module, "UsageError", PyExc_RuntimeError);
  input_error.attr("__doc__") =
      "Bad input: a frame, a calibration, a setting or a file. The message names it, the value "
      "found and what was expected. A frame that is refused changes nothing.";
  usage_error.attr("__doc__") =
      "A call that is not allowed now: a frame after finish(), two threads in track() at once, or "
      "any call after an internal error. The message says whether the session goes on.";
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const InputError& error) {
      PyErr_SetString(input_error.ptr(), error.what());
    } catch (const core::InputError& error) {
      PyErr_SetString(input_error.ptr(), error.what());
    } catch (const UsageError& error) {
      PyErr_SetString(usage_error.ptr(), error.what());
    } catch (const core::ContractError& error) {
      PyErr_SetString(usage_error.ptr(), error.what());
    }
  });
}

}  // namespace
}  // namespace samewhere::python

PYBIND11_MODULE(_core, module) {
  using namespace samewhere::python;
  module.doc() = "Bindings of the C++ library. Use package `samewhere`.";
  bind_errors(module);
  bind_types(module);
  bind_frame(module);
  bind_events(module);
  bind_all_options(module);
  bind_map(module);
  bind_sessions(module);
  bind_evaluate(module);
}
