#include <samewhere/pipeline/loop_detector.hpp>

namespace samewhere::pipeline {

LoopDetector::LoopDetector(const Config& config)
    : describer_(describe::make_describer(config.describe)),
      retriever_(config.retrieve, static_cast<std::uint64_t>(config.seed)),
      settings_{config.verify, config.features, config.optimize,
                static_cast<std::uint64_t>(config.seed)} {}

std::vector<core::LedgerRow> LoopDetector::look(const cv::Mat& image, const features::View& view,
                                                const MapKnowledge& map,
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
  return judge(candidates, view, map);
}

std::vector<core::LedgerRow> LoopDetector::recognise(const cv::Mat& image,
                                                     const features::View& view,
                                                     core::Timings& timings) {
  const core::ScopedTimer timer(timings, "recognise");
  const core::Descriptor descriptor = describe(view.frame, image);
  constexpr int kNoWindow = 0;
  const MapKnowledge nothing{
      [](const core::Candidate&, const core::Sim3&) { return std::nullopt; }};
  std::vector<core::LedgerRow> rows;
  for (const auto& candidate :
       retrieve::compare(descriptor, retriever_.search(descriptor, kNoWindow)))
    rows.push_back(judged(candidate, view, nothing));
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
                                                 const MapKnowledge& map) {
  std::vector<core::LedgerRow> rows;
  for (const core::Candidate& candidate : candidates) {
    rows.push_back(judged(candidate, view, map));
    if (core::is_loop(rows.back().verdict)) history_.last_loop_query = view.frame;
  }
  views_.emplace(view.frame, view);
  return rows;
}

core::LedgerRow LoopDetector::judged(core::Candidate candidate, const features::View& view,
                                     const MapKnowledge& map) {
  candidate.id = core::CandidateId(num_candidates_++, view.frame.session());
  return {candidate, verdict_on(candidate, view, map)};
}

core::Verdict LoopDetector::verdict_on(const core::Candidate& candidate, const features::View& view,
                                       const MapKnowledge& map) const {
  core::Evidence evidence{.similarity = candidate.similarity};
  if (auto refused = verify::refuse_early(candidate, evidence, history_, settings_.verify))
    return *refused;
  evidence.geometry = measure_geometry(candidate, view, map.view_of);
  if (evidence.geometry->match_from_query)
    evidence.odometry = map.measure_odometry(candidate, *evidence.geometry->match_from_query);
  return verify::decide(candidate, evidence, history_, settings_.verify);
}

core::GeometryEvidence LoopDetector::measure_geometry(const core::Candidate& candidate,
                                                      const features::View& view,
                                                      const ViewOf& view_of) const {
  if (!view_of)
    return verify::measure_geometry(candidate, view, views_.at(candidate.match), settings_);
  verify::MeasureSettings settings = settings_;
  settings.has_one_scale = false;
  return verify::measure_geometry(candidate, view_of(candidate.query), view_of(candidate.match),
                                  settings);
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
