#pragma once

#include <optional>
#include <string>

#include <pybind11/eigen.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <samewhere/types.hpp>

// Poses are 4 x 4 arrays of float64 in Python. Arguments are checked by the functions below, whose
// messages name the argument, what was found and what was expected.

namespace pybind11::detail {

// C++ to Python alone.
template <>
struct type_caster<Eigen::Isometry3d> {
  PYBIND11_TYPE_CASTER(Eigen::Isometry3d, const_name("numpy.ndarray[numpy.float64[4, 4]]"));
  bool load(handle, bool) { return false; }
  static handle cast(const Eigen::Isometry3d& pose, return_value_policy, handle) {
    array_t<double> matrix({4, 4});
    auto entries = matrix.mutable_unchecked<2>();
    for (ssize_t row = 0; row < 4; ++row) {
      for (ssize_t column = 0; column < 4; ++column)
        entries(row, column) = pose.matrix()(row, column);
    }
    return matrix.release();
  }
};

}  // namespace pybind11::detail

namespace samewhere::python {

namespace py = pybind11;

// A pose from a 4 x 4 array of numbers with the last row 0 0 0 1. Throws InputError.
Pose pose_from(const std::string& name, const py::object& given);

// A covariance from a 6 x 6 array of numbers; None: none. Throws InputError.
std::optional<Covariance> covariance_from(const std::string& name, const py::object& given);

// "shape (3, 4) of float32", or the type of what is no array.
std::string description_of(const py::object& given);

// Destroys a session while other threads of Python run: it may wait for threads of its own.
struct WithoutGil {
  template <class T>
  void operator()(T* session) const {
    const py::gil_scoped_release release;
    delete session;
  }
};

template <class T>
using Session = std::unique_ptr<T, WithoutGil>;

// An option given as a keyword: Options(**keywords).
template <class T>
T options_from(const py::object& options, const py::kwargs& keywords) {
  if (options.is_none()) return py::type::of<T>()(**keywords).template cast<T>();
  if (!keywords.empty())
    throw py::type_error("options: expected an object or keywords of its fields, not both");
  return options.cast<T>();
}

}  // namespace samewhere::python
