#pragma once

#include <memory>
#include <string>
#include <vector>

#include <samewhere/core/frame.hpp>
#include <samewhere/core/truth.hpp>
#include <samewhere/paper/methods/method.hpp>
#include <samewhere/paper/rows.hpp>
#include <samewhere/pipeline/config.hpp>

namespace samewhere::paper {

// A detector at work on a recording, with the processor time of each frame.
class TimedMethod {
 public:
  // Throws InputError as make_method() does.
  TimedMethod(std::string name, const pipeline::Config& config);

  void see(const core::Frame& frame);
  // Once, after the last frame. The truth has places.
  RecognitionRow row(const std::string& recording, const core::Truth& truth);

 private:
  std::string name_;
  int window_frames_;
  std::unique_ptr<Method> method_;
  std::vector<double> processor_ms_;
};

}  // namespace samewhere::paper
