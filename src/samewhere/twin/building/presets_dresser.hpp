#pragma once

#include <array>
#include <optional>
#include <vector>

#include <samewhere/twin/building/furnisher.hpp>
#include <samewhere/twin/building/plan.hpp>
#include <samewhere/twin/building/spec.hpp>

namespace samewhere::twin {

// One visit of a building: how bright it is, and when.
struct VisitSetting {
  std::uint64_t index = 0;
  LightSetting light;
};

// A building in the making, as it is at one visit.
struct Draft {
  Spec spec;
  VisitSetting visit;
  Plan plan;
  Building building;
};

// The units and spaces of the plan, nothing to see yet.
Draft draft_of(const Spec& spec, const Plan& plan, const VisitSetting& visit = {});

// What stands along one side of a space.
enum class Use : std::uint8_t {
  kNothing,  // the caller adds the skirting, too
  kBare,     // skirting only
  kPlain,    // boards, posters and the like
  kDoors,    // and doors with numbers
  kWindows,  // and windows
};

// How a space is dressed.
struct Dress {
  std::array<Use, 4> sides = {Use::kPlain, Use::kPlain, Use::kPlain, Use::kPlain};  // as WallPiece
  float pitch_m = 2.6F;      // at least this from door to door
  float max_depth_m = 0.4F;  // nothing stands out further from its walls
  bool has_ducts = true;     // along walls with doors
  bool has_pipes = false;    // along plain walls, below the ceiling
  bool has_lamps = true;
  bool has_cornices = true;
  bool has_extinguishers = true;  // a sign instead
};

// Puts what belongs into a corridor or room where there is room for it, in one unit. What hangs
// where is half common, half own, as looks are (Style).
class Dresser {
 public:
  // Begins with floors, ceilings, walls, lintels and risers of all spaces of the unit. The draft
  // must outlive it.
  Dresser(Draft& draft, int unit);

  // What is dressed from now on leaves this stretch of a wall to things that are put there by hand.
  void keep_free(const Place& middle, float width_m);
  // Doors are numbered on from here.
  void number_from(int number) { next_number_ = number; }
  void dress(int space, const Dress& dress);
  // Desk, chair and shelves; `window_side` is the side across from the door. At a later visit
  // chairs and bins have moved and the plant is gone.
  void furnish_office(int space, int window_side);
  // Sofa, table, chair and plant along one side, windows left and right of it.
  void furnish_lounge(int space, int sofa_side);
  // All along a wall but for the gaps: from, to.
  void add_skirting(const Wall& wall, const std::vector<Eigen::Vector2f>& gaps_m);
  // Handrails and lamps of a stair built by add_u_stair() at this corner.
  void dress_u_stair(const Eigen::Vector2f& corner_m, float floor_m);

  // The whole wall of a side, the longest if there are several.
  Wall wall_of(int space, int side) const;
  Furnisher& furnisher() { return furnisher_; }

 private:
  struct Gap;
  struct Stretch {
    Wall wall;
    float from_m = 0.0F;
    float to_m = 0.0F;
  };

  // How all ceilings of the unit are fitted.
  struct CeilingDesign {
    LampFitting lamp;
    bool is_across = false;            // lamps lie across the space
    float pitch_m = 2.4F;              // from lamp to lamp, about
    float phase = 0.5F;                // of the first lamp, in pitches
    std::vector<float> rows = {0.5F};  // where across the space, shares of its width
    std::optional<VentKind> vent;
    float vent_row = 0.5F;
    int vent_step = 2;  // one in so many gaps between lamps
    float detector_row = 0.5F;
    std::array<float, 2> signs_m = {1.3F, 1.3F};  // from either end; 0: none there
  };
  // Lamps one behind the other.
  struct LampRow {
    int num_lamps = 1;
    float step_m = 0.0F;   // from middle to middle
    float gap_m = 0.0F;    // between two
    float shift_m = 0.0F;  // of all of them

    float beside_lamp_m(float wanted_m) const;
    float middle_m(int lamp) const { return (static_cast<float>(lamp) + 0.5F) * step_m + shift_m; }
  };
  // How walls meet the ceiling.
  struct EdgeDesign {
    Eigen::Vector2f cornice_m = Eigen::Vector2f::Zero();  // along ceiling and wall; 0: none
    float duct_below_m = 0.17F;                           // the ceiling; 0: no duct
    float pipes_below_m = 0.34F;
  };
  // A stretch of one side of a space that reaches the ceiling, over its openings.
  struct TopEdge {
    Wall wall;
    bool starts_in_corner = false;  // with another wall of the space
    bool ends_in_corner = false;
  };
  static CeilingDesign ceiling_of(const Style& layout);
  static EdgeDesign edge_of(const Style& layout);

  void add_surfaces();
  void hang_along_flights(const Eigen::Vector2f& corner_m, float floor_m);
  void dress_wall(const WallPiece& piece, const Dress& dress);
  std::vector<Eigen::Vector2f> add_bays(Use use, float pitch_m, Gap& gap);
  float shift_of_bay(bool is_door, int bay, int num_bays, float pitch_m);
  void fill_long_gap(Gap gap);
  void add_bay(const Place& place, Use use);
  void fill_gap(const Gap& whole_gap);
  Gap without_kept(Gap gap) const;
  std::vector<TopEdge> top_edges(int space, int side) const;
  bool is_convex_corner(int space, const Eigen::Vector2f& at_m, const Wall& wall) const;
  void add_edges(int space, const Dress& dress);
  void add_edge(int space, const TopEdge& edge, Use use, const Dress& dress);
  void add_ceiling_things(const Space& space);
  LampRow add_lamps(const Space& space);
  LampRow lamps_along(float room_m, float lamp_m) const;
  void add_vents(const Space& space, const LampRow& lamps);
  void add_exit_signs(const Space& space, const LampRow& lamps);

  const Plan& plan_;
  int unit_;
  Style layout_;
  CeilingDesign ceiling_;
  EdgeDesign edge_;
  bool is_later_visit_;
  Furnisher furnisher_;
  std::vector<Stretch> kept_;
  std::uint64_t num_gaps_ = 0;
  std::uint64_t num_bays_ = 0;
  int next_number_ = 1;
};

// A spot before a wall, its back to it.
Spot spot_before(const Wall& wall, float along_m, float out_m);

}  // namespace samewhere::twin
