#include <cmath>
#include <memory>
#include <utility>

#include <samewhere/core/match_from_query.hpp>
#include <samewhere/pipeline/loop_closing.hpp>
#include <samewhere/report/jpeg.hpp>
#include <samewhere/scene/known_depths.hpp>
#include <samewhere/verify/measure_odometry.hpp>
#include <samewhere/verify/measure_rival.hpp>

namespace samewhere::pipeline {
namespace {

// Itself and those that share enough landmarks with it.
std::set<core::KeyframeId> neighbours_of(const scene::MapVersion& map, core::KeyframeId keyframe,
                                         int min_shared) {
  std::set<core::KeyframeId> neighbours = {keyframe};
  for (const auto& covisible : covisible_keyframes(map, keyframe)) {
    if (covisible.num_shared >= min_shared) neighbours.insert(covisible.keyframe);
  }
  return neighbours;
}

verify::ScaleErrors scale_errors(const Config& config) {
  return {.creep = config.optimize.odometry_scale_sigma, .loop = config.optimize.loop_scale_sigma};
}

// The keyframes that frames are, as a version of the map has them.
class Places {
 public:
  Places(const scene::MapVersion& map, const KeyframeOf& keyframe_of)
      : map_(map), keyframe_of_(keyframe_of), is_without_depth_(scene::is_without_depth(map)) {}

  // For the view that is looked at.
  MapKnowledge knowledge(core::FrameId query, const Config& config) const {
    MapKnowledge knowledge;
    const verify::ScaleErrors scale = scale_errors(config);
    knowledge.measure_odometry = [=, this, &config](const core::Candidate& candidate,
                                                    const core::Sim3& match_from_query) {
      return std::optional(verify::measure_odometry(map_, claim_of(candidate, match_from_query),
                                                    scale, config.verify));
    };
    knowledge.measure_rival = [=, this, &config](const core::Candidate& candidate,
                                                 const core::Sim3& match_from_query) {
      return verify::measure_rival(map_, claim_of(candidate, match_from_query), scale,
                                   config.verify);
    };
    knowledge.measure_other_place = [=, this, &config](const core::LedgerRow& row,
                                                       const core::LedgerRow& other) {
      return other_place(row, other, scale, config);
    };
    knowledge.is_connected = [this, neighbours = neighbours(query, config)](core::FrameId match) {
      return neighbours.contains(holder(match));
    };
    knowledge.are_one_place = one_place(config);
    if (is_without_depth_)
      knowledge.view_of = [this](core::FrameId frame) {
        return with_known_depths(map_, at(frame));
      };
    return knowledge;
  }

  AcceptedLoop accepted(const core::LedgerRow& row, const core::LoopClosure& loop) const {
    const scene::LoopEdge edge = edge_of(row, loop);
    return {.edge = edge,
            .overruled = loop.overruled,
            .query_log_scale = map_.at(edge.query).log_scale,
            .match_log_scale = map_.at(edge.match).log_scale};
  }

 private:
  core::KeyframeId holder(core::FrameId frame) const {
    return holder_of(map_, keyframe_of_.at(frame)).keyframe;
  }

  std::set<core::KeyframeId> neighbours(core::FrameId frame, const Config& config) const {
    return neighbours_of(map_, holder(frame), config.map.min_shared);
  }

  // Keyframes that share landmarks show one place. Those of one view are looked up once.
  AreOnePlace one_place(const Config& config) const {
    auto known = std::make_shared<std::map<core::FrameId, std::set<core::KeyframeId>>>();
    return [this, &config, known](core::FrameId a, core::FrameId b) {
      auto found = known->find(a);
      if (found == known->end()) found = known->emplace(a, neighbours(a, config)).first;
      return found->second.contains(holder(b));
    };
  }

  scene::LoopEdge edge_of(const core::LedgerRow& row, const core::LoopClosure& loop) const {
    return {
        at(row.candidate.query), at(row.candidate.match), rigid_part(*loop.match_from_query),
        loop.information,        loop.candidate,          std::log(loop.match_from_query->scale)};
  }

  // Keyframes that share landmarks show one place, whatever odometry says.
  std::optional<core::OtherPlaceEvidence> other_place(const core::LedgerRow& row,
                                                      const core::LedgerRow& other,
                                                      const verify::ScaleErrors& scale,
                                                      const Config& config) const {
    const auto pose = core::match_from_query_of(row.verdict);
    const auto other_pose = core::match_from_query_of(other.verdict);
    if (!pose || !other_pose) return std::nullopt;
    if (one_place(config)(row.candidate.match, other.candidate.match)) return std::nullopt;
    return verify::measure_other_place(map_, claim_of(row.candidate, *pose),
                                       claim_of(other.candidate, *other_pose), scale,
                                       config.verify);
  }

