#pragma once

#include <memory>
#include <optional>
#include <string>

#include <samewhere/core/channel.hpp>
#include <samewhere/report/html.hpp>
#include <samewhere/run/watcher.hpp>
#include <samewhere/view/live_page.hpp>
#include <samewhere/view/pace.hpp>
#include <samewhere/view/server.hpp>

namespace samewhere::view {

// Shows a run in browsers while it goes on: SLAM, recognition, or the sessions of a node. A page
// that grows, and where finish() is called the report at the end. Costs the run next to nothing
// while no page is open. A page may let a recording wait; when the last page is closed, it goes on.
class LiveView : public run::Watcher {
 public:
  // Serves at once. Throws InputError if the place cannot be served. A place that other
  // machines reach gets a token if `token` is empty.
  LiveView(const Place& place, const std::string& token);
  ~LiveView() override;

  std::string url() const { return server_->url(); }
  int num_pages() const { return server_->num_streams(); }

  void begin(const core::SourceInfo& source, const pipeline::Config& config,
             bool is_scale_unknown) override;
  void see_frame(const core::Frame& frame, const pipeline::Slam& slam) override;
  void begin_recognition(const core::SourceInfo& source, const pipeline::Config& config) override;
  void see_judged_frame(const core::Frame& frame, const features::View& view,
                        const core::Ledger& rows) override;
  void see_thumbnails(const std::vector<scene::Thumbnail>& thumbnails) override;

  // The run has ended: pages show its report.
  void finish(const report::PageBlocks& blocks);
  // Returns when no page is open any more, or at Ctrl-C.
  void wait_for_pages();

 private:
  Routes routes();
  NextEvents open_stream();
  std::string next_events(LiveCursor& cursor);
  Answer control(const std::string& body);
  void begin_session(const core::SourceInfo& source, const pipeline::Config& config, LiveKind kind);
  void note(const std::string& name, const core::Ledger& rows);
  bool is_copy_due() const;
  void copy(const core::Frame& frame, const pipeline::Slam& slam);
  void wait(double stamp_s);
  bool is_page_gone();

  core::Guarded<LiveNews> news_;
  std::size_t num_picture_bytes_ = 0;  // of the session; under the lock of news_
  core::Guarded<std::optional<LivePage>> page_;
  Page live_html_;
  core::Guarded<Page> report_;    // once the run has ended
  core::Guarded<bool> may_wait_;  // a recording, as fast as it is asked for
  Pace pace_;
  // of the run's thread
  std::size_t num_sessions_ = 0;
  std::size_t num_copied_ = 0;
  double copy_due_s_ = 0.0;
  double full_copy_due_s_ = 0.0;
  double last_page_s_ = 0.0;
  core::Channel<int> never_{1};
  std::unique_ptr<Server> server_;  // last: its threads use the others
};

}  // namespace samewhere::view
