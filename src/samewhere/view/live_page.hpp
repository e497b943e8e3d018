#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>
#include <opencv2/core/mat.hpp>

#include <samewhere/core/channel.hpp>
#include <samewhere/core/ledger.hpp>
#include <samewhere/report/upright.hpp>
#include <samewhere/run/watcher.hpp>
#include <samewhere/scene/map_version.hpp>
#include <samewhere/view/server.hpp>

namespace samewhere::view {

// The current image with its features.
struct LiveImage {
  core::FrameId frame;
  cv::Mat image;
  std::shared_ptr<const features::Features> features;
  std::vector<int> tracked;  // features that show a landmark
};

inline constexpr std::size_t kMaxLivePictures_bytes = 32'000'000;

// What a page is told of its run before all else.
struct LiveKind {
  std::size_t session = 0;  // how many came before it
  bool is_recognition = false;
  bool is_scale_unknown = false;
  bool may_wait = false;  // pages may let the run wait
};

// What a run has given since the pages were told. Its threads add to it and never wait for a page.
struct LiveNews {
  std::size_t first = 0;  // frames from here on are replaced
  std::vector<core::FramePose> frames;
  std::vector<std::string> names;  // of frames that were not named yet, copied or not
  std::optional<scene::MapVersion> map;
  std::optional<LiveImage> image;
  core::Ledger rows;
  std::vector<scene::Thumbnail> thumbnails;
  std::size_t num_frames = 0;
  std::string phase;
};

// How far a page has been told.
struct LiveCursor {
  std::size_t session = 0;
  bool has_start = false;
  std::size_t generation = 0;  // how often all poses were replaced
  std::size_t num_frames = 0;
  std::size_t points = 0;
  std::size_t image = 0;
  std::size_t num_candidates = 0;
  std::size_t num_pictures = 0;
  std::size_t status = 0;
};

// What the pages are told of a run, as JSON of page/README.md. Single-threaded.
class LivePage {
 public:
  LivePage(const core::SourceInfo& source, const pipeline::Config& config, const LiveKind& kind);

  void add(LiveNews news);
  // Server-sent events with all that the cursor lacks. One of an earlier session is told all.
  std::string events_for(LiveCursor& cursor) const;

 private:
  using Json = nlohmann::ordered_json;

  void add_frames(LiveNews& news);
  void replace_all_frames();
  void add_candidates(const core::Ledger& rows);
  void add_pictures(const std::vector<scene::Thumbnail>& thumbnails);
  void show_image(const LiveImage& image);
  void show_points();
  void turn_upright(const std::vector<report::FrameRecord>& records);
  std::vector<report::FrameRecord> records(std::size_t from, bool has_names) const;
  void tell_status(const LiveNews& news);
  std::string frames_event(const std::vector<report::FrameRecord>& records, std::size_t from,
                           bool has_names) const;

  std::size_t session_;
  Json start_;
  std::vector<core::FramePose> frames_;
  std::vector<std::string> names_;
  std::optional<scene::MapVersion> map_;
  report::Upright upright_;
  std::size_t upright_due_ = 0;  // when so many frames have a pose
  std::size_t generation_ = 0;
  std::string all_frames_;  // the event, made once for all pages
  std::size_t num_in_all_ = 0;
  core::Ledger ledger_;
  std::vector<std::string> candidates_;  // each verdict, in the order of its coming
  std::vector<std::string> pictures_;
  std::string points_;
  std::size_t points_version_ = 0;
  double points_due_s_ = 0.0;
  std::size_t num_keyframes_ = 0;
  std::size_t num_landmarks_ = 0;
  std::string image_;
  std::size_t image_version_ = 0;
  std::string status_;
  std::size_t status_version_ = 0;
};

}  // namespace samewhere::view
