#include <algorithm>
#include <cstdlib>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <opencv2/dnn.hpp>
#include <opencv2/imgproc.hpp>

#include <samewhere/core/checksum.hpp>
#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>
#include <samewhere/core/grey.hpp>
#include <samewhere/core/model_file.hpp>
#include <samewhere/network/opencv_errors.hpp>
#include <samewhere/network/trunk.hpp>

namespace samewhere::network {
namespace {

// Goes up when the same file and format give another map.
constexpr std::string_view kTrunkVersion = "trunk 1";

constexpr const char* kWhatTrunksAre =
    "a published network, which is not part of samewhere (src/samewhere/describe/README.md)";

std::filesystem::path weights_of(std::filesystem::path cfg) {
  return cfg.replace_extension(".weights");
}

bool is_darknet(const std::filesystem::path& path) { return path.extension() == ".cfg"; }

cv::Mat resized(const cv::Mat& image, cv::Size size_px) {
  const bool is_shrunk = size_px.width <= image.cols && size_px.height <= image.rows;
  cv::Mat result;
  cv::resize(image, result, size_px, 0.0, 0.0, is_shrunk ? cv::INTER_AREA : cv::INTER_LINEAR);
  return result;
}

cv::dnn::Net net_of(const std::filesystem::path& path, const std::string& bytes,
                    const std::string& weights) {
  return is_darknet(path) ? cv::dnn::readNetFromDarknet(bytes.data(), bytes.size(), weights.data(),
                                                        weights.size())
                          : cv::dnn::readNetFromONNX(bytes.data(), bytes.size());
}

class OpenCvTrunk : public Trunk {
 public:
  OpenCvTrunk(std::filesystem::path path, const TrunkSpec& spec)
      : path_(std::move(path)), spec_(spec) {
    const std::string bytes = core::read_file(path_, core::kNetworkLimit);
    const std::string weights =
        is_darknet(path_) ? core::read_file(weights_of(path_), core::kNetworkLimit) : "";
    checksum_ =
        core::checksum(fmt::format("{} {:016x} {:016x} {} {}", kTrunkVersion, core::checksum(bytes),
                                   core::checksum(weights), spec.layer, as_text(spec.picture)));
    const QuietOpenCv quiet;
    try {
      net_ = net_of(path_, bytes, weights);
      net_.setPreferableBackend(cv::dnn::DNN_BACKEND_OPENCV);
      net_.setPreferableTarget(cv::dnn::DNN_TARGET_CPU);
    } catch (const std::exception& error) {
      fail("cannot read", error);
    }
    layer_ = layer_named(spec.layer);
    // what it cannot run it says here, while it is quiet
    run(cv::Mat(spec.picture.size_px, CV_8UC3, cv::Scalar(90, 120, 150)));
  }

  cv::Mat run(const cv::Mat& image) final {
    cv::Mat map;
    try {
      net_.setInput(picture_blob(image, spec_.picture));
      map = net_.forward(layer_).clone();  // the net writes into its own again
    } catch (const std::exception& error) {
      fail("cannot run", error);
    }
    if (map.dims != 4 || map.size[0] != 1 || map.type() != CV_32FC1) {
      throw core::InputError(
          fmt::format("{}: layer {} gives {} dimensions; expected a feature map of floats, 1xCxHxW",
                      path_.string(), spec_.layer, map.dims));
    }
    return map;
  }

  std::uint64_t checksum() const final { return checksum_; }

 private:
  // OpenCV puts words of its own before the names of ONNX: "onnx_node_output_0!n61".
  std::string layer_named(const std::string& wanted) const {
    for (const std::string& name : net_.getLayerNames())
      if (name == wanted || name.ends_with("!" + wanted)) return name;
    throw core::InputError(fmt::format("{}: has no layer {}; expected the network that {} names",
                                       path_.string(), wanted, spec_.file));
  }

  [[noreturn]] void fail(const char* what, const std::exception& error) const {
    throw core::InputError(
        fmt::format("{}: OpenCV {} this network: {}", path_.string(), what, reason_of(error)));
  }

