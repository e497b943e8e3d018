#include "frame.hpp"

#include <cstring>

#include <samewhere/errors.hpp>

namespace samewhere::python {
namespace {

[[noreturn]] void refuse(const std::string& name, const py::object& given,
                         const std::string& expected) {
  throw InputError(name + ": " + description_of(given) + "; expected " + expected);
}

// Of this machine's byte order.
template <class T>
bool is_of(const py::array& array) {
  return array.dtype().equal(py::dtype::of<T>());
}

// Rows may have a gap between them, pixels of a row may not.
void require_rows(const std::string& name, const py::array& array) {
  py::ssize_t row_bytes = array.itemsize();
  bool is_dense = true;
  for (py::ssize_t axis = array.ndim() - 1; axis > 0; --axis) {
    is_dense = is_dense && (array.strides(axis) == row_bytes || array.shape(axis) == 1);
    row_bytes *= array.shape(axis);
  }
  if (is_dense && (array.strides(0) >= row_bytes || array.shape(0) == 1)) return;
  throw InputError(name + ": strides " + py::str(array.attr("strides")).cast<std::string>() +
                   " bytes of shape " + py::str(array.attr("shape")).cast<std::string>() +
                   "; expected rows from top to bottom whose pixels lie side by side "
                   "(numpy.ascontiguousarray makes such a copy)");
}

Image view_of(const std::string& name, const py::array& array, PixelFormat format) {
  if (array.shape(0) == 0 || array.shape(1) == 0)
    refuse(name, array, "at least one row and one column");
  require_rows(name, array);
  const bool has_one_row = array.shape(0) == 1;
  return {.data = array.data(),
          .width_px = static_cast<int>(array.shape(1)),
          .height_px = static_cast<int>(array.shape(0)),
          .format = format,
          .stride_bytes = has_one_row ? 0 : static_cast<std::size_t>(array.strides(0))};
}

struct NamedFormat {
  const char* name;
  PixelFormat format;
  py::ssize_t num_channels;
};

constexpr NamedFormat kFormats[] = {{"gray", PixelFormat::kGray8, 1},
                                    {"bgr", PixelFormat::kBgr8, 3},
                                    {"rgb", PixelFormat::kRgb8, 3},
                                    {"bgra", PixelFormat::kBgra8, 4}};

NamedFormat format_of(const std::string& name, const py::array& array,
                      const std::optional<std::string>& given) {
  const py::ssize_t num_channels = array.ndim() == 2 ? 1 : array.shape(2);
  if (!given) {
    if (array.ndim() == 2) return kFormats[0];
    refuse(name, array, "format='bgr', 'rgb' or 'bgra' for an image of several channels");
  }
  for (const NamedFormat& format : kFormats) {
    if (*given != format.name) continue;
    if (num_channels == format.num_channels) return format;
    refuse(name, array,
           format.num_channels == 1
               ? "shape (height, width) for format='gray'"
               : "shape (height, width, " + std::to_string(format.num_channels) + ") for format='" +
                     format.name + "'");
  }
  throw InputError("format: '" + *given + "'; expected 'gray', 'bgr', 'rgb' or 'bgra'");
}

py::list list_of_images(const py::object& given) {
  if (py::isinstance<py::list>(given) || py::isinstance<py::tuple>(given)) return py::list(given);
  py::list one;
  one.append(given);
  return one;
}

ArrayFrame frame_from(double stamp_s, const py::object& images, const py::object& depth,
                      const std::optional<std::string>& format, double depth_units_per_m) {
  ArrayFrame made;
  made.frame.stamp_s = stamp_s;
  const bool is_list = py::isinstance<py::list>(images) || py::isinstance<py::tuple>(images);
  for (const py::handle image : list_of_images(images)) {
    const auto object = py::reinterpret_borrow<py::object>(image);
    const std::string name =
        is_list ? "images[" + std::to_string(made.images.size()) + "]" : "images";
    made.frame.images.push_back(image_from(name, object, format));
    made.images.push_back(object.cast<py::array>());
  }
  if (!depth.is_none()) {
    made.frame.depth = depth_from(depth, depth_units_per_m);
    made.depth = depth.cast<py::array>();
  }
  return made;
}

py::array copy_of(const Image& image) {
  const bool is_color = image.format == PixelFormat::kBgr8;
  const bool is_depth = image.format == PixelFormat::kDepthFloat;
  std::vector<py::ssize_t> shape{image.height_px, image.width_px};
  if (is_color) shape.push_back(3);
  const py::dtype type = is_depth ? py::dtype::of<float>() : py::dtype::of<std::uint8_t>();
  py::array copy(type, shape);
  const std::size_t row_bytes =
      static_cast<std::size_t>(image.width_px) * (is_color ? 3 : 1) * (is_depth ? 4 : 1);
  const std::size_t stride = image.stride_bytes == 0 ? row_bytes : image.stride_bytes;
  auto* out = static_cast<std::byte*>(copy.mutable_data());
  const auto* in = static_cast<const std::byte*>(image.data);
  for (int row = 0; row < image.height_px; ++row)
    std::memcpy(out + static_cast<std::size_t>(row) * row_bytes,
                in + static_cast<std::size_t>(row) * stride, row_bytes);
  return copy;
}

}  // namespace

Image image_from(const std::string& name, const py::object& given,
                 const std::optional<std::string>& format) {
  const std::string expected =
      "a numpy array of uint8, shape (height, width) or (height, width, 3)";
  if (!py::isinstance<py::array>(given)) refuse(name, given, expected);
  const auto array = given.cast<py::array>();
  if (!is_of<std::uint8_t>(array) || array.ndim() < 2 || array.ndim() > 3)
    refuse(name, given, expected);
  return view_of(name, array, format_of(name, array, format).format);
}

Image depth_from(const py::object& given, double depth_units_per_m) {
  const std::string expected =
      "a numpy array (height, width) of uint16 (units) or float32 (metres)";
  if (!py::isinstance<py::array>(given)) refuse("depth", given, expected);
  const auto array = given.cast<py::array>();
  const bool is_in_units = is_of<std::uint16_t>(array);
  if ((!is_in_units && !is_of<float>(array)) || array.ndim() != 2) refuse("depth", given, expected);
  Image depth =
      view_of("depth", array, is_in_units ? PixelFormat::kDepth16 : PixelFormat::kDepthFloat);
  if (!(depth_units_per_m > 0.0))
    throw InputError(
        "depth_units_per_m: " + py::str(py::float_(depth_units_per_m)).cast<std::string>() +
        "; expected more than 0");
  depth.depth_units_per_m = depth_units_per_m;
  return depth;
}

ArrayFrame copy_of(const Frame& frame) {
  ArrayFrame made;
  made.frame.stamp_s = frame.stamp_s;
  for (const Image& image : frame.images) {
    made.images.push_back(copy_of(image));
    made.frame.images.push_back(view_of("images", made.images.back(), image.format));
  }
  if (frame.depth) {
    made.depth = copy_of(*frame.depth);
    made.frame.depth = view_of("depth", *made.depth, frame.depth->format);
  }
  return made;
}

void bind_frame(py::module_& module) {
  py::class_<ArrayFrame>(module, "Frame", R"(Sensor data of one moment.

stamp_s: seconds, rises from frame to frame.
images: one array per camera, or one array. uint8, shape (height, width), or
    (height, width, 3) with format='bgr' or 'rgb', (height, width, 4) with format='bgra'.
depth: of camera 0, the same size: uint16 in units (depth_units_per_m), or float32 in
    metres, along the optical axis. 0, NaN and infinity: unknown.

Arrays are referred to, not copied: rows may have a gap, pixels of a row lie side by side.
The pixels must not change until the call that takes the frame returns. Raises InputError.)")
      .def(py::init(&frame_from), py::arg("stamp_s"), py::arg("images"),
           py::arg("depth") = py::none(), py::kw_only(), py::arg("format") = py::none(),
           py::arg("depth_units_per_m") = 1000.0)
      .def_property_readonly(
          "stamp_s", [](const ArrayFrame& f) { return f.frame.stamp_s; }, "Seconds.")
      .def_property_readonly(
          "images", [](const ArrayFrame& f) { return f.images; },
          "The arrays that were given; of a recording gray or BGR.")
      .def_property_readonly(
          "depth", [](const ArrayFrame& f) { return f.depth; },
          "The array that was given; of a recording float32, metres. Or None.")
      .def_property_readonly(
          "formats",
          [](const ArrayFrame& f) {
            std::vector<std::string> names;
            for (const Image& image : f.frame.images) {
              for (const NamedFormat& format : kFormats)
                if (format.format == image.format) names.emplace_back(format.name);
            }
            return names;
          },
          "Of each image: 'gray', 'bgr', 'rgb' or 'bgra'.")
      .def("__repr__", [](const ArrayFrame& f) {
        return "<samewhere.Frame stamp_s=" +
               py::str(py::float_(f.frame.stamp_s)).cast<std::string>() + ", " +
               std::to_string(f.images.size()) + " images" + (f.depth ? ", depth>" : ">");
      });
}

}  // namespace samewhere::python
