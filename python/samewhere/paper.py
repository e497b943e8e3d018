"""Figures 3 to 9 of the published method from the results of `samewhere bench paper`.

    python3 -m samewhere.paper paper        reads paper/results.json, writes paper/figures/figure-3.svg, .pdf ...

Needs numpy and matplotlib, and not the library. Grey: what the paper (doi 10.1371/journal.pone.0312358) reports of its own sequences.
"""

import argparse
import json
import math
import pathlib
import sys
from typing import Any, Callable, Optional, Sequence

import numpy

from ._results import ResultsError
from .plot import COLOURS, STYLE, STYLES

GREY = "#888888"
Results = dict[str, Any]
Row = dict[str, Any]


def _read(folder: pathlib.Path) -> Results:
    file = folder / "results.json"
    try:
        results: Results = json.loads(file.read_text())
    except OSError:
        raise ResultsError(f"{file}: there is no such file, or it cannot be read; expected the folder of samewhere bench paper") from None
    except ValueError:
        raise ResultsError(f"{file}: is no JSON; expected the results of samewhere bench paper") from None
    if results.get("version") != 1:
        raise ResultsError(f"{file}: version {results.get('version')}, expected 1")
    return results


def _rows(results: Results, recording: str, method: str, search: Optional[str] = None, draws: Optional[int] = None) -> list[Row]:
    return [
        row
        for row in results["recognition"]
        if row["recording"] == recording and row["method"] == method and search in (None, row["search"]) and draws in (None, row["draws"])
    ]


def _used(results: Results, recording: str, method: str) -> list[Row]:
    """As Table 4 has them: the search with the number of draws that the paper uses, or the method's own."""
    return _rows(results, recording, method, "sampled", results["published"]["draws_of_use"]) or _rows(results, recording, method, "own")


def _with(results: Results, has: Callable[[str], Any]) -> list[str]:
    return [recording for recording in dict.fromkeys(results["recordings"]) if has(recording)]


def _panels(figure: Any, names: Sequence[str], width: float = 3.2, height: float = 2.9) -> list[Any]:
    columns = min(len(names), 3)
    lines = math.ceil(len(names) / columns)
    figure.set_size_inches(width * columns, height * lines)
    axes = figure.subplots(lines, columns, squeeze=False).ravel()
    for unused in axes[len(names) :]:
        unused.set_visible(False)
    for axis, name in zip(axes, names):
        axis.set_title(name, fontsize=8)
    return list(axes[: len(names)])


def _legend_beside(figure: Any, axes: Sequence[Any]) -> None:
    """One legend for all panels, below them."""
    entries: dict[str, Any] = {}
    for axis in axes:
        for handle, label in zip(*axis.get_legend_handles_labels()):
            entries.setdefault(label, handle)
    figure.legend(list(entries.values()), list(entries), loc="upper center", bbox_to_anchor=(0.5, 0.0), ncol=min(4, max(1, len(entries))), fontsize=8)


def _curve(axis: Any, row: Row, label: str, style: dict[str, Any]) -> None:
    points = numpy.array(row["result"]["curve"])
    if len(points):
        axis.plot(points[:, 0], points[:, 1], label=label, marker="o" if len(points) < 15 else None, markersize=3, **style)


def _recall_axes(axis: Any) -> None:
    axis.set_xlim(0, 1.02)
    axis.set_ylim(0, 1.05)
    axis.set_xlabel("recall")
    axis.set_ylabel("precision")


