#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/evaluate/precision_recall.hpp>

namespace samewhere::evaluate {
namespace {

constexpr double kFullPrecision = 1.0 - 1e-12;

struct ScoredAnswer {
  double score;
  bool is_true;
};

bool is_recent(int query, int match, int window_frames) { return query - match <= window_frames; }

int count_queries_with_loop(const core::PlaceTruthMatrix& truth, int window_frames) {
  int count = 0;
  for (int query = 0; query < truth.num_frames; ++query) {
    const int num_allowed = std::clamp(query - window_frames, 0, truth.num_frames);
    const auto row = truth.values.begin() + static_cast<std::ptrdiff_t>(query) * truth.num_frames;
    if (std::find(row, row + num_allowed, core::PlaceTruth::kSame) != row + num_allowed) ++count;
  }
  return count;
}

// Throws InputError if the rows are not at most one finite score per query, inside the matrix.
void check_rows(const core::PlaceTruthMatrix& truth, const std::vector<Match>& matches) {
  std::vector<bool> is_answered(static_cast<std::size_t>(truth.num_frames), false);
  for (const Match& row : matches) {
    place_truth_of(truth, row.query, row.match);
    if (!std::isfinite(row.score))
      throw core::InputError(fmt::format("match {} of query {}: score {} is not a finite number",
                                         row.match, row.query, row.score));
    const auto query = static_cast<std::size_t>(row.query);
    if (is_answered[query])
      throw core::InputError(
          fmt::format("query {} has a second match, expected at most one", row.query));
    is_answered[query] = true;
  }
}

// Answers that count, surest first.
std::vector<ScoredAnswer> scored_answers(const core::PlaceTruthMatrix& truth,
                                         const std::vector<Match>& matches, int window_frames) {
  std::vector<ScoredAnswer> answers;
  for (const Match& row : matches) {
    const core::PlaceTruth place = place_truth_of(truth, row.query, row.match);
    if (is_recent(row.query, row.match, window_frames) || place == core::PlaceTruth::kNear)
      continue;
    answers.push_back({row.score, place == core::PlaceTruth::kSame});
  }
  std::stable_sort(answers.begin(), answers.end(),
                   [](const ScoredAnswer& a, const ScoredAnswer& b) { return a.score > b.score; });
  return answers;
}

// One point per different score: equal scores are accepted together.
std::vector<PrecisionRecallPoint> sweep(const std::vector<ScoredAnswer>& answers,
                                        int num_with_loop) {
  std::vector<PrecisionRecallPoint> curve;
  int num_true = 0;
  for (std::size_t i = 0; i < answers.size(); ++i) {
    num_true += answers[i].is_true ? 1 : 0;
    if (i + 1 < answers.size() && answers[i + 1].score == answers[i].score) continue;
    curve.push_back({static_cast<double>(num_true) / num_with_loop,
                     static_cast<double>(num_true) / static_cast<double>(i + 1), answers[i].score});
  }
  return curve;
}

double area_under(const std::vector<PrecisionRecallPoint>& curve) {
  PrecisionRecallPoint last{0.0, curve.front().precision, 0.0};
  double area = 0.0;
  for (const PrecisionRecallPoint& point : curve) {
    area += (point.recall - last.recall) * (point.precision + last.precision) / 2.0;
    last = point;
  }
  return area;
}

double precision_at(const std::vector<PrecisionRecallPoint>& curve, double least_recall) {
  double best = 0.0;
  for (const PrecisionRecallPoint& point : curve)
    if (point.recall >= least_recall) best = std::max(best, point.precision);
  return best;
}

double recall_at_full_precision(const std::vector<PrecisionRecallPoint>& curve) {
  double best = 0.0;
  for (const PrecisionRecallPoint& point : curve)
    if (point.precision >= kFullPrecision) best = std::max(best, point.recall);
  return best;
}

}  // namespace

core::PlaceTruth place_truth_of(const core::PlaceTruthMatrix& truth, int query, int match) {
  const auto is_inside = [&](int frame) { return frame >= 0 && frame < truth.num_frames; };
  if (!is_inside(query) || !is_inside(match))
    throw core::InputError(fmt::format("query {} with match {}: expected frames 0 to {}", query,
                                       match, truth.num_frames - 1));
  return truth.at(query, match);
}

PrecisionRecall precision_recall(const core::PlaceTruthMatrix& truth,
                                 const std::vector<Match>& matches, int window_frames) {
  check_rows(truth, matches);
  const std::vector<ScoredAnswer> answers = scored_answers(truth, matches, window_frames);

  PrecisionRecall result;
  result.num_queries = truth.num_frames;
  result.num_with_loop = count_queries_with_loop(truth, window_frames);
  if (answers.empty() || result.num_with_loop == 0) return result;

  result.curve = sweep(answers, result.num_with_loop);
  result.auc = area_under(result.curve);
  result.recall_at_full_precision = recall_at_full_precision(result.curve);
  result.precision_at_recall_35 = precision_at(result.curve, 0.35);
  result.precision_at_recall_70 = precision_at(result.curve, 0.70);
  result.max_recall = result.curve.back().recall;
  result.num_false = static_cast<int>(std::count_if(
      answers.begin(), answers.end(), [](const ScoredAnswer& a) { return !a.is_true; }));
  return result;
}

bool is_aliased_pair(const std::vector<core::FramePair>& aliased_pairs, int query, int match) {
  return std::binary_search(aliased_pairs.begin(), aliased_pairs.end(),
                            core::FramePair{std::max(query, match), std::min(query, match)});
}

int count_accepted_aliased(const std::vector<core::FramePair>& aliased_pairs,
                           const std::vector<Match>& accepted, int window_frames) {
  return static_cast<int>(std::count_if(accepted.begin(), accepted.end(), [&](const Match& row) {
    return !is_recent(row.query, row.match, window_frames) &&
           is_aliased_pair(aliased_pairs, row.query, row.match);
  }));
}

AcceptedCounts count_accepted(const core::PlaceTruthMatrix& truth,
                              const std::vector<Match>& accepted, int window_frames) {
  AcceptedCounts counts;
  for (const Match& row : accepted) {
    const core::PlaceTruth place = place_truth_of(truth, row.query, row.match);
    if (is_recent(row.query, row.match, window_frames))
      ++counts.num_recent;
    else if (place == core::PlaceTruth::kSame)
      ++counts.num_true;
    else if (place == core::PlaceTruth::kNear)
      ++counts.num_near;
    else
      ++counts.num_false;
  }
  return counts;
}

}  // namespace samewhere::evaluate
