#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include <samewhere/core/ledger.hpp>
#include <samewhere/core/timing.hpp>
#include <samewhere/describe/describer.hpp>
#include <samewhere/features/features.hpp>
#include <samewhere/pipeline/config.hpp>
#include <samewhere/pipeline/numbered_views.hpp>
#include <samewhere/retrieve/retriever.hpp>
#include <samewhere/verify/decide.hpp>
#include <samewhere/verify/measure.hpp>
#include <samewhere/verify/sequence_verifier.hpp>

namespace samewhere::pipeline {

// What odometry says of a relative pose that geometry found; nothing where there is no odometry.
using MeasureOdometry = std::function<std::optional<core::OdometryEvidence>(
    const core::Candidate& candidate, const core::Sim3& match_from_query)>;

// What an earlier loop says against it; nothing if there was none.
using MeasureRival = std::function<std::optional<core::RivalEvidence>(
    const core::Candidate& candidate, const core::Sim3& match_from_query)>;

// How far apart two candidates for one view put it; nothing unless the map knows that they show two
// places.
using MeasureOtherPlace = std::function<std::optional<core::OtherPlaceEvidence>(
    const core::LedgerRow& row, const core::LedgerRow& other)>;

// Whether the map holds the two views together already, by landmarks that both show: a loop between
// them would say nothing new.
using IsConnected = std::function<bool(core::FrameId match)>;

// Whether the map knows that two views which it holds show one place.
using AreOnePlace = std::function<bool(core::FrameId a, core::FrameId b)>;

// A view that was looked at, with the depths that the map has worked out for it by now.
using ViewOf = std::function<features::View(core::FrameId frame)>;

// What the map says to the judge.
struct MapKnowledge {
  MeasureOdometry measure_odometry;
  MeasureRival measure_rival = {};
  MeasureOtherPlace measure_other_place = {};
  IsConnected is_connected = {};   // with the view that is looked at
  AreOnePlace are_one_place = {};  // none: every view is a place of its own
  ViewOf view_of = {};  // of a camera without depth: so its views have some, each in its own scale
};

// Have I been here before? Describe the view, search those that look alike, judge each one.
class LoopDetector {
 public:
  explicit LoopDetector(const Config& config);

  // The judged candidates of this view, most similar first; the view is remembered for later ones.
  // Views that are connected with it are no candidates, and of a place that the map knows only the
  // best are. Frames ascend. The steps below, timed as "describe", "retrieve" and "verify".
  std::vector<core::LedgerRow> look(const cv::Mat& image, const features::View& view,
                                    const MapKnowledge& map, core::Timings& timings);

  // The same for a view whose place nobody knows: any remembered view may match it, however young;
  // odometry says nothing, and the view itself is not remembered.
  std::vector<core::LedgerRow> recognise(const cv::Mat& image, const features::View& view,
                                         core::Timings& timings);

  // A view of an earlier session. Frames ascend.
  void remember(const core::Descriptor& descriptor, const features::View& view);

  // Of the describer: says which network it is.
  std::uint64_t describer_checksum() const { return describer_->checksum(); }

  // Of the views that were looked at, oldest first.
  int num_descriptors() const { return retriever_.num_views(); }
  core::Descriptor descriptor(int position) const { return retriever_.view(position); }

  // The steps of look(). Each has its own state and gets the frames in order; so each may run in a
  // thread of its own, with the same result.
  core::Descriptor describe(core::FrameId frame, const cv::Mat& image);
  std::vector<retrieve::FoundView> search(const core::Descriptor& descriptor,
                                          const features::View& view);
  std::vector<core::LedgerRow> judge(const core::Descriptor& descriptor,
                                     const std::vector<core::Candidate>& candidates,
                                     const features::View& view, const MapKnowledge& map);

  // Nothing comes any more: the last verdicts on whoever still waits.
  std::vector<core::LedgerRow> settle_all() { return waiting_.settle_all(); }

 private:
  std::vector<core::Candidate> candidates_for(const core::Descriptor& descriptor,
                                              const features::View& view, const MapKnowledge& map);
  void wait_or_pause(const core::LedgerRow& row);
  // Loops of one view that show two places: the verdict on each may change.
  void hold_against_each_other(const MapKnowledge& map, std::vector<core::LedgerRow>& rows) const;
  // Beside the best candidate's match: who shows more of the same?
  void look_around(const core::Descriptor& descriptor, const features::View& view,
                   const MapKnowledge& map, std::vector<core::LedgerRow>& rows);
  // Nothing where there is no such frame, or it is too young or judged already.
  std::optional<core::Candidate> beside(const core::Candidate& candidate, int frames,
                                        const core::Descriptor& descriptor) const;
  // Candidates that no search found: what the view should show if a sequence goes on.
  std::vector<core::Candidate> foretold(const core::Descriptor& descriptor);
  core::LedgerRow judged(core::Candidate candidate, const features::View& view,
                         const MapKnowledge& map, const verify::MeasureSettings& settings);
  core::Verdict verdict_on(const core::Candidate& candidate, const features::View& view,
                           const MapKnowledge& map, const verify::MeasureSettings& settings) const;

  core::GeometryEvidence measure_geometry(const core::Candidate& candidate,
                                          const features::View& view, const ViewOf& view_of,
                                          verify::MeasureSettings settings) const;

  std::unique_ptr<describe::Describer> describer_;  // of describe()

  retrieve::Config retrieve_;  // from here on of search()
  retrieve::Retriever retriever_;

  verify::MeasureSettings settings_;       // from here on of judge()
  verify::MeasureSettings lost_settings_;  // of recognise()
  verify::MeasureSettings lost_settings_without_depth_;
  verify::History history_;
  verify::Waiting waiting_;
  std::set<std::pair<core::FrameId, core::FrameId>> was_judged_;  // where more than search is asked
  NumberedViews numbered_;
  std::uint64_t window_frames_;
  std::map<core::FrameId, features::View> views_;
  std::map<core::FrameId, std::vector<float>>
      units_;  // of descriptors, where who looks around asks
  std::uint64_t num_candidates_ = 0;
};

// The candidate of a query that ranks first: a loop before what was refused, then by verify::rank,
// of equals the more similar. Nothing of no rows.
const core::LedgerRow* best_of_query(const std::vector<core::LedgerRow>& rows,
                                     const verify::Config& config);

}  // namespace samewhere::pipeline
