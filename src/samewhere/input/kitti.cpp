#include <map>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/text_file.hpp>
#include <samewhere/input/file_names.hpp>
#include <samewhere/input/formats.hpp>
#include <samewhere/input/left_out.hpp>
#include <samewhere/input/numbered.hpp>
#include <samewhere/input/truth_file.hpp>

namespace samewhere::input {
namespace {

using core::InputError;
using std::filesystem::path;

// The cameras of a sequence by their numbers: left first, then right if its folder is there. The
// grey pair is preferred: its baseline lies along the rows to the last digit.
std::vector<int> cameras_of(const path& folder) {
  for (const int left : {0, 2}) {
    if (!is_folder(folder / fmt::format("image_{}", left))) continue;
    if (is_folder(folder / fmt::format("image_{}", left + 1))) return {left, left + 1};
    return {left};
  }
  return {};
}

path camera_folder(const path& folder, int camera) {
  return folder / fmt::format("image_{}", camera);
}

// The pictures of one camera by their numbers: 000000.png, or of another format or length.
std::map<int, path> numbered_pictures(const path& folder) {
  std::map<int, path> pictures;
  for (const std::string& name : picture_names(folder)) {
    if (const auto number = frame_number(name)) pictures.try_emplace(*number, folder / name);
  }
  return pictures;
}

struct Frames {
  std::vector<FrameFiles> files;  // of those whose pictures are there
  std::vector<double> stamps_s;   // of all, as times.txt has them
  std::vector<bool> is_there;     // of all
};

std::vector<double> read_stamps(const path& times) {
  std::vector<double> stamps_s;
  for (const core::TextLine& line : core::read_text_lines(times)) {
    const double stamp_s = core::finite_numbers(line, 1, "the stamp of a frame, s").front();
    if (!stamps_s.empty() && stamp_s <= stamps_s.back()) {
      throw InputError(fmt::format("{}: found stamp {} after {}, expected stamps that rise",
                                   line.place, stamp_s, stamps_s.back()));
    }
    stamps_s.push_back(stamp_s);
  }
  if (stamps_s.empty()) throw InputError(times.string() + ": holds no stamp");
  return stamps_s;
}

Frames read_frames(const path& folder, const std::vector<int>& cameras) {
  const path times = folder / "times.txt";
  Frames frames{{}, read_stamps(times), {}};
  std::vector<std::map<int, path>> pictures;
  for (const int camera : cameras)
    pictures.push_back(numbered_pictures(camera_folder(folder, camera)));
  LeftOut left_out;
  const auto num_stamps = static_cast<int>(frames.stamps_s.size());
  for (int i = 0; i < num_stamps; ++i) {
    FrameFiles files{fmt::format("{:06}.png", i), frames.stamps_s[static_cast<std::size_t>(i)]};
    for (std::size_t camera = 0; camera < cameras.size(); ++camera) {
      const auto picture = pictures[camera].find(i);
      if (picture == pictures[camera].end()) {
        const path expected = camera_folder(folder, cameras[camera]) / files.name;
        left_out.add(fmt::format("{}, stamp {}: its image {} does not exist", times.string(), i + 1,
                                 expected.string()));
        break;
      }
      files.images.push_back(picture->second);
    }
    frames.is_there.push_back(files.images.size() == cameras.size());
    if (frames.is_there.back()) frames.files.push_back(std::move(files));
  }
  left_out.refuse_most(frames.stamps_s.size(), "frames");
  left_out.warn(frames.stamps_s.size(), "frames");
  const auto surplus = pictures.front().lower_bound(num_stamps);
  if (surplus != pictures.front().end()) {
    spdlog::warn(
        "{}: found {} stamps, expected one for each picture, such as {}; the pictures "
        "without a stamp are left out",
        times.string(), num_stamps, surplus->second.string());
  }
  return frames;
}

// A line of calib.txt without its key.
core::TextLine calibration_line(const path& file, const std::string& key) {
  for (core::TextLine& line : core::read_text_lines(file)) {
    if (line.words.front() != key) continue;
    line.words.erase(line.words.begin());
    return std::move(line);
  }
  throw InputError(fmt::format("{}: has no line {}, the projection of camera {}", file.string(),
                               key, key.substr(1, 1)));
}

// P = K [I | t]: the pictures are rectified, so all cameras look the same way without distortion.
void add_camera(const path& file, int number, core::Rig& rig) {
  const core::TextLine line = calibration_line(file, fmt::format("P{}:", number));
  const std::vector<double> p = core::finite_numbers(line, 12, "a 3 x 4 projection, row by row");
  const bool is_pinhole = p[0] > 0.0 && p[5] > 0.0 && p[1] == 0.0 && p[4] == 0.0 && p[8] == 0.0 &&
                          p[9] == 0.0 && p[10] == 1.0;
  if (!is_pinhole) {
    throw InputError(
        fmt::format("{}: found {}, expected fx 0 cx a 0 fy cy b 0 0 1 c with fx > 0 and fy > 0",
                    line.place, fmt::join(p, " ")));
  }
  rig.cameras.emplace_back(
      core::PinholeRadtan{.fx_px = p[0], .fy_px = p[5], .cx_px = p[2], .cy_px = p[6]});
  const Eigen::Vector3d camera_from_grey((p[3] - p[2] * p[11]) / p[0], (p[7] - p[6] * p[11]) / p[5],
                                         p[11]);
  rig.body_from_camera.push_back({Eigen::Quaterniond::Identity(), -camera_from_grey});
}

// Poses are those of the left grey camera, `body` here; a trajectory is that of the rig's first.
// The n-th belongs to the n-th stamp, whether its pictures are there or not.
core::Trajectory read_poses(const path& file, const Frames& frames,
                            const core::Rigid3& body_from_camera) {
  std::vector<FrameFiles> all;
  for (const double stamp_s : frames.stamps_s) all.push_back({"", stamp_s});
  return read_pose_lines(file, all, [&body_from_camera](const core::TextLine& line) {
    std::vector<double> rows =
        core::finite_numbers(line, 12, "the first three rows of a pose matrix");
    rows.insert(rows.end(), {0.0, 0.0, 0.0, 1.0});
    return rigid_from_rows(line, rows) * body_from_camera;
  });
}

// Poses lie apart from the pictures: sequences/00/ and poses/00.txt. Empty: there are none.
path poses_file(const path& folder) {
  const path whole = std::filesystem::absolute(folder / "").lexically_normal().parent_path();
  const path apart =
      whole.parent_path().parent_path() / "poses" / (whole.filename().string() + ".txt");
  for (const path& file : {folder / "poses.txt", apart}) {
    if (is_there(file)) return file;
  }
  return {};
}

}  // namespace

std::optional<Recording> find_kitti(const path& folder, const Config& config) {
  const std::vector<int> cameras = cameras_of(folder);
  if (cameras.empty() || !is_there(folder / "times.txt")) return std::nullopt;
  Frames frames = read_frames(folder, cameras);
  Recording recording{.format = "KITTI", .frames = std::move(frames.files)};
  const bool has_rig = read_own_rig(config, recording, [&] {
    for (const int camera : cameras) add_camera(folder / "calib.txt", camera, recording.rig);
  });
  recording.truth = read_truth(folder, static_cast<int>(recording.frames.size()));
  if (const path poses = poses_file(folder); !poses.empty()) {
    const core::Rigid3 body_from_camera =
        has_rig ? recording.rig.body_from_camera.front() : core::Rigid3{};
    recording.truth.trajectory = read_poses(poses, frames, body_from_camera);
  }
  return recording;
}

}  // namespace samewhere::input
