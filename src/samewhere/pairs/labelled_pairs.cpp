#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include <samewhere/core/checksum.hpp>
#include <samewhere/core/errors.hpp>
#include <samewhere/core/grey.hpp>
#include <samewhere/core/interrupt.hpp>
#include <samewhere/core/progress.hpp>
#include <samewhere/core/random.hpp>
#include <samewhere/describe/describer.hpp>
#include <samewhere/features/orb.hpp>
#include <samewhere/pairs/labelled_pairs.hpp>
#include <samewhere/pairs/most_alike.hpp>
#include <samewhere/pairs/other_camera.hpp>
#include <samewhere/pairs/tower.hpp>
#include <samewhere/run/open_source.hpp>
#include <samewhere/twin/studio.hpp>
#include <samewhere/twin/walkthrough.hpp>

namespace samewhere::pairs {
namespace {

constexpr int kShortlist = 10;
constexpr int kNeighbourFrames = 2;

enum class Kind { kNeither, kSame, kWrong };

// The views of a source, and what two of them are to each other.
struct KnownViews {
  std::vector<verify::SeenView> views;
  std::vector<std::vector<float>> descriptors;
  std::vector<int> queries;
  std::function<Kind(int query, int match)> kind;
};

class Viewer {
 public:
  Viewer(const pipeline::Config& config, const PairRule& rule)
      : features_(config.features),
        describer_(describe::make_describer(config.describe)),
        seed_(core::checksum(config.source)),
        other_cameras_(rule.other_cameras) {}

  void add(core::Frame frame, KnownViews& known) {
    core::Random random(core::seed_of(seed_, "camera", frame.id.value()));
    cv::Mat& image = frame.images.front();
    if (random.uniform() < other_cameras_) image = by_another_camera(image, random);
    known.views.push_back({features::extract(frame, features_), core::as_grey(image).clone()});
    known.descriptors.push_back(describer_->describe(frame.id, image).unit);
  }

