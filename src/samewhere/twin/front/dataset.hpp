#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include <samewhere/core/source.hpp>
#include <samewhere/twin/motion/wheel.hpp>
#include <samewhere/twin/truth/truth.hpp>

namespace samewhere::twin {

// What stands beside a recording: it is no part of the formats.
struct SideTables {
  WalkTruth truth;
  std::vector<WheelSample> wheels;  // empty: no robot
};

// Called once, after the last frame; empty: there are none.
using MakeTables = std::function<SideTables()>;

// Each of these writes all frames of the source, from the first, as a folder that other systems
// read. It grows under the name `folder`.partial and is renamed when it is complete, so that what
// bears the final name is whole; after an error or an interrupt nothing is left. The name is
// claimed before the source is asked for anything. Beside the format's own files stand, where
// `tables` are given: frames.csv (frame, stamp_s, visit, room, floor), loops.csv (query, match,
// overlap, confirmable, object), aliased_pairs.csv (query, match, alike), overlap.pgm unless the
// walk is long, wheels.csv (stamp_s, forward_m, turned_rad) if a robot walked; and same_place.pgm
// where the source knows its places (0 different, 1 same, 2 near). Throws InputError if the folder
// is there already or cannot be written, core::Interrupted after Ctrl-C, and whatever source.next()
// and tables() throw.

// TUM RGB-D (Sturm et al. 2012): rgb/, depth/ in units of 1/5000 m, rgb.txt, depth.txt,
// groundtruth.txt, accelerometer.txt if there are inertial samples; stamps with six decimals. Our
// camera.txt (input/camera_file.hpp). Of camera 0 alone: the format knows no other.
void write_tum_folder(core::Source& source, const std::filesystem::path& folder,
                      const MakeTables& tables = nullptr);

// EuRoC (Burri et al. 2016): mav0 with body.yaml, cam0, cam1 and so on, imu0 if the rig has one,
// state_groundtruth_estimate0 (the body's pose at each frame, with the source's inertial truth;
// where it knows none, velocities are central differences and biases 0, which sensor.yaml says);
// stamps in whole nanoseconds. The format knows no depth. Pictures
// have as many channels as the source's. Throws InputError too if the source is not calibrated.
void write_euroc_folder(core::Source& source, const std::filesystem::path& folder,
                        const MakeTables& tables = nullptr);

}  // namespace samewhere::twin
