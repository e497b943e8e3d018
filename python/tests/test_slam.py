"""Live SLAM from Python."""

import pathlib
import subprocess
import sys
import threading
import time

import numpy
import pytest
from conftest import LOOPS, WALK, Walk

import samewhere


def is_rotation(matrix: numpy.ndarray) -> bool:
    return matrix.shape == (3, 3) and numpy.allclose(matrix @ matrix.T, numpy.eye(3), atol=1e-9)


def test_tracks_each_frame_with_pose_covariance_and_map(walk: Walk, slam: samewhere.Slam) -> None:
    for index, frame in enumerate(walk.frames):
        tracked = slam.track(frame)
        assert tracked.frame == index and tracked.stamp_s == frame.stamp_s
    assert tracked.status == samewhere.Status.TRACKING and tracked.has_pose
    assert tracked.odom_from_camera.dtype == numpy.float64 and is_rotation(tracked.odom_from_camera[:3, :3])
    assert numpy.allclose(tracked.map_from_camera, tracked.map_from_odom @ tracked.odom_from_camera)
    assert tracked.covariance is not None and numpy.all(numpy.linalg.eigvalsh(tracked.covariance) > 0)
    slam.finish()
    trajectory = slam.trajectory()
    assert trajectory.poses.shape == (len(trajectory.stamps_s), 4, 4) and len(trajectory.stamps_s) == len(walk.frames)
    snapshot = slam.map()
    assert snapshot.is_metric and len(snapshot.keyframes()) == snapshot.num_keyframes
    landmarks = snapshot.landmarks()
    assert landmarks["in_map"].shape == (len(landmarks), 3) and len(landmarks) > 100
    assert all(edge.covariance.shape == (6, 6) for edge in snapshot.odometry())


def test_same_frames_give_the_same_trajectory_with_and_without_threads(walk: Walk) -> None:
    found = []
    for threads in (True, False):
        slam = samewhere.Slam(walk.calibration, samewhere.Options(settings=LOOPS, threads=threads))
        for frame in walk.frames:
            slam.track(frame)
        slam.finish()
        found.append(slam.trajectory().poses)
    assert numpy.array_equal(found[0], found[1])


def test_events_are_polled_or_told_to_a_callback(walk: Walk, slam: samewhere.Slam) -> None:
    told: "list[samewhere.Event]" = []
    listening = samewhere.Slam(walk.calibration, settings=LOOPS, on_event=told.append)
    for frame in walk.frames:
        slam.track(frame)
        listening.track(frame)
    slam.finish()
    listening.finish()
    polled = slam.take_events()
    assert [repr(event) for event in polled if not isinstance(event.what, (samewhere.KeyframeInserted, samewhere.MapCorrected))] == [
        repr(event) for event in told if not isinstance(event.what, (samewhere.KeyframeInserted, samewhere.MapCorrected))
    ]
    assert len(polled) == len(told)
    kinds = {type(event.what) for event in polled}
    assert samewhere.KeyframeInserted in kinds and samewhere.LoopVerdict in kinds
    assert slam.take_events() == [] and listening.take_events() == []


def test_what_a_callback_raises_comes_out_of_track_and_the_session_goes_on(walk: Walk) -> None:
    def refuse(event: samewhere.Event) -> None:
        raise KeyError("of the callback")

    slam = samewhere.Slam(walk.calibration, on_event=refuse)
    num_raised = 0
    for frame in walk.frames[:3]:
        try:
            slam.track(frame)
        except KeyError:
            num_raised += 1
    assert num_raised > 0 and slam.map().num_keyframes > 0


def test_other_threads_of_python_run_while_track_works(walk: Walk, slam: samewhere.Slam) -> None:
    ticks: "list[float]" = []
    is_over = threading.Event()

    def tick() -> None:
        while not is_over.is_set():
            ticks.append(time.perf_counter())
            time.sleep(0.0005)

    ticker = threading.Thread(target=tick)
    ticker.start()
    spans = []
    for frame in walk.frames:
        begin = time.perf_counter()
        slam.track(frame)
        spans.append((begin, time.perf_counter()))
    is_over.set()
    ticker.join()
    assert any(sum(begin < at < end for at in ticks) >= 2 for begin, end in spans)


def test_a_snapshot_is_read_from_another_thread(walk: Walk, slam: samewhere.Slam) -> None:
    versions: "list[int]" = []
    is_over = threading.Event()

    def read() -> None:
        while not is_over.is_set():
            snapshot = slam.map()
            assert len(snapshot.keyframes()) == snapshot.num_keyframes
            versions.append(snapshot.version)

    reader = threading.Thread(target=read)
    reader.start()
    for frame in walk.frames:
        slam.track(frame)
    is_over.set()
    reader.join()
    assert versions == sorted(versions) and len(versions) > 1


def test_save_and_localize(walk: Walk, slam: samewhere.Slam, tmp_path: pathlib.Path) -> None:
    for frame in walk.frames:
        slam.track(frame)
    slam.save(tmp_path / "map.sw")
    localizing = samewhere.Slam(walk.calibration, map=tmp_path / "map.sw", map_use=samewhere.MapUse.LOCALIZE)
    assert localizing.map().num_keyframes > 0
    assert localizing.track(walk.frames[0]).status in (samewhere.Status.LOST, samewhere.Status.PROVISIONAL)


def test_the_example_prints_poses_as_they_come(examples: pathlib.Path, tmp_path: pathlib.Path) -> None:
    script = examples / "track.py"
    assert len(script.read_text().splitlines()) <= 17
    command = [sys.executable, str(script), WALK, "twin.num_frames=6"]
    lines = subprocess.run(command, cwd=tmp_path, check=True, capture_output=True, text=True).stdout.splitlines()
    assert len(lines) == 6 and all(len(line.split()) == 4 for line in lines)
    assert len(samewhere.evaluate.read_trajectory(tmp_path / "trajectory.tum").stamps_s) == 6
