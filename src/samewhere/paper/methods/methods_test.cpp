#include <gtest/gtest.h>
#include <opencv2/core/utility.hpp>

#include <samewhere/core/errors.hpp>
#include <samewhere/evaluate/precision_recall.hpp>
#include <samewhere/paper/described_recording.hpp>
#include <samewhere/paper/methods/methods.hpp>
#include <samewhere/paper/methods/neighbour_graph.hpp>

namespace samewhere::paper {
namespace {

// Two laps of a rendered corridor, once for all tests.
struct Laps {
  pipeline::Config config;
  core::PlaceTruthMatrix places;
  std::vector<core::Frame> frames;
};

const Laps& laps() {
  static const Laps once = [] {
    cv::setNumThreads(1);
    OpenRecording recording = open_recording(
        with_source(pipeline::profile("default"), "twin:office-loop?seed=21&speed=4@10s"));
    Laps all{.config = recording.config, .places = *recording.truth.places, .frames = {}};
    while (auto frame = recording.source->next()) all.frames.push_back(std::move(*frame));
    return all;
  }();
  return once;
}

Findings findings_of(const std::string& name) {
  const auto method = make_method(name, laps().config);
  for (const core::Frame& frame : laps().frames) method->see(frame);
  return method->findings();
}

class EachMethod : public testing::TestWithParam<const char*> {};

TEST_P(EachMethod, FindsLoopsOfAWalkThatReturnsAndTheSameEachTime) {
  if (GetParam() == std::string("fild") && !NeighbourGraph::is_built_in())
    GTEST_SKIP() << "built without hnswlib";
  const Findings found = findings_of(GetParam());
  const int window_frames = laps().config.retrieve.window_frames;
  const auto counts = evaluate::count_accepted(laps().places, found.accepted, window_frames);
  const auto result = evaluate::precision_recall(laps().places, found.matches, window_frames);
  EXPECT_GT(counts.num_true, 0);
  EXPECT_EQ(counts.num_recent, 0);
  EXPECT_GT(result.auc, 0.5);

  const Findings again = findings_of(GetParam());
  const auto expect_equal = [](const std::vector<evaluate::Match>& a,
                               const std::vector<evaluate::Match>& b) {
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
      EXPECT_EQ(a[i].query, b[i].query);
      EXPECT_EQ(a[i].match, b[i].match);
      EXPECT_EQ(a[i].score, b[i].score);
    }
  };
  expect_equal(found.matches, again.matches);
  expect_equal(found.accepted, again.accepted);
}

INSTANTIATE_TEST_SUITE_P(Methods, EachMethod,
                         testing::Values("words", "words-geometry", "fild", "bowg"));

TEST(ComparedMethods, AreKnownByTheirNames) {
  EXPECT_THROW(make_method("nothing", laps().config), core::InputError);
  for (const MethodInfo& info : known_methods()) {
    EXPECT_FALSE(info.title.empty());
    EXPECT_FALSE(info.what_ran.empty());
  }
  pipeline::Config config = laps().config;
  config.retrieve.vocabulary = "/nowhere/words.bin";
  for (const char* name : {"words", "words-geometry", "bowg"})
    EXPECT_THROW(make_method(name, config), core::InputError) << name;
}

}  // namespace
}  // namespace samewhere::paper
