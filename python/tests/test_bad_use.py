"""Each bad use is an exception with one line; the session goes on, or is said to be over."""

import pathlib
import re
import threading
from typing import Any, Callable

import numpy
import pytest
from conftest import Walk

import samewhere

GRAY = numpy.zeros((48, 64), numpy.uint8)
BGR = numpy.zeros((48, 64, 3), numpy.uint8)


def camera(body_from_camera: Any) -> samewhere.Camera:
    return samewhere.Camera(64, 48, 60, 60, 32, 24, body_from_camera=body_from_camera)


@pytest.mark.parametrize(
    "make, words",
    [
        (lambda: samewhere.Frame(0.0, None), "images: NoneType; expected a numpy array of uint8"),
        (lambda: samewhere.Frame(0.0, "image.png"), "images: str; expected a numpy array of uint8"),
        (lambda: samewhere.Frame(0.0, [GRAY, 3]), "images[1]: int; expected a numpy array"),
        (lambda: samewhere.Frame(0.0, GRAY.astype(float)), "images: shape (48, 64) of float64; expected a numpy array of uint8"),
        (lambda: samewhere.Frame(0.0, GRAY[0]), "images: shape (64,) of uint8; expected"),
        (lambda: samewhere.Frame(0.0, BGR[None]), "images: shape (1, 48, 64, 3) of uint8; expected"),
        (lambda: samewhere.Frame(0.0, BGR), "expected format='bgr', 'rgb' or 'bgra' for an image of several channels"),
        (lambda: samewhere.Frame(0.0, BGR, format="hsv"), "format: 'hsv'; expected 'gray', 'bgr', 'rgb' or 'bgra'"),
        (lambda: samewhere.Frame(0.0, BGR, format="bgra"), "expected shape (height, width, 4) for format='bgra'"),
        (lambda: samewhere.Frame(0.0, BGR, format="gray"), "expected shape (height, width) for format='gray'"),
        (lambda: samewhere.Frame(0.0, GRAY, format="rgb"), "expected shape (height, width, 3) for format='rgb'"),
        (lambda: samewhere.Frame(0.0, GRAY[:0]), "shape (0, 64) of uint8; expected at least one row"),
        (lambda: samewhere.Frame(0.0, GRAY[:, ::2]), "images: strides (64, 2) bytes of shape (48, 32); expected rows"),
        (lambda: samewhere.Frame(0.0, GRAY[::-1]), "images: strides (-64, 1) bytes"),
        (lambda: samewhere.Frame(0.0, BGR[..., ::-1], format="rgb"), "images: strides (192, 3, -1) bytes"),
        (lambda: samewhere.Frame(0.0, GRAY.T), "images: strides (1, 64) bytes"),
        (lambda: samewhere.Frame(0.0, GRAY, GRAY), "depth: shape (48, 64) of uint8; expected a numpy array (height, width) of uint16"),
        (lambda: samewhere.Frame(0.0, GRAY, GRAY.astype(">u2")), "depth: shape (48, 64) of >u2; expected"),
        (lambda: samewhere.Frame(0.0, GRAY, [1.0]), "depth: list; expected a numpy array"),
        (lambda: samewhere.Frame(0.0, GRAY, GRAY.astype("u2"), depth_units_per_m=0.0), "depth_units_per_m: 0.0; expected more than 0"),
        (lambda: camera(numpy.eye(3)), "body_from_camera: shape (3, 3) of float64; expected a 4 x 4"),
        (lambda: camera(2 * numpy.eye(4)), "body_from_camera: another last row; expected a 4 x 4"),
        (lambda: samewhere.OdometryFrame(samewhere.Frame(0.0, GRAY), "pose"), "odom_from_body: str; expected a 4 x 4 array"),
        (lambda: samewhere.OdometryFrame(samewhere.Frame(0.0, GRAY), numpy.eye(4), [1.0]), "covariance: list; expected a 6 x 6 array"),
        (lambda: samewhere.Recording("no-such-folder"), "no-such-folder"),
        (lambda: samewhere.LoopDetector().add(BGR), "image: shape (48, 64, 3) of uint8; expected format="),
        (lambda: samewhere.LoopDetector(["verify.no_such_key=1"]), "no_such_key"),
    ],
)
def test_bad_arguments_are_refused_with_one_line(make: Callable[[], Any], words: str) -> None:
    with pytest.raises(samewhere.InputError, match=re.escape(words)) as caught:
        make()
    assert isinstance(caught.value, ValueError) and "\n" not in str(caught.value)


