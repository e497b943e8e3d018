#pragma once

#include <optional>

#include "liar.hpp"
#include "partition.hpp"

namespace samewhere::bench {

// How many classes of landmarks from before the lie were joined since by mapping alone, without
// what the true loops merged.
struct Joined {
  int num_all = 0;
  int num_wrong = 0;  // of these, of points more than 0.3 m apart
};

// What a lie left behind.
struct Aftermath {
  bool is_believed = false;     // by the pose graph, for as long as a keyframe
  int num_merged = 0;           // landmarks, while it was believed
  int num_seen = 0;             // landmarks in keyframes that did not know
  double ate_believed_m = 0.0;  // of the keyframes, before it was withdrawn

  // From here on: the moment in which it was withdrawn, before mapping goes on.
  std::optional<std::uint64_t> withdrawn_at;  // the newest keyframe then
  int num_marked = 0;                         // landmarks that still bear its mark
  int num_parted = 0;                         // classes of landmarks from before
  Joined joined;
  Joined joined_meanwhile;  // in the walk beside it that was never lied to
};

// Looks on while one is lied to and another, who sees the same, is not.
class Witness {
 public:
  Witness(const pipeline::Config& config, const Liar& liar, core::Truth truth);

  // Each version of the map of either, the believer's first.
  void see_believer(const scene::MapVersion& map);
  void see_honest(const scene::MapVersion& map) { honest_ = map; }

  const Aftermath& aftermath() const { return aftermath_; }
  // Since before the lie, in a map that came after it.
  Joined joined_in(const scene::MapVersion& map) const;

 private:
  void look_at_believed();
  void look_at_withdrawal();

  pipeline::Config config_;
  const Liar& liar_;
  core::Truth truth_;
  scene::MapVersion believed_;  // the last with the lie
  scene::MapVersion honest_;    // the last
  Aftermath aftermath_;
};

}  // namespace samewhere::bench
