#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <sstream>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>
#include <samewhere/core/tum_file.hpp>
#include <samewhere/dense/floor.hpp>
#include <samewhere/dense/occupancy_grid.hpp>
#include <samewhere/dense/octree_map.hpp>
#include <samewhere/dense/scans.hpp>
#include <samewhere/dense/stereo_depth.hpp>
#include <samewhere/dense/view.hpp>
#include <samewhere/dense/voxel_cloud.hpp>
#include <samewhere/report/html.hpp>
#include <samewhere/report/ply.hpp>
#include <samewhere/run/dense_maps.hpp>
#include <samewhere/run/run_lists.hpp>
#include <samewhere/run/source_frames.hpp>

namespace samewhere::run {
namespace {

constexpr double kStampUnit_s = 1e-6;  // what the files of a run round stamps to

// Stamps of the keyframes by their positions in the source.
using KeyframeStamps = std::map<std::uint64_t, double>;
using Poses = std::map<std::uint64_t, core::Rigid3>;  // world_from_camera, by the same

std::int64_t in_units(double stamp_s) { return std::llround(stamp_s / kStampUnit_s); }

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> fields;
  std::istringstream rest(line);
  for (std::string field; std::getline(rest, field, ',');) fields.push_back(field);
  if (line.ends_with(',')) fields.emplace_back();
  return fields;
}

// A keyframe is the first frame that refers to it. Columns are counted from both ends: the name
// between may hold commas.
KeyframeStamps read_keyframes(const std::filesystem::path& path) {
  constexpr std::size_t kMinFields = 14;
  constexpr std::size_t kReferenceFromEnd = 8;
  std::istringstream lines(core::read_file(path));
  std::string line;
  std::getline(lines, line);  // names of the columns
  KeyframeStamps stamps_s;
  std::set<std::string> known;
  for (int number = 2; std::getline(lines, line); ++number) {
    const std::vector<std::string> fields = split(line);
    try {
      if (fields.size() < kMinFields) throw std::invalid_argument("short");
      const std::string& reference = fields[fields.size() - kReferenceFromEnd];
      if (reference.empty() || !known.insert(reference).second) continue;
      stamps_s[std::stoull(fields[0])] = std::stod(fields[1]);
    } catch (const std::exception&) {
      throw core::InputError(fmt::format("{}, line {}: found '{}', expected index,stamp_s,name,...",
                                         path.string(), number, line));
    }
  }
  return stamps_s;
}

Poses read_keyframe_poses(const std::filesystem::path& run, const core::FolderLock* held) {
  if (std::filesystem::exists(run / "loops.json")) ledger_in_step(run, held);
  const core::Trajectory trajectory = core::read_tum(run / "trajectory.tum");
  std::map<std::int64_t, core::Rigid3> pose_at;
  for (const auto& pose : trajectory) pose_at[in_units(pose.stamp_s)] = pose.world_from_camera;
  Poses poses;
  for (const auto& [index, stamp_s] : read_keyframes(run / "frames.csv")) {
    const auto pose = pose_at.find(in_units(stamp_s));
    if (pose != pose_at.end()) poses.emplace(index, pose->second);
  }
  if (poses.empty()) {
    throw core::InputError(fmt::format("{}: none of its {} poses has the stamp of a keyframe",
                                       (run / "trajectory.tum").string(), trajectory.size()));
  }
  return poses;
}

std::set<std::uint64_t> positions_of(const Poses& poses) {
  std::set<std::uint64_t> positions;
  for (const auto& [position, pose] : poses) positions.insert(position);
  return positions;
}

// Reads the keyframes of a source as views with depth.
class ViewReader {
 public:
  ViewReader(const pipeline::Config& config, const Poses& poses)
      : config_(config), poses_(poses), frames_(config, positions_of(poses)) {
    if (!frames_.info().is_calibrated) {
      throw core::InputError(config.source + ": no camera file, which dense maps need");
    }
  }

  // The next frame that has a pose and depth.
  std::optional<dense::View> next() {
    while (const std::optional<core::Frame> frame = frames_.next()) {
      const auto depth_m = depth_of(*frame);
      if (!depth_m) continue;
      return dense::View{frame->rig->cameras[0], poses_.at(frame->id.index()), frame->images[0],
                         *depth_m};
    }
    return std::nullopt;
  }

 private:
  std::optional<cv::Mat> depth_of(const core::Frame& frame) const {
    auto depth_m = dense::depth_of(frame, config_.dense);
    if (!depth_m && !frames_.info().has_depth) {
      throw core::InputError(config_.source +
                             ": found neither depth images nor a second camera, expected one of "
                             "them for dense maps");
    }
    return depth_m;
  }

  const pipeline::Config& config_;
  const Poses& poses_;
  SourceFrames frames_;
};

// Fused depth of all keyframes.
struct Fused {
  explicit Fused(const dense::Config& config) : cloud(config), octree(config), scans(config) {}

