#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include <opencv2/core/mat.hpp>

namespace samewhere::network {

enum class Colour : std::uint8_t { kGrey, kRgb, kBgr };

// How a picture becomes the input of a network: resized, then (x - mean) * scale with x in [0,
// 255], channel by channel in the order of `colour`.
struct PictureFormat {
  Colour colour = Colour::kRgb;
  cv::Size size_px;
  std::array<double, 3> mean{0.0, 0.0, 0.0};
  std::array<double, 3> scale{1.0, 1.0, 1.0};
};

// All of it, for checksums.
std::string as_text(const PictureFormat& format);

// A published network of which one layer's feature map is used.
struct TrunkSpec {
  std::string file;   // *.onnx, or *.cfg of Darknet with its *.weights beside it
  std::string layer;  // name of the layer, or of what it gives
  PictureFormat picture;
};

// MobileNetV2, SqueezeNet v1.0 and a small Darknet detector, as evaluation.md names them. `word`:
// "mobilenet", "squeezenet" or "darknet" (else ContractError).
TrunkSpec known_trunk(const std::string& word);

// The trunk's file: in `folder` (the setting describe.trunks); where that is empty in models/ of
// the program, in models/ of the working directory, or in ../models as seen from the folder
// SAMEWHERE_DATA. Throws InputError naming the file and these places.
std::filesystem::path find_trunk(const std::string& folder, const std::string& file);

// The picture, 8-bit grey or BGR, as a blob 1xCxHxW of 32-bit floats.
cv::Mat picture_blob(const cv::Mat& image, const PictureFormat& format);

// A trunk ready to run by OpenCV dnn, on one thread: the same picture gives the same bits.
class Trunk {
 public:
  Trunk() = default;
  Trunk(const Trunk&) = delete;
  Trunk& operator=(const Trunk&) = delete;
  virtual ~Trunk() = default;

  // The feature map, 1xCxHxW, of a picture, 8-bit grey or BGR. Throws InputError naming the file if
  // it cannot be run.
  virtual cv::Mat run(const cv::Mat& image) = 0;
  // Of the file's bytes (Darknet: of both files), the layer and the picture's format.
  virtual std::uint64_t checksum() const = 0;
};

// `path`: find_trunk() of spec.file. Throws InputError naming the file if it cannot be read or run,
// has no such layer, or the layer's output is no map 1xCxHxW.
std::unique_ptr<Trunk> make_trunk(const std::filesystem::path& path, const TrunkSpec& spec);

}  // namespace samewhere::network
