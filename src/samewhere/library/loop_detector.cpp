#include <utility>

#include <opencv2/core/utility.hpp>

#include <samewhere/features/orb.hpp>
#include <samewhere/library/border.hpp>
#include <samewhere/library/convert.hpp>
#include <samewhere/library/pictures.hpp>
#include <samewhere/loop_detector.hpp>
#include <samewhere/pipeline/loop_detector.hpp>
#include <samewhere/pipeline/verifier_settings.hpp>
#include <samewhere/run/open_source.hpp>

namespace samewhere {
namespace {

pipeline::Config config_of(const std::vector<std::string>& settings, std::optional<Prior> prior,
                           double frame_rate_hz) {
  pipeline::Config config = library::config_of("recognition", settings, prior);
  config.verify.require_pose = false;  // there is no map that could use one
  return run::with_window_in_frames(std::move(config), {.frame_rate_hz = frame_rate_hz});
}

std::vector<LoopVerdict> verdicts_of(const std::vector<core::LedgerRow>& rows) {
  std::vector<LoopVerdict> verdicts;
  for (const core::LedgerRow& row : rows) verdicts.push_back(library::verdict_of(row));
  return verdicts;
}

}  // namespace

class LoopDetector::Session {
 public:
  explicit Session(const pipeline::Config& config)
      : config_(config), detector_(config, pipeline::recognition_settings(config)) {
    cv::setNumThreads(1);
  }

  std::vector<LoopVerdict> add(const Image& image) {
    const library::Door::Call call(door_, "add()");
    door_.require_open("add()");
    if (is_finished_) throw UsageError("add(): the session is finished");
    library::at_border([&] { library::check_image("image", image, false); });
    return door_.decisive([&] {
      const core::Frame frame{.id = core::FrameId(num_images_),
                              .stamp_s = static_cast<double>(num_images_),
                              .rig = rig_,
                              .images = {library::picture_of(image)}};
      ++num_images_;
      const core::Descriptor descriptor = detector_.index().describe(frame.id, frame.images[0]);
      const features::View view = features::extract(frame, config_.features);
      const auto found = detector_.index().search(descriptor, view);
      return verdicts_of(detector_.verify(descriptor, retrieve::compare(descriptor, found), view,
                                          verify::WithoutMap()));
    });
  }

  std::vector<LoopVerdict> finish() {
    const library::Door::Call call(door_, "finish()");
    door_.require_open("finish()");
    if (std::exchange(is_finished_, true)) return {};
    return door_.decisive([&] { return verdicts_of(detector_.settle_all()); });
  }

 private:
  library::Door door_;
  pipeline::Config config_;
  pipeline::LoopDetector detector_;
  std::shared_ptr<const core::Rig> rig_ = std::make_shared<const core::Rig>();
  std::uint64_t num_images_ = 0;
  bool is_finished_ = false;
};

LoopDetector::LoopDetector(const std::vector<std::string>& settings, std::optional<Prior> prior,
                           double frame_rate_hz)
    : session_(library::at_border(
          [&] { return std::make_unique<Session>(config_of(settings, prior, frame_rate_hz)); })) {}

LoopDetector::~LoopDetector() = default;

std::vector<LoopVerdict> LoopDetector::add(const Image& image) { return session_->add(image); }

std::vector<LoopVerdict> LoopDetector::finish() { return session_->finish(); }

}  // namespace samewhere
