#pragma once

#include <optional>
#include <string>
#include <vector>

#include "convert.hpp"
#include <samewhere/types.hpp>

namespace samewhere::python {

// A frame whose pixels are those of numpy arrays, which it keeps alive. Nothing is copied here.
struct ArrayFrame {
  Frame frame;
  std::vector<py::array> images;
  std::optional<py::array> depth;
};

// The pixels of an array of uint8: (height, width), or (height, width, 3 or 4) with `format`
// "bgr", "rgb", "bgra". Throws InputError that begins with `name`.
Image image_from(const std::string& name, const py::object& given,
                 const std::optional<std::string>& format);

// The depth of an array (height, width) of uint16 in units, or of float32 in metres. Throws
// InputError that begins with "depth".
Image depth_from(const py::object& given, double depth_units_per_m);

// A frame as the library reads it, in arrays of its own.
ArrayFrame copy_of(const Frame& frame);

void bind_frame(py::module_& module);

}  // namespace samewhere::python
