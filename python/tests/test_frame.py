"""Pixels cross the border without a copy."""

import sys

import numpy
import pytest
from conftest import Walk

import samewhere


def test_a_frame_refers_to_the_arrays_that_are_given() -> None:
    image = numpy.zeros((480, 640, 3), numpy.uint8)
    depth = numpy.ones((480, 640), numpy.float32)
    before = sys.getrefcount(image)
    frame = samewhere.Frame(1.0, [image], depth, format="rgb")
    assert frame.images[0] is image and frame.depth is depth and frame.formats == ["rgb"]
    assert sys.getrefcount(image) == before + 1
    del frame
    assert sys.getrefcount(image) == before


def test_a_frame_allocates_no_pixels() -> None:
    import tracemalloc

    image = numpy.zeros((4800, 6400), numpy.uint8)
    tracemalloc.start()
    frames = [samewhere.Frame(float(i), image) for i in range(100)]
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert len(frames) == 100 and peak < image.nbytes


def test_pixels_are_read_when_the_frame_is_tracked(walk: Walk) -> None:
    # a change after Frame() is seen, so that nothing was copied there
    slam = samewhere.Slam(walk.calibration)
    image = walk.frames[0].images[0].copy()
    frame = samewhere.Frame(0.0, image, walk.frames[0].depth, format="bgr")
    image[:] = 0
    assert slam.track(frame).status == samewhere.Status.INITIALIZING
    image[:] = walk.frames[0].images[0]
    assert slam.track(samewhere.Frame(1.0, image, walk.frames[0].depth, format="bgr")).num_inliers > 0


@pytest.mark.parametrize("kind", ["a gap after each row", "rgb", "bgra", "depth in units"])
def test_layouts_give_the_same_pose(walk: Walk, kind: str) -> None:
    def poses(with_layout: bool) -> numpy.ndarray:
        slam = samewhere.Slam(walk.calibration)
        for frame in walk.frames[:4]:
            image, depth, name = frame.images[0], frame.depth, "bgr"
            assert depth is not None
            if kind == "depth in units":
                depth = (depth * 5000).astype(numpy.uint16)  # both: the same rounding
                if not with_layout:
                    depth = (depth / 5000.0).astype(numpy.float32)
            if with_layout and kind == "a gap after each row":
                image = numpy.pad(image, ((0, 0), (0, 9), (0, 0)))[:, :-9]
            if with_layout and kind == "rgb":
                image, name = numpy.ascontiguousarray(image[..., ::-1]), "rgb"
            if with_layout and kind == "bgra":
                image, name = numpy.dstack([image, image[..., 0]]), "bgra"
            tracked = slam.track(samewhere.Frame(frame.stamp_s, image, depth, format=name, depth_units_per_m=5000.0))
        return tracked.map_from_camera

    assert numpy.array_equal(poses(True), poses(False))


def test_frames_of_a_recording_have_arrays_of_their_own(walk: Walk) -> None:
    assert len(walk.frames) == 24
    first, second = walk.frames[0].images[0], walk.frames[1].images[0]
    assert first.shape == (480, 640, 3) and first.dtype == numpy.uint8 and not numpy.shares_memory(first, second)
    depth = walk.frames[0].depth
    assert depth is not None and depth.shape == (480, 640) and depth.dtype == numpy.float32
    camera = walk.calibration.cameras[0]
    assert (camera.width_px, camera.height_px) == (640, 480) and camera.body_from_camera.shape == (4, 4)
