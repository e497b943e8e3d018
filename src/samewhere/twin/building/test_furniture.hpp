#pragma once

#include <numbers>

#include <samewhere/twin/building/furnisher.hpp>
#include <samewhere/twin/building/test_rooms.hpp>
#include <samewhere/twin/render/texture.hpp>

// One of everything, alone and in look-alikes.
namespace samewhere::twin::test {

inline const Wall kWall{{-4.0F, 2.0F}, {4.0F, 2.0F}, 0.0F, 2.6F};

// One of everything, with numbers that differ from twin to twin.
inline void furnish(Furnisher& f, int number) {
  f.add_floor({-4.0F, -2.0F}, {4.0F, 2.0F}, 0.0F, FloorFinish::kTiles);
  f.add_ceiling({-4.0F, -2.0F}, {4.0F, 2.0F}, 2.6F, CeilingFinish::kTiles);
  f.add_wall(kWall, 0.0F, 2.6F, WallFinish::kBlocks);
  f.add_skirting(kWall, 0.0F, 1.0F);
  f.add_door({kWall, 1.0F}, number);
  f.add_double_door({kWall, 2.0F});
  f.add_lift_door({kWall, 3.0F}, number / 100);
  f.add_floor_number({kWall, 3.5F}, number / 100);
  f.add_notice_board({kWall, 4.0F});
  f.add_framed_poster({kWall, 4.5F});
  f.add_extinguisher({kWall, 5.0F});
  f.add_cabinet({kWall, 5.5F});
  f.add_switch({kWall, 5.8F});
  f.add_window({kWall, 6.0F}, Daylight::kView);
  f.add_window({kWall, 6.5F}, Daylight::kBlinds);
  f.add_radiator({kWall, 6.0F});
  f.add_handrail(kWall, 0.3F);
  f.add_cable_duct(kWall);
  f.add_pipes(kWall, 2.1F);
  f.add_sign({kWall, 7.0F}, Pictogram::kStairs);
  f.add_chair({{0.0F, 0.0F, 0.0F}, 0.3F});
  f.add_table({{0.0F, 0.0F, 0.0F}, 0.3F});
  f.add_desk({{0.0F, 0.0F, 0.0F}, 0.3F});
  f.add_plant({{0.0F, 0.0F, 0.0F}, 0.3F});
  f.add_bin({{0.0F, 0.0F, 0.0F}, 0.3F});
  f.add_sofa({{0.0F, 0.0F, 0.0F}, 0.3F});
  f.add_shelf({{0.0F, 0.0F, 0.0F}, 0.3F});
  f.add_rack({{0.0F, 0.0F, 0.0F}, 0.3F}, {2.7F, 3});
  f.add_pallet({{0.0F, 0.0F, 0.0F}, 0.3F});
  f.add_cornice(kWall, 0.06F, 0.06F);
  f.add_ceiling_lamp({0.0F, 0.0F}, {}, 2.6F);
  f.add_ceiling_vent({0.0F, 0.0F}, VentKind::kGrille, 2.6F);
  f.add_exit_sign({0.0F, 0.0F}, 0.4F, 2.6F);
  f.add_smoke_detector({0.0F, 0.0F}, 2.6F);
  f.add_high_bay_lamp({0.0F, 0.0F}, 6.0F);
  f.add_coat_rack({kWall, 1.0F});
  f.add_leaflets({kWall, 2.5F});
  f.add_low_shelf({kWall, 4.0F});
  f.add_crates({kWall, 6.0F});
}

// Two units of one kind, the second turned and moved.
inline Building twins(double similarity, std::uint64_t visit = 0) {
  Building building;
  building.units = {Unit{}, Unit{0, turned_and_moved(std::numbers::pi, {20.0, 7.0, 3.0})}};
  for (int unit = 0; unit < 2; ++unit) {
    Furnisher f(building, unit,
                {.common_seed = 7,
                 .own_seed = 100 + static_cast<std::uint64_t>(unit),
                 .similarity = similarity,
                 .visit = visit});
    furnish(f, 301 + unit);
  }
  return building;
}

// Brightness on a grid, from the distance at which a pixel is this wide.
inline Eigen::ArrayXf texture_of(const Rectangle& rectangle, float footprint_m) {
  constexpr int kSide = 60;
  Eigen::ArrayXf values(kSide * kSide);
  for (int i = 0; i < kSide * kSide; ++i) {
    const Eigen::Vector2f ratio((static_cast<float>(i % kSide) + 0.5F) / kSide,
                                (static_cast<float>(i / kSide) + 0.5F) / kSide);
    const Eigen::Vector2f at_m = ratio.cwiseProduct(rectangle.size_m);
    values[i] = reflectance(rectangle, {at_m.x(), at_m.y(), footprint_m}).mean();
  }
  return values;
}

}  // namespace samewhere::twin::test
