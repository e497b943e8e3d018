#pragma once

#include <memory>
#include <string>
#include <vector>

#include <opencv2/core/mat.hpp>

#include <samewhere/network/network_file.hpp>

namespace samewhere::network {

// A network ready to run on the processor, one picture at a time and on one thread: the same
// picture gives the same bits whatever else runs.
class Inference {
 public:
  Inference() = default;
  Inference(const Inference&) = delete;
  Inference& operator=(const Inference&) = delete;
  virtual ~Inference() = default;

  // `picture`: as as_blob() takes it (else ContractError). Throws InputError naming the network if
  // its output is not 1xN, or if it cannot be run.
  virtual std::vector<float> run(const cv::Mat& picture) = 0;
};

// By ONNX Runtime where this program was built with it, else by OpenCV dnn. Throws InputError
// naming the file and the backend's complaint if the backend cannot load it.
std::unique_ptr<Inference> make_inference(const NetworkFile& network);

// "OpenCV dnn 4.6.0" or "ONNX Runtime 1.20.0": what make_inference() uses.
std::string inference_backend();

}  // namespace samewhere::network
