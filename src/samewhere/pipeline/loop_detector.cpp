#include <algorithm>
#include <iterator>
#include <utility>

#include <samewhere/pipeline/loop_detector.hpp>
#include <samewhere/pipeline/verifier_settings.hpp>

namespace samewhere::pipeline {

LoopDetector::LoopDetector(const Config& config, const verify::VerifierSettings& settings)
    : settings_(settings),
      window_frames_(static_cast<std::uint64_t>(config.retrieve.window_frames)),
      index_(config),
      verifier_(settings),
      relocalization_verifier_(relocalization_settings(config)),
      sequences_(settings.measure, window_frames_),
      neighbours_(window_frames_),
      waiting_(verifier_) {}

std::vector<core::LedgerRow> LoopDetector::detect(const cv::Mat& image, const features::View& view,
                                                  const verify::MapContext& map,
                                                  core::Timings& timings) {
  core::Descriptor descriptor;
  {
    const core::ScopedTimer timer(timings, "describe");
    descriptor = index_.describe(view.frame, image);
  }
  std::vector<core::Candidate> candidates;
  {
    const core::ScopedTimer timer(timings, "retrieve");
    candidates = index_.retrieve(descriptor, view, map);
  }
  const core::ScopedTimer timer(timings, "verify");
  return verify(descriptor, candidates, view, map);
}

std::vector<core::LedgerRow> LoopDetector::relocalize(const cv::Mat& image,
                                                      const features::View& view,
                                                      core::Timings& timings) {
  const core::ScopedTimer timer(timings, "relocalize");
  const core::Descriptor descriptor = index_.describe(view.frame, image);
  std::vector<core::LedgerRow> rows;
  for (core::Candidate candidate : index_.retrieve_places(descriptor, view)) {
    candidate.id = next_id(view);
    const core::Evidence evidence = relocalization_verifier_.measure(
        candidate, view, views_.at(candidate.match), verify::WithoutMap(), history_);
    rows.push_back({candidate, relocalization_verifier_.decide(candidate, evidence, history_)});
  }
  return rows;
}

void LoopDetector::remember(const core::Descriptor& descriptor, const features::View& view) {
  index_.remember(descriptor, view);
  views_.emplace(view.frame, view);
}

std::vector<core::LedgerRow> LoopDetector::ask_again(const verify::MapContext& map,
                                                     core::Timings& timings) {
  const core::ScopedTimer timer(timings, "verify");
  auto decided = waiting_.ask_again(map, waiting_.size());
  for (const core::LedgerRow& row : decided) record(row);
  return decided;
}

void LoopDetector::forget() {
  index_.forget();
  sequences_ = verify::SequenceVerifier(settings_.measure, window_frames_);
  neighbours_ = verify::Neighbours(window_frames_);
  waiting_ = verify::WaitingCandidates(verifier_);
  views_.clear();
}

std::vector<core::LedgerRow> LoopDetector::verify(const core::Descriptor& descriptor,
                                                  const std::vector<core::Candidate>& candidates,
                                                  const features::View& view,
                                                  const verify::MapContext& map) {
  views_.emplace(view.frame, view);
  sequences_.add(view, descriptor);
  std::vector<core::LedgerRow> rows;
  for (const core::Candidate& candidate : candidates)
    rows.push_back(verify_candidate(candidate, view, map));
  verifier_.compare_candidates_of_one_query(map, history_, rows);
  verify_neighbours(descriptor, view, map, rows);
  for (const core::Candidate& candidate : sequences_.predict(descriptor))
    rows.push_back(verify_candidate(candidate, views_.at(candidate.query), map));
  auto settled = sequences_.settle(view.frame);
  for (const core::LedgerRow& row : settled) record(row);
  auto decided = waiting_.ask_again(map, verifier_.config().asked_again_per_keyframe);
  for (const core::LedgerRow& row : decided) record(row);
  waiting_.add(rows);
  std::move(settled.begin(), settled.end(), std::back_inserter(rows));
  std::move(decided.begin(), decided.end(), std::back_inserter(rows));
  return rows;
}

core::LedgerRow LoopDetector::verify_candidate(core::Candidate candidate,
                                               const features::View& view,
                                               const verify::MapContext& map) {
  candidate.id = next_id(view);
  core::Evidence evidence =
      verifier_.measure(candidate, view, views_.at(candidate.match), map, history_);
  sequences_.number(candidate, evidence);
  core::LedgerRow row{candidate, verifier_.decide(candidate, evidence, history_)};
  record(row);
  return row;
}

void LoopDetector::verify_neighbours(const core::Descriptor& descriptor, const features::View& view,
                                     const verify::MapContext& map,
                                     std::vector<core::LedgerRow>& rows) {
  const verify::Config& config = verifier_.config();
  if (config.neighbour_frames == 0) return;
  neighbours_.add(descriptor);
  const core::LedgerRow* found = verify::best_of_query(rows, config);
  if (found == nullptr) return;
  core::LedgerRow best = *found;
  const auto& geometry = core::evidence_of(best.verdict).geometry;
  if (!geometry || geometry->num_inliers < config.min_matches) return;
  const auto shows_more = [&](int offset_frames) {
    const auto candidate = neighbours_.at(best.candidate, offset_frames);
    if (!candidate) return false;
    rows.push_back(verify_candidate(*candidate, view, map));
    const std::vector<core::LedgerRow> both = {best, rows.back()};
    const bool is_better = verify::best_of_query(both, config) == &both.back();
    if (is_better) best = both.back();
    return is_better;
  };
  for (int step = config.neighbour_frames; step > 0;) {
    if (!shows_more(-step) && !shows_more(step)) step /= 2;
  }
}

void LoopDetector::record(const core::LedgerRow& row) {
  if (core::is_loop(row.verdict))
    history_.last_loop_query =
        std::max(history_.last_loop_query, std::optional(row.candidate.query));
  if (verifier_.config().neighbour_frames > 0) neighbours_.record(row.candidate);
  sequences_.record(row);
}

core::CandidateId LoopDetector::next_id(const features::View& view) {
  return core::CandidateId(num_candidates_++, view.frame.session());
}

}  // namespace samewhere::pipeline
