#include <cmath>
#include <iterator>
#include <memory>

#include <fmt/format.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/twin/front/dataset.hpp>
#include <samewhere/twin/front/dataset_folder.hpp>
#include <samewhere/twin/render/picture_file.hpp>

namespace samewhere::twin {
namespace {

using core::InputError;

// The text files of the folder, as they grow.
struct EurocLists {
  std::string pictures;  // the same for every camera
  std::string imu;
  std::vector<double> imu_stamps_s;
  std::vector<double> stamps_s;
  std::shared_ptr<const core::Rig> rig;
};

std::int64_t stamp_ns(double stamp_s) { return std::llround(stamp_s * 1e9); }

// As the format's own files have it: 4 x 4, row by row.
std::string transform_yaml(const core::Rigid3& body_from_sensor) {
  const Eigen::Matrix4d m = body_from_sensor.matrix();
  std::string rows;
  for (int y = 0; y < 4; ++y) {
    fmt::format_to(std::back_inserter(rows), "{}{}, {}, {}, {}", y == 0 ? "" : ",\n         ",
                   m(y, 0), m(y, 1), m(y, 2), m(y, 3));
  }
  return fmt::format("T_BS:\n  cols: 4\n  rows: 4\n  data: [{}]\n", rows);
}

// Between the first and the last; 0 for a single one.
double mean_rate_hz(const std::vector<double>& stamps_s) {
  if (stamps_s.size() < 2) return 0.0;
  return static_cast<double>(stamps_s.size() - 1) / (stamps_s.back() - stamps_s.front());
}

std::string camera_yaml(const core::PinholeRadtan& camera, const core::Rigid3& body_from_camera,
                        double rate_hz) {
  std::string text = "# how camera and body lie to each other: body from camera\n";
  text += "sensor_type: camera\ncomment: rendered by samewhere\n" +
          transform_yaml(body_from_camera) +
          fmt::format("rate_hz: {:.6g}\nresolution: [{}, {}]\ncamera_model: pinhole\n", rate_hz,
                      camera.width_px, camera.height_px);
  text += fmt::format("intrinsics: [{}, {}, {}, {}] # fu, fv, cu, cv\n", camera.fx_px, camera.fy_px,
                      camera.cx_px, camera.cy_px);
  // the format knows four coefficients; a fifth is given only where leaving it out would be wrong
  const std::string fifth = camera.k3 == 0.0 ? "" : fmt::format(", {}", camera.k3);
  return text + fmt::format(
                    "distortion_model: radial-tangential\n"
                    "distortion_coefficients: [{}, {}, {}, {}{}] # k1, k2, p1, p2\n",
                    camera.k1, camera.k2, camera.p1, camera.p2, fifth);
}

std::string imu_yaml(const core::Imu& imu, double rate_hz) {
  return "# how inertial unit and body lie to each other: body from sensor\n"
         "sensor_type: imu\ncomment: simulated by samewhere\n" +
         transform_yaml(imu.body_from_imu) +
         fmt::format(
             "rate_hz: {:.6g}\n"
             "gyroscope_noise_density: {} # rad / s / sqrt(Hz)\n"
             "gyroscope_random_walk: {} # rad / s^2 / sqrt(Hz)\n"
             "accelerometer_noise_density: {} # m / s^2 / sqrt(Hz)\n"
             "accelerometer_random_walk: {} # m / s^3 / sqrt(Hz)\n",
             rate_hz, imu.gyroscope_noise_rad_s_sqrt_hz, imu.gyroscope_bias_walk_rad_s2_sqrt_hz,
             imu.accelerometer_noise_m_s2_sqrt_hz, imu.accelerometer_bias_walk_m_s3_sqrt_hz);
}

void check_rig(const core::Frame& frame, const std::string& name) {
  if (frame.rig->is_calibrated() && frame.rig->cameras.size() == frame.images.size()) return;
  throw InputError(fmt::format(
      "{}: {} pictures, {} calibrated cameras; EuRoC's sensor.yaml needs one camera file each",
      name, frame.images.size(), frame.rig->cameras.size()));
}

void add_frame(const PartialFolder& out, const core::Frame& frame, EurocLists& lists) {
  const std::string file = fmt::format("{}.png", stamp_ns(frame.stamp_s));
  for (std::size_t camera = 0; camera < frame.images.size(); ++camera) {
    out.write(fmt::format("mav0/cam{}/data/{}", camera, file), png_bytes(frame.images[camera]));
  }
  lists.pictures += fmt::format("{},{}\n", stamp_ns(frame.stamp_s), file);
  for (const core::ImuSample& sample : frame.imu_since_last) {
    const Eigen::Vector3d& w = sample.angular_velocity_rad_s;
    const Eigen::Vector3d& a = sample.acceleration_m_s2;
    fmt::format_to(std::back_inserter(lists.imu),
                   "{},{:.12f},{:.12f},{:.12f},{:.9f},{:.9f},{:.9f}\n", stamp_ns(sample.stamp_s),
                   w.x(), w.y(), w.z(), a.x(), a.y(), a.z());
    lists.imu_stamps_s.push_back(sample.stamp_s);
  }
  lists.stamps_s.push_back(frame.stamp_s);
  lists.rig = frame.rig;
}

core::Trajectory body_poses(const core::Trajectory& cameras, const core::Rigid3& body_from_camera) {
  const core::Rigid3 camera_from_body = inverse(body_from_camera);
  core::Trajectory bodies;
  for (const auto& pose : cameras) {
    bodies.push_back({pose.stamp_s, pose.world_from_camera * camera_from_body});
  }
  return bodies;
}

Eigen::Vector3d mean_velocity_m_s(const core::Trajectory& bodies, std::size_t i) {
  const auto& before = bodies[i == 0 ? 0 : i - 1];
  const auto& after = bodies[std::min(i + 1, bodies.size() - 1)];
  const double duration_s = after.stamp_s - before.stamp_s;
  if (duration_s <= 0.0) return Eigen::Vector3d::Zero();  // there is but one pose
  const Eigen::Vector3d way_m =
      after.world_from_camera.translation - before.world_from_camera.translation;
  return way_m / duration_s;
}

// What poses alone tell.
std::vector<core::InertialTruth> by_differences(const core::Trajectory& bodies) {
  std::vector<core::InertialTruth> states;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    states.push_back({.stamp_s = bodies[i].stamp_s, .velocity_m_s = mean_velocity_m_s(bodies, i)});
  }
  return states;
}

std::string states_csv(const core::Trajectory& bodies,
                       const std::vector<core::InertialTruth>& states) {
  core::require(states.size() == bodies.size(), "inertial truth is known for every pose");
  std::string text =
      "#timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], q_RS_y [], "
      "q_RS_z [], v_RS_R_x [m s^-1], v_RS_R_y [m s^-1], v_RS_R_z [m s^-1], b_w_RS_S_x [rad s^-1], "
      "b_w_RS_S_y [rad s^-1], b_w_RS_S_z [rad s^-1], b_a_RS_S_x [m s^-2], b_a_RS_S_y [m s^-2], "
      "b_a_RS_S_z [m s^-2]\n";
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const Eigen::Vector3d& t = bodies[i].world_from_camera.translation;
    const Eigen::Quaterniond& q = bodies[i].world_from_camera.rotation;
    const Eigen::Vector3d& v = states[i].velocity_m_s;
    const Eigen::Vector3d& w = states[i].gyroscope_bias_rad_s;
    const Eigen::Vector3d& a = states[i].accelerometer_bias_m_s2;
    fmt::format_to(std::back_inserter(text), "{},{:.9f},{:.9f},{:.9f},{:.9f},{:.9f},{:.9f},{:.9f},",
                   stamp_ns(bodies[i].stamp_s), t.x(), t.y(), t.z(), q.w(), q.x(), q.y(), q.z());
    fmt::format_to(std::back_inserter(text),
                   "{:.9f},{:.9f},{:.9f},{:.12f},{:.12f},{:.12f},{:.9f},{:.9f},{:.9f}\n", v.x(),
                   v.y(), v.z(), w.x(), w.y(), w.z(), a.x(), a.y(), a.z());
  }
  return text;
}