  dense::VoxelCloud cloud;
  dense::OctreeMap octree;
  dense::Scans scans;
  core::Trajectory cameras;  // stamps are not set
  std::size_t num_points = 0;
};

std::unique_ptr<Fused> fuse(const pipeline::Config& config, const Poses& poses,
                            const DenseFiles& files) {
  auto fused = std::make_unique<Fused>(config.dense);
  ViewReader reader(config, poses);
  dense::PointReader point_reader(config.dense);
  while (const auto view = reader.next()) {
    const auto points = point_reader.points(*view);
    const Eigen::Vector3d& camera_m = view->world_from_camera.translation;
    if (!files.cloud.empty() || !files.grid.empty()) fused->cloud.add(points);
    if (!files.octree.empty()) fused->octree.add(points, camera_m);
    if (!files.grid.empty()) fused->scans.add(points, camera_m);
    fused->cameras.push_back({0.0, view->world_from_camera});
    fused->num_points += points.size();
  }
  if (fused->num_points == 0) {
    throw core::InputError(fmt::format(
        "{}: none of its {} keyframes has depth between dense.min_depth_m = {} and "
        "dense.max_depth_m = {}",
        config.source, poses.size(), config.dense.min_depth_m, config.dense.max_depth_m));
  }
  return fused;
}

void warn_of_coarseness(const Fused& fused, const dense::Config& config) {
  if (fused.cloud.voxel_m() > config.voxel_m) {
    spdlog::warn("more than dense.max_voxels = {} voxels: voxel size {} m instead of {} m",
                 config.max_voxels, fused.cloud.voxel_m(), config.voxel_m);
  }
  if (fused.scans.stride_views() > 1) {
    spdlog::warn(
        "more than dense.max_scan_points = {} points: the grid uses one keyframe in "
        "{}",
        config.max_scan_points, fused.scans.stride_views());
  }
}

// What has been made: the files, without their names yet, and what is said of them.
struct Made {
  core::FilesTogether files;
  DenseOutcome outcome;
};

std::filesystem::path description_of(const DenseFiles& files) {
  std::filesystem::path description = files.grid;
  return description += ".yaml";
}

// Optional: the maps are made without.
void add_to_report(const std::vector<report::ColouredPoint>& points,
                   const std::filesystem::path& page) try {
  if (!core::is_there(page)) return;
  core::replace_file(page, report::with_dense_cloud(core::read_file(page), points));
} catch (const core::InputError& error) {
  spdlog::warn("{}: {}; the page lacks the cloud", page.string(), error.what());
}

std::vector<report::ColouredPoint> coloured_points(const std::vector<dense::CloudPoint>& cloud) {
  std::vector<report::ColouredPoint> points;
  points.reserve(cloud.size());
  for (const auto& point : cloud) points.push_back({point.in_world, point.rgb});
  return points;
}

void write_cloud(const std::vector<report::ColouredPoint>& points, const DenseFiles& files,
                 Made& made) {
  made.files.add(files.cloud, report::ply_bytes(points));
  made.outcome.figures.push_back(
      {"cloud", fmt::format("{}, {} points", files.cloud.string(), points.size())});
}

void write_grid(const Fused& fused, const std::vector<dense::CloudPoint>& cloud,
                const pipeline::Config& config, const DenseFiles& files, Made& made) {
  const auto floor = dense::find_floor(cloud, fused.cloud.voxel_m(), fused.cameras, config.dense,
                                       static_cast<std::uint64_t>(config.seed));
  if (!floor) {
    made.outcome.no_grid = "no floor was found: " + floor.error();
    made.outcome.figures.push_back({"grid", "none: " + *made.outcome.no_grid});
    return;
  }
  const core::Rigid3 map_from_world =
      dense::map_from_world(*floor, fused.cameras.front().world_from_camera);
  const dense::OccupancyGrid grid =
      dense::cast_grid(fused.scans.all(), *floor, map_from_world, config.dense);
  std::filesystem::path picture = files.grid;
  picture += ".pgm";
  const std::filesystem::path description = description_of(files);
  made.files.add(picture, dense::pgm_bytes(grid));
  made.files.add(description, dense::map_yaml(grid, picture.filename().string()));
  made.outcome.figures.push_back(
      {"grid",
       fmt::format("{}, {} x {} cells of {} m, {:.1f} m2 free, {:.1f} m2 occupied",
                   description.string(), grid.log_odds.cols, grid.log_odds.rows, grid.cell_m,
                   grid.area_m2(dense::Cell::kFree), grid.area_m2(dense::Cell::kOccupied))});
}

// So that the description of an earlier grid never lies beside the picture of another.
void publish(Made& made, const DenseFiles& files) {
  if (!files.grid.empty() && !made.outcome.no_grid) {
    std::error_code ignored;
    std::filesystem::remove(description_of(files), ignored);
  }
  made.files.publish();
}

// Before the work, to fail early for files that cannot be written.
void check_folders(const DenseFiles& files) {
  for (const auto& file : {files.cloud, files.grid, files.octree}) {
    if (file.empty()) continue;
    core::make_writable_folder(std::filesystem::absolute(file).parent_path());
  }
}

}  // namespace

DenseOutcome make_dense_maps(const std::filesystem::path& run, const pipeline::Config& config,
                             const DenseFiles& files, const core::FolderLock* held) {
  const Poses poses = read_keyframe_poses(run, held);
  check_folders(files);
  const std::unique_ptr<Fused> fused = fuse(config, poses, files);
  warn_of_coarseness(*fused, config.dense);
  Made made;
  made.outcome.figures.push_back({"keyframes", std::to_string(fused->cameras.size())});
  const std::vector<dense::CloudPoint> cloud = fused->cloud.points();
  if (!files.cloud.empty()) write_cloud(coloured_points(cloud), files, made);
  if (!files.octree.empty()) {
    const std::string bytes = fused->octree.bt_bytes();
    made.files.add(files.octree, bytes);
    made.outcome.figures.push_back(
        {"octree", fmt::format("{}, {} bytes", files.octree.string(), bytes.size())});
  }
  if (!files.grid.empty()) write_grid(*fused, cloud, config, files, made);
  publish(made, files);
  if (!files.cloud.empty()) add_to_report(coloured_points(cloud), run / "report.html");
  return std::move(made.outcome);
}

}  // namespace samewhere::run
