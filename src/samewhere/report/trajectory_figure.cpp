#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <optional>

#include <fmt/format.h>

#include <samewhere/report/funnel.hpp>
#include <samewhere/report/plan_view.hpp>
#include <samewhere/report/trajectory_figure.hpp>

namespace samewhere::report {
namespace {

constexpr double kFigureWidth_px = 960.0;
constexpr double kMargin_px = 48.0;
constexpr double kMaxPlotHeight_px = 560.0;
constexpr double kMinPlotHeight_px = 120.0;
constexpr double kMinExtent_m = 0.05;  // a camera that stands still is drawn as a point
constexpr double kMinStep_px = 0.4;    // finer steps are not seen

using Curve = std::vector<std::optional<core::Rigid3>>;  // nothing: the line is broken here

std::optional<core::Rigid3> drawable(const std::optional<core::Rigid3>& pose) {
  return pose && core::is_finite(*pose) ? pose : std::nullopt;
}

Curve curve_of(const std::vector<FrameRecord>& frames) {
  Curve curve;
  for (const FrameRecord& frame : frames) curve.push_back(drawable(frame.world_from_camera));
  return curve;
}

Curve curve_of(const core::Trajectory& trajectory) {
  Curve curve;
  for (const core::StampedPose& pose : trajectory)
    curve.push_back(drawable(pose.world_from_camera));
  return curve;
}

// From metres in the world to pixels on the page.
class Page {
 public:
  Page(const PlanView& view, const std::vector<const Curve*>& curves) : view_(view) {
    Eigen::Vector2d low = Eigen::Vector2d::Zero();
    Eigen::Vector2d high = Eigen::Vector2d::Zero();
    for (const Curve* curve : curves) {
      for (const auto& pose : *curve) {
        if (!pose) continue;
        low = low.cwiseMin(seen(view, pose->translation));
        high = high.cwiseMax(seen(view, pose->translation));
      }
    }
    const Eigen::Vector2d extent_m = (high - low).cwiseMax(kMinExtent_m);
    px_per_m_ = std::min((kFigureWidth_px - 2.0 * kMargin_px) / extent_m.x(),
                         kMaxPlotHeight_px / extent_m.y());
    middle_m_ = 0.5 * (low + high);
    plot_height_px_ = std::max(extent_m.y() * px_per_m_, kMinPlotHeight_px);
  }

  double height_px() const { return plot_height_px_ + 2.0 * kMargin_px; }
  double px_per_m() const { return px_per_m_; }

  Eigen::Vector2d at(const Eigen::Vector3d& in_world) const {
    const Eigen::Vector2d offset_px = px_per_m_ * (seen(view_, in_world) - middle_m_);
    return {0.5 * kFigureWidth_px + offset_px.x(),
            kMargin_px + 0.5 * plot_height_px_ - offset_px.y()};
  }

