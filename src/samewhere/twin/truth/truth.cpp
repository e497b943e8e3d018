#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <utility>

#include <Eigen/Geometry>

#include <samewhere/core/errors.hpp>
#include <samewhere/twin/truth/truth.hpp>
#include <samewhere/twin/truth/unique_objects.hpp>

namespace samewhere::twin {
namespace {

using Eigen::Vector3f;

constexpr double kMinSame = 0.3;
constexpr double kMinConfirmable = 0.5;
constexpr double kMaxDifferent = 0.05;
constexpr double kMinLoop_s = 10.0 - 1e-6;  // stamps are multiples of a fifteenth
constexpr int kStrideOfLongWalks_frames = 15;

bool look_the_same_way(const Viewpoint& a, const Viewpoint& b) {
  static const float min_cosine = std::cos(0.25F * std::numbers::pi_v<float>);
  return a.looks_along().dot(b.looks_along()) >= min_cosine;
}

std::size_t nearest_area(const std::vector<Area>& areas, const Vector3f& position_m) {
  const auto distance = [&](const Area& area) {
    return Eigen::AlignedBox3f(area.low_m, area.high_m).squaredExteriorDistance(position_m);
  };
  const auto nearest =
      std::min_element(areas.begin(), areas.end(),
                       [&](const Area& a, const Area& b) { return distance(a) < distance(b); });
  return static_cast<std::size_t>(nearest - areas.begin());
}

std::vector<FrameTruth> frames_of(const Walk& walk, const std::vector<Visit>& visits) {
  std::vector<FrameTruth> frames;
  int last_visit = 0;
  for (std::size_t i = 0; i < walk.poses.size(); ++i) {
    FrameTruth frame{.visit = walk.visit_of_frame[i]};
    if (frame.visit != kDark) last_visit = frame.visit;
    const auto& areas = visits[static_cast<std::size_t>(last_visit)].building->areas;
    if (!areas.empty()) {
      const Area& area =
          areas[nearest_area(areas, walk.poses[i].world_from_camera.translation.cast<float>())];
      frame.room = area.name;
      frame.floor = area.floor;
      frame.unit = area.unit;
    }
    frames.push_back(std::move(frame));
  }
  return frames;
}

// One frame of the walk with what it shows.
struct SeenFrame {
  int frame = 0;  // of the walk
  double stamp_s = 0.0;
  FrameTruth where;
  Sight sight;
  std::vector<ShownObject> shown;
};

// How much two frames share, both ways.
struct Shares {
  double query_by_match = 0.0;
  double match_by_query = 0.0;

  double smaller() const { return std::min(query_by_match, match_by_query); }
  double larger() const { return std::max(query_by_match, match_by_query); }
};

core::PlaceTruth place_truth(const Shares& overlap, const SeenFrame& query,
                             const SeenFrame& match) {
  if (overlap.larger() < kMaxDifferent) return core::PlaceTruth::kDifferent;
  const bool is_same = overlap.smaller() >= kMinSame &&
                       look_the_same_way(query.sight.viewpoint, match.sight.viewpoint);
  return is_same ? core::PlaceTruth::kSame : core::PlaceTruth::kNear;
}

// A rotation and a translation in single precision, for many points.
struct Move {
  Eigen::Matrix3f rotation;
  Vector3f translation_m;

  explicit Move(const core::Rigid3& a_from_b)
      : rotation(a_from_b.rotation.toRotationMatrix().cast<float>()),
        translation_m(a_from_b.translation.cast<float>()) {}
  // A viewpoint of b's world, carried into a's.
  Viewpoint operator*(const Viewpoint& in_b) const {
    return {in_b.camera_from_world * rotation.transpose(),
            rotation * in_b.position_m + translation_m};
  }
};

// The way from a unit to one that is built like it: what lies in the one's world, at its
// counterpart in the other's.
struct Kin {
  Move here_from_there;
  Move there_from_here;
};

std::vector<Kin> kin_of(int unit, const Building& here, const Building& there) {
  std::vector<Kin> kin;
  if (unit < 0) return kin;
  const Unit& own = here.units[static_cast<std::size_t>(unit)];
  for (std::size_t other = 0; other < there.units.size(); ++other) {
    const Unit& twin = there.units[other];
    if (twin.kind != own.kind || static_cast<int>(other) == unit) continue;
    const core::Rigid3 here_from_there = own.world_from_unit * inverse(twin.world_from_unit);
    kin.push_back({Move(here_from_there), Move(inverse(here_from_there))});
  }
  return kin;
}

class PairLabeler {
 public:
  PairLabeler(const std::vector<Visit>& visits, const core::Camera& camera)
      : visits_(visits), camera_(camera), eye_(camera), objects_(visits) {}

