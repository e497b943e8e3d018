#include <string>
#include <string_view>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include <samewhere/core/checksum.hpp>
#include <samewhere/core/errors.hpp>
#include <samewhere/core/similarity.hpp>
#include <samewhere/describe/autoencoder.hpp>
#include <samewhere/describe/describer.hpp>
#include <samewhere/describe/hog.hpp>
#include <samewhere/describe/network_describer.hpp>
#include <samewhere/describe/preprocess.hpp>

namespace samewhere::describe {
namespace {

// Goes up when the same settings give another vector.
constexpr std::string_view kHogVersion = "hog 1\n";

// The network is not asked, so its name changes nothing.
std::uint64_t checksum_of(Config config) {
  config.network.clear();
  config.trunks.clear();
  return core::checksum(std::string(kHogVersion) + core::config_as_yaml(config));
}

void check_cells_fit(std::string_view key, int side_px, int cell_px) {
  if (side_px % cell_px == 0 && side_px >= kHogCellsPerBlock * cell_px) return;
  throw core::InputError(
      fmt::format("describe.hog.{} = {} must be a multiple of describe.hog.cell_px = {}, and at "
                  "least twice as much",
                  key, side_px, cell_px));
}

class HogDescriber : public Describer {
 public:
  explicit HogDescriber(const Config& config) : config_(config), checksum_(checksum_of(config)) {
    check_cells_fit("width_px", config.hog.width_px, config.hog.cell_px);
    check_cells_fit("height_px", config.hog.height_px, config.hog.cell_px);
  }

  core::Descriptor describe(core::FrameId frame, const cv::Mat& image) override {
    cv::Mat small;
    cv::resize(preprocess(image, config_), small,
               cv::Size(config_.hog.width_px, config_.hog.height_px), 0.0, 0.0, cv::INTER_AREA);
    return {frame, core::unit(hog(small, config_.hog.cell_px, config_.hog.weak_gradient)),
            checksum_};
  }

  std::uint64_t checksum() const override { return checksum_; }

 private:
  Config config_;
  std::uint64_t checksum_;
};

}  // namespace

std::unique_ptr<Describer> make_describer(const Config& config) {
  if (config.method == Method::kHog) return std::make_unique<HogDescriber>(config);
  if (config.method == Method::kAutoencoder) return make_autoencoder(config);
  return make_baseline(kMethodNames.at(static_cast<std::size_t>(config.method)), config);
}

}  // namespace samewhere::describe
