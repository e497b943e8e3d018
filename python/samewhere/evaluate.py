"""Errors of trajectories and of place recognition (docs/evaluation.md), and trajectory files."""

from ._core import Ate, PrecisionRecall, Rpe, ate, precision_recall, read_trajectory, rpe, write_trajectory

__all__ = ["Ate", "PrecisionRecall", "Rpe", "ate", "precision_recall", "read_trajectory", "rpe", "write_trajectory"]
