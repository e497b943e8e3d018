"""A short rendered walk for all tests."""

import pathlib
from dataclasses import dataclass

import pytest

import samewhere

WALK = "twin:office-loop?seed=5"
# a window so short that loops close within a few frames
LOOPS = ["retrieve.window_frames=4", "map.min_shared=1000", "verify.min_look_alike_distance_m=0.3"]


@dataclass
class Walk:
    calibration: samewhere.Calibration
    frames: "list[samewhere.Frame]"


@pytest.fixture(scope="session")
def walk() -> Walk:
    recording = samewhere.Recording(WALK, settings=["twin.num_frames=24"])
    return Walk(recording.calibration(), list(recording))


@pytest.fixture
def slam(walk: Walk) -> samewhere.Slam:
    return samewhere.Slam(walk.calibration, settings=LOOPS)


@pytest.fixture(scope="session")
def examples() -> pathlib.Path:
    return pathlib.Path(__file__).parent.parent / "examples"
