#include <gtest/gtest.h>

#include <samewhere/dense/grid_message.hpp>
#include <samewhere/dense/occupancy_grid.hpp>
#include <samewhere/dense/test_room.hpp>

namespace samewhere::dense {
namespace {

// What the pipeline does with a walk.
struct Walked {
  explicit Walked(const Config& given, const std::vector<View>& views = TestRoom::walk())
      : config(given), cloud(given), scans(given) {
    PointReader reader(given);
    for (const View& view : views) {
      const auto points = reader.points(view);
      cloud.add(points);
      scans.add(points, view.world_from_camera.translation);
      cameras.push_back({0.0, view.world_from_camera});
    }
  }

  Result<FloorPlane, std::string> floor() const {
    return find_floor(cloud.points(), cloud.voxel_m(), cameras, config, 0);
  }
  OccupancyGrid grid() const {
    const FloorPlane plane = floor().value();
    return cast_grid(scans.all(), plane, map_from_world(plane, cameras.front().world_from_camera),
                     config);
  }

  Config config;
  VoxelCloud cloud;
  Scans scans;
  core::Trajectory cameras;
};

const Config kConfig{.step_px = 1, .max_depth_m = 6.0, .voxel_m = 0.05};

void expect_floor_of_room(const FloorPlane& floor) {
  const core::Rigid3 world_from_room = TestRoom::world_from_room();
  const Eigen::Vector3d up = world_from_room.rotation * Eigen::Vector3d::UnitZ();
  EXPECT_LT(std::acos(std::min(1.0, floor.up_in_world.dot(up))), 0.003);
  const Eigen::Vector3d middle = world_from_room * Eigen::Vector3d(2.0, 1.5, 0.0);
  EXPECT_NEAR(floor.up_in_world.dot(middle), floor.offset_m, 0.01);
}

TEST(Floor, IsFoundInAWorldThatStandsOnItsSide) {
  const Walked walked(kConfig);
  const auto floor = walked.floor();
  ASSERT_TRUE(floor) << floor.error();
  expect_floor_of_room(*floor);
  EXPECT_GT(floor->area_m2, 10.0);
}

// A table that hides most of the floor from above, as dense as the floor.
TEST(Floor, IsNotTheTable) {
  const core::Rigid3 world_from_room = TestRoom::world_from_room();
  std::vector<CloudPoint> cloud;
  const auto lay = [&](double width_m, double height_m) {
    for (double x = 0.0; x < width_m; x += 0.02) {
      for (double y = 0.0; y < 1.0; y += 0.02) {
        cloud.push_back(
            {(world_from_room * Eigen::Vector3d(x, y, height_m)).cast<float>().eval(), {}});
      }
    }
  };
  lay(3.0, 0.75);
  lay(1.2, 0.0);
  lay(0.1, -0.5);  // what a sensor finds below the floor is small
  const core::Trajectory cameras{{0.0, TestRoom::view({1.0, 1.0, 1.5}, 0.3).world_from_camera}};
  const auto floor = find_floor(cloud, 0.02, cameras, {}, 0);
  ASSERT_TRUE(floor) << floor.error();
  expect_floor_of_room(*floor);
}

TEST(Floor, ThereIsNoneWhereOnlyWallsWereSeen) {
  std::vector<View> views = TestRoom::walk();
  for (View& view : views) {
    for (int i = 0; i < view.depth_m.rows; ++i) {
      // with the camera looking down by 0.35 rad, rows above this see no floor and no box
      if (i > 20) view.depth_m.row(i).setTo(0.0);
    }
  }
  const Walked walked(kConfig, views);
  const auto floor = walked.floor();
  ASSERT_FALSE(floor);
  EXPECT_NE(floor.error().find("below the cameras"), std::string::npos) << floor.error();
}

TEST(Floor, AMapStandsOnItBelowTheFirstCamera) {
  const core::Rigid3 world_from_camera = TestRoom::view({1.0, 2.0, 1.2}, 0.7).world_from_camera;
  const core::Rigid3 world_from_room = TestRoom::world_from_room();
  const Eigen::Vector3d up = world_from_room.rotation * Eigen::Vector3d::UnitZ();
  const core::Rigid3 map_from =
      map_from_world({up, up.dot(world_from_room.translation), 1.0}, world_from_camera);
  EXPECT_LT((map_from * world_from_camera.translation - Eigen::Vector3d(0, 0, 1.2)).norm(), 1e-9);
  const Eigen::Vector3d forward =
      map_from.rotation * (world_from_camera.rotation * Eigen::Vector3d::UnitZ());
  EXPECT_GT(forward.x(), 0.9);
  EXPECT_NEAR(forward.y(), 0.0, 1e-9);
}

// What the grid says of the places of the room's plan, a centimetre apart.
struct PlanCheck {
  int num_free = 0;
  int num_open = 0;  // of the plan, a hand's breadth from walls and box
  int num_free_in_box = 0;
  int num_free_outside = 0;
  int num_walls = 0;
  int num_occupied_walls = 0;
};

// What the grid says of a place in the room.
Cell cell_at(const OccupancyGrid& grid, double x_in_room, double y_in_room) {
  const core::Rigid3 map_from_room = grid.map_from_world * TestRoom::world_from_room();
  const Eigen::Vector3d in_map = map_from_room * Eigen::Vector3d(x_in_room, y_in_room, 0.0);
  const Eigen::Vector2d cell = (in_map.head<2>() - grid.corner_in_map) / grid.cell_m;
  const bool is_inside = cell.x() >= 0 && cell.y() >= 0 && cell.x() < grid.log_odds.cols &&
                         cell.y() < grid.log_odds.rows;
  return is_inside ? grid.at(static_cast<int>(cell.y()), static_cast<int>(cell.x()))
                   : Cell::kUnknown;
}

void check_place(const Eigen::Vector3d& place, bool is_free, PlanCheck& check) {
  const Eigen::AlignedBox3d room(Eigen::Vector3d::Zero(), TestRoom::kSize_m);
  const double distance_m = TestRoom::distance_m(place);
  const bool is_in_box = TestRoom::kBox_m.contains(place);
  const bool is_open = room.contains(place) && !is_in_box && distance_m > 0.1;
  check.num_open += is_open ? 1 : 0;
  check.num_free += is_open && is_free ? 1 : 0;
  const bool is_wrong = is_free && distance_m > 0.08;
  check.num_free_in_box += is_wrong && is_in_box ? 1 : 0;
  check.num_free_outside += is_wrong && !room.contains(place) ? 1 : 0;
}

PlanCheck check_plan(const OccupancyGrid& grid) {
  PlanCheck check;
  for (double x = -0.5; x < 4.5; x += 0.01) {
    for (double y = -0.5; y < 3.5; y += 0.01) {
      check_place({x, y, 0.4}, cell_at(grid, x, y) == Cell::kFree, check);
    }
  }
  for (double x = 0.1; x < 3.9; x += 0.01) {
    for (const double y : {0.0, 3.0}) {
      ++check.num_walls;
      if (cell_at(grid, x, y) == Cell::kOccupied) ++check.num_occupied_walls;
    }
  }
  return check;
}

TEST(OccupancyGrid, IsThePlanOfTheRoom) {
  const PlanCheck check = check_plan(Walked(kConfig).grid());
  EXPECT_GT(check.num_free, 0.97 * check.num_open);
  EXPECT_EQ(check.num_free_in_box, 0);
  EXPECT_EQ(check.num_free_outside, 0);
  EXPECT_GT(check.num_occupied_walls, 0.9 * check.num_walls);
}

TEST(OccupancyGrid, WhatIsLowerThanAnObstacleIsWalkedOver) {
  Config config = kConfig;
  config.min_obstacle_m = 0.9;
  const OccupancyGrid grid = Walked(config).grid();
  const PlanCheck check = check_plan(grid);
  EXPECT_GT(check.num_free_in_box, 0) << "the box is lower than 0.9 m";
  EXPECT_GT(check.num_occupied_walls, 0.9 * check.num_walls);
}

// One view sees the table top; many look over it at the wall behind.
TEST(OccupancyGrid, LookingOverATableDoesNotClearIt) {
  const auto scan_of = [](float height_m, float from_m, float to_m) {
    Scan scan{{0.0F, 0.0F, 1.5F}, {}};
    for (float x = from_m; x <= to_m; x += 0.04F)
      scan.points_in_world.emplace_back(x, 0.0F, height_m);
    return scan;
  };
  std::vector<Scan> scans(2, scan_of(0.7F, 1.5F, 2.0F));
  scans.resize(20, scan_of(1.2F, 4.0F, 4.0F));
  const OccupancyGrid over = cast_grid(scans, {}, {}, {});
  const auto on_axis = [](const OccupancyGrid& grid, double x_m) {
    const Eigen::Vector2d cell = (Eigen::Vector2d(x_m, 0.0) - grid.corner_in_map) / grid.cell_m;
    return grid.at(static_cast<int>(cell.y()), static_cast<int>(cell.x()));
  };
  EXPECT_EQ(on_axis(over, 1.8), Cell::kOccupied);
  EXPECT_EQ(on_axis(over, 3.0), Cell::kFree);
  scans.resize(40, scan_of(0.0F, 3.5F, 3.5F));  // rays that pass 1.8 m at a height of 0.73 m
  scans.resize(60, scan_of(0.0F, 2.5F, 2.5F));  // and at 0.42 m: it was carried away
  EXPECT_EQ(on_axis(cast_grid(scans, {}, {}, {}), 1.8), Cell::kFree);
}

TEST(OccupancyGrid, FewerScansInLessMemoryStillMakeThePlan) {
  Config config = kConfig;
  config.max_scan_points = 80000;
  const Walked walked(config);
  EXPECT_GT(walked.scans.stride_views(), 1U);
  std::size_t num_points = 0;
  for (const auto& scan : walked.scans.all()) num_points += scan.points_in_world.size();
  EXPECT_LE(num_points, 80000U);
  const PlanCheck check = check_plan(walked.grid());
  EXPECT_GT(check.num_free, check.num_open / 2);
  EXPECT_EQ(check.num_free_in_box, 0);
}

// A robot that takes the message at its word finds walls and free floor where they are.
TEST(OccupancyGrid, TheMessageLiesWhereTheRoomIs) {
  const Walked walked(kConfig);
  const core::Rigid3 world_from_room = TestRoom::world_from_room();
  const Eigen::Vector3d forward = world_from_room.rotation * Eigen::Vector3d::UnitX();
  const auto grid = find_grid(walked.scans.all(), walked.cameras, forward, walked.config, 0);
  ASSERT_TRUE(grid) << grid.error();
  const core::Rigid3 frame_from_world{
      Eigen::Quaterniond(Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitZ())), {3.0, 2.0, 1.0}};
  const messages::OccupancyGrid message = grid_message(*grid, frame_from_world);
  const messages::Pose& pose = message.info.origin;
  const core::Rigid3 frame_from_grid{Eigen::Quaterniond(pose.orientation.w, pose.orientation.x,
                                                        pose.orientation.y, pose.orientation.z),
                                     {pose.position.x, pose.position.y, pose.position.z}};
  const core::Rigid3 grid_from_room =
      core::inverse(frame_from_grid) * frame_from_world * world_from_room;
  const auto value_at = [&](double x_m, double y_m) {
    const Eigen::Vector3d in_grid = grid_from_room * Eigen::Vector3d(x_m, y_m, 0.0);
    EXPECT_NEAR(in_grid.z(), 0.0, 0.02) << "the grid lies on the floor";
    const auto column = static_cast<std::size_t>(in_grid.x() / message.info.resolution);
    const auto row = static_cast<std::size_t>(in_grid.y() / message.info.resolution);
    return static_cast<int>(message.data.at(row * message.info.width + column));
  };
  EXPECT_EQ(value_at(1.5, 1.5), 0);
  EXPECT_EQ(value_at(2.61, 1.3), 100) << "side of the box";
  EXPECT_EQ(value_at(2.9, 1.3), 100) << "its top";
  EXPECT_EQ(value_at(1.5, -0.15), -1) << "behind the wall";
  EXPECT_EQ(message.data.size(), std::size_t{message.info.width} * message.info.height);
  EXPECT_LT((grid_from_room.rotation * Eigen::Vector3d::UnitX() - Eigen::Vector3d::UnitX()).norm(),
            0.01)
      << "its x axis is the one that was asked for";
}

TEST(OccupancyGrid, ThereIsNoneWithoutAFloor) {
  const auto grid = find_grid({{{}, {{1.0F, 0.0F, 0.0F}}}}, {{}}, Eigen::Vector3d::UnitX(), {}, 0);
  ASSERT_FALSE(grid);
  EXPECT_NE(grid.error().find("below the cameras"), std::string::npos) << grid.error();
}

TEST(OccupancyGrid, FilesSayWhatTheGridSays) {
  OccupancyGrid grid;
  grid.cell_m = 0.05;
  grid.corner_in_map = {-1.5, 2.0};
  grid.log_odds = (cv::Mat_<float>(2, 3) << -2.0F, 0.0F, 3.0F, 0.0F, 0.0F, 0.0F);
  const std::string picture = pgm_bytes(grid);
  const std::string header = "P5\n3 2\n255\n";
  EXPECT_EQ(picture.substr(0, header.size()), header);
  const auto unknown = static_cast<char>(205);
  EXPECT_EQ(picture.substr(header.size()),
            (std::string{unknown, unknown, unknown, static_cast<char>(254), unknown, '\0'}))
      << "the row of the smallest y comes last";
  const std::string yaml = map_yaml(grid, "a \"plan\".pgm");
  for (const char* line :
       {"image: \"a \\\"plan\\\".pgm\"\n", "resolution: 0.05\n",
        "origin: [-1.500000, 2.000000, 0.0]\n", "negate: 0\n", "occupied_thresh: 0.65\n",
        "free_thresh: 0.196\n", "# floor in the world of the run: "}) {
    EXPECT_NE(yaml.find(line), std::string::npos) << line << "\n" << yaml;
  }
}

}  // namespace
}  // namespace samewhere::dense
