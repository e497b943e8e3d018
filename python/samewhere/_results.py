"""Reads the files of a results folder (docs/first-map.md). Needs numpy only."""

import csv
import json
import pathlib
from dataclasses import dataclass, field
from typing import Any, Optional

import numpy
import numpy.typing

Array = numpy.typing.NDArray[numpy.float64]

# in the order in which they are made (docs/pipeline.md)
CHECKS = ["similarity", "pause", "matches", "inliers", "spread", "pose", "consistency", "odometry", "deformation", "competing", "sequence",
          "evidence", "graph", "withdrawn"]


class ResultsError(ValueError):
    """A file that cannot be used. The message is one line with file, value and what was expected."""


@dataclass
class Run:
    """What a results folder holds; what it lacks is empty."""

    name: str
    folder: pathlib.Path
    stamps_s: Array  # (n) of the final trajectory
    positions_m: Array  # (n, 3)
    status: list[tuple[float, str]] = field(default_factory=list)  # stamp and status of each frame
    candidates: list[dict[str, Any]] = field(default_factory=list)
    stages_ms: dict[str, dict[str, float]] = field(default_factory=dict)
    matches: list[tuple[int, int, float]] = field(default_factory=list)  # query, match, score


def _rows(file: pathlib.Path) -> list[tuple[int, list[str]]]:
    try:
        text = file.read_text(encoding="utf-8")
    except FileNotFoundError:
        raise ResultsError(f"{file}: there is no such file") from None
    except (OSError, UnicodeDecodeError) as error:
        raise ResultsError(f"{file}: cannot be read as text ({error.__class__.__name__})") from None
    lines = enumerate(text.splitlines(), 1)
    return [(number, line.replace(",", " ").split()) for number, line in lines if line.strip() and not line.lstrip().startswith("#")]


def read_tum(file: pathlib.Path) -> tuple[Array, Array]:
    """Stamps (n) in s and positions (n, 3) in m of lines `stamp tx ty tz qx qy qz qw`, sorted by stamp. Raises ResultsError."""
    values = []
    for number, words in _rows(file):
        try:
            row = [float(word) for word in words]
        except ValueError:
            row = []
        if len(row) < 8 or not numpy.all(numpy.isfinite(row[:8])):
            raise ResultsError(f"{file}, line {number}: expected stamp tx ty tz qx qy qz qw")
        values.append(row[:4])
    if not values:
        raise ResultsError(f"{file}: has no pose; expected lines stamp tx ty tz qx qy qz qw")
    table = numpy.array(sorted(values))
    return table[:, 0], table[:, 1:]


def _json_of(file: pathlib.Path, key: str) -> Any:
    if not file.exists():
        return None
    try:
        document = json.loads(file.read_text(encoding="utf-8"))
        return document[key]
    except (OSError, ValueError, KeyError, TypeError):
        raise ResultsError(f"{file}: has no '{key}'; expected a file of samewhere run") from None


def _status_of(file: pathlib.Path) -> list[tuple[float, str]]:
    if not file.exists():
        return []
    with file.open(encoding="utf-8", newline="") as stream:
        rows = csv.DictReader(stream)
        try:
            return [(float(row["stamp_s"]), row["status"]) for row in rows]
        except (KeyError, TypeError, ValueError):
            raise ResultsError(f"{file}, line {rows.line_num}: expected columns stamp_s and status") from None


def read_matches(file: pathlib.Path) -> list[tuple[int, int, float]]:
    """Rows `query match score`. Raises ResultsError."""
    matches = []
    for number, words in _rows(file):
        try:
            matches.append((int(words[0]), int(words[1]), float(words[2])))
        except (IndexError, ValueError):
            raise ResultsError(f"{file}, line {number}: expected query match score") from None
    return matches


def read_run(folder: pathlib.Path) -> Run:
    """The results in a folder of `samewhere run` or `samewhere loops`. Raises ResultsError."""
    if not folder.is_dir():
        raise ResultsError(f"{folder}: there is no such folder; expected one with the results of samewhere run")
    trajectory = folder / "trajectory.tum"
    matches = folder / "matches.txt"
    if not trajectory.exists() and not matches.exists():
        raise ResultsError(f"{folder}: has neither trajectory.tum nor matches.txt; expected the results of samewhere run or loops")
    stamps_s, positions_m = read_tum(trajectory) if trajectory.exists() else (numpy.empty(0), numpy.empty((0, 3)))
    return Run(
        name=folder.resolve().name,
        folder=folder,
        stamps_s=stamps_s,
        positions_m=positions_m,
        status=_status_of(folder / "frames.csv"),
        candidates=_json_of(folder / "loops.json", "candidates") or [],
        stages_ms=_json_of(folder / "timing.json", "stages") or {},
        matches=read_matches(matches) if matches.exists() else [],
    )


