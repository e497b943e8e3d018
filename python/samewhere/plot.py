"""Figures of one or several runs for a paper, from the results folders of `samewhere run` and `samewhere loops`.

    python3 -m samewhere.plot runs/office --truth office/groundtruth.txt --out figures --format pdf

Needs numpy and matplotlib, and not the library. Colours are those of Okabe and Ito (2008), which differ for colour-blind readers; runs differ
by line style, too, so that they can be told apart in grey.
"""

import argparse
import pathlib
import re
import sys
from typing import Any, Optional, Sequence

import numpy
import numpy.typing

from ._results import CHECKS, MAX_GAP_S, Array, Error, ResultsError, Run, error_of, funnel, precision_recall, read_run, read_tum

COLOURS = ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000"]
STYLES = ["-", "--", "-.", ":"]
LOST = {"lost", "provisional"}
STYLE = {
    "font.size": 9,
    "axes.grid": True,
    "grid.color": "#dddddd",
    "axes.axisbelow": True,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "legend.frameon": False,
    "figure.constrained_layout.use": True,
    "savefig.dpi": 200,
    "pdf.fonttype": 42,  # text stays text
    "svg.fonttype": "none",
    "svg.hashsalt": "samewhere",  # the same run gives the same bytes
}


def _line(index: int) -> dict[str, Any]:
    return {"color": COLOURS[index % len(COLOURS)], "linestyle": STYLES[index % len(STYLES)], "linewidth": 1.4}


def _plane(points_m: Array) -> tuple[int, int]:
    """The two axes along which the path extends most: the floor, whatever axis is up."""
    first, second = sorted(numpy.argsort(numpy.ptp(points_m, axis=0))[1:])
    return int(first), int(second)


def plot_trajectory(run: Run, error: Optional[Error], axes: Any) -> None:
    """The path in the plane of its largest extent, metres; with truth aligned to it and coloured by the error."""
    points_m = error.truth_m if error else run.positions_m
    first, second = _plane(points_m)
    if error:
        axes.plot(error.truth_m[:, first], error.truth_m[:, second], color="#bbbbbb", linewidth=5, label="truth", zorder=1)
        marks = axes.scatter(error.estimate_m[:, first], error.estimate_m[:, second], c=error.error_m, s=5, cmap="viridis", vmin=0, zorder=2)
        axes.figure.colorbar(marks, ax=axes, label="position error (m)", shrink=0.8)
        axes.set_title(f"{run.name}: ATE RMSE {error.rmse_m:.3g} m, n = {len(error.error_m)}", fontsize=9)
        axes.legend(loc="best")
    else:
        axes.plot(points_m[:, first], points_m[:, second], **_line(0))
        axes.set_title(f"{run.name}: {len(points_m)} poses", fontsize=9)
    axes.set_aspect("equal", adjustable="datalim")
    axes.margins(0.08)
    axes.set_xlabel(f"{'xyz'[first]} (m)")
    axes.set_ylabel(f"{'xyz'[second]} (m)")


def _height_of(points_m: Array, width: float) -> float:
    """Of a figure of this width, so that the path fills it."""
    first, second = _plane(points_m)
    extent_m = numpy.ptp(points_m, axis=0)
    return float(numpy.clip(width * extent_m[second] / max(extent_m[first], 1e-9) + 0.8, 2.4, 1.4 * width))


def _lost_spans(run: Run) -> list[tuple[float, float]]:
    spans: list[tuple[float, float]] = []
    begin: Optional[float] = None
    for stamp_s, status in run.status:
        if status in LOST and begin is None:
            begin = stamp_s
        if status not in LOST and begin is not None:
            spans.append((begin, stamp_s))
            begin = None
    if begin is not None:
        spans.append((begin, run.status[-1][0]))
    return spans


