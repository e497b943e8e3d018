#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/random.hpp>
#include <samewhere/core/similarity.hpp>
#include <samewhere/evaluate/precision_recall.hpp>
#include <samewhere/train/head_training.hpp>
#include <samewhere/twin/front/walkthrough.hpp>

namespace samewhere::train {
namespace {

constexpr double kWindow_s = 10.0;
constexpr int kMaxFirstViews = 1500;  // the head starts from so many

// A view of one of several sources.
struct ViewOf {
  int source = 0;
  int view = 0;
};

// Draws batches from sources.
class BatchMaker {
 public:
  BatchMaker(const std::vector<HeadSource>& sources, int num_anchors)
      : sources_(sources), num_anchors_(num_anchors) {
    for (int source = 0; source < static_cast<int>(sources.size()); ++source) {
      std::vector<int> anchors;
      for (int view = 0; view < at(source).num_views(); ++view)
        if (!views_like(source, view, Relation::kSame).empty()) anchors.push_back(view);
      num_all_ += static_cast<int>(anchors.size());
      if (!anchors.empty()) anchors_.push_back({source, std::move(anchors)});
    }
    if (anchors_.empty()) throw core::InputError("no two views of the same place to learn from");
  }

  int num_batches() const { return (num_all_ + num_anchors_ - 1) / num_anchors_; }

  HeadBatch draw(core::Random& random) const {
    std::vector<ViewOf> views;
    for (int i = 0; i < num_anchors_; ++i) {
      const auto& [source, anchors] = anchors_[random.index(anchors_.size())];
      add_group({source, anchors[random.index(anchors.size())]}, random, views);
    }
    HeadBatch batch{.num_views = static_cast<int>(views.size())};
    batch.maps = maps_of(views);
    for (const ViewOf& a : views) {
      for (const ViewOf& b : views) {
        batch.relations.push_back(a.source == b.source ? relation_of(at(a.source), a.view, b.view)
                                                       : Relation::kDifferent);
      }
    }
    return batch;
  }

  // Of evenly spread views.
  std::vector<float> first_maps() const {
    std::vector<ViewOf> all;
    for (int source = 0; source < static_cast<int>(sources_.size()); ++source) {
      for (int view = 0; view < at(source).num_views(); ++view) all.push_back({source, view});
    }
    const std::size_t step = (all.size() + kMaxFirstViews - 1) / kMaxFirstViews;
    std::vector<ViewOf> some;
    for (std::size_t i = 0; i < all.size(); i += step) some.push_back(all[i]);
    return maps_of(some);
  }

 private:
  const HeadSource& at(int source) const { return sources_[static_cast<std::size_t>(source)]; }

  std::vector<int> views_like(int source, int view, Relation wanted) const {
    std::vector<int> views;
    const HeadSource& all = at(source);
    const int image = view - view % all.views_per_image;
    const int begin = all.is_walk() ? 0 : image;
    const int end = all.is_walk() ? all.num_views() : image + all.views_per_image;
    for (int other = begin; other < end; ++other)
      if (relation_of(all, view, other) == wanted) views.push_back(other);
    return views;
  }

  // The anchor, a view of its place, and of a look-alike place if there is one.
  void add_group(const ViewOf& anchor, core::Random& random, std::vector<ViewOf>& views) const {
    views.push_back(anchor);
    const std::vector<int> same = views_like(anchor.source, anchor.view, Relation::kSame);
    views.push_back({anchor.source, same[random.index(same.size())]});
    std::vector<int> aliased;
    for (const core::FramePair& pair : at(anchor.source).aliased_pairs) {
      if (pair.query == anchor.view) aliased.push_back(pair.match);
      if (pair.match == anchor.view) aliased.push_back(pair.query);
    }
    if (!aliased.empty()) views.push_back({anchor.source, aliased[random.index(aliased.size())]});
  }

  std::vector<float> maps_of(const std::vector<ViewOf>& views) const {
    std::vector<float> maps;
    for (const ViewOf& each : views) {
      cv::Mat map;
      at(each.source).maps[static_cast<std::size_t>(each.view)].convertTo(map, CV_32F);
      maps.insert(maps.end(), map.begin<float>(), map.end<float>());
    }
    return maps;
  }

  const std::vector<HeadSource>& sources_;
  int num_anchors_;
  int num_all_ = 0;                                        // anchors of all sources
  std::vector<std::pair<int, std::vector<int>>> anchors_;  // source, views with another like them
};

std::vector<std::vector<float>> codes_of(HeadNetwork& network, const HeadSource& source) {
  std::vector<std::vector<float>> codes;
  for (const cv::Mat& half : source.maps) {
    cv::Mat map;
    half.convertTo(map, CV_32F);
    codes.push_back(network.codes({map.ptr<float>(), map.total()}));
  }
  return codes;
}

double mean_auc(HeadNetwork& network, const std::vector<HeadSource>& walks) {
  double sum = 0.0;
  for (const HeadSource& walk : walks) sum += auc_of_walk(walk, codes_of(network, walk));
  return walks.empty() ? 0.0 : sum / static_cast<double>(walks.size());
}

}  // namespace

double auc_of_walk(const HeadSource& walk, const std::vector<std::vector<float>>& codes) {
  core::require(walk.is_walk() && codes.size() == walk.maps.size(), "a walk has a code per view");
  const int window = static_cast<int>(
      std::ceil(kWindow_s * twin::kFrameRate_hz / static_cast<double>(walk.frames_per_view)));
  std::vector<evaluate::Match> matches;
  for (int query = window + 1; query < walk.num_views(); ++query) {
    evaluate::Match best{query, 0, -2.0};
    for (int match = 0; match < query - window; ++match) {
      const double score =
          core::ncc(codes[static_cast<std::size_t>(query)], codes[static_cast<std::size_t>(match)]);
      if (score > best.score) best = {query, match, score};
    }
    matches.push_back(best);
  }
  return evaluate::precision_recall(walk.places, matches, window).auc;
}

TrainedHead train_head(HeadKind kind, const std::vector<HeadSource>& sources,
                       const std::vector<HeadSource>& validation, const HeadConfig& config,
                       const std::function<bool(const HeadEpoch&)>& on_epoch) {
  core::require(!sources.empty(), "there is something to learn from");
  const BatchMaker batches(sources, config.batch);
  HeadNetwork network(kind, sources.front().shape, config);
  network.initialize(batches.first_maps());
  TrainedHead trained{
      .weights = network.weights(), .best = {.auc = mean_auc(network, validation)}, .history = {}};
  trained.history.push_back(trained.best);
  bool goes_on = on_epoch(trained.best);
  for (int epoch = 1; epoch <= config.epochs && goes_on; ++epoch) {
    const double phase = std::numbers::pi * (epoch - 1) / config.epochs;
    const double rate = 0.5 * config.learning_rate * (1.0 + std::cos(phase));
    core::Random random(core::seed_of(static_cast<std::uint64_t>(config.seed), "batches",
                                      static_cast<std::uint64_t>(epoch)));
    double loss = 0.0;
    for (int i = 0; i < batches.num_batches(); ++i)
      loss += network.learn(batches.draw(random), rate);
    const HeadEpoch now{epoch, loss / batches.num_batches(), mean_auc(network, validation)};
    trained.history.push_back(now);
    if (validation.empty() || now.auc > trained.best.auc) {
      trained.best = now;
      trained.weights = network.weights();
    }
    goes_on = on_epoch(now);
  }
  return trained;
}

}  // namespace samewhere::train
