#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include <samewhere/report/funnel.hpp>
#include <samewhere/report/jpeg.hpp>
#include <samewhere/report/packed.hpp>
#include <samewhere/report/page_parts.hpp>
#include <samewhere/report/page_points.hpp>
#include <samewhere/run/candidate_matches.hpp>
#include <samewhere/run/map_export.hpp>
#include <samewhere/view/live_page.hpp>

namespace samewhere::view {
namespace {

constexpr std::size_t kMaxLivePoints = 60'000;
constexpr std::size_t kMaxLiveCandidates = 20'000;
constexpr int kImageWidth_px = 480;
constexpr double kPointsPeriod_s = 1.5;
constexpr double kCostShare = 0.05;  // of one processor, at most, for landmarks
constexpr std::size_t kFirstUpright = 8;

double seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

std::string event(const char* name, const std::string& json) {
  return fmt::format("event: {}\ndata: {}\n\n", name, json);
}
std::string event(const char* name, const nlohmann::ordered_json& json) {
  return event(name, report::json_for_script(json));
}

std::uint16_t share_of(float value, int extent) {
  const float share = std::clamp(value / static_cast<float>(std::max(1, extent)), 0.0F, 1.0F);
  return static_cast<std::uint16_t>(std::lround(65535.0F * share));
}

std::string image_json(const LiveImage& image) {
  std::vector<std::uint16_t> shares;
  std::vector<std::uint8_t> are_tracked;
  if (image.features) {
    for (const Eigen::Vector2f& at : image.features->raw_px) {
      shares.push_back(share_of(at.x(), image.image.cols));
      shares.push_back(share_of(at.y(), image.image.rows));
    }
    are_tracked.assign(image.features->raw_px.size(), 0);
    for (const int feature : image.tracked) are_tracked.at(static_cast<std::size_t>(feature)) = 1;
  }
  return report::json_for_script(
      {{"frame", image.frame.index()},
       {"jpeg_base64", report::base64(report::jpeg_bytes(image.image, kImageWidth_px))},
       {"shares", report::packed(shares, 2)},
       {"are_tracked", report::packed(are_tracked)}});
}

}  // namespace

LivePage::LivePage(const core::SourceInfo& source, const pipeline::Config& config,
                   const LiveKind& kind)
    : session_(kind.session),
      start_({{"title", source.name},
              {"source", config.source},
              {"is_recognition", kind.is_recognition},
              {"is_scale_unknown", kind.is_scale_unknown},
              {"may_wait", kind.may_wait},
              {"num_expected", source.num_frames},
              {"status_names", report::page_status_names()},
              {"limits", report::page_limits(run::score_limits(config.verify))},
              {"config_yaml", core::config_as_yaml(config)}}) {}

void LivePage::add(LiveNews news) {
  std::move(news.names.begin(), news.names.end(), std::back_inserter(names_));
  add_candidates(news.rows);
  add_pictures(news.thumbnails);
  add_frames(news);
  if (map_ && seconds() >= points_due_s_) show_points();
  if (news.image) show_image(*news.image);
  if (news.num_frames > 0) tell_status(news);
}

void LivePage::add_frames(LiveNews& news) {
  if (news.frames.empty()) return;
  frames_.resize(std::min(frames_.size(), news.first));
  std::move(news.frames.begin(), news.frames.end(), std::back_inserter(frames_));
  if (!news.map) return;
  map_ = std::move(news.map);
  replace_all_frames();
}

void LivePage::replace_all_frames() {
  const std::vector<report::FrameRecord> all = records(0, false);
  turn_upright(all);
  all_frames_ = frames_event(all, 0, false);
  num_in_all_ = all.size();
  ++generation_;
}

// The world turns on the page whenever twice as many poses tell which way is up.
void LivePage::turn_upright(const std::vector<report::FrameRecord>& records) {
  std::vector<core::Rigid3> poses;
  for (const report::FrameRecord& record : records)
    if (const auto pose = report::finite_pose(record)) poses.push_back(*pose);
  if (poses.size() < upright_due_) return;
  upright_ = report::upright_of(poses);
  upright_due_ = std::max(kFirstUpright, 2 * poses.size());
}

std::vector<report::FrameRecord> LivePage::records(std::size_t from, bool has_names) const {
  std::vector<report::FrameRecord> records;
  for (std::size_t i = from; i < frames_.size(); ++i) {
    const core::FramePose& pose = frames_[i];
    report::FrameRecord record{pose, has_names && i < names_.size() ? names_[i] : "", std::nullopt};
    // a map that was discarded may have had more keyframes
    const bool is_in_map =
        map_ && pose.is_measured && pose.reference_keyframe.index() < map_->keyframes.size();
    if (is_in_map) record.world_from_camera = pipeline::world_from_camera(*map_, pose);
    records.push_back(std::move(record));
  }
  return records;
}

std::string LivePage::frames_event(const std::vector<report::FrameRecord>& records,
                                   std::size_t from, bool has_names) const {
  const report::PageClock clock(frames_.empty() ? 0.0 : frames_.front().stamp_s);
  Json json = report::page_frames(records, clock);
  json["from"] = from;
  if (!has_names) json.erase("names");
  if (from == 0) json["upright"] = report::page_upright(upright_);
  return event("frames", json);
}

void LivePage::add_candidates(const core::Ledger& rows) {
  for (const core::LedgerRow& row : rows) {
    ledger_.push_back(row);
    if (candidates_.size() < kMaxLiveCandidates)
      candidates_.push_back(report::json_for_script(report::page_candidate(row)));
  }
}

void LivePage::add_pictures(const std::vector<scene::Thumbnail>& thumbnails) {
  for (const scene::Thumbnail& thumbnail : thumbnails) {
    pictures_.push_back(report::json_for_script({{"frame", thumbnail.frame.index()},
                                                 {"session", thumbnail.frame.session()},
                                                 {"jpeg_base64", report::base64(thumbnail.jpeg)}}));
  }
}

void LivePage::show_image(const LiveImage& image) {
  image_ = event("image", image_json(image));
  ++image_version_;
}

void LivePage::show_points() {
  const double begin_s = seconds();
  points_ = event("points", report::page_points(run::points_of(*map_), kMaxLivePoints));
  ++points_version_;
  num_keyframes_ = num_live(map_->keyframes);
  num_landmarks_ = num_live(map_->landmarks);
  const double end_s = seconds();
  points_due_s_ = end_s + std::max(kPointsPeriod_s, (end_s - begin_s) / kCostShare);
}

void LivePage::tell_status(const LiveNews& news) {
  status_ = event("status", Json{{"num_frames", news.num_frames},
                                 {"phase", news.phase},
                                 {"num_keyframes", num_keyframes_},
                                 {"num_landmarks", num_landmarks_},
                                 {"num_candidates", report::final_rows(ledger_).size()},
                                 {"checks", report::page_checks(ledger_)}});
  ++status_version_;
}

std::string LivePage::events_for(LiveCursor& cursor) const {
  if (cursor.session != session_) cursor = {.session = session_};
  std::string text;
  if (!cursor.has_start) text += event("start", start_);
  if (!cursor.has_start && !frames_.empty()) {
    text += frames_event(records(0, true), 0, true);
    cursor.num_frames = frames_.size();
  } else if (cursor.generation != generation_) {
    text += all_frames_;
    cursor.num_frames = num_in_all_;
  }
  cursor.has_start = true;
  cursor.generation = generation_;
  if (cursor.num_frames < frames_.size())
    text += frames_event(records(cursor.num_frames, true), cursor.num_frames, true);
  cursor.num_frames = frames_.size();
  const auto add_list = [&](const char* name, const std::vector<std::string>& all,
                            std::size_t& num) {
    if (num < all.size())
      text +=
          event(name, fmt::format("[{}]", fmt::join(all.begin() + static_cast<std::ptrdiff_t>(num),
                                                    all.end(), ",")));
    num = all.size();
  };
  add_list("pictures", pictures_, cursor.num_pictures);
  add_list("candidates", candidates_, cursor.num_candidates);
  const auto add_newest = [&](const std::string& newest, std::size_t version, std::size_t& told) {
    if (told != version) text += newest;
    told = version;
  };
  add_newest(points_, points_version_, cursor.points);
  add_newest(status_, status_version_, cursor.status);
  add_newest(image_, image_version_, cursor.image);
  return text;
}

}  // namespace samewhere::view
