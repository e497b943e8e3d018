#include <deque>
#include <map>
#include <utility>

#include <Eigen/LU>
#include <fmt/format.h>
#include <opencv2/core/utility.hpp>

#include <samewhere/library/border.hpp>
#include <samewhere/library/convert.hpp>
#include <samewhere/library/event_log.hpp>
#include <samewhere/library/frame_intake.hpp>
#include <samewhere/library/kept_map.hpp>
#include <samewhere/library/live_pose.hpp>
#include <samewhere/library/map_content.hpp>
#include <samewhere/library/watched_slam.hpp>
#include <samewhere/run/mapped_slam.hpp>
#include <samewhere/run/open_source.hpp>
#include <samewhere/slam.hpp>

namespace samewhere {
namespace {

constexpr std::size_t kMaxEvents = 10000;

pipeline::Config config_of(const Options& options) {
  pipeline::Config config = library::config_of(options.profile, options.settings, options.prior);
  config.threads = options.threads;
  if (config.odometry.is_used()) {
    throw core::InputError("odometry.file = " + config.odometry.file +
                           ": expected none; LoopCloser takes odometry from elsewhere");
  }
  if (options.never_wait && !options.threads)
    throw core::InputError("never_wait without threads; expected threads");
  return config;
}

run::MapPlan plan_of(const Options& options) {
  if (!options.map.empty() && !options.save_to.empty()) {
    throw core::InputError(options.save_to.string() +
                           ": a session in a saved map does not make another; expected save_to or "
                           "map");
  }
  if (!options.save_to.empty() && std::filesystem::exists(options.save_to))
    throw core::InputError(options.save_to.string() + ": is there already; expected a new file");
  run::MapPlan plan{.known = options.map, .is_known_fixed = options.map_use == MapUse::kLocalize};
  if (!options.save_to.empty()) plan.begin = [path = options.save_to] { return path; };
  return plan;
}

}  // namespace

class Slam::Session {
 public:
  Session(const Calibration& calibration, const Options& options, run::Watcher* watcher)
      : calibration_(calibration),
        options_(options),
        config_(config_of(options)),
        watcher_(watcher) {
    cv::setNumThreads(1);
    begin(plan_of(options_));
  }

  Tracked track(const Frame& frame) {
    const library::Door::Call call(door_, "track()");
    door_.require_open("track()");
    if (is_finished_) throw UsageError("track(): the session is finished; reset() begins another");
    library::at_border([&] { intake_->check(frame); });
    std::vector<Event> events;
    const Tracked tracked = door_.decisive([&] {
      core::Frame taken = intake_->take(frame);
      mapped_->feed(taken);
      live_.update(mapped_->slam());
      events = log_->update(mapped_->slam());
      publish(mapped_->slam().visible_map());
      if (watcher_ != nullptr) watcher_->see_frame(taken, mapped_->slam());
      return result();
    });
    tell(std::move(events));
    return tracked;
  }

  std::vector<Event> take_events() {
    std::deque<Event> events = events_.exchange({});
    return {std::make_move_iterator(events.begin()), std::make_move_iterator(events.end())};
  }

  std::shared_ptr<const Map> map() const { return map_.get(); }

  void save(const std::filesystem::path& file) {
    const library::Door::Call call(door_, "save()");
    if (is_known_) {
      throw UsageError(
          "save(): the session began in a saved map, which grows in its own file; the session goes "
          "on");
    }
    library::at_border([&] { kept_->save(file, config_, mapped_->slam().describer_checksum()); });
  }

  void load(const std::filesystem::path& file, MapUse use) {
    const library::Door::Call call(door_, "load()");
    library::at_border([&] { begin({.known = file, .is_known_fixed = use == MapUse::kLocalize}); });
  }

  void reset() {
    const library::Door::Call call(door_, "reset()");
    library::at_border([&] { begin({}); });
  }

  void set_paused(bool is_paused, const std::string& name) {
    const library::Door::Call call(door_, name);
    door_.require_open(name);
    mapped_->set_map_fixed(is_paused);
  }

  void finish() {
    const library::Door::Call call(door_, "finish()");
    door_.require_open("finish()");
    if (is_finished_) return;
    std::optional<std::string> map_error;
    std::vector<Event> events;
    door_.decisive([&] {
      map_error = mapped_->finish();
      events = log_->finish(mapped_->slam());
      publish(mapped_->slam().map());
    });
    is_finished_ = true;
    tell(std::move(events));
    if (map_error) throw InputError("finish(): the map file lacks what came last: " + *map_error);
  }

  bool is_finished() const { return is_finished_; }

  std::vector<StampedPose> trajectory() {
    const library::Door::Call call(door_, "trajectory()");
    if (!is_finished_) throw UsageError("trajectory(): comes after finish(); the session goes on");
    std::vector<StampedPose> poses;
    const pipeline::Slam& slam = mapped_->slam();
    for (const core::StampedPose& pose : pipeline::trajectory_of(slam.map(), slam.frames()))
      poses.push_back({pose.stamp_s, library::pose_of(pose.world_from_camera)});
    return poses;
  }

