#include <fmt/format.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/text_file.hpp>
#include <samewhere/input/file_names.hpp>
#include <samewhere/input/formats.hpp>
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

path picture_path(const path& folder, int camera, std::size_t index) {
  return folder / fmt::format("image_{}", camera) / fmt::format("{:06}.png", index);
}

FrameFiles frame_files(const path& folder, const std::vector<int>& cameras, std::size_t index,
                       const core::TextLine& line) {
  FrameFiles files{fmt::format("{:06}.png", index),
                   core::finite_numbers(line, 1, "the stamp of a frame, s").front()};
  for (const int camera : cameras) {
    files.images.push_back(picture_path(folder, camera, index));
    if (is_there(files.images.back())) continue;
    throw InputError(
        fmt::format("{}: its image {} does not exist", line.place, files.images.back().string()));
  }
  return files;
}

std::vector<FrameFiles> read_frames(const path& folder, const std::vector<int>& cameras) {
  const path times = folder / "times.txt";
  std::vector<FrameFiles> frames;
  for (const core::TextLine& line : core::read_text_lines(times)) {
    frames.push_back(frame_files(folder, cameras, frames.size(), line));
    if (frames.size() < 2 || frames.back().stamp_s > frames.rbegin()[1].stamp_s) continue;
    throw InputError(fmt::format("{}: found stamp {} after {}, expected stamps that rise",
                                 line.place, frames.back().stamp_s, frames.rbegin()[1].stamp_s));
  }
  if (frames.empty()) throw InputError(times.string() + ": holds no stamp");
  if (const path surplus = picture_path(folder, cameras.front(), frames.size());
      is_there(surplus)) {
    throw InputError(fmt::format("{}: found {} stamps, expected one more, since {} exists",
                                 times.string(), frames.size(), surplus.string()));
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
core::Trajectory read_poses(const path& file, const std::vector<FrameFiles>& frames,
                            const core::Rigid3& body_from_camera) {
  const std::vector<core::TextLine> lines = core::read_text_lines(file);
  if (lines.size() != frames.size()) {
    throw InputError(fmt::format("{}: found {} poses, expected {}, one per stamp of times.txt",
                                 file.string(), lines.size(), frames.size()));
  }
  core::Trajectory trajectory;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    std::vector<double> rows =
        core::finite_numbers(lines[i], 12, "the first three rows of a pose matrix");
    rows.insert(rows.end(), {0.0, 0.0, 0.0, 1.0});
    trajectory.push_back({frames[i].stamp_s, rigid_from_rows(lines[i], rows) * body_from_camera});
  }
  return trajectory;
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

std::optional<Recording> find_kitti(const path& folder, const Config& /*config*/) {
  const std::vector<int> cameras = cameras_of(folder);
  if (cameras.empty() || !is_there(folder / "times.txt")) return std::nullopt;
  Recording recording{.format = "KITTI", .frames = read_frames(folder, cameras)};
  for (const int camera : cameras) add_camera(folder / "calib.txt", camera, recording.rig);
  recording.truth = read_truth(folder, static_cast<int>(recording.frames.size()));
  if (const path poses = poses_file(folder); !poses.empty()) {
    recording.truth.trajectory =
        read_poses(poses, recording.frames, recording.rig.body_from_camera.front());
  }
  return recording;
}

}  // namespace samewhere::input