def plot_error(runs: Sequence[Run], errors: Sequence[Optional[Error]], axes: Any) -> None:
    """Position error over time since the first frame of each run; grey: the camera is lost (of a single run)."""
    for index, (run, error) in enumerate(zip(runs, errors)):
        if error is None:
            continue
        begin_s = run.status[0][0] if run.status else run.stamps_s[0]
        gaps = numpy.flatnonzero(numpy.diff(error.stamps_s) > 1.0) + 1  # no line across time without poses
        time_s = numpy.insert(error.stamps_s - begin_s, gaps, numpy.nan)
        axes.plot(time_s, numpy.insert(error.error_m, gaps, numpy.nan), label=run.name, **_line(index))
        if len(runs) == 1:
            for first_s, last_s in _lost_spans(run):
                axes.axvspan(first_s - begin_s, last_s - begin_s, color="#bbbbbb", alpha=0.5, linewidth=0)
    axes.set_ylim(bottom=0)
    axes.set_xlabel("time (s)")
    axes.set_ylabel("position error (m)")
    axes.legend(loc="best")


def plot_precision_recall(runs: Sequence[Run], curves: Sequence[Array], axes: Any) -> None:
    """Precision over recall of the best match of each query, all thresholds."""
    for index, (run, curve) in enumerate(zip(runs, curves)):
        if len(curve):
            axes.plot(curve[:, 0], curve[:, 1], marker="o" if len(curve) < 20 else None, markersize=3, label=run.name, **_line(index))
    axes.set_xlim(0, 1.02)
    axes.set_ylim(0, 1.05)
    axes.set_xlabel("recall")
    axes.set_ylabel("precision")
    axes.legend(loc="lower left")


def plot_funnel(runs: Sequence[Run], axes: Any) -> None:
    """Loop candidates by the check that rejected them, in the order of the checks; then ambiguous and accepted ones."""
    counts = [funnel(run.candidates) for run in runs]
    order = CHECKS + ["ambiguous", "accepted"]
    others = sorted({name for count in counts for name in count} - set(order))
    names = [name for name in order[:-2] + others + order[-2:] if any(count.get(name) for count in counts)]
    height = 0.8 / len(runs)
    largest = max(max(count.values(), default=1) for count in counts)
    for index, (run, count) in enumerate(zip(runs, counts)):
        at = numpy.arange(len(names)) + (index - (len(runs) - 1) / 2) * height
        values = [count.get(name, 0) for name in names]
        hatch = ["", "///", "...", "xxx"][index % 4]
        axes.barh(at, values, height, label=run.name, color=COLOURS[index % len(COLOURS)], hatch=hatch, edgecolor="white", linewidth=0.5)
        for position, value in zip(at, values):
            axes.text(value + 0.01 * largest, position, str(value), va="center", fontsize=8)
    axes.set_yticks(range(len(names)), [name if name in order[-2:] else f"rejected: {name}" for name in names])
    axes.invert_yaxis()
    axes.set_xlim(0, 1.12 * largest)
    axes.grid(axis="y", visible=False)
    axes.set_xlabel("loop candidates")
    if len(runs) > 1:
        axes.legend(loc="lower right")


def plot_timing(runs: Sequence[Run], axes: Any) -> None:
    """Median (mark) and 95 % point (end of the line) of each stage, milliseconds, largest total first."""
    total: dict[str, float] = {}
    for run in runs:
        for stage, times in run.stages_ms.items():
            total[stage] = max(total.get(stage, 0.0), times.get("total_ms", 0.0))
    names = sorted(total, key=lambda stage: -total[stage])[:14]
    height = 0.8 / len(runs)
    for index, run in enumerate(runs):
        at = numpy.arange(len(names)) + (index - (len(runs) - 1) / 2) * height
        median = numpy.array([run.stages_ms.get(name, {}).get("median_ms", numpy.nan) for name in names])
        late = numpy.array([run.stages_ms.get(name, {}).get("p95_ms", numpy.nan) for name in names])
        colour = COLOURS[index % len(COLOURS)]
        axes.plot(median, at, "os^D"[index % 4], color=colour, markersize=5, label=run.name)
        axes.hlines(at, median, late, color=colour, linewidth=1.2)
        axes.plot(late, at, "|", color=colour, markersize=6)
    axes.set_xscale("log")
    axes.set_yticks(range(len(names)), names)
    axes.invert_yaxis()
    axes.grid(axis="y", visible=False)
    axes.set_xlabel("time per call (ms): median to 95 % point")
    if len(runs) > 1:
        axes.legend(loc="best")