@dataclass
class Error:
    """Distances between a trajectory and its truth after alignment."""

    stamps_s: Array  # (n)
    estimate_m: Array  # (n, 3), aligned to the truth
    truth_m: Array  # (n, 3), interpolated to the stamps
    error_m: Array  # (n)
    scale: float

    @property
    def rmse_m(self) -> float:
        return float(numpy.sqrt(numpy.mean(self.error_m**2)))


MAX_GAP_S = 0.1  # of the truth, as in `samewhere eval` (docs/evaluation.md)
SAME_STAMP_S = 1e-3


def _truth_at(truth_s: Array, truth_m: Array, stamps_s: Array) -> tuple[Array, numpy.typing.NDArray[numpy.bool_]]:
    right = numpy.clip(numpy.searchsorted(truth_s, stamps_s), 1, len(truth_s) - 1)
    left = right - 1
    at = numpy.stack([numpy.interp(stamps_s, truth_s, truth_m[:, axis]) for axis in range(3)], axis=1)
    nearest_s = numpy.minimum(abs(truth_s[left] - stamps_s), abs(truth_s[right] - stamps_s))
    is_inside = (stamps_s >= truth_s[0]) & (stamps_s <= truth_s[-1])
    is_known = (is_inside & (truth_s[right] - truth_s[left] <= MAX_GAP_S)) | (nearest_s <= SAME_STAMP_S)
    return at, is_known


def align(truth_m: Array, estimate_m: Array, is_scale_free: bool) -> tuple[float, Array, Array]:
    """Scale, rotation (3, 3) and translation (3) that take the estimate to the truth, least squares (Umeyama, PAMI 1991)."""
    truth_mean, estimate_mean = truth_m.mean(axis=0), estimate_m.mean(axis=0)
    covariance = (truth_m - truth_mean).T @ (estimate_m - estimate_mean) / len(truth_m)
    left, values, right = numpy.linalg.svd(covariance)
    signs = numpy.array([1.0, 1.0, numpy.sign(numpy.linalg.det(left) * numpy.linalg.det(right))])
    rotation = left @ numpy.diag(signs) @ right
    variance = ((estimate_m - estimate_mean) ** 2).sum() / len(truth_m)
    scale = float((values * signs).sum() / variance) if is_scale_free and variance > 0 else 1.0
    return scale, rotation, truth_mean - scale * rotation @ estimate_mean


def error_of(run: Run, truth_s: Array, truth_m: Array, is_scale_free: bool = False) -> Optional[Error]:
    """Absolute trajectory error, pose by pose; None with fewer than 3 poses that have a truth."""
    if len(truth_s) < 2 or len(run.stamps_s) == 0:
        return None
    at, is_known = _truth_at(truth_s, truth_m, run.stamps_s)
    if is_known.sum() < 3:
        return None
    truth, estimate = at[is_known], run.positions_m[is_known]
    scale, rotation, translation = align(truth, estimate, is_scale_free)
    aligned = scale * estimate @ rotation.T + translation
    return Error(run.stamps_s[is_known], aligned, truth, numpy.linalg.norm(aligned - truth, axis=1), scale)


def funnel(candidates: list[dict[str, Any]]) -> dict[str, int]:
    """Candidates by what decided on them: each check that rejected some, then 'ambiguous' and 'accepted'. Raises ResultsError."""
    counts = {check: 0 for check in CHECKS}
    counts.update({"ambiguous": 0, "accepted": 0})
    for candidate in candidates:
        verdict = candidate.get("verdict") if isinstance(candidate, dict) else None
        if verdict not in ("LOOP", "NOT", "AMBIGUOUS"):
            raise ResultsError(f"loops.json: verdict {verdict!r}; expected LOOP, NOT or AMBIGUOUS")
        name = {"LOOP": "accepted", "AMBIGUOUS": "ambiguous"}.get(verdict, str(candidate.get("stage")))
        counts[name] = counts.get(name, 0) + 1
    return {name: count for name, count in counts.items() if count}


def precision_recall(matches: list[tuple[int, int, float]], places: numpy.typing.NDArray[numpy.uint8], window_frames: int) -> Array:
    """(n, 2) of recall and precision over the scores of `matches`; protocol pr-v2 of docs/evaluation.md, as evaluate.precision_recall."""
    num_frames = len(places)
    with_loop = {query for query in range(num_frames) if numpy.any(places[query, : max(0, query - window_frames)] == 1)}
    curve = []
    num_true = num_false = 0
    by_score: dict[float, list[int]] = {}
    for query, match, score in matches:
        if not (0 <= match < num_frames and 0 <= query < num_frames):
            raise ResultsError(f"matches.txt: frames {query} and {match}; expected positions below {num_frames}, those of the matrix")
        if query - match > window_frames and places[query, match] != 2:
            by_score.setdefault(score, []).append(int(places[query, match]))
    for score in sorted(by_score, reverse=True):
        num_true += by_score[score].count(1)
        num_false += by_score[score].count(0)
        if with_loop:
            curve.append((num_true / len(with_loop), num_true / (num_true + num_false)))
    return numpy.array(curve).reshape(-1, 2)