  SeenFrame look(const core::StampedPose& pose, int frame, const FrameTruth& where) const {
    SeenFrame seen{.frame = frame, .stamp_s = pose.stamp_s, .where = where};
    if (where.visit == kDark) return seen;
    seen.sight = eye_.look(pose.world_from_camera, visits_[static_cast<std::size_t>(where.visit)]);
    seen.shown = objects_.shown_to(camera_, pose.world_from_camera, where.visit);
    return seen;
  }

  Shares overlap(const SeenFrame& query, const SeenFrame& match) const {
    return {eye_.overlap(query.sight, match.sight), eye_.overlap(match.sight, query.sight)};
  }

  TrueLoop loop(const SeenFrame& query, const SeenFrame& match, double overlap) const {
    TrueLoop loop{.query = query.frame, .match = match.frame, .overlap = overlap};
    const std::optional<int> object = best_shared(query.shown, match.shown);
    if (object) loop.object = objects_.name(*object);
    loop.is_confirmable = object && overlap >= kMinConfirmable;
    return loop;
  }

  // For each visit, the kin of the unit that the frame was taken in.
  std::vector<std::vector<Kin>> kin_by_visit(const SeenFrame& seen) const {
    std::vector<std::vector<Kin>> kin;
    for (const Visit& visit : visits_) {
      kin.push_back(seen.sight.building == nullptr
                        ? std::vector<Kin>()
                        : kin_of(seen.where.unit, *seen.sight.building, *visit.building));
    }
    return kin;
  }

  // How alike they are with the query moved to the best of its unit's kin; 0 if they are not.
  double alike(const SeenFrame& query, const SeenFrame& match, const std::vector<Kin>& kin) const {
    constexpr float kMaxApart_m = 3.0F;
    double best = 0.0;
    for (const Kin& twin : kin) {
      const Viewpoint match_here = twin.here_from_there * match.sight.viewpoint;
      const Viewpoint& from = query.sight.viewpoint;
      if ((match_here.position_m - from.position_m).squaredNorm() > kMaxApart_m * kMaxApart_m ||
          !look_the_same_way(match_here, from)) {
        continue;
      }
      const double least = std::max(best, kMinSame);
      const double query_by_match = eye_.alike(query.sight, match.sight, match_here, least);
      if (query_by_match <= best) continue;
      const double match_by_query =
          eye_.alike(match.sight, query.sight, twin.there_from_here * from, least);
      best = std::max(best, Shares{query_by_match, match_by_query}.smaller());
    }
    return best;
  }

