"""Loop closer, verifier and detector."""

import numpy
import pytest
from conftest import LOOPS, Walk

import samewhere


@pytest.fixture(scope="module")
def odometry(walk: Walk) -> "list[numpy.ndarray]":
    """Poses of the body by our own tracking, in place of the odometry of a robot."""
    slam = samewhere.Slam(walk.calibration)
    body_from_camera = walk.calibration.cameras[0].body_from_camera
    camera_from_body = numpy.linalg.inv(body_from_camera)
    return [body_from_camera @ slam.track(frame).odom_from_camera @ camera_from_body for frame in walk.frames]


def test_closes_loops_for_odometry_from_elsewhere(walk: Walk, odometry: "list[numpy.ndarray]") -> None:
    closer = samewhere.LoopCloser(
        walk.calibration, sensor=samewhere.OdometrySensor.VISUAL, settings=LOOPS, are_keyframes=False
    )
    verdicts = []
    for frame, pose in zip(walk.frames, odometry):
        verdicts += closer.add(samewhere.OdometryFrame(frame, pose))
    verdicts += closer.finish()
    assert verdicts and all(verdict.reason and verdict.check is not None for verdict in verdicts)
    poses = closer.poses()
    assert poses.poses.shape == (len(walk.frames), 4, 4)
    assert numpy.linalg.norm(poses.positions[-1] - odometry[-1][:3, 3]) < 0.1
    with pytest.raises(samewhere.UsageError):
        closer.add(samewhere.OdometryFrame(walk.frames[0], odometry[0]))


def test_verifies_one_candidate_for_another_pose_graph(walk: Walk, odometry: "list[numpy.ndarray]") -> None:
    verifier = samewhere.LoopVerifier(walk.calibration)
    match, query = walk.frames[0], walk.frames[4]
    between = numpy.linalg.inv(odometry[0]) @ odometry[4]
    verdict = verifier.verify(match, query, samewhere.OdometryBetween(between, 1e-4 * numpy.eye(6)))
    assert verdict.decision == samewhere.LoopDecision.ACCEPTED, verdict.reason
    assert verdict.match_from_query is not None and verdict.covariance is not None
    assert numpy.linalg.norm(verdict.match_from_query[:3, 3] - between[:3, 3]) < 0.05
    assert verdict.scores.num_inliers is not None and verdict.scores.num_inliers > 20
    between[0, 3] += 5.0  # another place, of the same look
    verdict = verifier.verify(match, query, samewhere.OdometryBetween(between, 1e-4 * numpy.eye(6)))
    assert verdict.decision == samewhere.LoopDecision.REJECTED and verdict.check == "odometry"


def test_detects_loops_in_images_alone(walk: Walk) -> None:
    detector = samewhere.LoopDetector(["retrieve.window_frames=4"], samewhere.Prior.UNIQUE)
    verdicts = []
    for frame in walk.frames[:12]:
        verdicts += detector.add(frame.images[0], format="bgr")
    verdicts += detector.finish()
    assert verdicts and all(verdict.query.index > verdict.match.index for verdict in verdicts)
    assert "LoopVerdict" in repr(verdicts[0])
