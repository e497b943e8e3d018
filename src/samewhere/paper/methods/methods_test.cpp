#include <cstdlib>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/random.hpp>
#include <samewhere/evaluate/precision_recall.hpp>
#include <samewhere/paper/methods/methods.hpp>
#include <samewhere/paper/methods/neighbour_graph.hpp>

namespace samewhere::paper {
namespace {

constexpr int kLap = 30;       // frames
constexpr int kStep_px = 100;  // from frame to frame
constexpr int kWindow_frames = 10;
const cv::Size kImage_px(640, 480);

// A long wall of random rectangles.
cv::Mat wall() {
  core::Random random(7);
  cv::Mat image(kImage_px.height, kImage_px.width + kLap * kStep_px, CV_8U, cv::Scalar(128));
  for (int i = 0; i < 4000; ++i) {
    const cv::Point at(static_cast<int>(random.index(static_cast<std::uint64_t>(image.cols))),
                       static_cast<int>(random.index(static_cast<std::uint64_t>(image.rows))));
    const cv::Size size(8 + static_cast<int>(random.index(40)),
                        8 + static_cast<int>(random.index(40)));
    cv::rectangle(image, cv::Rect(at, size), static_cast<double>(random.index(256)), cv::FILLED);
  }
  return image;
}

// Two laps along the wall, the second in less light. Frames that share a third are the same place.
struct Laps {
  pipeline::Config config;
  core::PlaceTruthMatrix places{2 * kLap, {}};
  std::vector<core::Frame> frames;
};

const Laps& laps() {
  static const Laps once = [] {
    cv::setNumThreads(1);
    Laps all{.config = pipeline::profile("default")};
    all.config.retrieve.window_frames = kWindow_frames;
    const cv::Mat whole = wall();
    const auto uncalibrated = std::make_shared<core::Rig>();
    for (int i = 0; i < 2 * kLap; ++i) {
      const cv::Rect part(cv::Point(i % kLap * kStep_px, 0), kImage_px);
      const cv::Mat image = i < kLap ? whole(part).clone() : cv::Mat(0.7 * whole(part));
      all.frames.push_back({.id = core::FrameId(static_cast<std::uint64_t>(i)),
                            .rig = uncalibrated,
                            .images = {image}});
      for (int k = 0; k < 2 * kLap; ++k) {
        all.places.values.push_back(std::abs(i % kLap - k % kLap) <= 4
                                        ? core::PlaceTruth::kSame
                                        : core::PlaceTruth::kDifferent);
      }
    }
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
  const auto counts = evaluate::count_accepted(laps().places, found.accepted, kWindow_frames);
  const auto result = evaluate::precision_recall(laps().places, found.matches, kWindow_frames);
  EXPECT_GT(counts.num_true, 0);
  EXPECT_EQ(counts.num_false, 0);
  EXPECT_EQ(counts.num_recent, 0);
  EXPECT_GT(result.auc, 0.9);

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
