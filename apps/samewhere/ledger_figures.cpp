#include "ledger_figures.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

#include <samewhere/report/loops.hpp>

namespace samewhere::app {
namespace {

class Figures {
 public:
  // `bar`: the threshold; empty without one.
  void add(const char* name, std::optional<double> value, const char* unit = "",
           const std::string& bar = {}) {
    add(name, value ? fmt::format("{:.4g}{}{}", *value, unit, bar) : "unmeasured");
  }
  void add(const char* name, std::string value) { figures_.push_back({name, std::move(value)}); }

  std::vector<report::Figure> taken() { return std::move(figures_); }

 private:
  std::vector<report::Figure> figures_;
};

std::string at_least(double bar) { return fmt::format(" (at least {:.4g})", bar); }
std::string at_most(double bar) { return fmt::format(" (at most {:.4g})", bar); }

void add_geometry(const std::optional<core::GeometryEvidence>& geometry,
                  const verify::Config& config, Figures& figures) {
  const auto value = [&](auto core::GeometryEvidence::*field) {
    return geometry ? std::optional<double>((*geometry).*field) : std::nullopt;
  };
  // measured only where a geometry was found
  const auto found = [&](auto core::GeometryEvidence::*field) {
    return geometry && geometry->num_inliers > 0 ? value(field) : std::nullopt;
  };
  using Geometry = core::GeometryEvidence;
  figures.add("matches", value(&Geometry::num_matches), "", at_least(config.min_matches));
  if (geometry && geometry->num_guided_matches > 0)
    figures.add("matches guided by the pose", value(&Geometry::num_guided_matches));
  figures.add("inliers", value(&Geometry::num_inliers), "", at_least(config.min_inliers));
  figures.add("inlier ratio", found(&Geometry::inlier_ratio));
  figures.add("spread over the image", found(&Geometry::spread_ratio), "",
              at_least(config.min_spread_ratio));
  figures.add("overlap of the views", found(&Geometry::overlap_ratio));
  figures.add("reprojection error", found(&Geometry::reprojection_rmse_px), " px");
  const auto apart_m = geometry ? geometry->pose_difference_m : std::nullopt;
  if (apart_m && std::isinf(*apart_m)) {
    figures.add("distance of the poses of both views", "one view gives no pose");
  } else {
    figures.add("distance of the poses of both views", apart_m, " m",
                at_most(config.max_pose_difference_m));
  }
}

void add_odometry(const std::optional<core::OdometryEvidence>& odometry,
                  const verify::Config& config, Figures& figures) {
  figures.add("correction of the query pose",
              odometry ? std::optional(odometry->correction_m) : std::nullopt, " m");
  figures.add("odometry gate, chi-square",
              odometry ? std::optional(odometry->mahalanobis_squared) : std::nullopt, "",
              at_most(config.max_odometry_chi_square));
  const auto gain = odometry
                        ? std::max(odometry->look_alike_gain, odometry->look_alike_gain_with_loops)
                        : std::nullopt;
  if (odometry && odometry->variance_factor)
    figures.add("variance factor of odometry, from closed loops", odometry->variance_factor);
  figures.add("gain over a look-alike place", gain, "",
              config.prior == verify::Prior::kRepetitive ? at_least(config.min_look_alike_gain)
                                                         : std::string());
}

std::string text_of(const core::CompetingLoopEvidence& loop, const verify::Config& config) {
  std::string text =
      fmt::format("frame {}, {:.2f} m away, chi-square {:.4g}{}", loop.frame.index(), loop.apart_m,
                  loop.mahalanobis_squared, at_most(config.max_competing_chi_square));
  if (loop.gain) {
    text +=
        fmt::format("; likelihood gain {:.4g}{}", *loop.gain, at_least(config.min_competing_gain));
  }
  return text;
}

std::string text_of(const core::CompetingPlaceEvidence& place, const verify::Config& config) {
  return fmt::format("frame {}, {:.2f} m away, {} inliers (at most {:.0f} % of those here)",
                     place.frame.index(), place.apart_m, place.num_inliers,
                     100.0 * config.max_competing_place_ratio);
}

std::string text_of(const core::SequenceEvidence& sequence, const verify::Config& config) {
  return fmt::format("{}{}, {} inliers in total", sequence.num_views, at_least(config.min_views),
                     sequence.num_inliers);
}

}  // namespace

std::vector<report::Figure> figures_of(const core::LedgerRow& row, const verify::Config& config) {
  const core::Evidence& evidence = core::evidence_of(row.verdict);
  const auto text = [&](const auto& measured) {
    return measured ? text_of(*measured, config) : "unmeasured";
  };
  Figures figures;
  figures.add("query / match", fmt::format("frame {} / frame {}", row.candidate.query.index(),
                                           report::name_of_match(row.candidate)));
  figures.add("verdict",
              fmt::format("{}, {}", core::name_of(row.verdict), core::stage_of(row.verdict)));
  figures.add("why", core::reason_of(row.verdict));
  figures.add("similarity", evidence.similarity, "",
              config.min_similarity > -1.0
                  ? fmt::format(" (more than {:.4g})", config.min_similarity)
                  : std::string());
  add_geometry(evidence.geometry, config, figures);
  add_odometry(evidence.odometry, config, figures);
  figures.add("competing hypothesis of the last loop", text(evidence.competing_loop));
  figures.add("competing hypothesis of another place", text(evidence.competing_place));
  figures.add("consecutive views", text(evidence.sequence));
  return figures.taken();
}

}  // namespace samewhere::app
