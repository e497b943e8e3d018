#include <iterator>
#include <map>

#include <fmt/format.h>

#include <samewhere/report/status_strip.hpp>

namespace samewhere::report {
namespace {

// Consecutive frames of one state are one rectangle.
std::string rectangles(const std::vector<FrameRecord>& frames) {
  std::string svg;
  for (std::size_t first = 0; first < frames.size();) {
    const core::FrameStatus status = frames[first].pose.status;
    std::size_t end = first;
    while (end < frames.size() && frames[end].pose.status == status) ++end;
    fmt::format_to(std::back_inserter(svg),
                   "<rect class=\"{0}\" x=\"{1}\" y=\"0\" width=\"{2}\" height=\"1\">"
                   "<title>{0}: frames {3} to {4}</title></rect>",
                   core::name_of(status), first, end - first, frames[first].pose.frame.index(),
                   frames[end - 1].pose.frame.index());
    first = end;
  }
  return svg;
}

}  // namespace

std::string status_strip(const std::vector<FrameRecord>& frames) {
  if (frames.empty()) return "";
  std::map<core::FrameStatus, int> num_frames;
  for (const FrameRecord& frame : frames) ++num_frames[frame.pose.status];
  std::string html = fmt::format(
      "<div class=\"strip\"><svg viewBox=\"0 0 {} 1\" preserveAspectRatio=\"none\" role=\"img\" "
      "aria-label=\"tracking status of each frame\">{}</svg>",
      frames.size(), rectangles(frames));
  html += "<ul class=\"legend states\">";
  for (const auto& [status, count] : num_frames)
    fmt::format_to(std::back_inserter(html), "<li><i class=\"{0}\"></i>{0} {1}</li>",
                   core::name_of(status), count);
  return html + "</ul></div>\n";
}

}  // namespace samewhere::report
