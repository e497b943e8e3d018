#include <samewhere/paper/methods/recognition_method.hpp>
#include <samewhere/run/recognition.hpp>

namespace samewhere::paper {
namespace {

std::vector<evaluate::Match> matches_of(const std::vector<report::ScoredPair>& pairs) {
  std::vector<evaluate::Match> matches;
  for (const report::ScoredPair& pair : pairs) {
    matches.push_back(
        {static_cast<int>(pair.query.index()), static_cast<int>(pair.match.index()), pair.score});
  }
  return matches;
}

class RecognitionMethod : public Method {
 public:
  explicit RecognitionMethod(const pipeline::Config& config)
      : recognition_(config), steps_(recognition_.steps()) {}

  void see(const core::Frame& frame) override {
    steps_.verify(steps_.search(steps_.describe(frame)));
  }

  Findings findings() override {
    run::RunOutcome outcome;
    std::move(recognition_).report_to(outcome);
    return {matches_of(outcome.matches), matches_of(outcome.accepted)};
  }

 private:
  run::Recognition recognition_;
  run::RecognitionSteps steps_;  // point into it
};

}  // namespace

std::unique_ptr<Method> make_recognition_method(const pipeline::Config& config) {
  return std::make_unique<RecognitionMethod>(config);
}

}  // namespace samewhere::paper