def plot_comparison(runs: Sequence[Run], errors: Sequence[Optional[Error]], axes: Any) -> None:
    """Distribution of the position error of each run: median, quartiles, 5 and 95 % points; the diamond is the RMSE."""
    known = [(run, error) for run, error in zip(runs, errors) if error is not None][::-1]  # the first on top
    axes.boxplot([error.error_m for _, error in known], vert=False, whis=(5, 95), showfliers=False, widths=0.5,
                 medianprops={"color": COLOURS[1]})
    for position, (_, error) in enumerate(known, 1):
        axes.plot(error.rmse_m, position, "D", color=COLOURS[0], markersize=5)
        axes.text(error.rmse_m, position + 0.33, f"RMSE {error.rmse_m:.3g} m", fontsize=8, ha="center", va="bottom")
    axes.set_yticks(range(1, len(known) + 1), [run.name for run, _ in known])
    axes.set_ylim(0.5, len(known) + 0.9)
    axes.set_xlim(left=0)
    axes.grid(axis="y", visible=False)
    axes.set_xlabel("position error (m): quartiles, median, 5 and 95 % points; diamond: RMSE")


def _read_places(file: pathlib.Path) -> numpy.typing.NDArray[numpy.uint8]:
    expected = "expected rows of 0 (different), 1 (same) and 2 (near), or a binary PGM of them"
    try:
        content = file.read_bytes()
        if content.startswith(b"P5"):
            header = re.match(rb"P5\s+(?:#.*\s+)*(\d+)\s+(\d+)\s+\d+\s", content)
            if header is None:
                raise ValueError
            size = (int(header[2]), int(header[1]))
            places = numpy.frombuffer(content[header.end() :], numpy.uint8, size[0] * size[1]).reshape(size)
        else:
            places = numpy.loadtxt(content.decode("ascii").splitlines(), dtype=numpy.uint8, ndmin=2)
    except OSError:
        raise ResultsError(f"{file}: there is no such file, or it cannot be read") from None
    except ValueError:
        raise ResultsError(f"{file}: cannot be read; {expected}") from None
    if places.shape[0] != places.shape[1] or places.max(initial=0) > 2:
        raise ResultsError(f"{file}: {places.shape[0]} x {places.shape[1]} numbers up to {places.max(initial=0)}; {expected}, as many as columns")
    return places


class _Writer:
    def __init__(self, folder: pathlib.Path, kind: str) -> None:
        self.folder, self.kind = folder, kind
        self.files: list[pathlib.Path] = []

    def write(self, name: str, width: float, height: float, draw: Any) -> None:
        from matplotlib.figure import Figure

        figure = Figure(figsize=(width, height))
        draw(figure.add_subplot())
        file = self.folder / f"{name}.{self.kind}"
        # no date, so that the same run gives the same bytes
        dated = {"svg": {"Date": None}, "pdf": {"CreationDate": None}, "png": {}}[self.kind]
        figure.savefig(file, metadata=dated)
        self.files.append(file)


def _distinct_names(runs: Sequence[Run]) -> None:
    names = [run.name for run in runs]
    for index, run in enumerate(runs):
        if names.count(names[index]) > 1:
            run.name = f"{run.folder.resolve().parent.name}/{run.name}"
    for index, run in enumerate(runs):
        if [other.name for other in runs].count(run.name) > 1:
            run.name = f"{run.name} ({index + 1})"


