#pragma once

#include <cstdint>
#include <memory>

#include <opencv2/core/mat.hpp>

#include <samewhere/core/descriptor.hpp>
#include <samewhere/describe/config.hpp>

namespace samewhere::describe {

// Image descriptor of a whole view.
class Describer {
 public:
  Describer() = default;
  Describer(const Describer&) = delete;
  Describer& operator=(const Describer&) = delete;
  virtual ~Describer() = default;

  // `image` as it came from the camera: 8-bit grey or BGR, any size from 1x1 (else ContractError).
  // The vector has length 1, or is all zero for a view without structure.
  virtual core::Descriptor describe(core::FrameId frame, const cv::Mat& image) = 0;
  // Differs between any two describers whose vectors cannot be compared: method, version, every
  // setting that bears on it, and the network's weights.
  virtual std::uint64_t checksum() const = 0;
};

// By config.method. Throws InputError on settings that do not fit each other, and on a network that
// cannot be used (autoencoder.hpp).
std::unique_ptr<Describer> make_describer(const Config& config);

}  // namespace samewhere::describe