  scene::LoopEdge claim_of(const core::Candidate& candidate,
                           const core::Sim3& match_from_query) const {
    scene::LoopEdge claim;
    claim.query = at(candidate.query);
    claim.match = at(candidate.match);
    claim.match_from_query = rigid_part(match_from_query);
    claim.log_scale = std::log(match_from_query.scale);
    return claim;
  }

  // Without depth, a culled keyframe knows nothing of how far away things are; what it hangs on
  // does.
  core::KeyframeId at(core::FrameId frame) const {
    const core::KeyframeId id = keyframe_of_.at(frame);
    return is_without_depth_ ? holder_of(map_, id).keyframe : id;
  }

  const scene::MapVersion& map_;
  const KeyframeOf& keyframe_of_;
  bool is_without_depth_;
};

// With a map every view is judged by itself, whatever recognition alone would wait for.
Config judging_each_view(Config config) {
  config.verify.min_views = 1;
  return config;
}

}  // namespace

core::Verdict verdict_on(const scene::MapVersion& map, const scene::LoopEdge& loop,
                         const core::LedgerRow& accepted, const Config& config) {
  core::Evidence evidence = core::evidence_of(accepted.verdict);
  evidence.rival = verify::measure_rival(map, loop, scale_errors(config), config.verify);
  return verify::decide(accepted.candidate, evidence, {}, config.verify);
}

LoopClosing::LoopClosing(const Config& config)
    : config_(config), detector_(judging_each_view(config)) {}

LoopClosing::LoopClosing(const Config& config, const scene::StoredMap& known)
    : LoopClosing(config) {
  for (std::size_t i = 0; i < known.map.keyframes.size(); ++i)
    keyframe_of_[known.map.keyframes[i].view.frame] = known.map.keyframes[i].id;
  for (const auto& descriptor : known.extras.descriptors) {
    const auto keyframe = keyframe_of_.find(descriptor.frame);
    if (keyframe != keyframe_of_.end())
      detector_.remember(descriptor, known.map.at(keyframe->second).view);
  }
}

LoopAnswer LoopClosing::answer(const ToLoopClosing& message) {
  LoopAnswer answer =
      std::visit([this](const auto& question) { return this->answer(question); }, message);
  ledger_.insert(ledger_.end(), answer.rows.begin(), answer.rows.end());
  return answer;
}

LoopAnswer LoopClosing::answer(const FindLoops& question) {
  if (question.image.empty()) return {};
  const scene::MapVersion& map = question.map;
  const features::View& view = map.at(question.keyframe).view;
  keyframe_of_[view.frame] = question.keyframe;
  LoopAnswer answer{.map_number = map.number};
  {
    const core::ScopedTimer timer(timings_, "thumbnail");
    answer.thumbnail = {view.frame, report::jpeg_bytes(question.image, report::kThumbnailWidth_px)};
  }
  if (!config_.close_loops) {  // who is lost is found all the same
    answer.descriptor = detector_.describe(view.frame, question.image);
    detector_.remember(*answer.descriptor, view);
    return answer;
  }
  const Places places(map, keyframe_of_);
  answer.rows =
      detector_.look(question.image, view, places.knowledge(view.frame, config_), timings_);
  for (const auto& row : answer.rows) {
    const auto* loop = std::get_if<core::LoopClosure>(&row.verdict);
    if (loop != nullptr && loop->match_from_query)
      answer.loops.push_back(places.accepted(row, *loop));
  }
  answer.descriptor = detector_.descriptor(detector_.num_descriptors() - 1);
  return answer;
}

LoopAnswer LoopClosing::answer(const FindPlace& question) {
  LoopAnswer answer;
  answer.rows = detector_.recognise(question.image, question.view, timings_);
  for (const core::LedgerRow& row : answer.rows) {
    const auto& geometry = core::evidence_of(row.verdict).geometry;
    if (!geometry || geometry->num_inliers == 0) continue;
    Place place{.keyframe = keyframe_of_.at(row.candidate.match),
                .keyframe_from_body = std::nullopt,
                .is_recognised = core::is_loop(row.verdict)};
    if (geometry->match_from_query)
      place.keyframe_from_body = rigid_part(*geometry->match_from_query);
    answer.places.push_back(place);
  }
  return answer;
}

}  // namespace samewhere::pipeline
