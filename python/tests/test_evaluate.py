"""Errors against values known by construction, and trajectory files."""

import pathlib

import numpy
import pytest

from samewhere import InputError, Trajectory, _results, evaluate


def helix(num_poses: int = 200) -> Trajectory:
    stamps_s = numpy.arange(num_poses) * 0.05
    poses = numpy.tile(numpy.eye(4), (num_poses, 1, 1))
    for pose, stamp_s in zip(poses, stamps_s):
        cosine, sine = numpy.cos(stamp_s), numpy.sin(stamp_s)
        pose[:3, :3] = [[cosine, -sine, 0], [sine, cosine, 0], [0, 0, 1]]
        pose[:3, 3] = [3 * cosine, 3 * sine, 0.2 * stamp_s]
    return Trajectory(stamps_s, poses)


def moved(trajectory: Trajectory, scale: float = 1.0) -> Trajectory:
    world = numpy.eye(4)
    world[:3, :3] = [[0, 0, 1], [1, 0, 0], [0, 1, 0]]
    world[:3, 3] = [5, -2, 1]
    poses = trajectory.poses.copy()
    poses[:, :3, 3] *= scale
    return Trajectory(trajectory.stamps_s, world @ poses)


def test_ate_of_a_moved_trajectory_is_zero() -> None:
    ate = evaluate.ate(helix(), moved(helix()))
    assert ate is not None and ate.num_poses == 200 and ate.rmse_m < 1e-9 and ate.scale == 1.0
    assert numpy.allclose(ate.truth_from_estimate @ moved(helix()).poses[17], helix().poses[17])


def test_ate_of_equal_opposite_errors_is_their_size() -> None:
    estimate = helix()
    poses = estimate.poses.copy()
    poses[:, 2, 3] += 0.1 * (-1.0) ** numpy.arange(len(poses))
    ate = evaluate.ate(helix(), Trajectory(estimate.stamps_s, poses))
    assert ate is not None and ate.rmse_m == pytest.approx(0.1, rel=1e-3) and ate.median_m == pytest.approx(0.1, rel=0.02)


def test_free_scale_is_found() -> None:
    fixed, free = evaluate.ate(helix(), moved(helix(), 0.5)), evaluate.ate(helix(), moved(helix(), 0.5), free_scale=True)
    assert fixed is not None and fixed.rmse_m > 1.0
    assert free is not None and free.rmse_m < 1e-9 and free.scale == pytest.approx(2.0)


def test_rpe_of_a_constant_drift() -> None:
    estimate = helix()
    poses = numpy.tile(numpy.eye(4), (200, 1, 1))
    straight = Trajectory(estimate.stamps_s, poses.copy())
    poses[:, 0, 3] = 0.02 * estimate.stamps_s  # 2 cm a second
    rpe = evaluate.rpe(straight, Trajectory(estimate.stamps_s, poses), delta_s=1.0)
    assert rpe is not None and rpe.translation_rmse_m == pytest.approx(0.02, rel=1e-2) and rpe.rotation_rmse_deg < 1e-6
    assert evaluate.rpe(straight, straight, delta_s=1000.0) is None


def test_precision_recall_of_known_matches() -> None:
    truth = numpy.zeros((10, 10), numpy.uint8)
    truth[6, 0] = truth[7, 1] = truth[8, 2] = truth[9, 3] = 1
    truth[5, 0] = 2
    # true, true, false, true; the near one of query 5 is ignored, that of query 4 lies inside the window
    matches = [(6, 0, 0.9), (7, 1, 0.8), (8, 0, 0.7), (9, 3, 0.6), (5, 0, 0.95), (4, 3, 0.99)]
    found = evaluate.precision_recall(truth, matches, window_frames=2)
    assert numpy.allclose(found.curve[:, :2], [[0.25, 1], [0.5, 1], [0.5, 2 / 3], [0.75, 0.75]])
    assert found.recall_at_full_precision == 0.5 and found.num_with_loop == 4 and found.num_false == 1
    # the plots compute the same without the library
    assert numpy.allclose(_results.precision_recall(matches, truth, 2), found.curve[:, :2])


def test_the_errors_of_the_plots_are_those_of_the_library() -> None:
    estimate = moved(helix(), 0.97)
    poses = estimate.poses.copy()
    poses[:, :3, 3] += 0.01 * numpy.random.default_rng(3).standard_normal((200, 3))
    stamps_s = estimate.stamps_s + 0.013
    run = _results.Run("run", pathlib.Path("run"), stamps_s, poses[:, :3, 3])
    for free_scale in (False, True):
        ate = evaluate.ate(helix(), Trajectory(stamps_s, poses), free_scale=free_scale)
        error = _results.error_of(run, helix().stamps_s, helix().positions, free_scale)
        assert ate is not None and error is not None
        assert error.rmse_m == pytest.approx(ate.rmse_m, rel=1e-9) and len(error.error_m) == ate.num_poses


def test_a_trajectory_is_written_and_read(tmp_path: pathlib.Path) -> None:
    evaluate.write_trajectory(tmp_path / "t.tum", helix())
    read = evaluate.read_trajectory(str(tmp_path / "t.tum"))
    assert numpy.allclose(read.poses, helix().poses, atol=1e-8) and numpy.allclose(read.stamps_s, helix().stamps_s)


def test_bad_trajectories_are_refused_with_one_line(tmp_path: pathlib.Path) -> None:
    file = tmp_path / "bad.tum"
    file.write_text("0 0 0 0 0 0 0 1\n1 2 3\n")
    good = helix(5)
    backwards = Trajectory(good.stamps_s[::-1], good.poses)
    for work, words in [
        (lambda: evaluate.read_trajectory(file), "bad.tum"),
        (lambda: evaluate.read_trajectory(tmp_path / "none.tum"), "none.tum"),
        (lambda: evaluate.ate(good, None), "estimate: NoneType; expected a samewhere.Trajectory"),
        (lambda: evaluate.ate((good.stamps_s, good.poses[:3]), good), r"truth: shape \(5,\) of float64 and shape \(3, 4, 4\)"),
        (lambda: evaluate.ate(backwards, good), "truth: the stamp of row 1 does not rise"),
        (lambda: evaluate.ate(good, Trajectory(good.stamps_s, good.poses * numpy.nan)), "estimate: row 0 is not finite"),
        (lambda: evaluate.rpe(good, good, delta_s=0.0), "delta_s"),
        (lambda: evaluate.precision_recall(numpy.zeros((2, 3), numpy.uint8), [], window_frames=1), "truth: shape"),
        (lambda: evaluate.precision_recall(numpy.zeros((3, 3), numpy.uint8), [(9, 0, 1)], window_frames=1), "9"),
        (lambda: evaluate.precision_recall(numpy.zeros((3, 3), numpy.uint8), [(1.5, 0, 1)], window_frames=1), "matches: row 0"),
    ]:
        with pytest.raises(InputError, match=words) as caught:
            work()
        assert "\n" not in str(caught.value)