  std::filesystem::path path_;
  TrunkSpec spec_;
  std::uint64_t checksum_ = 0;
  cv::dnn::Net net_;
  std::string layer_;
};

}  // namespace

std::string reason_of(const std::exception& error) {
  const auto* const known = dynamic_cast<const cv::Exception*>(&error);
  std::string reason = known != nullptr ? known->err : error.what();
  std::replace_if(
      reason.begin(), reason.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
  return reason;
}

std::string as_text(const PictureFormat& format) {
  return fmt::format("{} {}x{} {} {}", static_cast<int>(format.colour), format.size_px.width,
                     format.size_px.height, fmt::join(format.mean, " "),
                     fmt::join(format.scale, " "));
}

TrunkSpec known_trunk(const std::string& word) {
  if (word == "mobilenet") {
    constexpr double kHalf = 127.5;
    return {"mobilenet_v2.onnx",
            "n61_a",
            {.colour = Colour::kRgb,
             .size_px = {320, 256},
             .mean = {kHalf, kHalf, kHalf},
             .scale = {1.0 / kHalf, 1.0 / kHalf, 1.0 / kHalf}}};
  }
  if (word == "squeezenet") {
    return {"squeezenet_v1.onnx",
            "/Concat_7",
            {.colour = Colour::kBgr, .size_px = {227, 227}, .mean = {104.0, 117.0, 123.0}}};
  }
  core::require(word == "darknet", "a trunk is one of three");
  constexpr double kScale = 1.0 / 255.0;
  return {"yolo-fastest-1.1-xl.cfg",
          "leaky_106",
          {.colour = Colour::kRgb, .size_px = {320, 320}, .scale = {kScale, kScale, kScale}}};
}

std::filesystem::path find_trunk(const std::string& folder, const std::string& file) {
  std::vector<std::filesystem::path> places{folder};
  if (folder.empty()) {
    places = {core::models_folder(), "models"};
    if (const char* const data = std::getenv("SAMEWHERE_DATA"); data != nullptr && *data != '\0')
      places.push_back(std::filesystem::path(data) / ".." / "models");
  }
  std::vector<std::string> names;
  for (const std::filesystem::path& place : places) {
    if (core::is_there(place / file)) return place / file;
    names.push_back(place.string());
  }
  throw core::InputError(fmt::format("describe.trunks: there is no {} in {}; expected {}", file,
                                     fmt::join(names, ", "), kWhatTrunksAre));
}

cv::Mat picture_blob(const cv::Mat& image, const PictureFormat& format) {
  core::require(!image.empty() && (image.type() == CV_8UC1 || image.type() == CV_8UC3),
                "a view to describe is 8-bit grey or BGR");
  const int num_channels = format.colour == Colour::kGrey ? 1 : 3;
  cv::Mat picture = num_channels == 1 ? core::as_grey(image) : image;
  if (picture.channels() < num_channels) cv::cvtColor(picture, picture, cv::COLOR_GRAY2BGR);
  picture = resized(picture, format.size_px);
  const int shape[] = {1, num_channels, picture.rows, picture.cols};
  cv::Mat blob(4, shape, CV_32FC1);
  for (int channel = 0; channel < num_channels; ++channel) {
    const int from = format.colour == Colour::kRgb ? 2 - channel : channel;
    const double mean = format.mean[static_cast<std::size_t>(channel)];
    const double scale = format.scale[static_cast<std::size_t>(channel)];
    cv::Mat plane;
    cv::extractChannel(picture, plane, from);
    cv::Mat target(picture.size(), CV_32FC1, blob.ptr<float>(0, channel));
    plane.convertTo(target, CV_32F, scale, -mean * scale);
  }
  return blob;
}

std::unique_ptr<Trunk> make_trunk(const std::filesystem::path& path, const TrunkSpec& spec) {
  return std::make_unique<OpenCvTrunk>(path, spec);
}

}  // namespace samewhere::network