 private:
  // Replaces the session; what throws leaves it as it was.
  void begin(run::MapPlan plan) {
    auto intake = std::make_unique<library::FrameIntake>(calibration_, config_);
    config_ = run::with_window_in_frames(config_, intake->info());
    auto kept = std::make_shared<library::KeptMap>();
    const bool is_known = !plan.known.empty();
    if (!is_known)
      plan.watch = [kept](const auto& map, const auto& news) { kept->note(map, news); };
    const auto depth_from =
        intake->is_without_scale() ? pipeline::DepthFrom::kMotion : pipeline::DepthFrom::kSensor;
    auto mapped =
        std::make_unique<run::MappedSlam>(config_, depth_from, run::watched(plan, watcher_));
    if (options_.never_wait) mapped->never_wait();
    mapped_ = std::move(mapped);
    kept_ = std::move(kept);
    intake_ = std::move(intake);
    live_ = {};
    log_.emplace(mapped_->slam().visible_map());
    is_known_ = is_known;
    is_finished_ = false;
    door_.reopen();
    events_.set({});
    map_.set(library::snapshot(mapped_->slam().visible_map(), mapped_->is_metric()));
    if (watcher_ != nullptr) tell_begin();
  }

  void tell_begin() {
    core::SourceInfo info = intake_->info();
    info.is_live = true;
    watcher_->begin(info, config_, !mapped_->is_metric());
  }

  void publish(const scene::MapVersion& map) {
    if (map_.get()->version() != map.number) map_.set(library::snapshot(map, mapped_->is_metric()));
  }

  void tell(std::vector<Event> events) {
    if (options_.on_event) {
      for (const Event& event : events) options_.on_event(event);
      return;
    }
    events_.with([&](std::deque<Event>& held) {
      for (Event& event : events) held.push_back(std::move(event));
      while (held.size() > kMaxEvents) held.pop_front();
    });
  }

  Tracked result() const {
    const pipeline::Slam& slam = mapped_->slam();
    const core::FramePose& newest = slam.frames().back();
    const Pose body_from_camera = calibration_.cameras[0].body_from_camera;
    Tracked tracked{.frame = newest.frame.index(),
                    .stamp_s = newest.stamp_s,
                    .status = library::status_of(newest.status),
                    .odom_from_camera = library::pose_of(live_.odom_from_body()) * body_from_camera,
                    .map_from_odom = library::pose_of(live_.map_from_odom()),
                    .num_inliers = newest.num_inliers,
                    .map_version = slam.visible_map().number};
    if (live_.provisional())
      tracked.provisional_map_from_camera =
          library::pose_of(*live_.provisional()) * body_from_camera;
    if (slam.newest().pose) tracked.covariance = slam.newest().pose->information.inverse();
    return tracked;
  }

  library::Door door_;
  Calibration calibration_;
  Options options_;
  pipeline::Config config_;
  run::Watcher* watcher_;
  std::unique_ptr<library::FrameIntake> intake_;
  library::LivePose live_;
  std::optional<library::EventLog> log_;
  core::Guarded<std::deque<Event>> events_;
  core::Guarded<std::shared_ptr<const Map>> map_;
  std::shared_ptr<library::KeptMap> kept_;
  std::unique_ptr<run::MappedSlam> mapped_;  // its threads end before what they use
  bool is_known_ = false;
  bool is_finished_ = false;
};

Slam::Slam(const Calibration& calibration, const Options& options)
    : Slam(library::at_border(
          [&] { return std::make_unique<Session>(calibration, options, nullptr); })) {}

Slam::Slam(std::unique_ptr<Session> session) : session_(std::move(session)) {}

struct SlamMaker {
  static std::unique_ptr<Slam> make(const Calibration& calibration, const Options& options,
                                    run::Watcher* watcher) {
    return std::unique_ptr<Slam>(
        new Slam(std::make_unique<Slam::Session>(calibration, options, watcher)));
  }
};

std::unique_ptr<Slam> library::watched_slam(const Calibration& calibration, const Options& options,
                                            run::Watcher* watcher) {
  return at_border([&] { return SlamMaker::make(calibration, options, watcher); });
}

Slam::~Slam() = default;

Tracked Slam::track(const Frame& frame) { return session_->track(frame); }

std::vector<Event> Slam::take_events() { return session_->take_events(); }

std::shared_ptr<const Map> Slam::map() const { return session_->map(); }

void Slam::save(const std::filesystem::path& file) const { session_->save(file); }

void Slam::load(const std::filesystem::path& file, MapUse use) { session_->load(file, use); }

void Slam::reset() { session_->reset(); }

void Slam::pause_mapping() { session_->set_paused(true, "pause_mapping()"); }

void Slam::resume_mapping() { session_->set_paused(false, "resume_mapping()"); }

void Slam::finish() { session_->finish(); }

bool Slam::is_finished() const { return session_->is_finished(); }

std::vector<StampedPose> Slam::trajectory() const { return session_->trajectory(); }

}  // namespace samewhere
