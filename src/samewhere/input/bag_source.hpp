#pragma once

#include <filesystem>
#include <memory>

#include <samewhere/core/source.hpp>
#include <samewhere/input/bag_topics.hpp>
#include <samewhere/input/config.hpp>

namespace samewhere::input {

// The pictures of a recording of messages (bags/bag.hpp), with depth or a second camera, IMU and
// ground truth where it has them (bag_topics.hpp; config.topics names topics). A picture and its
// partner are those nearest to each other in time, at most config.max_stamp_difference_s apart. A
// picture without depth has none; one without its second picture is left out. Stamps are those of
// the headers, or of the recording where a header has none. What is left out is counted and warned
// of after the last frame. A file that is cut gives the frames before, then InputError.
//
// The body is camera 0, in the axes of its optical frame. The second camera hangs on it by the
// calibrations of the pair (R, P), or by /tf_static; the IMU by /tf_static, without which it is not
// read. config.camera replaces the calibration of camera 0.
//
// Throws InputError as bags::open_bag and choose_topics do, and for a calibration that cannot be
// used where config.needs_calibration; next() for a message that cannot be read, a picture of
// another size, pictures of two cameras on one topic, and stamps that go back by more than a
// second.
std::unique_ptr<core::Source> open_bag_source(const std::filesystem::path& path,
                                              const Config& config);

// Those that it reads.
BagTopics topics_of_bag(const std::filesystem::path& path, const Config& config);

}  // namespace samewhere::input
