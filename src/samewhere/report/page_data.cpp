#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <map>
#include <optional>
#include <set>

#include <nlohmann/json.hpp>

#include <samewhere/report/funnel.hpp>
#include <samewhere/report/loops.hpp>
#include <samewhere/report/packed.hpp>
#include <samewhere/report/page_data.hpp>
#include <samewhere/report/page_parts.hpp>
#include <samewhere/report/page_points.hpp>
#include <samewhere/report/pairs.hpp>
#include <samewhere/report/upright.hpp>

namespace samewhere::report {
namespace {

using Json = nlohmann::ordered_json;

Json path_json(const core::Trajectory& trajectory, const PageClock& clock) {
  std::vector<std::uint32_t> stamps;
  std::vector<float> positions;
  for (const core::StampedPose& pose : trajectory) {
    if (!core::is_finite(pose.world_from_camera)) continue;
    stamps.push_back(clock.steps(pose.stamp_s));
    add_position(positions, pose.world_from_camera);
  }
  return {{"stamps_s", page_stamps(stamps)}, {"positions", packed(positions, 3)}};
}

std::vector<core::Rigid3> finite_poses(const RunRecord& record) {
  std::vector<core::Rigid3> poses;
  for (const FrameRecord& frame : record.frames)
    if (const auto pose = finite_pose(frame)) poses.push_back(*pose);
  return poses;
}

Json covariances_json(const std::vector<PositionCovariance>& covariances) {
  std::vector<std::uint32_t> frames;
  std::vector<float> matrices;
  for (const PositionCovariance& covariance : covariances) {
    if (!covariance.in_world_m2.allFinite()) continue;
    frames.push_back(static_cast<std::uint32_t>(covariance.frame.index()));
    for (int row = 0; row < 3; ++row)
      for (int column = row; column < 3; ++column)
        matrices.push_back(static_cast<float>(covariance.in_world_m2(row, column)));
  }
  return {{"frames", packed(frames)}, {"matrices", packed(matrices, 6)}};
}

// Each match is 4 shares of 65535 and whether it is an inlier.
Json matches_json(const std::vector<ImageMatch>& matches) {
  std::vector<std::uint16_t> shares;
  std::vector<std::uint8_t> are_inliers;
  for (const ImageMatch& match : matches) {
    for (const float share :
         {match.in_query.x(), match.in_query.y(), match.in_match.x(), match.in_match.y()})
      shares.push_back(
          static_cast<std::uint16_t>(std::lround(65535.0F * std::clamp(share, 0.0F, 1.0F))));
    are_inliers.push_back(match.is_inlier ? 1 : 0);
  }
  return {{"shares", packed(shares, 4)}, {"are_inliers", packed(are_inliers)}};
}

// Accepted loops first, then the others, most inliers first.
std::vector<const core::LedgerRow*> rows_by_worth(const core::Ledger& ledger) {
  std::vector<const core::LedgerRow*> rows = accepted_rows(ledger);
  const std::vector<const core::LedgerRow*> others = rejected_rows(ledger);
  rows.insert(rows.end(), others.begin(), others.end());
  return rows;
}

// The verdicts before the last one, in words.
std::map<core::CandidateId, Json> earlier_verdicts(const core::Ledger& ledger) {
  std::map<core::CandidateId, Json> earlier;
  std::map<core::CandidateId, const core::LedgerRow*> last;
  for (const core::LedgerRow& row : ledger) {
    const core::LedgerRow*& before = last[row.candidate.id];
    if (before != nullptr)
      earlier[row.candidate.id].push_back({{"verdict", core::name_of(before->verdict)},
                                           {"stage", core::stage_of(before->verdict)},
                                           {"reason", core::reason_of(before->verdict)}});
    before = &row;
  }
  return earlier;
}

Json candidates_json(const RunRecord& record) {
  std::vector<const core::LedgerRow*> rows = rows_by_worth(record.ledger);
  if (rows.size() > kMaxPageCandidates) rows.resize(kMaxPageCandidates);
  std::sort(rows.begin(), rows.end(), [](const core::LedgerRow* a, const core::LedgerRow* b) {
    return a->candidate.id < b->candidate.id;
  });
  const std::map<core::CandidateId, Json> earlier = earlier_verdicts(record.ledger);
  Json candidates = Json::array();
  for (const core::LedgerRow* row : rows) {
    Json entry = page_candidate(*row);
    if (record.false_loops.contains(row->candidate.id)) entry["is_false"] = true;
    if (const auto found = earlier.find(row->candidate.id); found != earlier.end())
      entry["earlier"] = found->second;
    if (const auto found = record.matches.find(row->candidate.id); found != record.matches.end())
      entry["matches"] = matches_json(found->second);
    candidates.push_back(std::move(entry));
  }
  return candidates;
}

Json figures_json_of(const std::vector<Figure>& figures) {
  Json array = Json::array();
  for (const Figure& figure : figures)
    array.push_back({{"name", figure.name}, {"value", figure.value}});
  return array;
}

// Pictures until the budget is spent.
class Album {
 public:
  explicit Album(const RunRecord& record) : thumbnails_(record.thumbnails) {}