def test_a_frame_that_does_not_fit_is_refused_and_the_session_goes_on(walk: Walk, slam: samewhere.Slam) -> None:
    good = walk.frames[0]
    image, depth = good.images[0], good.depth
    assert depth is not None
    slam.track(good)
    later = good.stamp_s + 1.0
    nan = float("nan")
    bad = [
        (samewhere.Frame(later, []), "0 images; expected 1"),
        (samewhere.Frame(later, [image, image], depth, format="bgr"), "2 images; expected 1"),
        (samewhere.Frame(later, image[:100], depth, format="bgr"), "expected 640 x 480 as in the calibration"),
        (samewhere.Frame(later, image, depth[:100], format="bgr"), "depth: 640 x 100 pixels; expected 640 x 480"),
        (samewhere.Frame(good.stamp_s, image, depth, format="bgr"), "expected a later one than"),
        (samewhere.Frame(good.stamp_s - 1.0, image, depth, format="bgr"), "expected a later one than"),
        (samewhere.Frame(nan, image, depth, format="bgr"), "stamp nan s; expected a number"),
    ]
    for frame, words in bad:
        with pytest.raises(samewhere.InputError, match=re.escape(words)) as caught:
            slam.track(frame)
        assert "\n" not in str(caught.value)
    assert slam.track(walk.frames[1]).frame == 1


def test_calls_after_finish_are_usage_errors(walk: Walk, slam: samewhere.Slam) -> None:
    slam.track(walk.frames[0])
    with pytest.raises(samewhere.UsageError, match="comes after finish"):
        slam.trajectory()
    slam.finish()
    with pytest.raises(samewhere.UsageError, match="the session is finished") as caught:
        slam.track(walk.frames[1])
    assert isinstance(caught.value, RuntimeError)
    slam.reset()
    assert slam.track(walk.frames[1]).frame == 0


def test_a_call_from_the_callback_is_a_usage_error(walk: Walk) -> None:
    slam: samewhere.Slam

    def track_again(event: samewhere.Event) -> None:
        slam.track(walk.frames[1])

    slam = samewhere.Slam(walk.calibration, on_event=track_again)
    with pytest.raises(samewhere.UsageError, match="one thread at a time"):
        for frame in walk.frames:
            slam.track(frame)


def test_bad_odometry_is_refused(walk: Walk) -> None:
    closer = samewhere.LoopCloser(walk.calibration, sensor=samewhere.OdometrySensor.COVARIANCES)
    closer.add(samewhere.OdometryFrame(walk.frames[0], numpy.eye(4)))
    pose = numpy.eye(4)
    pose[0, 3] = numpy.nan
    for odometry, words in [
        (samewhere.OdometryFrame(walk.frames[1], pose, numpy.eye(6)), "odom_from_body is not finite"),
        (samewhere.OdometryFrame(walk.frames[1], numpy.eye(4)), "has no covariance"),
        (samewhere.OdometryFrame(walk.frames[1], numpy.eye(4), -numpy.eye(6)), "positive definite"),
    ]:
        with pytest.raises(samewhere.InputError, match=words):
            closer.add(odometry)
    closer.add(samewhere.OdometryFrame(walk.frames[1], numpy.eye(4), 1e-4 * numpy.eye(6)))


def test_options_are_an_object_or_keywords(walk: Walk) -> None:
    with pytest.raises(TypeError, match="not both"):
        samewhere.Slam(walk.calibration, samewhere.Options(), threads=False)
    with pytest.raises(TypeError):
        samewhere.Slam(walk.calibration, no_such_option=1)
    with pytest.raises(samewhere.InputError, match="is there already"):
        samewhere.Slam(walk.calibration, save_to=pathlib.Path(__file__))


def test_a_second_thread_is_refused_and_the_session_goes_on(walk: Walk) -> None:
    slam, verifier = samewhere.Slam(walk.calibration), samewhere.LoopVerifier(walk.calibration)
    frames = iter(walk.frames)
    for work in (lambda: slam.track(next(frames)), lambda: verifier.verify(walk.frames[0], walk.frames[4])):
        refused: "list[str]" = []

        def work_often() -> None:
            for _ in range(8):
                try:
                    work()
                except samewhere.UsageError as error:
                    refused.append(str(error))

        others = [threading.Thread(target=work_often) for _ in range(2)]
        for other in others:
            other.start()
        for other in others:
            other.join()
        assert refused and all("one thread at a time" in message for message in refused)
        work()
