#include <memory>
#include <utility>
#include <vector>

#include <samewhere/core/errors.hpp>
#include <samewhere/describe/describer.hpp>
#include <samewhere/features/orb.hpp>
#include <samewhere/paper/methods/fild_method.hpp>
#include <samewhere/paper/methods/inlier_check.hpp>
#include <samewhere/paper/methods/neighbour_graph.hpp>

namespace samewhere::paper {
namespace {

constexpr int kFildNearest = 5;
constexpr int kFildInliers = 20;     // ours: the published figure is set for each recording
constexpr int kFildConsecutive = 2;  // ours: as above
constexpr double kFildRatio = 0.7;

InlierCheck fild_check(const pipeline::Config& base) {
  InlierCheck check{.features = features::Config{}, .seed = static_cast<std::uint64_t>(base.seed)};
  check.features.max_ratio = kFildRatio;
  return check;
}

class FildMethod : public Method {
 public:
  explicit FildMethod(const pipeline::Config& base)
      : window_frames_(base.retrieve.window_frames),
        check_(fild_check(base)),
        graph_(NeighbourGraph::Settings{.num_links = 48,
                                        .num_inserted_among = 48,
                                        .num_searched = 20,
                                        .seed = static_cast<std::uint64_t>(base.seed)}),
        describer_(describe::make_describer(base.describe)) {
    core::require(window_frames_ >= 0, "the window is in frames");
  }

  void see(const core::Frame& frame) override {
    const int query = static_cast<int>(views_.size());
    views_.push_back(features::extract(frame, check_.features));
    descriptors_.push_back(describer_->describe(frame.id, frame.images[0]));
    const int leaves = query - window_frames_ - 1;
    if (leaves < 0) return;
    graph_.insert(leaves, descriptors_[static_cast<std::size_t>(leaves)].unit);
    const evaluate::Match best = verified_best(query);
    if (best.match < 0) return;
    findings_.matches.push_back(best);
    num_consecutive_ = best.score >= kFildInliers ? num_consecutive_ + 1 : 0;
    if (num_consecutive_ >= kFildConsecutive) findings_.accepted.push_back(best);
  }

  Findings findings() override { return std::move(findings_); }

 private:
  // Of the nearest views the one with most inliers, of equals the nearer.
  evaluate::Match verified_best(int query) const {
    evaluate::Match best{.query = query, .match = -1, .score = -1.0};
    for (const int match :
         graph_.nearest(descriptors_[static_cast<std::size_t>(query)].unit, kFildNearest)) {
      const int num_inliers =
          count_inliers(views_.back(), views_[static_cast<std::size_t>(match)], check_);
      if (num_inliers <= best.score) continue;
      best.match = match;
      best.score = num_inliers;
    }
    return best;
  }

  int window_frames_;
  InlierCheck check_;
  NeighbourGraph graph_;
  std::unique_ptr<describe::Describer> describer_;
  std::vector<features::View> views_;
  std::vector<core::Descriptor> descriptors_;
  int num_consecutive_ = 0;
  Findings findings_;
};

}  // namespace

std::unique_ptr<Method> make_fild_method(const pipeline::Config& base) {
  return std::make_unique<FildMethod>(base);
}

}  // namespace samewhere::paper