def _style(index: int) -> dict[str, Any]:
    return {"color": COLOURS[index % len(COLOURS)], "linestyle": STYLES[index // len(COLOURS) % len(STYLES)], "linewidth": 1.3}


def curves_by_draws(results: Results, figure: Any) -> bool:
    """Precision over recall of the published method by number of draws L, first seed."""
    recordings = _with(results, lambda recording: _rows(results, recording, "paper", "sampled"))
    if not recordings:
        return False
    axes = _panels(figure, recordings)
    for axis, recording in zip(axes, recordings):
        rows = [row for row in _rows(results, recording, "paper", "sampled") if row["seed"] == 0]
        for index, row in enumerate(rows):
            _curve(axis, row, f"L = {row['draws']}", {"color": str(0.8 - 0.8 * index / max(len(rows), 1)), "linewidth": 1.1})
        for row in _rows(results, recording, "paper", "exact"):
            _curve(axis, row, "exact search", {"color": COLOURS[0], "linewidth": 1.3})
        points = numpy.array(results["published"]["points"])
        axis.plot(points[:, 0], points[:, 1], "x", color=COLOURS[1], markersize=5, label="the paper says, of its sequences")
        _recall_axes(axis)
    _legend_beside(figure, axes)
    return True


def _by_draws(results: Results, figure: Any, value: Callable[[Row], float], published: str, name: str) -> bool:
    recordings = _with(results, lambda recording: _rows(results, recording, "paper", "sampled"))
    if not recordings:
        return False
    figure.set_size_inches(6.2, 3.6)
    axis = figure.subplots()
    for index, recording in enumerate(recordings):
        rows = _rows(results, recording, "paper", "sampled")
        draws = sorted({row["draws"] for row in rows})
        values = [[value(row) for row in rows if row["draws"] == count] for count in draws]
        axis.errorbar(draws, [numpy.mean(each) for each in values], [numpy.std(each, ddof=1) if len(each) > 1 else 0 for each in values],
                      capsize=2, label=recording, **_style(index))
    for index, sequence in enumerate(results["published"]["sequences"]):
        axis.plot(results["published"]["draws"], sequence[published], color=GREY, linestyle=STYLES[index], marker=".", linewidth=1,
                  label=f"published, {sequence['name']}")
    axis.set_xlabel("draws L")
    axis.set_ylabel(name)
    _legend_beside(figure, [axis])
    return True


def auc_by_draws(results: Results, figure: Any) -> bool:
    """AUC of the published method over the number of draws; bars: standard deviation over the seeds."""
    return _by_draws(results, figure, lambda row: float(row["result"]["auc"]), "auc_by_draws", "AUC")


def time_by_draws(results: Results, figure: Any) -> bool:
    """Milliseconds a frame of the published method over the number of draws, median on one core."""
    drawn = _by_draws(results, figure, lambda row: float(row["ms"]["together"]["median"]), "ms_by_draws", "ms a frame")
    for axis in figure.axes:
        axis.set_ylim(bottom=0)
    return drawn


def curves_by_method(results: Results, figure: Any) -> bool:
    """Precision over recall by method, as in Table 4; sampled searches: first seed."""
    recordings = _with(results, lambda recording: any(_used(results, recording, method["name"]) for method in results["methods"]))
    if not recordings:
        return False
    axes = _panels(figure, recordings)
    for axis, recording in zip(axes, recordings):
        for index, method in enumerate(results["methods"]):
            rows = [row for row in _used(results, recording, method["name"]) if row["seed"] == 0]
            for row in rows:
                _curve(axis, row, method["title"], _style(index))
        _recall_axes(axis)
    _legend_beside(figure, axes)
    return True


def _plane(path: Any) -> tuple[int, int]:
    first, second = sorted(numpy.argsort(numpy.ptp(path, axis=0))[1:])
    return int(first), int(second)


def _first_run(results: Results, recording: str, configuration: str) -> Optional[Row]:
    for row in results["slam"]:
        if row["recording"] == recording and row["configuration"] == configuration and row["path"]:
            first: Row = row
            return first
    return None


def _slam_recordings(results: Results) -> list[str]:
    return _with(results, lambda recording: any(_first_run(results, recording, each["name"]) for each in results["configurations"]))


def loops_on_path(results: Results, figure: Any) -> bool:
    """Accepted loops on the true path by the configuration of loop closing, first run: blue right, red wrong."""
    recordings = _slam_recordings(results)
    configurations = [each for each in results["configurations"] if each["name"] != "off"]
    if not recordings or not configurations:
        return False
    figure.set_size_inches(2.9 * len(configurations), 2.5 * len(recordings))
    axes = figure.subplots(len(recordings), len(configurations), squeeze=False)
    for line, recording in zip(axes, recordings):
        for axis, configuration in zip(line, configurations):
            row = _first_run(results, recording, configuration["name"])
            axis.set_aspect("equal", adjustable="datalim")
            axis.tick_params(labelsize=7)
            if row is None:
                continue
            path = numpy.array(row["path"])[:, 1]
            first, second = _plane(path)
            axis.plot(path[:, first], path[:, second], color="#bbbbbb", linewidth=1)
            for loop in row["loops"]:
                ends = numpy.array([loop["query"], loop["match"]])
                axis.plot(ends[:, first], ends[:, second], color=COLOURS[1] if loop["false"] else COLOURS[0], linewidth=0.8, marker=".", markersize=3)
            axis.set_title(f"{recording}\n{configuration['title']}: {row['loops_true']} right, {row['loops_false']} wrong", fontsize=7)
    return True


def trajectories(results: Results, figure: Any) -> bool:
    """Trajectories after alignment, first run, with the truth."""
    recordings = _slam_recordings(results)
    if not recordings:
        return False
    axes = _panels(figure, recordings)
    for axis, recording in zip(axes, recordings):
        has_truth = False
        for index, configuration in enumerate(results["configurations"]):
            row = _first_run(results, recording, configuration["name"])
            if row is None:
                continue
            path = numpy.array(row["path"])
            first, second = _plane(path[:, 1])
            if not has_truth:
                axis.plot(path[:, 1, first], path[:, 1, second], color="#cccccc", linewidth=4, label="truth")
            has_truth = True
            axis.plot(path[:, 0, first], path[:, 0, second], label=configuration["title"], **{**_style(index), "linewidth": 1})
        axis.set_aspect("equal", adjustable="datalim")
        axis.set_xlabel("m")
        axis.set_ylabel("m")
    _legend_beside(figure, axes)
    return True


def errors(results: Results, figure: Any) -> bool:
    """ATE RMSE by the configuration of loop closing: mean over the runs, largest and smallest."""
    recordings = _slam_recordings(results)
    if not recordings:
        return False
    figure.set_size_inches(6.5, 0.6 + 0.55 * len(recordings))
    axis = figure.subplots()
    configurations = results["configurations"]
    height = 0.8 / len(configurations)
    for index, configuration in enumerate(configurations):
        for line, recording in enumerate(recordings):
            values = [row["ate_m"]["rmse"] for row in results["slam"]
                      if row["recording"] == recording and row["configuration"] == configuration["name"] and "ate_m" in row]
            if not values:
                continue
            at = line + (index - (len(configurations) - 1) / 2) * height
            axis.barh(at, numpy.mean(values), height, color=COLOURS[index], label=configuration["title"] if line == 0 else None)
            axis.hlines(at, min(values), max(values), color="black", linewidth=1)
    axis.set_yticks(range(len(recordings)), recordings, fontsize=8)
    axis.invert_yaxis()
    axis.set_xlim(left=0)
    axis.grid(axis="y", visible=False)
    axis.set_xlabel("ATE RMSE (m)")
    _legend_beside(figure, [axis])
    return True


FIGURES: list[tuple[int, Callable[[Results, Any], bool]]] = [
    (3, curves_by_draws), (4, auc_by_draws), (5, time_by_draws), (6, curves_by_method), (7, loops_on_path), (8, trajectories), (9, errors),
]


def draw(folder: pathlib.Path) -> list[pathlib.Path]:
    """Draws what there are rows for into folder/figures, as SVG and PDF, with figures.json as their list; the files. Raises ResultsError."""
    import matplotlib
    from matplotlib.figure import Figure

    results = _read(folder)
    out = folder / "figures"
    out.mkdir(exist_ok=True)
    files, listed = [], []
    style: dict[str, Any] = {**STYLE, "font.size": 8}
    with matplotlib.rc_context(style):
        for number, make in FIGURES:
            figure = Figure()
            if not make(results, figure):
                continue
            undated: dict[str, Any] = {"svg": {"Date": None}, "pdf": {"CreationDate": None}}  # the same results give the same bytes
            for kind, dated in undated.items():
                files.append(out / f"figure-{number}.{kind}")
                figure.savefig(files[-1], metadata=dated, bbox_inches="tight")  # with the legend below
            listed.append({"file": f"figure-{number}.svg", "title": f"Figure {number}: {make.__doc__}"})
    (out / "figures.json").write_text(json.dumps(listed, indent=1) + "\n")
    return files


class _Parser(argparse.ArgumentParser):
    def error(self, message: str) -> Any:
        print(f"paper: {message} (--help tells more)", file=sys.stderr)
        sys.exit(2)


def main(arguments: Optional[Sequence[str]] = None) -> int:
    """Exit status: 0 done, 2 bad input."""
    parser = _Parser(prog="python3 -m samewhere.paper", description="Figures 3 to 9 of the published method, as SVG and PDF.")
    parser.add_argument("folder", metavar="FOLDER", type=pathlib.Path, help="results folder of samewhere bench paper")
    given = parser.parse_args(arguments)
    try:
        import matplotlib  # noqa: F401
    except ImportError:
        print("paper: found no matplotlib; on Debian and Ubuntu it is the package python3-matplotlib", file=sys.stderr)
        return 2
    try:
        for file in draw(given.folder):
            print(file)
    except (ResultsError, OSError) as error:
        print(f"paper: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
