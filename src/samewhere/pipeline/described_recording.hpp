#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <samewhere/core/descriptor.hpp>
#include <samewhere/core/truth.hpp>
#include <samewhere/describe/describer.hpp>
#include <samewhere/pipeline/config.hpp>

namespace samewhere::pipeline {

// A describer under the name that tables give it.
struct NamedDescriber {
  std::string name;
  std::shared_ptr<describe::Describer> describer;
};

// "hog", an ONNX file, or several separated by commas; empty: the one of the config. A network is
// called by its file, without folder and extension. Throws InputError on a network that cannot be
// used, and on two describers of one name.
std::vector<NamedDescriber> make_describers(const std::string& list, const Config& config);

// The config for "SOURCE", "SOURCE@149" or "SOURCE@10s": a recording or a twin building, and the
// window of its protocol in frames or seconds, instead of the config's. Throws InputError on a
// window that is out of range.
Config with_source(Config config, const std::string& source_at_window);

// All views of a recording as one describer sees them.
struct DescribedViews {
  std::string describer;
  std::vector<core::Descriptor> views;  // one a frame, in their order
  std::vector<double> durations_ms;     // of preprocessing and description
};

// A recording whose loops are known.
struct DescribedRecording {
  std::string name;
  int window_frames = 0;
  core::Truth truth;  // has places
  std::vector<DescribedViews> by_describer;
};

// Throws InputError naming the source if it cannot be opened or its truth says nothing about
// places. Reads no frame.
void require_place_truth(const Config& config);

// Reads the source that the config names once and describes each frame by each describer, with a
// progress line on stderr. Nothing after Ctrl-C. Throws InputError as require_place_truth(), and on
// a bad frame.
std::optional<DescribedRecording> describe_recording(const Config& config,
                                                     const std::vector<NamedDescriber>& describers);

}  // namespace samewhere::pipeline
