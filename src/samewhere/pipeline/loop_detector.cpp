#include <samewhere/pipeline/loop_detector.hpp>

namespace samewhere::pipeline {

LoopDetector::LoopDetector(const Config& config)
    : describer_(describe::make_describer(config.describe)),
      retriever_(config.retrieve, static_cast<std::uint64_t>(config.seed)),
      settings_{config.verify, config.features, config.optimize,
                static_cast<std::uint64_t>(config.seed)} {}

std::vector<core::LedgerRow> LoopDetector::look(const cv::Mat& image, const features::View& view,
                                                const MeasureOdometry& measure_odometry,
                                                const IsConnected& is_connected,
                                                core::Timings& timings) {
  core::Descriptor descriptor;
  {
    const core::ScopedTimer timer(timings, "describe");
    descriptor = describe(view.frame, image);
  }
  std::vector<core::Candidate> candidates;
  {
    const core::ScopedTimer timer(timings, "retrieve");
    candidates = retrieve::compare(descriptor, search(descriptor));
  }
  std::erase_if(candidates, [&](const core::Candidate& c) { return is_connected(c.match); });
  const core::ScopedTimer timer(timings, "verify");
  return judge(candidates, view, measure_odometry);
}

std::vector<core::LedgerRow> LoopDetector::recognise(const cv::Mat& image,
                                                     const features::View& view,
                                                     core::Timings& timings) {
  const core::ScopedTimer timer(timings, "recognise");
  const core::Descriptor descriptor = describe(view.frame, image);
  constexpr int kNoWindow = 0;
  const auto no_odometry = [](const core::Candidate&, const core::Sim3&) { return std::nullopt; };
  std::vector<core::LedgerRow> rows;
  for (const auto& candidate :
       retrieve::compare(descriptor, retriever_.search(descriptor, kNoWindow)))
    rows.push_back(judged(candidate, view, no_odometry));
  return rows;
}

void LoopDetector::remember(const core::Descriptor& descriptor, const features::View& view) {
  retriever_.add(descriptor);
  views_.emplace(view.frame, view);
}

core::Descriptor LoopDetector::describe(core::FrameId frame, const cv::Mat& image) {
  return describer_->describe(frame, image);
}

std::vector<retrieve::FoundView> LoopDetector::search(const core::Descriptor& descriptor) {
  std::vector<retrieve::FoundView> found = retriever_.search(descriptor);
  retriever_.add(descriptor);
  return found;
}

std::vector<core::LedgerRow> LoopDetector::judge(const std::vector<core::Candidate>& candidates,
                                                 const features::View& view,
                                                 const MeasureOdometry& measure_odometry) {
  std::vector<core::LedgerRow> rows;
  for (const core::Candidate& candidate : candidates) {
    rows.push_back(judged(candidate, view, measure_odometry));
    if (core::is_loop(rows.back().verdict)) history_.last_loop_query = view.frame;
  }
  views_.emplace(view.frame, view);
  return rows;
}

core::LedgerRow LoopDetector::judged(core::Candidate candidate, const features::View& view,
                                     const MeasureOdometry& measure_odometry) {
  candidate.id = core::CandidateId(num_candidates_++, view.frame.session());
  return {candidate, verdict_on(candidate, view, measure_odometry)};
}

core::Verdict LoopDetector::verdict_on(const core::Candidate& candidate, const features::View& view,
                                       const MeasureOdometry& measure_odometry) const {
  core::Evidence evidence{.similarity = candidate.similarity};
  if (auto refused = verify::refuse_early(candidate, evidence, history_, settings_.verify))
    return *refused;
  evidence.geometry =
      verify::measure_geometry(candidate, view, views_.at(candidate.match), settings_);
  if (evidence.geometry->match_from_query) {
    evidence.odometry = measure_odometry(candidate, *evidence.geometry->match_from_query);
  }
  return verify::decide(candidate, evidence, history_, settings_.verify);
}

const core::LedgerRow* best_of_query(const std::vector<core::LedgerRow>& rows,
                                     const verify::Config& config) {
  const auto rank = [&](const core::LedgerRow& row) {
    return std::pair(core::is_loop(row.verdict),
                     verify::score(core::evidence_of(row.verdict), config));
  };
  const core::LedgerRow* best = nullptr;
  for (const auto& row : rows) {
    if (best == nullptr || rank(row) > rank(*best)) best = &row;
  }
  return best;
}

}  // namespace samewhere::pipeline