 private:
  PlanView view_;
  Eigen::Vector2d middle_m_ = Eigen::Vector2d::Zero();
  double px_per_m_ = 1.0;
  double plot_height_px_ = 0.0;
};

std::string polyline(std::string_view css_class, const std::string& points) {
  if (points.empty()) return "";
  return fmt::format("<polyline class=\"{}\" points=\"{}\"/>\n", css_class, points);
}

// One polyline for each unbroken piece.
std::string drawn(const Curve& curve, std::string_view css_class, const Page& page) {
  std::string svg;
  std::string points;
  Eigen::Vector2d last_px(-1e9, -1e9);
  for (const auto& pose : curve) {
    if (!pose) {
      svg += polyline(css_class, points);
      points.clear();
      last_px = {-1e9, -1e9};
      continue;
    }
    const Eigen::Vector2d px = page.at(pose->translation);
    if ((px - last_px).norm() < kMinStep_px) continue;
    fmt::format_to(std::back_inserter(points), "{}{:.1f},{:.1f}", points.empty() ? "" : " ", px.x(),
                   px.y());
    last_px = px;
  }
  return svg + polyline(css_class, points);
}

std::string drawn_loops(const RunRecord& record, const Page& page) {
  std::map<core::FrameId, Eigen::Vector2d> px_of_frame;
  for (const FrameRecord& frame : record.frames)
    if (const auto pose = drawable(frame.world_from_camera))
      px_of_frame[frame.pose.frame] = page.at(pose->translation);
  std::string svg;
  for (const core::LedgerRow* row : final_rows(record.ledger)) {
    const auto query = px_of_frame.find(row->candidate.query);
    const auto match = px_of_frame.find(row->candidate.match);
    if (!core::is_loop(row->verdict) || query == px_of_frame.end() || match == px_of_frame.end())
      continue;
    fmt::format_to(
        std::back_inserter(svg),
        "<g class=\"loop\"><title>loop closure: frame {} with frame {}</title>"
        "<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\"/>"
        "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"4\"/><circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"4\"/>"
        "</g>\n",
        row->candidate.query.index(), row->candidate.match.index(), query->second.x(),
        query->second.y(), match->second.x(), match->second.y(), query->second.x(),
        query->second.y(), match->second.x(), match->second.y());
  }
  return svg;
}

std::string mark(const Curve::value_type& pose, std::string_view css_class, std::string_view name,
                 const Page& page) {
  const Eigen::Vector2d px = page.at(pose->translation);
  const bool is_at_right_edge = px.x() > kFigureWidth_px - 2.0 * kMargin_px;
  return fmt::format(
      "<circle class=\"{}\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"6\"><title>{}</title></circle>"
      "<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>\n",
      css_class, px.x(), px.y(), name, px.x() + (is_at_right_edge ? -11.0 : 11.0), px.y() - 9.0,
      is_at_right_edge ? "end" : "start", name);
}

std::string start_and_end(const Curve& path, const Page& page) {
  const auto has_pose = [](const auto& pose) { return pose.has_value(); };
  const auto first = std::find_if(path.begin(), path.end(), has_pose);
  const auto last = std::find_if(path.rbegin(), path.rend(), has_pose);
  return mark(*first, "mark open", "start", page) + mark(*last, "mark", "end", page);
}

// The round length (1, 2 or 5 times a power of ten) that comes nearest to a sixth of the width.
double bar_length_m(const Page& page) {
  const double wanted_m = kFigureWidth_px / 6.0 / page.px_per_m();
  const double power = std::pow(10.0, std::floor(std::log10(wanted_m)));
  const double digit = wanted_m / power;
  return power * (digit < 1.5 ? 1.0 : digit < 3.5 ? 2.0 : digit < 7.5 ? 5.0 : 10.0);
}

std::string scale_bar(const Page& page) {
  const double length_m = bar_length_m(page);
  const std::string name = length_m < 0.995 ? fmt::format("{:.0f} cm", 100.0 * length_m)
                                            : fmt::format("{:.0f} m", length_m);
  const double y = page.height_px() - 18.0;
  return fmt::format(
      "<line class=\"bar\" x1=\"20\" y1=\"{0:.1f}\" x2=\"{1:.1f}\" y2=\"{0:.1f}\"/>"
      "<text x=\"{2:.1f}\" y=\"{3:.1f}\">{4}</text>\n",
      y, 20.0 + length_m * page.px_per_m(), 30.0 + length_m * page.px_per_m(), y + 5.0, name);
}

std::string legend(const RunRecord& record, bool has_loops) {
  std::string html = "<ul class=\"legend\"><li class=\"path\"><i></i>estimated trajectory</li>";
  if (!record.odometry.empty())
    html += "<li class=\"odometry\"><i></i>odometry, without loop closures</li>";
  if (!record.truth.empty()) html += "<li class=\"truth\"><i></i>ground truth</li>";
  if (has_loops) html += "<li class=\"loop\"><i></i>accepted loop closure</li>";
  return html + "</ul>";
}

}  // namespace

std::string trajectory_figure(const RunRecord& record) {
  const Curve path = curve_of(record.frames);
  const Curve odometry = curve_of(record.odometry);
  const Curve truth = curve_of(record.truth);
  std::vector<core::Rigid3> poses;
  for (const auto& pose : path)
    if (pose) poses.push_back(*pose);
  if (poses.empty()) return "";

  const PlanView view = plan_view_of(poses);
  const Page page(view, {&path, &odometry, &truth});
  const std::string loops = drawn_loops(record, page);
  return fmt::format(
             "<figure><div class=\"plot\"><svg viewBox=\"0 0 {:.0f} {:.0f}\" role=\"img\" "
             "aria-label=\"trajectory of the camera\">\n",
             kFigureWidth_px, page.height_px()) +
         drawn(odometry, "odometry", page) + drawn(path, "path", page) +
         drawn(truth, "truth", page) + loops + start_and_end(path, page) +
         (record.is_scale_unknown ? "" : scale_bar(page)) + "</svg></div>" +
         legend(record, !loops.empty()) +
         (view.is_from_above
              ? "<p class=\"note\">View from above.</p>"
              : "<p class=\"note\">Projected onto the two directions of largest motion.</p>") +
         (record.is_scale_unknown
              ? "<p class=\"note\">Scale unknown: one camera without depth does not observe it.</p>"
              : "") +
         "</figure>\n";
}

}  // namespace samewhere::report