def plot_runs(folders: Sequence[pathlib.Path], out: pathlib.Path, kind: str = "pdf", truth: Optional[pathlib.Path] = None,
              places: Optional[pathlib.Path] = None, window_frames: int = 0, is_scale_free: bool = False) -> list[pathlib.Path]:
    """Writes every figure for which there is data into folder `out`; the files written. Raises ResultsError.

    kind: 'svg', 'pdf' or 'png'. truth: TUM file, of all runs. places: same_place.txt, for precision and recall.
    """
    import matplotlib

    runs = [read_run(folder) for folder in folders]
    _distinct_names(runs)
    truth_s, truth_m = read_tum(truth) if truth else (numpy.empty(0), numpy.empty((0, 3)))
    errors = [error_of(run, truth_s, truth_m, is_scale_free) for run in runs]
    if truth and not any(errors):
        raise ResultsError(f"{truth}: fewer than 3 poses of any run have a truth within {MAX_GAP_S} s; expected stamps of the same clock")
    place_truth = _read_places(places) if places else None
    out.mkdir(parents=True, exist_ok=True)
    writer = _Writer(out, kind)
    with matplotlib.rc_context(STYLE):
        for run, error in zip(runs, errors):
            if len(run.stamps_s):
                name = "trajectory" if len(runs) == 1 else "trajectory-" + run.name.replace("/", "-")
                writer.write(name, 5, _height_of(error.truth_m if error else run.positions_m, 4.0), lambda axes: plot_trajectory(run, error, axes))
        if any(errors):
            writer.write("error", 6, 2.6, lambda axes: plot_error(runs, errors, axes))
        if len(runs) > 1 and any(errors):
            writer.write("comparison", 5, 0.9 + 0.6 * len(runs), lambda axes: plot_comparison(runs, errors, axes))
        if place_truth is not None and any(run.matches for run in runs):
            curves = [precision_recall(run.matches, place_truth, window_frames) for run in runs]
            writer.write("precision-recall", 4, 3.4, lambda axes: plot_precision_recall(runs, curves, axes))
        if any(run.candidates for run in runs):
            writer.write("funnel", 5.5, 3.4, lambda axes: plot_funnel(runs, axes))
        if any(run.stages_ms for run in runs):
            writer.write("timing", 5.5, 4, lambda axes: plot_timing(runs, axes))
    return writer.files


EXAMPLES = """examples:
  python3 -m samewhere.plot runs/demo                                         funnel, timing and trajectory, as PDF
  python3 -m samewhere.plot runs/room --truth room/groundtruth.txt            coloured by error; error over time
  python3 -m samewhere.plot runs/a runs/b --truth truth.tum --format svg      comparison of two runs
  python3 -m samewhere.plot runs/loops --places same_place.txt --window 100   precision and recall of samewhere loops
"""


class _Parser(argparse.ArgumentParser):
    def error(self, message: str) -> Any:
        print(f"plot: {message} (--help tells more)", file=sys.stderr)
        sys.exit(2)


def _parser() -> argparse.ArgumentParser:
    parser = _Parser(prog="python3 -m samewhere.plot", description="Figures of one or several runs for a paper.", epilog=EXAMPLES,
                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("runs", metavar="RUN", nargs="+", type=pathlib.Path, help="results folder of samewhere run or samewhere loops")
    parser.add_argument("--out", metavar="FOLDER", type=pathlib.Path, default=pathlib.Path("figures"), help="folder to write to (default: figures)")
    parser.add_argument("--format", choices=["svg", "pdf", "png"], default="pdf", help="kind of file (default: pdf)")
    parser.add_argument("--truth", metavar="FILE", type=pathlib.Path, help="true trajectory of camera 0, TUM format, for all runs")
    parser.add_argument("--free-scale", action="store_true", help="align with a free scale (one camera without depth)")
    parser.add_argument("--places", metavar="FILE", type=pathlib.Path, help="same_place.txt or .pgm: which frames show the same place")
    parser.add_argument("--window", metavar="FRAMES", type=int, default=0, help="matches of frames no farther apart are no loops (default: 0)")
    return parser


def main(arguments: Optional[Sequence[str]] = None) -> int:
    """Exit status: 0 done, 2 bad input."""
    given = _parser().parse_args(arguments)
    try:
        import matplotlib  # noqa: F401
    except ImportError:
        print("plot: found no matplotlib; on Debian and Ubuntu it is the package python3-matplotlib", file=sys.stderr)
        return 2
    try:
        files = plot_runs(given.runs, given.out, given.format, given.truth, given.places, given.window, given.free_scale)
    except (ResultsError, OSError) as error:
        print(f"plot: {error}", file=sys.stderr)
        return 2
    for file in files:
        print(file)
    return 0


if __name__ == "__main__":
    sys.exit(main())
