#include <algorithm>
#include <iterator>
#include <optional>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/program.hpp>
#include <samewhere/paper/benchmark.hpp>
#include <samewhere/paper/method_rows.hpp>
#include <samewhere/paper/methods/methods.hpp>
#include <samewhere/paper/place_truth.hpp>
#include <samewhere/paper/published.hpp>
#include <samewhere/paper/slam_rows.hpp>
#include <samewhere/run/open_source.hpp>

namespace samewhere::paper {
namespace {

// Describers with the search of the published method, as tables call them.
constexpr std::array<std::pair<const char*, const char*>, 6> kDescribers = {
    {{kPaperMethod, "published method"},
     {"hog", "HOG"},
     {"squeezenet", "SqueezeNet"},
     {"darknet", "DarkNet"},
     {"gem", "GeM"},
     {"netvlad", "NetVLAD"}}};

bool is_detector(const std::string& name) {
  const auto& known = known_methods();
  return std::any_of(known.begin(), known.end(),
                     [&](const MethodInfo& method) { return method.name == name; });
}

ComparedMethod describer_info(const std::string& name) {
  if (name == kPaperMethod) {
    return {name, "published method",
            "profile paper: autoencoder, sampled search, NCC above 0.7, pause of 10 frames"};
  }
  const auto* const known = std::find_if(kDescribers.begin(), kDescribers.end(),
                                         [&](const auto& each) { return each.first == name; });
  return {name, known == kDescribers.end() ? name : known->second,
          "the search of the published method on describe.method=" + name};
}

ComparedMethod info_of(const std::string& name) {
  for (const MethodInfo& method : known_methods()) {
    if (method.name == name) return {method.name, method.title, method.what_ran};
  }
  return describer_info(name);
}

// The work on one plan.
class Benchmark {
 public:
  Benchmark(const BenchmarkPlan& plan, const RowStore& store, Results& results,
            const std::function<void(const Results&)>& on_news)
      : plan_(plan), store_(store), results_(results), on_news_(on_news) {
    for (const std::string& source : plan.sources)
      configs_.push_back(with_source(plan.config, source));
    for (const pipeline::Config& config : configs_)
      results_.recordings.push_back(recording_name(config));
    results_.configurations = slam_configurations();
    if (wants(2, 6)) make_describers();
  }

  bool run() {
    if (wants(2, 6)) {
      for (const pipeline::Config& config : configs_) {
        if (!recognize(config)) return false;
      }
    }
    for (int seed = 0; wants(6, 8) && seed < plan_.num_slam_runs; ++seed) {
      for (const pipeline::Config& config : configs_) {
        if (!run_slams(config, seed)) return false;
      }
    }
    return true;
  }

 private:
  bool wants(int first, int last) const {
    const auto at = plan_.tables.lower_bound(first);
    return at != plan_.tables.end() && *at <= last;
  }

  void make_describers() {
    for (const std::string& name : plan_.methods) {
      ComparedMethod info = info_of(name);
      try {
        if (!is_detector(name)) describers_.push_back(make_named_describer(name, plan_.config));
      } catch (const core::InputError& error) {
        if (plan_.needs_all_methods) throw;
        note_missing("", name, error.what());
        continue;
      }
      if (!is_detector(name)) info.name = describers_.back().name;
      results_.methods.push_back(std::move(info));
    }
  }

  void note_missing(const std::string& recording, const std::string& method,
                    const std::string& reason) {
    spdlog::warn("{}{}{}: {}", recording, recording.empty() ? "" : ", ", method, reason);
    results_.missing.push_back({recording, method, reason});
  }

  RowSettings settings_for(const pipeline::Config& config, const std::string& method) const {
    RowSettings settings = settings_of(config);
    settings["method"] = fmt::format("{}: {}", method, info_of(method).what_ran);
    settings["seeds"] = std::to_string(plan_.searches.num_seeds);
    settings["draws"] = fmt::format("{}", fmt::join(draws_of(method), ","));
    for (const NamedDescriber& by : describers_) {
      if (by.name == method)
        settings["describer"] = fmt::format("{:016x}", by.describer->checksum());
    }
    return settings;
  }

  // The published method alone is searched with several numbers.
  std::vector<int> draws_of(const std::string& method) const {
    return method == kPaperMethod ? plan_.searches.num_draws
                                  : std::vector<int>{kPublishedDrawsOfUse};
  }

  std::string piece_of(const pipeline::Config& config, const std::string& method) const {
    return file_stem(config) + "." + method;
  }

  // False: interrupted.
  bool recognize(const pipeline::Config& config) {
    std::set<std::string> missing;
    for (const ComparedMethod& method : results_.methods) {
      const auto rows =
          store_.find(piece_of(config, method.name), settings_for(config, method.name));
      if (rows)
        add(rows->get<std::vector<RecognitionRow>>());
      else
        missing.insert(method.name);
    }
    if (missing.empty()) return true;
    try {
      return measure_recognition(config, open_recording(config), missing);
    } catch (const core::InputError& error) {
      if (plan_.needs_all_sources) throw;
      note_missing(recording_name(config), "recognition", error.what());
    }
    return true;
  }

