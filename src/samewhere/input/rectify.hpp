#pragma once

#include <memory>

#include <samewhere/core/rectified_pair.hpp>
#include <samewhere/core/source.hpp>

namespace samewhere::input {

// The same source with the pictures of a calibrated pair of cameras turned so that it is rectified
// (Bouguet's method as in OpenCV: both cameras turn half the way, the pictures are cropped to what
// all pixels see). Its rig is that of the new pictures: two equal pinholes without distortion;
// depth follows camera 0. The body, its inertial unit and the truth stay where they are:
// body_from_taken_camera remembers camera 0 as it was. Pictures of a fisheye or a rational lens are
// turned into those of an ideal pinhole (straighten.hpp), also of a single camera. Frames of any
// other source, and of a pair that is rectified already (core/rectified_pair.hpp), pass as they
// are.
//
// next() throws InputError if the pair cannot be rectified: pictures of two sizes, cameras at one
// place, above each other or looking too far apart.
std::unique_ptr<core::Source> rectified(std::unique_ptr<core::Source> source);

}  // namespace samewhere::input