 private:
  features::Config features_;
  std::unique_ptr<describe::Describer> describer_;
  std::uint64_t seed_;
  double other_cameras_;
};

void ask_every_view(KnownViews& known) {
  for (std::size_t i = 0; i < known.views.size(); ++i) known.queries.push_back(static_cast<int>(i));
}

// By place truth; `frame_of` are the frames of the views.
std::function<Kind(int, int)> kind_by_place(std::optional<core::PlaceTruthMatrix> places,
                                            std::vector<int> frame_of, int window_frames) {
  if (!places) throw core::InputError("the truth says nothing about places: expected a matrix");
  return [places = std::move(*places), frame_of = std::move(frame_of), window_frames](int query,
                                                                                      int match) {
    const int later = frame_of[static_cast<std::size_t>(query)];
    const int earlier = frame_of[static_cast<std::size_t>(match)];
    if (later - earlier <= window_frames) return Kind::kNeither;
    const core::PlaceTruth place = places.at(later, earlier);
    if (place == core::PlaceTruth::kSame) return Kind::kSame;
    return place == core::PlaceTruth::kDifferent ? Kind::kWrong : Kind::kNeither;
  };
}

// Frames in between are not rendered, nor depth, nor a second camera's pictures: nobody asks.
KnownViews views_of_twin(const pipeline::Config& config, const PairRule& rule) {
  twin::Spec spec = twin::parse_spec(config.source);
  spec.sensors = twin::Sensors::kMono;
  const twin::Walkthrough walk(spec, config.twin);
  const twin::Studio studio(walk, config.twin);
  core::Progress progress("looking at " + config.source, walk.num_frames() / rule.step);
  Viewer viewer(config, rule);
  KnownViews known;
  std::vector<int> frame_of;
  for (int index = 0; index < walk.num_frames(); index += rule.step) {
    core::stop_if_interrupted();
    core::Frame frame = walk.frame_without_pictures(index);
    frame.images = studio.pictures(index).images;
    viewer.add(std::move(frame), known);
    frame_of.push_back(index);
    progress.update(static_cast<int>(frame_of.size()));
  }
  ask_every_view(known);
  known.kind =
      kind_by_place(twin::watched_truth(walk).places, std::move(frame_of), rule.window_frames);
  return known;
}

KnownViews views_of_recording(const pipeline::Config& config, const PairRule& rule) {
  const auto source = run::open_source_with_truth(config);
  Viewer viewer(config, rule);
  KnownViews known;
  std::vector<int> frame_of;
  for (int index = 0; const auto frame = source->next(); ++index) {
    core::stop_if_interrupted();
    if (index % rule.step != 0) continue;
    viewer.add(*frame, known);
    frame_of.push_back(index);
  }
  ask_every_view(known);
  known.kind = kind_by_place(source->truth().places, std::move(frame_of), rule.window_frames);
  return known;
}

KnownViews views_of_tower(pipeline::Config config, const PairRule& rule) {
  const TowerSource tower = tower_source(config.source);
  const std::vector<TowerImage> images = read_tower(tower);
  config.source = (tower.folder / "walk.txt").string();
  const auto source = run::open_source(config);
  core::Progress progress("looking at " + config.source, static_cast<int>(images.size()));
  Viewer viewer(config, rule);
  KnownViews known;
  std::vector<int> frame_of;
  for (int index = 0; const auto frame = source->next(); ++index) {
    core::stop_if_interrupted();
    progress.update(index);
    const TowerImage& image = images[static_cast<std::size_t>(index)];
    if (!image.is_gallery || !tower.has(image.floor)) continue;
    if (known.views.size() % static_cast<std::size_t>(rule.query_step) == 0)
      known.queries.push_back(static_cast<int>(known.views.size()));
    viewer.add(*frame, known);
    frame_of.push_back(index);
  }
  known.kind = [images, frame_of](int query, int match) {
    const int frame = frame_of[static_cast<std::size_t>(query)];
    const int other = frame_of[static_cast<std::size_t>(match)];
    const TowerImage& own = images[static_cast<std::size_t>(frame)];
    const TowerImage& there = images[static_cast<std::size_t>(other)];
    if (own.floor != there.floor) return Kind::kWrong;
    const bool is_neighbour = own.clip == there.clip && std::abs(frame - other) <= kNeighbourFrames;
    return is_neighbour && query != match ? Kind::kSame : Kind::kNeither;
  };
  return known;
}

KnownViews known_views(const std::string& source, const PairRule& rule) {
  pipeline::Config config = pipeline::profile("default");
  config.source = source;
  if (is_tower(source)) return views_of_tower(config, rule);
  if (twin::is_twin_spec(source)) return views_of_twin(config, rule);
  return views_of_recording(config, rule);
}

std::vector<int> shortlist_of(int query, Kind kind, const KnownViews& known) {
  std::vector<int> offered;
  for (int match = 0; match < static_cast<int>(known.views.size()); ++match) {
    if (known.kind(query, match) == kind) offered.push_back(match);
  }
  return most_alike(known.descriptors, query, offered, kShortlist);
}

void add_pairs(int query, Kind kind, const KnownViews& known, int min_matches,
               std::vector<LabelledPair>& pairs) {
  const features::View& view = known.views[static_cast<std::size_t>(query)].view;
  for (const int match : shortlist_of(query, kind, known)) {
    const features::View& other = known.views[static_cast<std::size_t>(match)].view;
    const core::Candidate candidate{core::CandidateId(0), view.frame, other.frame};
    auto matches = verify::agreeing_matches(candidate, view, other, {});
    if (static_cast<int>(matches.size()) < min_matches) continue;
    pairs.push_back({query, match, kind == Kind::kSame, std::move(matches)});
  }
}

}  // namespace

LabelledPairs labelled_pairs(const std::string& source, const PairRule& rule) {
  KnownViews known = known_views(source, rule);
  core::Progress progress("matching " + source, static_cast<int>(known.queries.size()));
  LabelledPairs labelled;
  int num_done = 0;
  for (const int query : known.queries) {
    core::stop_if_interrupted();
    add_pairs(query, Kind::kSame, known, rule.min_matches, labelled.pairs);
    add_pairs(query, Kind::kWrong, known, rule.min_matches, labelled.pairs);
    progress.update(++num_done);
  }
  labelled.views = std::move(known.views);
  return labelled;
}

}  // namespace samewhere::pairs