  bool measure_recognition(const pipeline::Config& config, OpenRecording opened,
                           const std::set<std::string>& missing) {
    const pipeline::Config in_frames = opened.config;
    std::vector<NamedDescriber> describers;
    for (const NamedDescriber& by : describers_) {
      if (missing.contains(by.name)) describers.push_back(by);
    }
    std::vector<std::pair<std::string, std::unique_ptr<TimedMethod>>> detectors;
    for (const std::string& name : missing) {
      if (is_detector(name))
        detectors.emplace_back(name, std::make_unique<TimedMethod>(name, in_frames));
    }
    const auto recording =
        describe_recording(std::move(opened), describers, [&](const core::Frame& frame) {
          for (const auto& [name, detector] : detectors) detector->see(frame);
        });
    if (!recording) return false;
    for (const auto& [name, detector] : detectors)
      keep(config, name, {detector->row(recording->name, recording->truth)});
    return search(config, in_frames, *recording);
  }

  bool search(const pipeline::Config& config, const pipeline::Config& in_frames,
              const DescribedRecording& recording) {
    for (const DescribedViews& views : recording.by_describer) {
      PaperPlan searches = plan_.searches;
      searches.num_draws = draws_of(views.describer);
      const auto rows = run_searches(recording, views, in_frames, searches);
      if (!rows) return false;
      keep(config, views.describer, *rows);
    }
    return true;
  }

  void keep(const pipeline::Config& config, const std::string& method,
            const std::vector<RecognitionRow>& rows) {
    store_.keep(piece_of(config, method), settings_for(config, method), rows);
    add(rows);
    on_news_(results_);
  }

  void add(const std::vector<RecognitionRow>& rows) {
    results_.recognition.insert(results_.recognition.end(), rows.begin(), rows.end());
  }

  // False: interrupted.
  bool run_slams(const pipeline::Config& base, int seed) {
    if (const auto reason = why_no_slam(base)) {
      if (seed == 0) note_missing(recording_name(base), "SLAM", *reason);
      return true;
    }
    for (const ComparedMethod& configuration : results_.configurations) {
      const pipeline::Config config = slam_config(base, configuration.name, seed);
      const std::string piece =
          fmt::format("{}.slam-{}-{}", file_stem(base), configuration.name, seed);
      const RowSettings settings = settings_of(config);
      std::optional<nlohmann::json> known = store_.find(piece, settings);
      if (!known) {
        core::note(fmt::format("{}: SLAM with loop closing {}, run {} of {}", recording_name(base),
                               configuration.name, seed + 1, plan_.num_slam_runs));
        const auto row = run_slam_once(config, recording_name(base), configuration.name);
        if (!row) return false;
        known = *row;
        store_.keep(piece, settings, *known);
      }
      results_.slam.push_back(known->get<SlamRow>());
      on_news_(results_);
    }
    return true;
  }

  const BenchmarkPlan& plan_;
  const RowStore& store_;
  Results& results_;
  const std::function<void(const Results&)>& on_news_;
  std::vector<pipeline::Config> configs_;
  std::vector<NamedDescriber> describers_;
};

void check_sources(const BenchmarkPlan& plan) {
  std::set<std::string> stems;
  for (const std::string& source : plan.sources) {
    const pipeline::Config config = with_source(plan.config, source);
    if (!stems.insert(file_stem(config)).second) {
      throw core::InputError(fmt::format(
          "{}: two sequences are called {}, expected a different name or window for each",
          config.source, file_stem(config)));
    }
    const auto opened = run::open_source(config);
    const bool needs_slam = *plan.tables.rbegin() > 6;
    if (plan.needs_all_sources && !needs_slam) require_place_truth(*opened, config);
  }
}

void check_methods(const BenchmarkPlan& plan) {
  std::set<std::string> names;
  for (const std::string& method : plan.methods) {
    const std::string name = is_detector(method) || !plan.needs_all_methods
                                 ? method
                                 : make_named_describer(method, plan.config).name;
    if (!names.insert(name).second) {
      throw core::InputError(
          fmt::format("--methods: two are called {}, expected a different name for each", name));
    }
  }
}

}  // namespace

void check_plan(const BenchmarkPlan& plan) {
  core::require(!plan.tables.empty(), "some table is wanted");
  check_methods(plan);
  check_sources(plan);
}

std::vector<std::string> all_methods() {
  std::vector<std::string> names;
  for (const auto& [name, title] : kDescribers) names.emplace_back(name);
  for (const MethodInfo& method : known_methods()) names.push_back(method.name);
  return names;
}

bool run_benchmark(const BenchmarkPlan& plan, const RowStore& store, Results& results,
                   const std::function<void(const Results&)>& on_news) {
  return Benchmark(plan, store, results, on_news).run();
}

}  // namespace samewhere::paper
