#include <algorithm>
#include <iterator>
#include <string_view>

#include <fmt/format.h>

#include <samewhere/report/graph_plan.hpp>
#include <samewhere/report/html_text.hpp>
#include <samewhere/report/plan_view.hpp>

namespace samewhere::report {
namespace {

constexpr double kSize_px = 900.0;  // of the longer side of what is drawn
constexpr double kBorder_px = 30.0;
constexpr double kLegend_px = 24.0;  // a line of it
constexpr double kMinExtent_m = 1e-6;

struct Layer {
  std::string_view name;
  std::string_view colour;
  double width_px = 1.0;
  const std::vector<Eigen::Vector2d>* positions = nullptr;
  const std::vector<std::pair<int, int>>* pairs = nullptr;
};

// Where the nodes are on the page, metres to the right and up.
std::vector<Eigen::Vector2d> on_page(const std::vector<core::Rigid3>& poses, const PlanView& view) {
  std::vector<Eigen::Vector2d> positions;
  for (const auto& pose : poses) positions.push_back(seen(view, pose.translation));
  return positions;
}

// The whole of `positions` fits into kSize_px.
class Page {
 public:
  explicit Page(const std::vector<Eigen::Vector2d>& positions) {
    Eigen::AlignedBox2d box;
    for (const auto& position : positions) box.extend(position);
    low_ = box.isEmpty() ? Eigen::Vector2d::Zero() : box.min();
    extent_ = box.isEmpty() ? Eigen::Vector2d::Ones() : Eigen::Vector2d(box.sizes());
    scale_ = kSize_px / std::max(extent_.maxCoeff(), kMinExtent_m);
  }

  double width_px() const { return scale_ * extent_.x() + 2 * kBorder_px; }
  double height_px() const { return scale_ * extent_.y() + 2 * kBorder_px; }
  Eigen::Vector2d pixel(const Eigen::Vector2d& position) const {
    const Eigen::Vector2d from_low = scale_ * (position - low_);
    return {kBorder_px + from_low.x(), height_px() - kBorder_px - from_low.y()};
  }

 private:
  Eigen::Vector2d low_;
  Eigen::Vector2d extent_;
  double scale_ = 1.0;
};

std::string drawn(const Layer& layer, const Page& page) {
  std::string path;
  for (const auto& [a, b] : *layer.pairs) {
    const auto from = page.pixel((*layer.positions)[static_cast<std::size_t>(a)]);
    const auto to = page.pixel((*layer.positions)[static_cast<std::size_t>(b)]);
    fmt::format_to(std::back_inserter(path), "M{:.1f} {:.1f}L{:.1f} {:.1f}", from.x(), from.y(),
                   to.x(), to.y());
  }
  return fmt::format(R"(<path d="{}" fill="none" stroke="{}" stroke-width="{}"/>)"
                     "\n",
                     path, layer.colour, layer.width_px);
}

std::string legend_line(const Layer& layer, double y_px) {
  return fmt::format(R"(<rect x="{0}" y="{1:.1f}" width="18" height="4" fill="{2}"/>)"
                     R"(<text x="{3}" y="{4:.1f}">{5} ({6})</text>)"
                     "\n",
                     kBorder_px, y_px - 6.0, layer.colour, kBorder_px + 26.0, y_px, layer.name,
                     layer.pairs->size());
}

}  // namespace

std::string graph_plan_svg(const GraphRecord& record) {
  const PlanView view = record.is_planar ? PlanView{} : plan_view_of(record.after);
  const std::vector<Eigen::Vector2d> before = on_page(record.before, view);
  const std::vector<Eigen::Vector2d> after = on_page(record.after, view);
  const Layer layers[] = {{"initial path", "#c8c8c8", 1.0, &before, &record.path},
                          {"accepted loops", "#7fbf9f", 0.6, &after, &record.accepted},
                          {"rejected loops", "#d62728", 0.8, &after, &record.rejected},
                          {"optimized path", "#1f4e9c", 1.4, &after, &record.path}};
  const Page page(after);
  const double top_px = kLegend_px * (std::size(layers) + 1) + kBorder_px;
  const double height_px = page.height_px() + top_px;
  std::string legend;
  double y_px = kBorder_px + kLegend_px;
  for (const Layer& layer : layers) {
    legend += legend_line(layer, y_px);
    y_px += kLegend_px;
  }
  std::string body;
  for (const Layer& layer : layers) body += drawn(layer, page);
  const double width_px = std::max(page.width_px(), 480.0);
  return fmt::format(
      R"(<svg xmlns="http://www.w3.org/2000/svg" width="{0:.0f}" height="{1:.0f}" viewBox="0 0 {0:.0f} {1:.0f}" )"
      R"(font-family="sans-serif" font-size="14"><rect width="100%" height="100%" fill="white"/>)"
      R"(<text x="{2}" y="{2}" font-size="16">{3}</text>)"
      "\n{4}"
      R"svg(<g transform="translate(0 {5:.1f})">)svg"
      "\n{6}</g></svg>\n",
      width_px, height_px, kBorder_px, escaped(record.title), legend, top_px, body);
}

}  // namespace samewhere::report
