#include "convert.hpp"

#include <samewhere/errors.hpp>

namespace samewhere::python {
namespace {

// Real numbers in an array of this size.
py::array_t<double> matrix_from(const std::string& name, const py::object& given, py::ssize_t size,
                                const std::string& expected) {
  const auto array = py::array::ensure(given);
  if (!array) PyErr_Clear();
  const bool is_real = array && std::string("fiu").find(array.dtype().kind()) != std::string::npos;
  if (!is_real || array.ndim() != 2 || array.shape(0) != size || array.shape(1) != size)
    throw InputError(name + ": " + description_of(given) + "; expected " + expected);
  return py::array_t<double>(array);
}

}  // namespace

std::string description_of(const py::object& given) {
  if (!py::isinstance<py::array>(given))
    return py::str(py::type::of(given).attr("__name__")).cast<std::string>();
  const auto array = given.cast<py::array>();
  return "shape " + py::str(array.attr("shape")).cast<std::string>() + " of " +
         py::str(array.dtype()).cast<std::string>();
}

Pose pose_from(const std::string& name, const py::object& given) {
  const std::string expected = "a 4 x 4 array of float64, its last row 0 0 0 1";
  const py::array_t<double> matrix = matrix_from(name, given, 4, expected);
  const auto entries = matrix.unchecked<2>();
  Pose pose = Pose::Identity();
  for (py::ssize_t row = 0; row < 3; ++row) {
    for (py::ssize_t column = 0; column < 4; ++column)
      pose.matrix()(row, column) = entries(row, column);
  }
  const bool is_affine =
      entries(3, 0) == 0.0 && entries(3, 1) == 0.0 && entries(3, 2) == 0.0 && entries(3, 3) == 1.0;
  if (!is_affine) throw InputError(name + ": another last row; expected " + expected);
  return pose;
}

std::optional<Covariance> covariance_from(const std::string& name, const py::object& given) {
  if (given.is_none()) return std::nullopt;
  const py::array_t<double> matrix =
      matrix_from(name, given, 6, "a 6 x 6 array of float64, order [m; rad]");
  const auto entries = matrix.unchecked<2>();
  Covariance covariance;
  for (py::ssize_t row = 0; row < 6; ++row) {
    for (py::ssize_t column = 0; column < 6; ++column)
      covariance(row, column) = entries(row, column);
  }
  return covariance;
}

}  // namespace samewhere::python
