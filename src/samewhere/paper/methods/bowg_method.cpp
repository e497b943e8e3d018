#include <algorithm>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <samewhere/core/errors.hpp>
#include <samewhere/features/orb.hpp>
#include <samewhere/paper/methods/bowg_method.hpp>
#include <samewhere/paper/methods/inlier_check.hpp>
#include <samewhere/paper/methods/islands.hpp>
#include <samewhere/paper/methods/word_groups.hpp>

namespace samewhere::paper {
namespace {

// The defaults of the published program.
constexpr int kBowgFeatures = 580;  // 300 at full size, half as many at each half size
constexpr int kBowgLevels = 5;
constexpr double kBowgScale = 2.0;
constexpr double kFeatureSize_px = 5.0;
constexpr double kWordWeight = 0.7;
constexpr double kGroupWeight = 0.3;
constexpr double kMinOwnScore = 0.005;  // of the query with the view before it
constexpr double kPoorOwnScore = 10.0;  // in its place where that is lower
constexpr double kMaxPreviousWeight = 0.5;
constexpr double kBowgSimilarity = 0.4;
constexpr int kIslandGapFrames = 3;
constexpr int kMaxIslandDistanceFrames = 1;
constexpr int kBowgInliers = 30;
constexpr double kBowgError_px = 7.0;
constexpr int kBowgIterations = 200;
constexpr double kBowgRatio = 0.8;

InlierCheck bowg_check(const pipeline::Config& base) {
  InlierCheck check{.features = features::Config{},
                    .min_matches = kBowgInliers,
                    .max_error_px = kBowgError_px,
                    .max_iterations = kBowgIterations,
                    .seed = static_cast<std::uint64_t>(base.seed)};
  check.features.num_features = kBowgFeatures;
  check.features.num_levels = kBowgLevels;
  check.features.scale_factor = kBowgScale;
  check.features.max_ratio = kBowgRatio;
  return check;
}

// Both bags of a view.
struct Bags {
  BagOfWords words;
  BagOfWords groups;
};

class BowgMethod : public Method {
 public:
  explicit BowgMethod(const pipeline::Config& base)
      : window_frames_(base.retrieve.window_frames),
        check_(bowg_check(base)),
        vocabulary_(vocabulary_of(base)),
        words_(vocabulary_->num_words(), BagNorm::kL1),
        groups_(vocabulary_->num_words(), BagNorm::kL2) {
    core::require(window_frames_ >= 0, "the window is in frames");
  }

  void see(const core::Frame& frame) override {
    views_.push_back(features::extract(frame, check_.features));
    const features::Features& features = *views_.back().features;
    const Bags bags{
        .words = tf_idf(*vocabulary_, features.descriptors),
        .groups = dictionary_.learn(features, vocabulary_->words_of(features.descriptors))};
    judge(mixed_with_previous(similarity_of(bags)));
    words_.append(bags.words);
    groups_.append(bags.groups);
    before_ = bags;
    previous_.resize(views_.size());
  }

  Findings findings() override { return std::move(findings_); }

 private:
  int query() const { return static_cast<int>(views_.size()) - 1; }

  // What the query scores with the view before it: the scale of its scores.
  static double own_score(const BagOfWords& bag, const BagOfWords& before, BagNorm norm) {
    const double score = score_of(bag, before, norm);
    return score < kMinOwnScore ? kPoorOwnScore : score;
  }

  // Of views outside the window that share words, by words and by groups.
  std::vector<ScoredBag> similarity_of(const Bags& bags) const {
    const int num_allowed = std::max(0, query() - window_frames_);
    std::vector<ScoredBag> scored = words_.search(bags.words, num_allowed);
    const std::vector<ScoredBag> by_groups = groups_.search(bags.groups, num_allowed);
    const double own_words = own_score(bags.words, before_.words, BagNorm::kL1);
    const double own_groups = own_score(bags.groups, before_.groups, BagNorm::kL2);
    auto group = by_groups.begin();
    for (ScoredBag& view : scored) {
      view.score *= kWordWeight / own_words;
      while (group != by_groups.end() && group->position < view.position) ++group;
      if (group != by_groups.end() && group->position == view.position)
        view.score += kGroupWeight * group->score / own_groups;
    }
    return scored;
  }

  // The camera is taken to have moved as it did then: from a match's view before to the match.
  std::vector<ScoredBag> mixed_with_previous(std::vector<ScoredBag> scored) {
    for (ScoredBag& view : scored) {
      if (view.position == 0) continue;
      const auto& previous = previous_[static_cast<std::size_t>(view.position) - 1];
      if (!previous) continue;
      const double change = *previous - view.score;
      const double weight = kMaxPreviousWeight / (change * change + 1.0);
      view.score = weight * *previous + (1.0 - weight) * view.score;
    }
    for (const ScoredBag& view : scored)
      previous_[static_cast<std::size_t>(view.position)] = view.score;
    return scored;
  }

  void judge(const std::vector<ScoredBag>& scored) {
    const std::vector<ScoredBag> best = best_scored(scored, 1);
    if (!best.empty())
      findings_.matches.push_back({query(), best.front().position, best.front().score});
    const auto island = best_island(scored, kBowgSimilarity, kIslandGapFrames);
    const auto island_before = std::exchange(island_before_, island);
    if (!island || !island_before || !are_near(*island, *island_before, kMaxIslandDistanceFrames))
      return;
    const auto match = static_cast<std::size_t>(island->best.position);
    if (count_inliers(views_.back(), views_[match], check_) >= kBowgInliers)
      findings_.accepted.push_back({query(), island->best.position, island->best.score});
  }

  int window_frames_;
  InlierCheck check_;
  std::shared_ptr<const features::Vocabulary> vocabulary_;
  InvertedFile words_;
  InvertedFile groups_;
  WordGroups dictionary_{kFeatureSize_px, kBowgScale};
  std::vector<features::View> views_;
  Bags before_;
  std::vector<std::optional<double>> previous_;  // the last score of each view
  std::optional<Island> island_before_;          // of the query before
  Findings findings_;
};

}  // namespace

std::unique_ptr<Method> make_bowg_method(const pipeline::Config& base) {
  return std::make_unique<BowgMethod>(base);
}

}  // namespace samewhere::paper