 private:
  const std::vector<Visit>& visits_;
  const core::Camera& camera_;
  Eye eye_;
  UniqueObjects objects_;
};

void make_room_for_matrices(WalkTruth& truth) {
  const std::size_t n = truth.frames.size();
  truth.overlap.resize(n * n);
  truth.places = core::PlaceTruthMatrix{static_cast<int>(n), std::vector<core::PlaceTruth>(n * n)};
}

void write_pair(const core::FramePair& pair, const Shares& overlap, core::PlaceTruth place,
                WalkTruth& truth) {
  const auto rounded = [](double share) {
    return static_cast<std::uint8_t>(std::lround(255.0 * share));
  };
  const auto query = static_cast<std::size_t>(pair.query);
  const auto match = static_cast<std::size_t>(pair.match);
  const std::size_t n = truth.frames.size();
  truth.overlap[query * n + match] = rounded(overlap.query_by_match);
  truth.overlap[match * n + query] = rounded(overlap.match_by_query);
  truth.places->values[query * n + match] = place;
  truth.places->values[match * n + query] = place;
}

// Writes down whether a pair is a loop or an aliased pair; `kin` are those of the query, by visit.
void register_pair(const PairLabeler& labeler, const SeenFrame& query, const SeenFrame& match,
                   const std::vector<std::vector<Kin>>& kin, WalkTruth& truth) {
  const Shares overlap = labeler.overlap(query, match);
  const core::PlaceTruth place = place_truth(overlap, query, match);
  if (truth.places) write_pair({query.frame, match.frame}, overlap, place, truth);
  if (place == core::PlaceTruth::kSame && query.stamp_s - match.stamp_s >= kMinLoop_s) {
    truth.loops.push_back(labeler.loop(query, match, overlap.smaller()));
  }
  if (place == core::PlaceTruth::kDifferent && match.where.visit != kDark) {
    const double alike =
        labeler.alike(query, match, kin[static_cast<std::size_t>(match.where.visit)]);
    if (alike > 0.0) truth.aliased_pairs.push_back({query.frame, match.frame, alike});
  }
}

void label_pairs(const PairLabeler& labeler, const std::vector<SeenFrame>& frames,
                 const WatchPairs& watch, WalkTruth& truth) {
  const auto num_pairs = [](std::size_t num_frames) {
    return static_cast<int>(num_frames * (num_frames + 1) / 2);
  };
  for (std::size_t query = 0; query < frames.size(); ++query) {
    const std::vector<std::vector<Kin>> kin = labeler.kin_by_visit(frames[query]);
    for (std::size_t match = 0; match <= query; ++match) {
      register_pair(labeler, frames[query], frames[match], kin, truth);
    }
    if (watch) watch(num_pairs(query + 1), num_pairs(frames.size()));
  }
}

void check(const Walk& walk, const std::vector<Visit>& visits) {
  core::require(!visits.empty(), "a walk has a building");
  core::require(walk.visit_of_frame.size() == walk.poses.size(), "every frame has a visit");
  for (const int visit : walk.visit_of_frame) {
    core::require(visit >= kDark && visit < static_cast<int>(visits.size()), "a visit is known");
  }
}

}  // namespace

WalkTruth truth_of(const Walk& walk, const std::vector<Visit>& visits, const core::Camera& camera,
                   const WatchPairs& watch) {
  check(walk, visits);
  WalkTruth truth{.frames = frames_of(walk, visits)};
  const bool is_long = walk.poses.size() > static_cast<std::size_t>(kMaxFramesOfMatrix);
  truth.stride_frames = is_long ? kStrideOfLongWalks_frames : 1;
  if (!is_long) make_room_for_matrices(truth);

  const PairLabeler labeler(visits, camera);
  std::vector<SeenFrame> frames;
  for (std::size_t i = 0; i < walk.poses.size();
       i += static_cast<std::size_t>(truth.stride_frames)) {
    frames.push_back(labeler.look(walk.poses[i], static_cast<int>(i), truth.frames[i]));
  }
  label_pairs(labeler, frames, watch, truth);
  return truth;
}

std::vector<core::FrameSpan> revisits_of(const std::vector<TrueLoop>& loops) {
  std::vector<core::FrameSpan> stays;
  std::vector<core::FrameSpan> revisits;  // of these, those that can be confirmed
  for (const TrueLoop& loop : loops) {
    if (!stays.empty() && loop.query <= stays.back().last + 1) {
      stays.back().last = loop.query;
    } else {
      stays.push_back({loop.query, loop.query});
    }
    const core::FrameSpan& stay = stays.back();
    const bool is_known = !revisits.empty() && revisits.back().first == stay.first;
    if (is_known) {
      revisits.back() = stay;
    } else if (loop.is_confirmable) {
      revisits.push_back(stay);
    }
  }
  return revisits;
}

core::Truth core_truth(core::Trajectory poses, const WalkTruth& truth) {
  core::Truth result{.trajectory = std::move(poses), .places = truth.places};
  if (truth.stride_frames != 1) return result;
  result.revisits = revisits_of(truth.loops);
  for (const AliasedPair& pair : truth.aliased_pairs) {
    result.aliased_pairs.push_back({pair.query, pair.match});
  }
  return result;
}

}  // namespace samewhere::twin
