#include <algorithm>
#include <chrono>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/interrupt.hpp>
#include <samewhere/report/page_parts.hpp>
#include <samewhere/view/live_view.hpp>

namespace samewhere::view {
namespace {

constexpr double kCopyPeriod_s = 0.15;     // of new frames and the image
constexpr double kFullCopyPeriod_s = 1.0;  // of all poses and the map
constexpr double kFullCopyShare = 0.01;    // of the run's thread, at most
constexpr double kReload_s = 10.0;         // for a page that is opened once more
constexpr double kLookForPages_s = 0.1;

double steady_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

const char* name_of_phase(pipeline::SessionPhase phase) {
  constexpr const char* kNames[] = {"initializing", "tracking",    "weak",
                                    "lost",         "relocalized", "provisional"};
  return kNames[static_cast<int>(phase)];
}

std::string token_for(const Place& place, const std::string& token) {
  return token.empty() && !is_on_this_machine(place) ? random_token() : token;
}

}  // namespace

LiveView::LiveView(const Place& place, const std::string& token)
    : live_html_(std::make_shared<const std::string>(
          report::served_html({.title = "samewhere"}, R"({"mode":"live"})"))),
      server_(std::make_unique<Server>(place, token_for(place, token), routes())) {}

LiveView::~LiveView() = default;

Routes LiveView::routes() {
  Routes routes;
  routes.pages["/"] = [this] {
    const Page report = report_.get();
    return report ? report : live_html_;
  };
  routes.streams["/events"] = [this] { return open_stream(); };
  routes.actions["/control"] = [this](const std::string& body) { return control(body); };
  return routes;
}

void LiveView::begin(const core::SourceInfo& source, const pipeline::Config& config,
                     bool is_scale_unknown) {
  begin_session(source, config, {.is_scale_unknown = is_scale_unknown});
}

void LiveView::begin_recognition(const core::SourceInfo& source, const pipeline::Config& config) {
  begin_session(source, config, {.is_recognition = true});
}

void LiveView::begin_session(const core::SourceInfo& source, const pipeline::Config& config,
                             LiveKind kind) {
  kind.session = num_sessions_++;
  kind.may_wait = !source.is_live && !config.input.realtime;
  may_wait_.set(kind.may_wait);
  num_copied_ = 0;
  copy_due_s_ = full_copy_due_s_ = 0.0;
  page_.with([&](auto& page) {
    news_.with([this](LiveNews& news) {
      news = {};
      num_picture_bytes_ = 0;
      return 0;
    });
    page.emplace(source, config, kind);
    return 0;
  });
}

void LiveView::note(const std::string& name, const core::Ledger& rows) {
  news_.with([&](LiveNews& news) {
    news.names.push_back(name);
    news.rows.insert(news.rows.end(), rows.begin(), rows.end());
    return 0;
  });
}

bool LiveView::is_copy_due() const {
  return num_pages() > 0 && (pace_.get().is_paused || steady_s() >= copy_due_s_);
}

void LiveView::wait(double stamp_s) {
  if (may_wait_.get()) pace_.wait(stamp_s, [this] { return is_page_gone(); });
}

void LiveView::see_frame(const core::Frame& frame, const pipeline::Slam& slam) {
  note(frame.name, slam.newest_rows());
  if (is_copy_due()) copy(frame, slam);
  wait(frame.stamp_s);
}

void LiveView::see_judged_frame(const core::Frame& frame, const features::View& view,
                                const core::Ledger& rows) {
  note(frame.name, rows);
  if (is_copy_due()) {
    news_.with([&](LiveNews& news) {
      news.image = LiveImage{frame.id, frame.images.at(0), view.features, {}};
      news.num_frames = frame.id.index() + 1;
      news.phase = "recognition";
      return 0;
    });
    copy_due_s_ = steady_s() + kCopyPeriod_s;
  }
  wait(frame.stamp_s);
}

// All poses now and then: relocalization, initialization and corrections change older ones.
void LiveView::copy(const core::Frame& frame, const pipeline::Slam& slam) {
  const double begin_s = steady_s();
  const bool is_full = begin_s >= full_copy_due_s_;
  const auto& frames = slam.frames();
  const std::size_t from = is_full ? 0 : std::min(num_copied_, frames.size());
  news_.with([&](LiveNews& news) {
    if (is_full || news.frames.empty()) {
      news.first = from;
      news.frames.clear();
    }
    news.frames.insert(news.frames.end(), frames.begin() + static_cast<std::ptrdiff_t>(from),
                       frames.end());
    if (is_full) news.map = slam.visible_map();
    news.image = LiveImage{frame.id, frame.images.at(0), slam.newest().features,
                           slam.newest().tracked_features};
    news.num_frames = frames.size();
    news.phase = name_of_phase(slam.phase());
    return 0;
  });
  num_copied_ = frames.size();
  const double end_s = steady_s();
  copy_due_s_ = end_s + kCopyPeriod_s;
  if (is_full)
    full_copy_due_s_ = end_s + std::max(kFullCopyPeriod_s, (end_s - begin_s) / kFullCopyShare);
}

void LiveView::see_thumbnails(const std::vector<scene::Thumbnail>& thumbnails) {
  if (thumbnails.empty()) return;
  news_.with([&](LiveNews& news) {
    for (const scene::Thumbnail& thumbnail : thumbnails) {
      if (num_picture_bytes_ > kMaxLivePictures_bytes) break;
      num_picture_bytes_ += thumbnail.jpeg.size();
      news.thumbnails.push_back(thumbnail);
    }
    return 0;
  });
}

// A run that waits for a page that is closed would wait for ever.
bool LiveView::is_page_gone() {
  if (core::is_interrupted()) return true;
  if (num_pages() > 0) last_page_s_ = steady_s();
  if (steady_s() - last_page_s_ < kReload_s) return false;
  pace_.set({});
  return true;
}

NextEvents LiveView::open_stream() {
  return [this, cursor = LiveCursor{}, is_end_told = false,
          wish = std::string()]() mutable -> std::optional<std::string> {
    if (report_.get()) {
      if (std::exchange(is_end_told, true)) return "";
      return "event: finished\ndata: {}\n\n";
    }
    std::string text = next_events(cursor);
    const PaceWish now = pace_.get();
    const std::string told =
        fmt::format(R"({{"is_paused":{},"speed":{}}})", now.is_paused, now.speed);
    if (cursor.has_start && std::exchange(wish, told) != told)
      text += fmt::format("event: pace\ndata: {}\n\n", told);
    return text;
  };
}

std::string LiveView::next_events(LiveCursor& cursor) {
  return page_.with([&](std::optional<LivePage>& page) {
    if (!page) return std::string();
    page->add(news_.exchange({}));
    return page->events_for(cursor);
  });
}

Answer LiveView::control(const std::string& body) {
  if (!may_wait_.get())
    throw core::InputError("a live camera, or a recording that is played, does not wait");
  try {
    const auto wish = nlohmann::json::parse(body);
    if (wish.value("step", false)) {
      pace_.step();
      return {200, "{}"};
    }
    PaceWish now = pace_.get();
    now.is_paused = wish.value("is_paused", now.is_paused);
    now.speed = std::clamp(wish.value("speed", now.speed), 0.0, 100.0);
    now.num_steps = 0;
    pace_.set(now);
    return {200, "{}"};
  } catch (const nlohmann::json::exception&) {
    throw core::InputError(R"(expected {"is_paused": true}, {"step": true} or {"speed": 0.5})");
  }
}

void LiveView::finish(const report::PageBlocks& blocks) {
  report_.set(
      std::make_shared<const std::string>(report::served_html(blocks, R"({"mode":"finished"})")));
}

void LiveView::wait_for_pages() {
  if (num_pages() == 0) return;
  last_page_s_ = steady_s();
  while (!is_page_gone()) never_.is_open_for(kLookForPages_s);
}

}  // namespace samewhere::view
