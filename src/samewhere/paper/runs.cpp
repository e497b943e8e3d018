#include <fmt/format.h>

#include <samewhere/core/interrupt.hpp>
#include <samewhere/core/progress.hpp>
#include <samewhere/paper/runs.hpp>
#include <samewhere/retrieve/retriever.hpp>
#include <samewhere/verify/decide.hpp>

namespace samewhere::paper {
namespace {

constexpr const char* kSearch = "search";
constexpr const char* kExactSimilarity = "exact similarity";

core::Candidate candidate_of(const evaluate::Match& match) {
  return {{},
          core::FrameId(static_cast<std::uint64_t>(match.query)),
          core::FrameId(static_cast<std::uint64_t>(match.match)),
          match.score};
}

SearchKind kind_of(retrieve::Search search) {
  switch (search) {
    case retrieve::Search::kExact:
      return SearchKind::kExact;
    case retrieve::Search::kEveryQueue:
      return SearchKind::kEveryQueue;
    case retrieve::Search::kSampled:
      break;
  }
  return SearchKind::kSampled;
}

// Of each step, and of all of a frame together where its description was timed.
std::map<std::string, core::TimingSummary> step_times(const DescribedRecording& recording,
                                                      const DescribedViews& views,
                                                      const core::Timings& timings) {
  const std::vector<double>& search_ms = timings.durations_ms().at(kSearch);
  const std::vector<double>& exact_ms = timings.durations_ms().at(kExactSimilarity);
  std::vector<double> together_ms;
  for (std::size_t i = 0; i < views.durations_ms.size(); ++i) {
    const auto frame = static_cast<std::size_t>(recording.timed_frames.at(i));
    together_ms.push_back(views.durations_ms[i] + search_ms.at(frame) + exact_ms.at(frame));
  }
  return {{"describe", core::summarize(views.durations_ms)},
          {kSearch, core::summarize(search_ms)},
          {kExactSimilarity, core::summarize(exact_ms)},
          {kTogether, core::summarize(together_ms)}};
}

RecognitionRow run_once(const DescribedRecording& recording, const DescribedViews& views,
                        const pipeline::Config& config) {
  core::Timings timings;
  const std::vector<evaluate::Match> matches = best_matches(views.views, config, timings);
  const bool is_sampled = config.retrieve.search == retrieve::Search::kSampled;
  return {.recording = recording.name,
          .window_frames = recording.window_frames,
          .method = views.describer,
          .search = kind_of(config.retrieve.search),
          .num_draws = is_sampled ? config.retrieve.num_draws : 0,
          .seed = config.seed,
          .result =
              evaluate::precision_recall(*recording.truth.places, matches, recording.window_frames),
          .loops = count_loops(accepted_with_pause(matches, config.verify), recording.truth,
                               recording.window_frames),
          .ms = step_times(recording, views, timings)};
}

// One config for each search.
std::vector<pipeline::Config> configs_of(pipeline::Config config, const PaperPlan& plan) {
  std::vector<pipeline::Config> configs;
  config.retrieve.search = retrieve::Search::kSampled;
  for (const int num_draws : plan.num_draws) {
    config.retrieve.num_draws = num_draws;
    for (config.seed = 0; config.seed < plan.num_seeds; ++config.seed) configs.push_back(config);
  }
  config.seed = 0;
  for (const auto search : {retrieve::Search::kEveryQueue, retrieve::Search::kExact}) {
    config.retrieve.search = search;
    configs.push_back(config);
  }
  return configs;
}

}  // namespace

std::vector<evaluate::Match> best_matches(const std::vector<core::Descriptor>& views,
                                          const pipeline::Config& config, core::Timings& timings) {
  retrieve::Retriever retriever(config.retrieve, static_cast<std::uint64_t>(config.seed));
  std::vector<evaluate::Match> matches;
  for (const core::Descriptor& view : views) {
    std::vector<retrieve::FoundView> found;
    {
      const core::ScopedTimer timer(timings, kSearch);
      found = retriever.search(view);
      retriever.add(view);
    }
    const core::ScopedTimer timer(timings, kExactSimilarity);
    const std::vector<core::Candidate> candidates = retrieve::compare(view, found);
    if (candidates.empty()) continue;
    const core::Candidate& best = candidates.front();
    matches.push_back({static_cast<int>(best.query.index()), static_cast<int>(best.match.index()),
                       best.similarity});
  }
  return matches;
}

std::vector<evaluate::Match> accepted_with_pause(const std::vector<evaluate::Match>& matches,
                                                 const verify::Config& config) {
  verify::History history;
  std::vector<evaluate::Match> accepted;
  for (const evaluate::Match& match : matches) {
    const core::Candidate candidate = candidate_of(match);
    const core::Evidence evidence{.similarity = match.score};
    if (verify::refuse_early(candidate, evidence, history, config)) continue;
    accepted.push_back(match);
    history.last_loop_query = candidate.query;
  }
  return accepted;
}

RecognitionLoops count_loops(const std::vector<evaluate::Match>& accepted, const core::Truth& truth,
                             int window_frames) {
  const evaluate::AcceptedCounts counts =
      evaluate::count_accepted(*truth.places, accepted, window_frames);
  RecognitionLoops loops{counts.num_true, counts.num_false, counts.num_near, std::nullopt};
  if (!truth.aliased_pairs.empty())
    loops.num_aliased =
        evaluate::count_accepted_aliased(truth.aliased_pairs, accepted, window_frames);
  return loops;
}

std::optional<std::vector<RecognitionRow>> run_searches(const DescribedRecording& recording,
                                                        const DescribedViews& views,
                                                        const pipeline::Config& given,
                                                        const PaperPlan& plan) {
  pipeline::Config config = given;
  config.retrieve.window_frames = recording.window_frames;
  const std::vector<pipeline::Config> configs = configs_of(config, plan);
  core::Progress progress(fmt::format("{}, {}: searches", recording.name, views.describer),
                          static_cast<int>(configs.size()));
  std::vector<RecognitionRow> rows;
  for (const pipeline::Config& each : configs) {
    if (core::is_interrupted()) return std::nullopt;
    rows.push_back(run_once(recording, views, each));
    progress.update(static_cast<int>(rows.size()));
  }
  return rows;
}

}  // namespace samewhere::paper
