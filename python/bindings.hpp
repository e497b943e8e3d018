#pragma once

#include <pybind11/functional.h>

#include "convert.hpp"
#include "frame.hpp"
#include <samewhere/errors.hpp>
#include <samewhere/event.hpp>
#include <samewhere/loop_closer.hpp>
#include <samewhere/loop_detector.hpp>
#include <samewhere/loop_verifier.hpp>
#include <samewhere/map.hpp>
#include <samewhere/recording.hpp>
#include <samewhere/slam.hpp>
#include <samewhere/types.hpp>

// The parts of module samewhere._core, in the order in which they are bound.

namespace samewhere::python {

void bind_types(py::module_& module);
void bind_events(py::module_& module);
void bind_all_options(py::module_& module);
void bind_map(py::module_& module);
void bind_sessions(py::module_& module);
void bind_evaluate(py::module_& module);

// samewhere.Trajectory(stamps_s, poses) of poses with stamps.
py::object trajectory_of(const std::vector<double>& stamps_s, const std::vector<Pose>& poses);

}  // namespace samewhere::python
