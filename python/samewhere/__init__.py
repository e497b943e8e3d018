"""Visual SLAM that rejects false loop closures caused by look-alike places.

    recording = samewhere.Recording("my-recording")
    slam = samewhere.Slam(recording.calibration())
    for frame in recording:
        print(slam.track(frame).map_from_camera)

The classes are those of the C++ headers <samewhere/...>. Poses a_from_b are 4 x 4 arrays that take a point in b to the same point in a, in
metres; covariances are 6 x 6, [m; rad]. The library works without the GIL. `samewhere.plot` needs matplotlib, and not the library.
"""

import importlib as _importlib
from typing import TYPE_CHECKING as _TYPE_CHECKING, Any as _Any

from ._trajectory import Trajectory

if _TYPE_CHECKING:
    from . import evaluate
    from ._core import *

_CORE = [
    "Calibration", "Camera", "Event", "Frame", "FrameKey", "InputError", "KeyframeInserted", "Lens", "LoopCloser", "LoopCloserOptions",
    "LoopDecision", "LoopDetector", "LoopScores", "LoopVerdict", "LoopVerifier", "Map", "MapCorrected", "MapDiscarded", "MapUse",
    "OdometryBetween", "OdometryFrame", "OdometrySensor", "Options", "Prior", "Recording", "RelocalizationStep", "Relocalized", "Slam",
    "Status", "Tracked", "TrackingLost", "UsageError", "read_camera",
]

__all__ = [*_CORE, "Trajectory", "evaluate"]


def __getattr__(name: str) -> _Any:
    # loaded where it is used: plots do without the library
    if name == "evaluate":
        return _importlib.import_module(".evaluate", __name__)
    if name not in _CORE:
        raise AttributeError(f"module 'samewhere' has no attribute '{name}'")
    return getattr(_importlib.import_module("._core", __name__), name)


def __dir__() -> "list[str]":
    return sorted(__all__)
