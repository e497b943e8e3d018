#include <algorithm>

#include <samewhere/twin/building/presets_dresser.hpp>

// What stands and hangs in rooms and stairs of one kind.

namespace samewhere::twin {

void Dresser::furnish_office(int space, int window_side) {
  const auto far = static_cast<std::size_t>(window_side);
  Dress walls{.max_depth_m = 0.05F, .has_ducts = false};
  walls.sides[far] = Use::kWindows;
  walls.sides[(far + 1) % 4] = Use::kBare;
  dress(space, walls);
  const Wall window = wall_of(space, window_side);
  const Wall side = wall_of(space, (window_side + 1) % 4);
  const float middle_m = 0.5F * window.length_m();
  const float moved_m = is_later_visit_ ? 0.45F : 0.0F;
  furnisher_.add_desk(spot_before(window, middle_m, 1.35F));
  Spot chair = spot_before(window, middle_m - moved_m, 0.60F);
  chair.heading_rad += is_later_visit_ ? 0.8F : -0.2F;
  furnisher_.add_chair(chair);
  Spot visitor = spot_before(side, 0.5F * side.length_m() + moved_m, 0.9F);
  visitor.heading_rad += 0.5F - moved_m;
  furnisher_.add_chair(visitor);
  furnisher_.add_bin(spot_before(window, middle_m + (is_later_visit_ ? -1.1F : 1.1F), 1.2F));
  furnisher_.add_shelf(spot_before(side, side.length_m() - 0.6F, 0.19F));
  furnisher_.add_shelf(spot_before(side, 0.6F, 0.19F));
  if (is_later_visit_) return furnisher_.skip_thing();
  furnisher_.add_plant(spot_before(window, 0.4F, 0.4F));
}

void Dresser::furnish_lounge(int space, int sofa_side) {
  const auto far = static_cast<std::size_t>(sofa_side);
  Dress walls{.max_depth_m = 0.05F, .has_ducts = false};
  walls.sides = {Use::kWindows, Use::kWindows, Use::kWindows, Use::kWindows};
  walls.sides[far] = Use::kBare;
  walls.pitch_m = 2.2F;
  dress(space, walls);
  const Wall back = wall_of(space, sofa_side);
  const float middle_m = 0.5F * back.length_m();
  const float moved_m = is_later_visit_ ? 0.3F : 0.0F;
  furnisher_.add_framed_poster({back, middle_m - 0.5F});
  furnisher_.add_framed_poster({back, middle_m + 0.5F});
  furnisher_.add_sofa(spot_before(back, middle_m, 0.45F));
  furnisher_.add_table(spot_before(back, middle_m + moved_m, 1.35F));
  Spot chair = spot_before(back, middle_m + 1.1F + moved_m, 1.3F + 0.5F * moved_m);
  chair.heading_rad += is_later_visit_ ? -0.6F : -1.3F;
  furnisher_.add_chair(chair);
  furnisher_.add_bin(spot_before(back, is_later_visit_ ? back.length_m() - 0.3F : 0.86F, 0.25F));
  furnisher_.add_plant(spot_before(back, 0.4F, 0.7F));
}

void Dresser::hang_along_flights(const Eigen::Vector2f& corner_m, float floor_m) {
  using namespace u_stair;
  const float foot_m = corner_m.y();
  const float head_m = foot_m + kFlight_m;
  const float left_m = corner_m.x();
  const float right_m = corner_m.x() + kWidth_m;
  constexpr float kSlope = 0.5F * kStorey_m / kFlight_m;
  constexpr float kHigher_m = 0.12F;  // the handrail climbs below what hangs
  // as seen from the flight, which is so high at the wall's left end and climbs by so much a metre
  const auto hang = [&](const Eigen::Vector2f& from_m, const Eigen::Vector2f& to_m,
                        float left_end_m, float slope, bool is_framed) {
    for (const float along_m : {0.25F * kFlight_m, 0.68F * kFlight_m}) {
      const float step_m = left_end_m + slope * along_m + kHigher_m;
      const Place place{{from_m, to_m, step_m, step_m + 2.5F}, along_m};
      if (is_framed) {
        furnisher_.add_framed_poster(place);
      } else {
        furnisher_.add_notice(place);
      }
    }
  };
  const float half_up_m = floor_m + 0.5F * kStorey_m;
  hang({right_m, head_m}, {right_m, foot_m}, half_up_m, -kSlope, true);
  hang({left_m, foot_m}, {left_m, head_m}, floor_m + kStorey_m, -kSlope, true);
  const float inner_m[2] = {left_m + kFlightWidth_m, left_m + kFlightWidth_m + kCore_m};
  hang({inner_m[1], foot_m}, {inner_m[1], head_m}, floor_m, kSlope, false);
  hang({inner_m[0], head_m}, {inner_m[0], foot_m}, half_up_m, kSlope, false);
}

void Dresser::dress_u_stair(const Eigen::Vector2f& corner_m, float floor_m) {
  using namespace u_stair;
  const float half_m = 0.5F * kStorey_m;
  const float head_m = corner_m.y() + kFlight_m;
  const float left_m = corner_m.x();
  const float right_m = corner_m.x() + kWidth_m;
  furnisher_.add_handrail(
      {{right_m, head_m}, {right_m, corner_m.y()}, floor_m + half_m, floor_m + half_m + 2.7F},
      -half_m);
  furnisher_.add_handrail(
      {{left_m, corner_m.y()}, {left_m, head_m}, floor_m + kStorey_m, floor_m + kStorey_m + 2.7F},
      -half_m);
  const Wall back{{left_m, head_m + kLanding_m},
                  {right_m, head_m + kLanding_m},
                  floor_m + half_m,
                  floor_m + half_m + 2.7F};
  furnisher_.add_window({back, 0.5F * kWidth_m}, Daylight::kBlinds);
  const float ends_m[2] = {head_m, head_m + kLanding_m};
  furnisher_.add_framed_poster(
      {{{right_m, ends_m[1]}, {right_m, ends_m[0]}, back.floor_m, back.ceiling_m}, 0.65F});
  furnisher_.add_notice_board(
      {{{left_m, ends_m[0]}, {left_m, ends_m[1]}, back.floor_m, back.ceiling_m}, 0.65F});
  furnisher_.add_radiator({back, 0.5F * kWidth_m});
  furnisher_.add_pipes(back, 2.3F);
  hang_along_flights(corner_m, floor_m);
  LampFitting lamp = ceiling_.lamp;
  lamp.drop_m = 0.0F;
  lamp.usual_m2 = 0.36F;
  furnisher_.add_ceiling_lamp({0.5F * (left_m + right_m), head_m + 0.5F * kLanding_m}, lamp,
                              back.ceiling_m);
  // on the ceiling of a step in the middle of each flight, and no longer than that
  const float y_m = corner_m.y() + 0.5F * kFlight_m - 0.14F;
  const float rise_m = kStorey_m / 18.0F;
  lamp.size_m.x() = std::min(lamp.size_m.x(), 1.0F);
  lamp.size_m.y() = std::min(lamp.size_m.y(), 0.2F);
  lamp.usual_m2 = 0.2F;
  furnisher_.add_ceiling_lamp({right_m - 0.5F * kFlightWidth_m, y_m}, lamp,
                              floor_m + 4.0F * rise_m + 2.7F);
  furnisher_.add_ceiling_lamp({left_m + 0.5F * kFlightWidth_m, y_m}, lamp,
                              floor_m + 14.0F * rise_m + 2.7F);
}

}  // namespace samewhere::twin
