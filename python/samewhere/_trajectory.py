"""Poses with stamps."""

from typing import NamedTuple

import numpy
import numpy.typing


class Trajectory(NamedTuple):
    """Poses with rising stamps, n of them.

    stamps_s: (n), seconds. poses: (n, 4, 4), metres; of camera 0 (or the body) in the map.
    """

    stamps_s: numpy.typing.NDArray[numpy.float64]
    poses: numpy.typing.NDArray[numpy.float64]

    @property
    def positions(self) -> numpy.typing.NDArray[numpy.float64]:
        """(n, 3), metres."""
        positions: numpy.typing.NDArray[numpy.float64] = self.poses[:, :3, 3]
        return positions
