#include "bindings.hpp"
#include <samewhere/core/file.hpp>
#include <samewhere/core/tum_file.hpp>
#include <samewhere/evaluate/precision_recall.hpp>
#include <samewhere/evaluate/trajectory_error.hpp>

namespace samewhere::python {
namespace {

namespace fs = std::filesystem;

core::Rigid3 rigid_of(const Pose& pose) {
  return {Eigen::Quaterniond(pose.linear()).normalized(), pose.translation()};
}

Pose pose_of(const core::Rigid3& rigid) {
  Pose pose = Pose::Identity();
  pose.matrix() = rigid.matrix();
  return pose;
}

[[noreturn]] void refuse(const std::string& name, const std::string& found,
                         const std::string& expected) {
  throw InputError(name + ": " + found + "; expected " + expected);
}

// A pair (stamps_s, poses): arrays (n) and (n, 4, 4).
core::Trajectory trajectory_from(const std::string& name, const py::object& given) {
  const std::string expected =
      "a samewhere.Trajectory, or a pair of arrays (n) of seconds and (n, 4, 4) of poses";
  if (!py::isinstance<py::tuple>(given) || py::len(given) != 2)
    refuse(name, description_of(given), expected);
  const auto pair = given.cast<py::tuple>();
  const auto stamps = py::array_t<double, py::array::forcecast>::ensure(pair[0]);
  if (!stamps) PyErr_Clear();
  const auto poses = py::array_t<double, py::array::forcecast>::ensure(pair[1]);
  if (!poses) PyErr_Clear();
  if (!stamps || !poses || stamps.ndim() != 1 || poses.ndim() != 3 || poses.shape(1) != 4 ||
      poses.shape(2) != 4 || poses.shape(0) != stamps.shape(0)) {
    refuse(name, description_of(pair[0]) + " and " + description_of(pair[1]), expected);
  }
  core::Trajectory trajectory;
  const auto stamp = stamps.unchecked<1>();
  const auto entries = poses.unchecked<3>();
  for (py::ssize_t i = 0; i < stamps.shape(0); ++i) {
    Pose pose = Pose::Identity();
    for (py::ssize_t row = 0; row < 3; ++row) {
      for (py::ssize_t column = 0; column < 4; ++column)
        pose.matrix()(row, column) = entries(i, row, column);
    }
    if (!std::isfinite(stamp(i)) || !pose.matrix().allFinite())
      refuse(name, "row " + std::to_string(i) + " is not finite", "finite numbers");
    if (i > 0 && stamp(i) <= stamp(i - 1))
      refuse(name, "the stamp of row " + std::to_string(i) + " does not rise", "rising stamps");
    trajectory.push_back({stamp(i), rigid_of(pose)});
  }
  return trajectory;
}

py::object to_python(const core::Trajectory& trajectory) {
  std::vector<double> stamps_s;
  std::vector<Pose> poses;
  for (const core::StampedPose& pose : trajectory) {
    stamps_s.push_back(pose.stamp_s);
    poses.push_back(pose_of(pose.world_from_camera));
  }
  return trajectory_of(stamps_s, poses);
}

core::PlaceTruthMatrix places_from(const py::array& given) {
  if (!given.dtype().equal(py::dtype::of<std::uint8_t>()) || given.ndim() != 2 ||
      given.shape(0) != given.shape(1)) {
    refuse("truth", description_of(given), "a square array of uint8: 0 different, 1 same, 2 near");
  }
  const auto matrix = py::array_t<std::uint8_t>(given);
  const auto entries = matrix.unchecked<2>();
  core::PlaceTruthMatrix places{.num_frames = static_cast<int>(given.shape(0)), .values = {}};
  for (py::ssize_t row = 0; row < given.shape(0); ++row) {
    for (py::ssize_t column = 0; column < given.shape(0); ++column) {
      if (entries(row, column) > 2)
        refuse("truth", "value " + std::to_string(entries(row, column)), "0, 1 or 2");
      places.values.push_back(static_cast<core::PlaceTruth>(entries(row, column)));
    }
  }
  return places;
}

std::vector<evaluate::Match> matches_from(const py::object& given) {
  const std::string expected = "an array (n, 3) of rows query, match, score";
  const auto array = py::array_t<double, py::array::forcecast>::ensure(given);
  if (!array) PyErr_Clear();
  const bool is_empty = array && array.size() == 0;
  if (!array || (!is_empty && (array.ndim() != 2 || array.shape(1) != 3)))
    refuse("matches", description_of(given), expected);
  std::vector<evaluate::Match> matches;
  if (is_empty) return matches;
  const auto rows = array.unchecked<2>();
  for (py::ssize_t i = 0; i < array.shape(0); ++i) {
    const auto is_position = [&](double value) {
      return value >= 0.0 && value < 1e9 && value == std::floor(value);
    };
    if (!is_position(rows(i, 0)) || !is_position(rows(i, 1)))
      refuse("matches", "row " + std::to_string(i) + " has no whole positions", expected);
    matches.push_back({static_cast<int>(rows(i, 0)), static_cast<int>(rows(i, 1)), rows(i, 2)});
  }
  return matches;
}

void bind_trajectory_errors(py::module_& module) {
  py::class_<evaluate::AteResult>(module, "Ate",
                                  R"(Absolute trajectory error, metres, after alignment.

num_poses: of the estimate, that have a truth. scale: of truth_from_estimate, 4 x 4 without the
scale: x_truth = scale * (R @ x_estimate) + t.)")
      .def_readonly("rmse_m", &evaluate::AteResult::rmse_m)
      .def_readonly("median_m", &evaluate::AteResult::median_m)
      .def_readonly("min_m", &evaluate::AteResult::min_m)
      .def_readonly("max_m", &evaluate::AteResult::max_m)
      .def_readonly("num_poses", &evaluate::AteResult::num_poses)
      .def_readonly("scale", &evaluate::AteResult::scale)
      .def_property_readonly("truth_from_estimate", [](const evaluate::AteResult& a) {
        return pose_of({a.truth_from_estimate.rotation, a.truth_from_estimate.translation});
      });
  py::class_<evaluate::RpeResult>(module, "Rpe", "Relative pose error: drift over a fixed time.")
      .def_readonly("translation_median_m", &evaluate::RpeResult::translation_median_m)
      .def_readonly("translation_rmse_m", &evaluate::RpeResult::translation_rmse_m)
      .def_readonly("rotation_median_deg", &evaluate::RpeResult::rotation_median_deg)
      .def_readonly("rotation_rmse_deg", &evaluate::RpeResult::rotation_rmse_deg)
      .def_readonly("num_pairs", &evaluate::RpeResult::num_pairs);
  module.def(
      "ate",
      [](const py::object& truth, const py::object& estimate, bool free_scale) {
        const auto alignment = free_scale ? evaluate::Alignment::kSim3 : evaluate::Alignment::kSe3;
        return evaluate::ate(trajectory_from("truth", truth), trajectory_from("estimate", estimate),
                             alignment);
      },
      py::arg("truth"), py::arg("estimate"), py::kw_only(), py::arg("free_scale") = false,
      R"(Absolute trajectory error of camera 0 (docs/evaluation.md).

Ground truth is interpolated to the estimate's stamps; least squares alignment of the positions,
with free_scale (monocular) of the scale too. None with fewer than 3 poses that have a truth.)");
  module.def(
      "rpe",
      [](const py::object& truth, const py::object& estimate, double delta_s, double scale) {
        if (!(delta_s > 0.0)) refuse("delta_s", std::to_string(delta_s), "more than 0 seconds");
        return evaluate::rpe(trajectory_from("truth", truth), trajectory_from("estimate", estimate),
                             delta_s, scale);
      },
      py::arg("truth"), py::arg("estimate"), py::kw_only(), py::arg("delta_s") = 1.0,
      py::arg("scale") = 1.0,
      R"(Relative pose error: error of the estimated motion over delta_s seconds.

scale multiplies the estimate's translations (monocular: Ate.scale). None where no pair of poses
is so far apart. Sturm et al., "A benchmark for the evaluation of RGB-D SLAM systems", 2012.)");
}

void bind_precision_recall(py::module_& module) {
  using evaluate::PrecisionRecall;
  py::class_<PrecisionRecall>(module, "PrecisionRecall", R"(Protocol pr-v2 of docs/evaluation.md.

curve: array (n, 3) of recall (ascending), precision, score.)")
      .def_property_readonly("curve",
                             [](const PrecisionRecall& result) {
                               py::array_t<double> curve(
                                   {static_cast<py::ssize_t>(result.curve.size()), py::ssize_t{3}});
                               double* out = curve.mutable_data();
                               for (const auto& point : result.curve) {
                                 *out++ = point.recall;
                                 *out++ = point.precision;
                                 *out++ = point.score;
                               }
                               return curve;
                             })
      .def_readonly("auc", &PrecisionRecall::auc)
      .def_readonly("recall_at_full_precision", &PrecisionRecall::recall_at_full_precision)
      .def_readonly("precision_at_recall_35", &PrecisionRecall::precision_at_recall_35)
      .def_readonly("precision_at_recall_70", &PrecisionRecall::precision_at_recall_70)
      .def_readonly("num_queries", &PrecisionRecall::num_queries)
      .def_readonly("num_with_loop", &PrecisionRecall::num_with_loop)
      .def_readonly("max_recall", &PrecisionRecall::max_recall)
      .def_readonly("num_false", &PrecisionRecall::num_false);
  module.def(
      "precision_recall",
      [](const py::array& truth, const py::object& matches, int window_frames) {
        return evaluate::precision_recall(places_from(truth), matches_from(matches), window_frames);
      },
      py::arg("truth"), py::arg("matches"), py::kw_only(), py::arg("window_frames"),
      R"(Precision and recall of place recognition, over all thresholds of the score.

truth: (n, n) of uint8, row query, column match: 0 different, 1 same, 2 near (ignored).
matches: (m, 3) of rows query, match, score, at most one row per query; higher is more similar.
window_frames: rows with query - match <= window_frames are no loops. Raises InputError.)");
}

}  // namespace

void bind_evaluate(py::module_& module) {
  bind_trajectory_errors(module);
  bind_precision_recall(module);
  module.def(
      "read_trajectory", [](const fs::path& file) { return to_python(core::read_tum(file)); },
      py::arg("file"),
      R"(A samewhere.Trajectory from a TUM file: lines `stamp tx ty tz qx qy qz qw`.

Raises InputError that names file and line.)");
  module.def(
      "write_trajectory",
      [](const fs::path& file, const py::object& trajectory) {
        core::write_file(file, core::tum_text(trajectory_from("trajectory", trajectory)));
      },
      py::arg("file"), py::arg("trajectory"),
      "Writes a TUM file, as `samewhere run` does: nine decimals, six for the stamp.");
}

}  // namespace samewhere::python