void write_cameras(const PartialFolder& out, const EurocLists& lists) {
  for (std::size_t i = 0; i < lists.rig->cameras.size(); ++i) {
    const std::string camera = fmt::format("mav0/cam{}/", i);
    out.write(camera + "data.csv", "#timestamp [ns],filename\n" + lists.pictures);
    out.write(camera + "sensor.yaml",
              camera_yaml(std::get<core::PinholeRadtan>(lists.rig->cameras[i]),
                          lists.rig->body_from_camera[i], mean_rate_hz(lists.stamps_s)));
  }
}

void write_imu(const PartialFolder& out, const EurocLists& lists) {
  if (!lists.rig->imu) return;
  out.write("mav0/imu0/data.csv",
            "#timestamp [ns],w_RS_S_x [rad s^-1],w_RS_S_y [rad s^-1],w_RS_S_z [rad s^-1],"
            "a_RS_S_x [m s^-2],a_RS_S_y [m s^-2],a_RS_S_z [m s^-2]\n" +
                lists.imu);
  out.write("mav0/imu0/sensor.yaml", imu_yaml(*lists.rig->imu, mean_rate_hz(lists.imu_stamps_s)));
}

void write_states(const PartialFolder& out, const core::Truth& known, const core::Rig& rig) {
  if (known.trajectory.empty()) return;
  const std::string folder = "mav0/state_groundtruth_estimate0/";
  const core::Trajectory bodies = body_poses(known.trajectory, rig.body_from_camera.front());
  const bool is_exact = !known.inertial.empty();
  out.write(folder + "data.csv",
            states_csv(bodies, is_exact ? known.inertial : by_differences(bodies)));
  const char* const comment =
      is_exact ? "exact" : "velocities by central differences; biases not known, written as 0";
  out.write(folder + "sensor.yaml", fmt::format("sensor_type: visual-inertial\ncomment: {}\n{}",
                                                comment, transform_yaml(core::Rigid3{})));
}

}  // namespace

void write_euroc_folder(core::Source& source, const std::filesystem::path& folder,
                        const MakeTables& tables) {
  PartialFolder out(folder);
  EurocLists lists;
  const std::string name = source.info().name;
  const auto take = [&](const core::Frame& frame) {
    check_rig(frame, name);
    add_frame(out, frame, lists);
  };
  write_each_frame(source, take);
  // before the source's truth, of which they may be a part: their source reports progress
  if (tables) write_tables(out, lists.stamps_s, tables());
  core::require(lists.rig != nullptr, "a source has at least one frame");
  const core::Truth known = source.truth();
  write_cameras(out, lists);
  write_imu(out, lists);
  write_states(out, known, *lists.rig);
  out.write("mav0/body.yaml", "comment: samewhere\n");
  if (known.places) write_places(out, lists.stamps_s.size(), *known.places);
  out.finish();
}

}  // namespace samewhere::twin
