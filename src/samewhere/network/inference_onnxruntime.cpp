// Inference by ONNX Runtime, where CMake found it.
#ifdef SAMEWHERE_ONNXRUNTIME

#include <array>

#include <fmt/format.h>
#include <onnxruntime_cxx_api.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/network/inference.hpp>

namespace samewhere::network {
namespace {

// One thread, so that the same bits come out on any number of cores.
Ort::SessionOptions one_thread() {
  Ort::SessionOptions options;
  options.SetIntraOpNumThreads(1);
  options.SetInterOpNumThreads(1);
  return options;
}

class OnnxRuntimeInference : public Inference {
 public:
  explicit OnnxRuntimeInference(const NetworkFile& network) : ends_(network) {
    std::string().swap(ends_.bytes);  // the session has its own copy of the weights
    try {
      session_ =
          Ort::Session(environment_, network.bytes.data(), network.bytes.size(), one_thread());
    } catch (const Ort::Exception& error) {
      fail("cannot read", error);
    }
  }

  std::vector<float> run(const cv::Mat& picture) override {
    const cv::Mat blob = as_blob(picture, ends_);
    try {
      return code_of(blob);
    } catch (const Ort::Exception& error) {
      fail("cannot run", error);
    }
  }

 private:
  std::vector<float> code_of(cv::Mat blob) {
    const std::array<std::int64_t, 4> shape{1, blob.size[1], blob.size[2], blob.size[3]};
    const auto memory = Ort::MemoryInfo::CreateCpu(OrtDeviceAllocator, OrtMemTypeCPU);
    const Ort::Value input = Ort::Value::CreateTensor<float>(
        memory, blob.ptr<float>(), blob.total(), shape.data(), shape.size());
    const char* const input_name = ends_.input_name.c_str();
    const char* const output_name = ends_.output_name.c_str();
    const auto outputs =
        session_.Run(Ort::RunOptions(nullptr), &input_name, &input, 1, &output_name, 1);
    const auto type = outputs.front().GetTensorTypeAndShapeInfo();
    core::require(type.GetElementType() == ONNX_TENSOR_ELEMENT_DATA_TYPE_FLOAT,
                  "the output was declared as floats");
    require_row(ends_, type.GetShape());
    const auto* values = outputs.front().GetTensorData<float>();
    return {values, values + type.GetElementCount()};
  }

  [[noreturn]] void fail(const char* what, const Ort::Exception& error) const {
    throw core::InputError(fmt::format("{}: ONNX Runtime {} this network: {}", ends_.path.string(),
                                       what, error.what()));
  }

  NetworkFile ends_;                               // without the bytes
  Ort::Env environment_{ORT_LOGGING_LEVEL_FATAL};  // what goes wrong it also throws
  Ort::Session session_{nullptr};
};

}  // namespace

std::unique_ptr<Inference> make_inference(const NetworkFile& network) {
  return std::make_unique<OnnxRuntimeInference>(network);
}

std::string inference_backend() {
  return std::string("ONNX Runtime ") + OrtGetApiBase()->GetVersionString();
}

}  // namespace samewhere::network

#endif
