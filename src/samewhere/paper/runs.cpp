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

PausedLoops loops_of(const std::vector<evaluate::Match>& matches, const core::Truth& truth,
                     const pipeline::Config& config) {
  const int window_frames = config.retrieve.window_frames;
  const std::vector<evaluate::Match> accepted = accepted_with_pause(matches, config.verify);
  PausedLoops loops{evaluate::count_accepted(*truth.places, accepted, window_frames), std::nullopt};
  if (!truth.impostors.empty())
    loops.num_impostors =
        evaluate::count_accepted_impostors(truth.impostors, accepted, window_frames);
  return loops;
}

PaperRun run_once(const DescribedRecording& recording, const DescribedViews& views,
                  const pipeline::Config& config) {
  core::Timings timings;
  const std::vector<evaluate::Match> matches = best_matches(views.views, config, timings);
  PaperRun run;
  run.search = config.retrieve.search;
  run.num_draws = config.retrieve.num_draws;
  run.seed = config.seed;
  run.result =
      evaluate::precision_recall(*recording.truth.places, matches, config.retrieve.window_frames);
  run.loops = loops_of(matches, recording.truth, config);
  run.search_ms = timings.durations_ms().at(kSearch);
  run.exact_similarity_ms = timings.durations_ms().at(kExactSimilarity);
  return run;
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

std::optional<PaperBlock> run_paper_plan(const DescribedRecording& recording,
                                         const DescribedViews& views, const pipeline::Config& given,
                                         const PaperPlan& plan) {
  pipeline::Config config = given;
  config.retrieve.window_frames = recording.window_frames;
  PaperBlock block{.recording = recording.name,
                   .describer = views.describer,
                   .describer_checksum = views.checksum,
                   .window_frames = recording.window_frames,
                   .min_similarity = config.verify.min_similarity,
                   .pause_frames = config.verify.pause_frames,
                   .timed_frames = recording.timed_frames,
                   .describe_ms = views.durations_ms,
                   .runs = {}};
  const std::vector<pipeline::Config> configs = configs_of(config, plan);
  core::Progress progress(fmt::format("{}, {}: searches", recording.name, views.describer),
                          static_cast<int>(configs.size()));
  for (const pipeline::Config& each : configs) {
    if (core::is_interrupted()) return std::nullopt;
    block.runs.push_back(run_once(recording, views, each));
    progress.update(static_cast<int>(block.runs.size()));
  }
  return block;
}

}  // namespace samewhere::paper
