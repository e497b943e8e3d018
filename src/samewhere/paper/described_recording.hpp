#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <samewhere/core/descriptor.hpp>
#include <samewhere/core/frame.hpp>
#include <samewhere/core/source.hpp>
#include <samewhere/core/truth.hpp>
#include <samewhere/describe/describer.hpp>
#include <samewhere/pipeline/config.hpp>

namespace samewhere::paper {

// A describer under the name that tables give it.
struct NamedDescriber {
  std::string name;
  std::shared_ptr<describe::Describer> describer;
};

// The name of the published method among the describers: the one that the config has.
inline constexpr const char* kPaperMethod = "paper";

// By a word: "paper" is the describer of the config; else the name of a method of describe, but for
// "autoencoder"; or an ONNX file, which is called by its name without folder and extension. Throws
// InputError on a network that cannot be used.
NamedDescriber make_named_describer(const std::string& word, const pipeline::Config& config);

// The config for "SOURCE", "SOURCE@149" or "SOURCE@10s": a recording or a twin building, and the
// window of its protocol in frames or seconds, instead of the config's. Without a window, and for
// the tolerance of its truth, a known data set has those of its protocol (protocols.hpp). Throws
// InputError on a window that is out of range.
pipeline::Config with_source(pipeline::Config config, const std::string& source_at_window);

// How tables call the sequence of a config: a folder's name, or what a twin building was asked for.
std::string recording_name(const pipeline::Config& config);

// What files on this sequence are called: name and window, in letters, digits and -_. only.
std::string file_stem(const pipeline::Config& config);

// A recording whose loops are known, open and not yet read.
struct OpenRecording {
  pipeline::Config config;  // with its window in frames
  std::string name;
  int num_frames = 0;
  std::unique_ptr<core::Source> source;
  core::Truth truth;  // has places
};

// Opens the source, and has its truth: what a twin building has to compute for that is computed
// now; where nothing but depth and true poses tells of places, all depth is read for it. Throws
// InputError naming the source if it cannot be opened or its truth says nothing about places;
// Interrupted after Ctrl-C.
OpenRecording open_recording(const pipeline::Config& config);

// All views of a recording as one describer sees them.
struct DescribedViews {
  std::string describer;
  std::uint64_t checksum = 0;           // of the describer
  std::vector<core::Descriptor> views;  // one a frame, in their order
  std::vector<double> durations_ms;     // of preprocessing and description of the timed frames
};

// A recording that was read.
struct DescribedRecording {
  std::string name;
  int window_frames = 0;
  core::Truth truth;              // has places
  std::vector<int> timed_frames;  // ascending
  std::vector<DescribedViews> by_describer;
};

using SeeFrame = std::function<void(const core::Frame& frame)>;

// Reads the recording and describes each frame by each describer, with a progress line on stderr;
// `also_see` is shown each frame once, in their order, meanwhile and by another thread.
// Descriptions are timed after that, when reading and rendering have ended: those of up to 400
// frames, spread evenly, by one describer after the other. Nothing after Ctrl-C. Throws InputError
// on a bad frame.
std::optional<DescribedRecording> describe_recording(OpenRecording recording,
                                                     const std::vector<NamedDescriber>& describers,
                                                     const SeeFrame& also_see = nullptr);

}  // namespace samewhere::paper