  // False when it does not fit.
  bool add(core::FrameId frame, std::size_t max_bytes) {
    const auto found = thumbnails_.find(frame);
    if (found == thumbnails_.end() || chosen_.contains(frame)) return true;
    if (num_bytes_ + found->second.size() > max_bytes) return false;
    num_bytes_ += found->second.size();
    chosen_.insert(frame);
    return true;
  }
  // The keyframes in between, every n-th that fits.
  void add_evenly(std::size_t max_bytes) {
    std::size_t num_left_bytes = 0;
    for (const auto& [frame, jpeg] : thumbnails_)
      if (!chosen_.contains(frame)) num_left_bytes += jpeg.size();
    if (num_left_bytes == 0 || num_bytes_ >= max_bytes) return;
    const std::size_t step = (num_left_bytes - 1) / (max_bytes - num_bytes_) + 1;
    std::size_t at = 0;
    for (const auto& [frame, jpeg] : thumbnails_)
      if (!chosen_.contains(frame) && at++ % step == 0) add(frame, max_bytes);
  }
  const std::set<core::FrameId>& chosen() const { return chosen_; }

 private:
  const std::map<core::FrameId, std::string>& thumbnails_;
  std::set<core::FrameId> chosen_;
  std::size_t num_bytes_ = 0;
};

}  // namespace

std::string page_run_json(const RunRecord& record) {
  const PageClock clock(record.frames.empty() ? 0.0 : record.frames.front().pose.stamp_s);
  Json run = {{"version", kPageVersion},
              {"title", record.title},
              {"source", record.source},
              {"is_interrupted", record.is_interrupted},
              {"is_scale_unknown", record.is_scale_unknown},
              {"figures", figures_json_of(record.figures)},
              {"status_names", page_status_names()},
              {"upright", page_upright(upright_of(finite_poses(record)))},
              {"frames", page_frames(record.frames, clock)},
              {"odometry", path_json(record.odometry, clock)},
              {"truth", path_json(record.truth, clock)},
              {"covariances", covariances_json(record.covariances)},
              {"points", page_points(record.points, kMaxPagePoints)},
              {"num_candidates", final_rows(record.ledger).size()},
              {"candidates", candidates_json(record)},
              {"checks", page_checks(record.ledger)},
              {"limits", page_limits(record.limits)},
              {"num_keyframe_pictures", record.thumbnails.size()},
              {"config_yaml", record.config_yaml}};
  if (record.input_error) run["input_error"] = *record.input_error;
  return json_for_script(run);
}

std::string page_pictures_json(const RunRecord& record) {
  Album album(record);
  // two thirds for the candidates
  constexpr std::size_t kForCandidates_bytes = kMaxPagePictures_bytes / 3 * 2;
  for (const core::LedgerRow* row : rows_by_worth(record.ledger)) {
    if (!album.add(row->candidate.query, kForCandidates_bytes) ||
        !album.add(row->candidate.match, kForCandidates_bytes))
      break;
  }
  album.add_evenly(kMaxPagePictures_bytes);
  Json pictures = Json::array();
  for (const core::FrameId frame : album.chosen())
    pictures.push_back({{"frame", frame.index()},
                        {"session", frame.session()},
                        {"jpeg_base64", base64(record.thumbnails.at(frame))}});
  return json_for_script(pictures);
}

std::string page_durations_json(const RunRecord& record) {
  const core::Timings& timings = record.timings;
  std::vector<float> frames_ms;
  Json stages = Json::array();
  for (const auto& [stage, durations_ms] : timings.durations_ms()) {
    if (stage == kWholeFrameStage) frames_ms.assign(durations_ms.begin(), durations_ms.end());
    const core::TimingSummary summary = core::summarize(durations_ms);
    stages.push_back({{"name", stage},
                      {"count", summary.count},
                      {"median_ms", summary.median_ms},
                      {"p95_ms", summary.p95_ms},
                      {"processor_ms", timings.processor_ms().at(stage)}});
  }
  std::vector<std::uint32_t> memory_frames;
  std::vector<float> memory_mib;
  for (const MemorySample& sample : record.memory) {
    memory_frames.push_back(static_cast<std::uint32_t>(sample.frame));
    memory_mib.push_back(static_cast<float>(sample.mib));
  }
  return json_for_script(
      {{"frames_ms", packed(frames_ms)},
       {"stages", std::move(stages)},
       {"memory", {{"frames", packed(memory_frames)}, {"mib", packed(memory_mib)}}}});
}

}  // namespace samewhere::report
