#include <algorithm>
#include <cstdlib>
#include <utility>
#include <vector>

#include <samewhere/core/errors.hpp>
#include <samewhere/features/orb.hpp>
#include <samewhere/paper/methods/bag_of_words.hpp>
#include <samewhere/paper/methods/consistency.hpp>
#include <samewhere/paper/methods/inlier_check.hpp>
#include <samewhere/paper/methods/words_method.hpp>

namespace samewhere::paper {
namespace {

constexpr int kOrbSlamFeatures = 1000;
constexpr double kMinSharedRatio = 0.8;        // of the largest number of shared words
constexpr double kMinAccumulatedRatio = 0.75;  // of the largest accumulated score
constexpr int kNeighbourFrames = 5;            // to either side: ten, as ORB-SLAM2 takes keyframes
constexpr int kNumConsistent = 3;              // queries before that agree
constexpr int kOrbSlamInliers = 20;
constexpr int kOrbSlamPauseFrames = 10;  // after a loop
constexpr int kNumReranked = 10;

// Few matches rank, too.
InlierCheck ranking_check(const pipeline::Config& base) {
  InlierCheck check{.features = features::Config{}, .seed = static_cast<std::uint64_t>(base.seed)};
  check.features.num_features = kOrbSlamFeatures;
  return check;
}

// ORB-SLAM2 matches words of loops within 50 bits and with a ratio of 0.75.
InlierCheck orb_slam_check(const pipeline::Config& base) {
  InlierCheck check = ranking_check(base);
  check.min_matches = kOrbSlamInliers;
  check.features.max_distance_bits = 50;
  check.features.max_ratio = 0.75;
  return check;
}

// The views of a sequence and the score of each query with those outside the window.
class WordsMethod : public Method {
 public:
  WordsMethod(const pipeline::Config& base, const InlierCheck& check)
      : window_frames_(base.retrieve.window_frames),
        check_(check),
        vocabulary_(vocabulary_of(base)),
        file_(vocabulary_->num_words(), BagNorm::kL1) {
    core::require(window_frames_ >= 0, "the window is in frames");
  }

  void see(const core::Frame& frame) override {
    views_.push_back(features::extract(frame, check_.features));
    bags_.push_back(tf_idf(*vocabulary_, views_.back().features->descriptors));
    judge(file_.search(bags_.back(), std::max(0, query() - window_frames_)));
    file_.append(bags_.back());
  }

  Findings findings() override { return std::move(findings_); }

 protected:
  // The newest view, with views that share words with it.
  virtual void judge(const std::vector<ScoredBag>& scored) = 0;

  int query() const { return static_cast<int>(views_.size()) - 1; }
  const BagOfWords& bag(int position) const { return bags_[static_cast<std::size_t>(position)]; }
  int inliers_of(int match) const {
    return count_inliers(views_.back(), views_[static_cast<std::size_t>(match)], check_);
  }

  Findings findings_;

 private:
  int window_frames_;
  InlierCheck check_;
  std::shared_ptr<const features::Vocabulary> vocabulary_;
  InvertedFile file_;
  std::vector<features::View> views_;
  std::vector<BagOfWords> bags_;
};

class OrbSlamWords : public WordsMethod {
 public:
  explicit OrbSlamWords(const pipeline::Config& base) : WordsMethod(base, orb_slam_check(base)) {}

 private:
  void judge(const std::vector<ScoredBag>& scored) override {
    const std::vector<ScoredBag> best = best_scored(scored, 1);
    if (!best.empty()) {
      findings_.matches.push_back({query(), best.front().position, best.front().score});
    }
    if (query() < pause_end_) return;
    for (const ScoredBag& candidate : consistency_.consistent_of(candidates_of(scored))) {
      if (inliers_of(candidate.position) < kOrbSlamInliers) continue;
      findings_.accepted.push_back({query(), candidate.position, candidate.score});
      pause_end_ = query() + kOrbSlamPauseFrames;
      return;
    }
  }

  // What a view near the query scores at least: a candidate scores no less.
  double min_score() const {
    double least = 1.0;
    for (int i = std::max(0, query() - 2 * kNeighbourFrames); i < query(); ++i)
      least = std::min(least, score_of(bag(query()), bag(i), BagNorm::kL1));
    return least;
  }

  std::vector<ScoredBag> candidates_of(std::vector<ScoredBag> scored) const {
    int most_shared = 0;
    for (const ScoredBag& found : scored) most_shared = std::max(most_shared, found.num_shared);
    std::erase_if(scored, [&](const ScoredBag& found) {
      return found.num_shared <= kMinSharedRatio * most_shared;
    });
    return accumulated_best(scored, min_score());
  }

  // A candidate with its neighbours in time.
  struct Group {
    double accumulated = 0.0;
    ScoredBag best;
  };

  static Group group_of(const ScoredBag& centre, const std::vector<ScoredBag>& scored) {
    Group group{.accumulated = 0.0, .best = centre};
    for (const ScoredBag& other : scored) {
      if (std::abs(other.position - centre.position) > kNeighbourFrames) continue;
      group.accumulated += other.score;
      if (other.score > group.best.score) group.best = other;
    }
    return group;
  }

  // Of each candidate's neighbourhood the best, where that scores nearly as well as the best one.
  static std::vector<ScoredBag> accumulated_best(const std::vector<ScoredBag>& scored,
                                                 double min_score) {
    std::vector<Group> groups;
    double most = min_score;
    for (const ScoredBag& centre : scored) {
      if (centre.score < min_score) continue;
      groups.push_back(group_of(centre, scored));
      most = std::max(most, groups.back().accumulated);
    }
    std::vector<ScoredBag> candidates;
    for (const Group& group : groups) {
      const bool is_new = candidates.empty() || candidates.back().position != group.best.position;
      if (is_new && group.accumulated > kMinAccumulatedRatio * most)
        candidates.push_back(group.best);
    }
    return best_scored(candidates, static_cast<int>(candidates.size()));
  }

  Consistency consistency_{2 * kNeighbourFrames, kNumConsistent};
  int pause_end_ = 0;
};

class RerankedWords : public WordsMethod {
 public:
  explicit RerankedWords(const pipeline::Config& base) : WordsMethod(base, ranking_check(base)) {}

 private:
  void judge(const std::vector<ScoredBag>& scored) override {
    evaluate::Match best{.query = query(), .match = -1, .score = -1.0};
    for (const ScoredBag& candidate : best_scored(scored, kNumReranked)) {
      const int num_inliers = inliers_of(candidate.position);
      if (num_inliers <= best.score) continue;
      best.match = candidate.position;
      best.score = num_inliers;
    }
    if (best.match < 0) return;
    findings_.matches.push_back(best);
    if (best.score >= kOrbSlamInliers) findings_.accepted.push_back(best);
  }
};

}  // namespace

std::unique_ptr<Method> make_words_method(const pipeline::Config& base) {
  return std::make_unique<OrbSlamWords>(base);
}

std::unique_ptr<Method> make_words_geometry_method(const pipeline::Config& base) {
  return std::make_unique<RerankedWords>(base);
}

}  // namespace samewhere::paper
