#include <algorithm>
#include <iterator>
#include <utility>

#include <samewhere/core/similarity.hpp>
#include <samewhere/pipeline/loop_detector.hpp>

namespace samewhere::pipeline {
namespace {

// None of a view whose features nobody extracted.
cv::Mat orb_of(const features::View& view) {
  return view.features ? view.features->descriptors : cv::Mat();
}

verify::MeasureSettings settings_of(const Config& config) {
  return {config.verify, config.features, config.optimize, static_cast<std::uint64_t>(config.seed)};
}

// How a view is judged whose place nobody knows.
verify::MeasureSettings settings_of_lost(const Config& config, bool is_without_depth) {
  verify::MeasureSettings settings = settings_of(config);
  settings.features = features_of_lost(config, is_without_depth);
  settings.verify.min_views = 1;
  // what was refused early is no place
  settings.verify.measure_all = false;
  // whoever tracks the view among the place's points finds it
  settings.verify.require_pose = false;
  return settings;
}

}  // namespace

LoopDetector::LoopDetector(const Config& config)
    : describer_(describe::make_describer(config.describe)),
      retrieve_(config.retrieve),
      retriever_(config.retrieve, static_cast<std::uint64_t>(config.seed)),
      settings_(settings_of(config)),
      lost_settings_(settings_of_lost(config, false)),
      lost_settings_without_depth_(settings_of_lost(config, true)),
      waiting_(config.verify),
      numbered_(config.features, config.verify.same_view_ratio),
      window_frames_(static_cast<std::uint64_t>(config.retrieve.window_frames)) {}

std::vector<core::LedgerRow> LoopDetector::look(const cv::Mat& image, const features::View& view,
                                                const MapKnowledge& map, core::Timings& timings) {
  core::Descriptor descriptor;
  {
    const core::ScopedTimer timer(timings, "describe");
    descriptor = describe(view.frame, image);
  }
  std::vector<core::Candidate> candidates;
  {
    const core::ScopedTimer timer(timings, "retrieve");
    candidates = candidates_for(descriptor, view, map);
  }
  const core::ScopedTimer timer(timings, "verify");
  return judge(descriptor, candidates, view, map);
}

namespace {

// Of candidates, most similar first, so many of different places, each with so many of its views:
// those found by looks, and so many more found by their features.
std::vector<core::Candidate> best_of_places(const std::vector<core::Candidate>& candidates,
                                            const AreOnePlace& are_one_place,
                                            const retrieve::Config& config) {
  std::vector<core::Candidate> firsts;  // of each place
  std::vector<int> num_views;
  std::vector<core::Candidate> best;
  int num_by_looks = config.num_candidates;
  int num_by_features = config.word_candidates;
  for (const core::Candidate& next : candidates) {
    const auto place = std::ranges::find_if(firsts, [&](const core::Candidate& first) {
      return are_one_place(first.match, next.match);
    });
    const auto index = static_cast<std::size_t>(place - firsts.begin());
    if (place == firsts.end()) {
      int& num_left = next.is_by_features ? num_by_features : num_by_looks;
      if (num_left == 0) continue;
      --num_left;
      firsts.push_back(next);
      num_views.push_back(0);
    }
    if (num_views[index]++ < config.views_per_place) best.push_back(next);
  }
  return best;
}

}  // namespace

std::vector<core::Candidate> LoopDetector::candidates_for(const core::Descriptor& descriptor,
                                                          const features::View& view,
                                                          const MapKnowledge& map) {
  const bool has_places = map.are_one_place && retrieve_.shortlist > 0;
  auto candidates =
      retrieve::compare(descriptor, has_places ? retriever_.shortlist(descriptor, orb_of(view))
                                               : retriever_.search(descriptor, orb_of(view)));
  retriever_.add(descriptor, orb_of(view));
  if (map.is_connected)
    std::erase_if(candidates, [&](const core::Candidate& c) { return map.is_connected(c.match); });
  return has_places ? best_of_places(candidates, map.are_one_place, retrieve_) : candidates;
}

std::vector<core::LedgerRow> LoopDetector::recognise(const cv::Mat& image,
                                                     const features::View& view,
                                                     core::Timings& timings) {
  const core::ScopedTimer timer(timings, "recognise");
  const core::Descriptor descriptor = describe(view.frame, image);
  const MapKnowledge nothing{
      [](const core::Candidate&, const core::Sim3&) { return std::nullopt; }};
  const auto& settings = has_depth(view) ? lost_settings_ : lost_settings_without_depth_;
  std::vector<core::LedgerRow> rows;
  for (core::Candidate candidate :
       retrieve::compare(descriptor, retriever_.search_places(descriptor, orb_of(view)))) {
    candidate.is_lost = true;
    rows.push_back(judged(candidate, view, nothing, settings));
  }
  return rows;
}

void LoopDetector::remember(const core::Descriptor& descriptor, const features::View& view) {
  retriever_.add(descriptor, orb_of(view));
  views_.emplace(view.frame, view);
}

core::Descriptor LoopDetector::describe(core::FrameId frame, const cv::Mat& image) {
  return describer_->describe(frame, image);
}

std::vector<retrieve::FoundView> LoopDetector::search(const core::Descriptor& descriptor,
                                                      const features::View& view) {
  std::vector<retrieve::FoundView> found = retriever_.search(descriptor, orb_of(view));
  retriever_.add(descriptor, orb_of(view));
  return found;
}

std::vector<core::LedgerRow> LoopDetector::judge(const core::Descriptor& descriptor,
                                                 const std::vector<core::Candidate>& candidates,
                                                 const features::View& view,
                                                 const MapKnowledge& map) {
  views_.emplace(view.frame, view);
  const bool may_wait = may_need_sequences(settings_.verify);
  if (may_wait) numbered_.add(view, descriptor);
  std::vector<core::LedgerRow> rows;
  for (const core::Candidate& candidate : candidates) {
    rows.push_back(judged(candidate, view, map, settings_));
    wait_or_pause(rows.back());
  }
  if (map.measure_other_place) hold_against_each_other(map, rows);
  look_around(descriptor, view, map, rows);
  if (!may_wait) return rows;
  for (const core::Candidate& candidate : foretold(descriptor)) {
    rows.push_back(judged(candidate, views_.at(candidate.query), map, settings_));
    wait_or_pause(rows.back());
  }
  auto settled = waiting_.settle(numbered_.number_of(view.frame));
  for (const core::LedgerRow& row : settled) wait_or_pause(row);
  std::move(settled.begin(), settled.end(), std::back_inserter(rows));
  return rows;
}

void LoopDetector::look_around(const core::Descriptor& descriptor, const features::View& view,
                               const MapKnowledge& map, std::vector<core::LedgerRow>& rows) {
  const verify::Config& config = settings_.verify;
  if (config.neighbour_frames == 0) return;
  units_.emplace(descriptor.frame, descriptor.unit);
  const core::LedgerRow* found = best_of_query(rows, config);
  if (found == nullptr) return;
  core::LedgerRow best = *found;
  const auto& geometry = core::evidence_of(best.verdict).geometry;
  if (!geometry || geometry->num_inliers < config.min_matches) return;
  const auto shows_more = [&](int frames) {
    const auto candidate = beside(best.candidate, frames, descriptor);
    if (!candidate) return false;
    rows.push_back(judged(*candidate, view, map, settings_));
    wait_or_pause(rows.back());
    const std::vector<core::LedgerRow> both = {best, rows.back()};
    const bool is_better = best_of_query(both, config) == &both.back();
    if (is_better) best = both.back();
    return is_better;
  };
  for (int step = config.neighbour_frames; step > 0;) {
    if (!shows_more(-step) && !shows_more(step)) step /= 2;
  }
}

std::optional<core::Candidate> LoopDetector::beside(const core::Candidate& candidate, int frames,
                                                    const core::Descriptor& descriptor) const {
  const auto there = static_cast<std::int64_t>(candidate.match.index()) + frames;
  const auto newest = static_cast<std::int64_t>(candidate.query.index()) -
                      static_cast<std::int64_t>(window_frames_);
  if (there < 0 || there >= newest) return std::nullopt;
  const core::FrameId match(static_cast<std::uint64_t>(there), candidate.match.session());
  const auto unit = units_.find(match);
  if (unit == units_.end() || was_judged_.contains({candidate.query, match})) return std::nullopt;
  return core::Candidate{.query = candidate.query,
                         .match = match,
                         .similarity = core::ncc(descriptor.unit, unit->second),
                         .is_foretold = true};
}

namespace {

// Of the other loops among the claims the one at another place that most agrees with.
std::optional<core::OtherPlaceEvidence> other_place_of(const core::LedgerRow& row,
                                                       const std::vector<core::LedgerRow>& claims,
                                                       const MeasureOtherPlace& measure) {
  std::optional<core::OtherPlaceEvidence> best;
  for (const core::LedgerRow& other : claims) {
    if (!core::is_loop(other.verdict) || other.candidate.id == row.candidate.id) continue;
    auto found = measure(row, other);
    if (!found) continue;
    found->num_inliers = core::evidence_of(other.verdict).geometry->num_inliers;
    if (!best || found->num_inliers > best->num_inliers) best = found;
  }
  return best;
}

}  // namespace

void LoopDetector::hold_against_each_other(const MapKnowledge& map,
                                           std::vector<core::LedgerRow>& rows) const {
  const std::vector<core::LedgerRow> claims = rows;  // each as it is for itself
  for (core::LedgerRow& row : rows) {
    if (!core::is_loop(row.verdict)) continue;
    core::Evidence evidence = core::evidence_of(row.verdict);
    evidence.other_place = other_place_of(row, claims, map.measure_other_place);
    if (evidence.other_place)
      row.verdict = verify::decide(row.candidate, evidence, history_, settings_.verify);
  }
}

void LoopDetector::wait_or_pause(const core::LedgerRow& row) {
  const core::Candidate& candidate = row.candidate;
  if (may_need_sequences(settings_.verify) || settings_.verify.neighbour_frames > 0)
    was_judged_.insert({candidate.query, candidate.match});
  if (core::is_loop(row.verdict))
    history_.last_loop_query = std::max(history_.last_loop_query, std::optional(candidate.query));
  const auto* ambiguous = std::get_if<core::Ambiguous>(&row.verdict);
  if (ambiguous != nullptr && ambiguous->stage == core::Refusal::kSequence)
    waiting_.add(row.candidate, ambiguous->evidence);
}

std::vector<core::Candidate> LoopDetector::foretold(const core::Descriptor& descriptor) {
  const int now = numbered_.number_of(descriptor.frame);
  std::vector<core::Candidate> candidates;
  for (const verify::ViewPair& views : waiting_.foretold(now)) {
    const auto* match = numbered_.at(views.match);
    const auto* query = views.query == now ? &descriptor : numbered_.at(views.query);
    if (query == nullptr || match == nullptr) continue;
    const bool is_recent = query->frame.index() <= match->frame.index() + window_frames_;
    if (is_recent || was_judged_.contains({query->frame, match->frame})) continue;
    candidates.push_back({.query = query->frame,
                          .match = match->frame,
                          .similarity = core::ncc(query->unit, match->unit),
                          .is_foretold = true});
  }
  return candidates;
}

core::LedgerRow LoopDetector::judged(core::Candidate candidate, const features::View& view,
                                     const MapKnowledge& map,
                                     const verify::MeasureSettings& settings) {
  candidate.id = core::CandidateId(num_candidates_++, view.frame.session());
  return {candidate, verdict_on(candidate, view, map, settings)};
}

core::Verdict LoopDetector::verdict_on(const core::Candidate& candidate, const features::View& view,
                                       const MapKnowledge& map,
                                       const verify::MeasureSettings& settings) const {
  const verify::Config& config = settings.verify;
  core::Evidence evidence{.similarity = candidate.similarity};
  auto refused = verify::refuse_early(candidate, evidence, history_, config);
  if (refused && !config.measure_all) return *refused;
  evidence.geometry = measure_geometry(candidate, view, map.view_of, settings);
  if (needs_sequence(*evidence.geometry, config))
    evidence.sequence = {.query_view = numbered_.number_of(candidate.query),
                         .match_view = numbered_.number_of(candidate.match)};
  if (evidence.geometry->match_from_query)
    evidence.odometry = map.measure_odometry(candidate, *evidence.geometry->match_from_query);
  if (evidence.odometry && map.measure_rival)
    evidence.rival = map.measure_rival(candidate, *evidence.geometry->match_from_query);
  return verify::decide(candidate, evidence, history_, config);
}

core::GeometryEvidence LoopDetector::measure_geometry(const core::Candidate& candidate,
                                                      const features::View& view,
                                                      const ViewOf& view_of,
                                                      verify::MeasureSettings settings) const {
  if (!view_of)
    return verify::measure_geometry(candidate, view, views_.at(candidate.match), settings);
  settings.has_one_scale = false;
  return verify::measure_geometry(candidate, view_of(candidate.query), view_of(candidate.match),
                                  settings);
}

namespace {

// What was measured for a replay alone says nothing of who is the best.
core::Evidence judged_by(const core::Verdict& verdict) {
  core::Evidence evidence = core::evidence_of(verdict);
  const auto* refused = std::get_if<core::Rejection>(&verdict);
  if (refused != nullptr &&
      (refused->stage == core::Refusal::kSimilarity || refused->stage == core::Refusal::kPause))
    evidence.geometry.reset();
  return evidence;
}

}  // namespace

const core::LedgerRow* best_of_query(const std::vector<core::LedgerRow>& rows,
                                     const verify::Config& config) {
  const auto rank = [&](const core::LedgerRow& row) {
    return std::pair(core::is_loop(row.verdict), verify::rank(judged_by(row.verdict), config));
  };
  const core::LedgerRow* best = nullptr;
  for (const auto& row : rows) {
    if (best == nullptr || rank(row) > rank(*best)) best = &row;
  }
  return best;
}

}  // namespace samewhere::pipeline
