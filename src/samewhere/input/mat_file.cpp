#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <matio.h>
#include <zlib.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>
#include <samewhere/core/text_file.hpp>
#include <samewhere/input/mat_file.hpp>
#include <samewhere/input/truth_file.hpp>

namespace samewhere::input {
namespace {

using core::InputError;
using core::PlaceTruthMatrix;
using std::filesystem::path;

constexpr core::SizeLimit kMatLimit{256 * core::kMegabyte, "a MATLAB file"};
constexpr std::size_t kMaxData_bytes = 1'000'000'000;  // 11,000 x 11,000 doubles
constexpr std::size_t kMaxHeader_bytes = 1000;         // of a variable
constexpr std::size_t kHeader_bytes = 128;
constexpr std::size_t kTag_bytes = 8;

struct CloseMat {
  void operator()(mat_t* mat) const { Mat_Close(mat); }
};
struct FreeVariable {
  void operator()(matvar_t* variable) const { Mat_VarFree(variable); }
};
using Mat = std::unique_ptr<mat_t, CloseMat>;
using Variable = std::unique_ptr<matvar_t, FreeVariable>;

std::uint32_t value_at(std::string_view bytes, std::size_t at, bool is_little) {
  std::uint32_t number = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const auto byte = static_cast<unsigned char>(bytes[at + (is_little ? 3 - i : i)]);
    number = number << 8U | byte;
  }
  return number;
}

[[noreturn]] void fail_damaged(const path& file) {
  throw InputError(file.string() + ": is cut short or damaged: its matrix cannot be read");
}

// What a compressed element holds.
std::string inflated(std::string_view bytes, const path& file) {
  z_stream stream{};
  if (inflateInit(&stream) != Z_OK) fail_damaged(file);
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  std::string whole;
  std::string piece(std::size_t{1} << 20U, '\0');
  int state = Z_OK;
  while (state == Z_OK && whole.size() <= kMaxData_bytes + kMaxHeader_bytes) {
    stream.next_out = reinterpret_cast<Bytef*>(piece.data());
    stream.avail_out = static_cast<uInt>(piece.size());
    state = inflate(&stream, Z_NO_FLUSH);
    whole.append(piece, 0, piece.size() - stream.avail_out);
  }
  inflateEnd(&stream);
  if (state != Z_STREAM_END || whole.size() < kTag_bytes) fail_damaged(file);
  return whole;
}

// libmatio takes memory as the sizes of parts say: all have to be within the element. Of a kind of
// variable that holds others nothing is read.
void require_sound_matrix(std::string_view bytes, bool is_little, const path& file) {
  constexpr std::uint32_t kMostSmall_bytes = 4;
  constexpr std::size_t kFlags_bytes = 16;
  if (bytes.size() < kFlags_bytes) fail_damaged(file);
  const std::uint32_t variable_class = value_at(bytes, kTag_bytes, is_little) & 0xffU;
  if (variable_class < MAT_C_CHAR || variable_class > MAT_C_UINT64) {
    throw InputError(fmt::format("{}: holds a variable of class {}, expected matrices only",
                                 file.string(), variable_class));
  }
  for (std::size_t at = 0; at < bytes.size();) {
    const std::size_t left = bytes.size() - at;
    if (left < kTag_bytes) fail_damaged(file);
    const std::uint32_t type = value_at(bytes, at, is_little);
    const bool is_small = type >> 16U != 0;
    const std::size_t size = is_small ? type >> 16U : value_at(bytes, at + 4, is_little);
    if (is_small ? size > kMostSmall_bytes : size > left - kTag_bytes) fail_damaged(file);
    at += kTag_bytes + (is_small ? 0 : (size + 7) / 8 * 8);
  }
}

void require_sound_element(std::string_view bytes, std::uint32_t type, bool is_little,
                           const path& file) {
  if (type == MAT_T_MATRIX) return require_sound_matrix(bytes, is_little, file);
  const std::string whole = inflated(bytes, file);
  const std::string_view inner(whole);
  if (value_at(inner, 0, is_little) != MAT_T_MATRIX ||
      value_at(inner, 4, is_little) > inner.size() - kTag_bytes)
    fail_damaged(file);
  require_sound_matrix(inner.substr(kTag_bytes, value_at(inner, 4, is_little)), is_little, file);
}

// libmatio takes what is missing at the end of a file for zeros, and reads version 7.3 by HDF5.
void require_whole_version_5(const path& file) {
  const std::string bytes = core::read_file(file, kMatLimit);
  const std::string_view order =
      bytes.size() < kHeader_bytes ? "" : std::string_view(bytes).substr(126, 2);
  const bool is_little = order == "IM";
  if (!is_little && order != "MI")
    throw InputError(file.string() + ": is no MATLAB file of version 5 to 7");
  constexpr char kVersion5 = 1;
  if (bytes[is_little ? 125 : 124] != kVersion5) {
    throw InputError(file.string() +
                     ": is a MATLAB file of another version, expected 5 to 7 (save -v7)");
  }
  for (std::size_t at = kHeader_bytes; at < bytes.size();) {
    const std::size_t left = bytes.size() - at;
    const std::size_t size = left < kTag_bytes ? left : value_at(bytes, at + 4, is_little);
    if (left < kTag_bytes || size > left - kTag_bytes) {
      throw InputError(fmt::format("{}: is cut short or damaged: found {} bytes at {}, expected {}",
                                   file.string(), left, at, size + kTag_bytes));
    }
    const std::uint32_t type = value_at(bytes, at, is_little);
    if (type != MAT_T_MATRIX && type != MAT_T_COMPRESSED) {
      throw InputError(
          fmt::format("{}: is damaged: found an element of type {} at {}, expected a matrix",
                      file.string(), type, at));
    }
    require_sound_element(std::string_view(bytes).substr(at + kTag_bytes, size), type, is_little,
                          file);
    at += kTag_bytes + size;
  }
}

bool is_matrix_of_numbers(const matvar_t& variable) {
  return variable.class_type >= MAT_C_SPARSE && variable.class_type <= MAT_C_UINT64 &&
         variable.isComplex == 0 && variable.rank == 2 && variable.dims != nullptr;
}

bool is_square(const matvar_t& variable) {
  return variable.dims[0] == variable.dims[1] && variable.dims[0] > 0;
}

std::string shape_text(const matvar_t& variable) {
  return fmt::format("{} ({} x {})", core::printable(variable.name == nullptr ? "" : variable.name),
                     variable.dims[0], variable.dims[1]);
}

bool is_truth(const matvar_t& variable) {
  return is_square(variable) && variable.name != nullptr &&
         std::string_view(variable.name) == "truth";
}

[[noreturn]] void fail_choice(bool are_several, const std::vector<std::string>& shapes,
                              const path& file) {
  const std::string found = shapes.empty() ? "none" : fmt::format("{}", fmt::join(shapes, ", "));
  throw InputError(
      are_several
          ? fmt::format("{}: holds several square matrices: {}; expected one, or truth",
                        file.string(), found)
          : fmt::format("{}: holds no square matrix of numbers; found {}", file.string(), found));
}

// Without its values.
Variable find_matrix(mat_t* mat, const path& file) {
  constexpr int kMostVariables = 1000;
  Variable found;
  std::vector<std::string> shapes;
  for (int i = 0; i < kMostVariables; ++i) {
    Variable variable(Mat_VarReadNextInfo(mat));
    if (!variable) break;
    if (!is_matrix_of_numbers(*variable)) continue;
    if (is_truth(*variable)) return variable;
    if (shapes.size() < 10) shapes.push_back(shape_text(*variable));
    if (!is_square(*variable)) continue;
    if (found) fail_choice(true, shapes, file);
    found = std::move(variable);
  }
  if (!found) fail_choice(false, shapes, file);
  return found;
}

void check_size(const matvar_t& variable, const path& file) {
  const std::size_t rows = variable.dims[0];
  const bool is_full = variable.class_type != MAT_C_SPARSE;
  const std::size_t value_bytes = is_full ? Mat_SizeOfClass(variable.class_type) : 1;
  if (rows > static_cast<std::size_t>(kMaxPlaceRows)) {
    throw InputError(
        fmt::format("{}: has {} rows, expected at most {}", file.string(), rows, kMaxPlaceRows));
  }
  if (rows * rows * value_bytes > kMaxData_bytes) {
    throw InputError(fmt::format(
        "{}: takes more than {} MB; expected a sparse matrix, or one of uint8 or logical values",
        file.string(), kMaxData_bytes / core::kMegabyte));
  }
}

template <class Number>
double number_of(const void* data, std::size_t index) {
  return static_cast<double>(static_cast<const Number*>(data)[index]);
}

double value_at(const void* data, matio_types type, std::size_t index) {
  switch (type) {
    case MAT_T_INT8:
      return number_of<std::int8_t>(data, index);
    case MAT_T_UINT8:
      return number_of<std::uint8_t>(data, index);
    case MAT_T_INT16:
      return number_of<std::int16_t>(data, index);
    case MAT_T_UINT16:
      return number_of<std::uint16_t>(data, index);
    case MAT_T_INT32:
      return number_of<std::int32_t>(data, index);
    case MAT_T_UINT32:
      return number_of<std::uint32_t>(data, index);
    case MAT_T_INT64:
      return number_of<std::int64_t>(data, index);
    case MAT_T_UINT64:
      return number_of<std::uint64_t>(data, index);
    case MAT_T_SINGLE:
      return number_of<float>(data, index);
    case MAT_T_DOUBLE:
      return number_of<double>(data, index);
    default:
      return std::numeric_limits<double>::quiet_NaN();
  }
}

// Columns come one after another.
void fill_full(const matvar_t& variable, const path& file, PlaceTruthMatrix& places) {
  const auto rows = static_cast<std::size_t>(places.num_frames);
  const std::size_t value_bytes = Mat_SizeOf(variable.data_type);
  if (value_bytes == 0 || variable.nbytes / value_bytes < rows * rows) fail_damaged(file);
  for (std::size_t column = 0; column < rows; ++column) {
    for (std::size_t row = 0; row < rows; ++row) {
      places.values[row * rows + column] = place_truth_of_value(
          value_at(variable.data, variable.data_type, column * rows + row), file.string());
    }
  }
}

void fill_sparse(const matvar_t& variable, const path& file, PlaceTruthMatrix& places) {
  const auto& sparse = *static_cast<const mat_sparse_t*>(variable.data);
  const auto rows = static_cast<std::size_t>(places.num_frames);
  const bool is_whole = sparse.jc != nullptr && sparse.njc == rows + 1 && sparse.jc[0] == 0 &&
                        sparse.jc[rows] <= sparse.nir && sparse.jc[rows] <= sparse.ndata &&
                        (sparse.jc[rows] == 0 || (sparse.ir != nullptr && sparse.data != nullptr));
  if (!is_whole) fail_damaged(file);
  for (std::size_t column = 0; column < rows; ++column) {
    if (sparse.jc[column] > sparse.jc[column + 1] || sparse.jc[column + 1] > sparse.jc[rows])
      fail_damaged(file);
    for (std::size_t k = sparse.jc[column]; k < sparse.jc[column + 1]; ++k) {
      if (sparse.ir[k] >= rows) fail_damaged(file);
      places.values[sparse.ir[k] * rows + column] =
          place_truth_of_value(value_at(sparse.data, variable.data_type, k), file.string());
    }
  }
}

}  // namespace

PlaceTruthMatrix read_mat_matrix(const path& file) {
  require_whole_version_5(file);
  const Mat mat(Mat_Open(file.c_str(), MAT_ACC_RDONLY));
  if (!mat) throw InputError(file.string() + ": is no MATLAB file that libmatio can read");
  const Variable variable = find_matrix(mat.get(), file);
  check_size(*variable, file);
  if (Mat_VarReadDataAll(mat.get(), variable.get()) != 0 || variable->data == nullptr)
    fail_damaged(file);
  const std::size_t rows = variable->dims[0];
  PlaceTruthMatrix places{static_cast<int>(rows), {}};
  places.values.resize(rows * rows, core::PlaceTruth::kDifferent);
  if (variable->class_type == MAT_C_SPARSE) {
    fill_sparse(*variable, file, places);
  } else {
    fill_full(*variable, file, places);
  }
  return places;
}

}  // namespace samewhere::input
