#include <iterator>

#include <fmt/format.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/tum_file.hpp>
#include <samewhere/twin/front/dataset.hpp>
#include <samewhere/twin/front/dataset_folder.hpp>
#include <samewhere/twin/render/picture_file.hpp>

namespace samewhere::twin {
namespace {

// The text files of the folder, as they grow.
struct TumLists {
  std::string rgb;
  std::string depth;
  std::string accelerometer;
  std::string camera;
  std::vector<double> stamps_s;
};

std::string with_header(const char* what, const std::string& name, const char* columns,
                        const std::string& lines) {
  return fmt::format("# {}\n# file: '{}'\n# {}\n{}", what, name, columns, lines);
}

std::string camera_text(const core::PinholeRadtan& camera) {
  return fmt::format("{} 0 {}\n0 {} {}\n0 0 1\n{} {} {} {} {}\n{} {}\n", camera.fx_px, camera.cx_px,
                     camera.fy_px, camera.cy_px, camera.k1, camera.k2, camera.p1, camera.p2,
                     camera.k3, camera.width_px, camera.height_px);
}

void add_picture(const PartialFolder& out, const char* folder, const core::Frame& frame,
                 const cv::Mat& picture, std::string& list) {
  const std::string file = fmt::format("{}/{:.6f}.png", folder, frame.stamp_s);
  out.write(file, png_bytes(picture));
  list += fmt::format("{:.6f} {}\n", frame.stamp_s, file);
}

void add_frame(const PartialFolder& out, const core::Frame& frame, TumLists& lists) {
  add_picture(out, "rgb", frame, frame.images.front(), lists.rgb);
  if (frame.depth_m) add_picture(out, "depth", frame, depth_units(*frame.depth_m), lists.depth);
  for (const core::ImuSample& sample : frame.imu_since_last) {
    const Eigen::Vector3d& a = sample.acceleration_m_s2;
    fmt::format_to(std::back_inserter(lists.accelerometer), "{:.6f} {:.9f} {:.9f} {:.9f}\n",
                   sample.stamp_s, a.x(), a.y(), a.z());
  }
  if (frame.rig->is_calibrated()) {
    lists.camera = camera_text(std::get<core::PinholeRadtan>(frame.rig->cameras.front()));
  }
  lists.stamps_s.push_back(frame.stamp_s);
}

}  // namespace

void write_tum_folder(core::Source& source, const std::filesystem::path& folder,
                      const MakeTables& tables) {
  PartialFolder out(folder);
  TumLists lists;
  const auto take = [&](const core::Frame& frame) { add_frame(out, frame, lists); };
  write_each_frame(source, take);
  // before the source's truth, of which they may be a part: their source reports progress
  if (tables) write_tables(out, lists.stamps_s, tables());
  const std::string name = source.info().name;
  const core::Truth known = source.truth();
  out.write("rgb.txt", with_header("color images", name, "timestamp filename", lists.rgb));
  if (!lists.depth.empty()) {
    out.write("depth.txt", with_header("depth maps", name, "timestamp filename", lists.depth));
  }
  if (!lists.accelerometer.empty()) {
    out.write("accelerometer.txt",
              with_header("accelerometer data", name, "timestamp ax ay az", lists.accelerometer));
  }
  if (!known.trajectory.empty()) {
    out.write("groundtruth.txt",
              with_header("ground truth trajectory", name, "timestamp tx ty tz qx qy qz qw",
                          core::tum_text(known.trajectory)));
  }
  if (!lists.camera.empty()) out.write("camera.txt", lists.camera);
  if (known.places) write_places(out, lists.stamps_s.size(), *known.places);
  out.finish();
}

}  // namespace samewhere::twin
