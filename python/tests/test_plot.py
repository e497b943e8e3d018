"""Figures from results folders; needs no library."""

import json
import pathlib
import subprocess
import sys

import numpy
import pytest

from samewhere import plot


def write_run(folder: pathlib.Path, noise_m: float = 0.02) -> pathlib.Path:
    folder.mkdir()
    random = numpy.random.default_rng(1)
    rows = []
    for index in range(100):
        at = [3 * numpy.cos(index / 15), 0.0, 3 * numpy.sin(index / 15)] + noise_m * random.standard_normal(3)
        rows.append(f"{index / 10:.6f} {at[0]:.9f} {at[1]:.9f} {at[2]:.9f} 0 0 0 1")
    (folder / "trajectory.tum").write_text("\n".join(rows) + "\n")
    frames = [f'{index},{index / 10},"a, b.png",{"lost" if 40 < index < 50 else "tracking"}' for index in range(100)]
    (folder / "frames.csv").write_text("index,stamp_s,name,status\n" + "\n".join(frames) + "\n")
    verdicts = [("LOOP", None)] * 3 + [("NOT", "inliers")] * 7 + [("NOT", "odometry")] * 4 + [("AMBIGUOUS", "competing")]
    candidates = [{"query": 50 + i, "match": i, "verdict": verdict, "stage": stage} for i, (verdict, stage) in enumerate(verdicts)]
    (folder / "loops.json").write_text(json.dumps({"version": 2, "candidates": candidates}))
    stages = {"features": {"count": 9, "median_ms": 8.0, "p95_ms": 12.0, "total_ms": 80.0}}
    (folder / "timing.json").write_text(json.dumps({"version": 1, "stages": stages}))
    (folder / "matches.txt").write_text("6 0 0.9\n7 1 0.8\n8 0 0.7\n")
    return folder


@pytest.fixture
def truth(tmp_path: pathlib.Path) -> pathlib.Path:
    rows = [f"{i / 10} {3 * numpy.cos(i / 15)} 0 {3 * numpy.sin(i / 15)} 0 0 0 1" for i in range(100)]
    (tmp_path / "truth.tum").write_text("# stamp tx ty tz qx qy qz qw\n" + "\n".join(rows) + "\n")
    return tmp_path / "truth.tum"


@pytest.mark.parametrize("kind, begin", [("svg", b"<?xml"), ("pdf", b"%PDF"), ("png", b"\x89PNG")])
def test_writes_every_figure(tmp_path: pathlib.Path, truth: pathlib.Path, kind: str, begin: bytes) -> None:
    (tmp_path / "places.txt").write_text("\n".join(" ".join("1" if row - column == 6 else "0" for column in range(9)) for row in range(9)))
    runs = [str(write_run(tmp_path / "a")), str(write_run(tmp_path / "b", 0.1))]
    more = ["--truth", str(truth), "--places", str(tmp_path / "places.txt"), "--window", "2"]
    assert plot.main([*runs, "--out", str(tmp_path / "figures"), "--format", kind, *more]) == 0
    names = {"trajectory-a", "trajectory-b", "error", "comparison", "precision-recall", "funnel", "timing"}
    files = list((tmp_path / "figures").iterdir())
    assert {file.name for file in files} == {f"{name}.{kind}" for name in names}
    assert all(file.read_bytes().startswith(begin) and file.stat().st_size > 3000 for file in files)


def test_the_same_run_gives_the_same_bytes(tmp_path: pathlib.Path) -> None:
    run = write_run(tmp_path / "a")
    first, second = (plot.plot_runs([run], tmp_path / name, "svg") for name in ("one", "two"))
    assert [file.name for file in first] == ["trajectory.svg", "funnel.svg", "timing.svg"]
    assert [file.read_bytes() for file in first] == [file.read_bytes() for file in second]


def test_the_figure_says_what_the_files_say(tmp_path: pathlib.Path, truth: pathlib.Path) -> None:
    files = plot.plot_runs([write_run(tmp_path / "a", 0.0)], tmp_path / "figures", "svg", truth)
    text = {file.stem: file.read_text() for file in files}
    assert "ATE RMSE" in text["trajectory"] and "n = 100" in text["trajectory"]
    for words in ("rejected: inliers", "rejected: odometry", "ambiguous", "accepted"):
        assert words in text["funnel"]
    assert plot.funnel(plot.read_run(tmp_path / "a").candidates) == {"inliers": 7, "odometry": 4, "ambiguous": 1, "accepted": 3}


@pytest.mark.parametrize(
    "break_it, words",
    [
        (lambda run: (run / "trajectory.tum").write_text("1 2 three\n"), "trajectory.tum, line 1: expected stamp"),
        (lambda run: (run / "trajectory.tum").write_text("# nothing\n"), "trajectory.tum: has no pose"),
        (lambda run: (run / "trajectory.tum").write_bytes(b"\xff\xfe\x00"), "cannot be read as text"),
        (lambda run: (run / "loops.json").write_text("{"), "loops.json: has no 'candidates'"),
        (lambda run: (run / "loops.json").write_text('{"candidates": [{"verdict": "MAYBE"}]}'), "verdict 'MAYBE'; expected LOOP"),
        (lambda run: (run / "timing.json").write_text("[]"), "timing.json: has no 'stages'"),
        (lambda run: (run / "frames.csv").write_text("a,b\n1,2\n"), "frames.csv, line 2: expected columns"),
        (lambda run: (run / "matches.txt").write_text("1 2\n"), "matches.txt, line 1: expected query match score"),
        (lambda run: [file.unlink() for file in run.iterdir()], "has neither trajectory.tum nor matches.txt"),
    ],
)
def test_broken_files_are_named_in_one_line(tmp_path: pathlib.Path, break_it: object, words: str, capsys: pytest.CaptureFixture) -> None:
    run = write_run(tmp_path / "a")
    break_it(run)  # type: ignore[operator]
    assert plot.main([str(run), "--out", str(tmp_path / "figures")]) == 2
    message = capsys.readouterr().err
    assert words in message and message.count("\n") == 1


@pytest.mark.parametrize("arguments, words", [([], "RUN"), (["none"], "there is no such folder"), (["none", "--format", "gif"], "'gif'")])
def test_bad_arguments_exit_with_2_and_one_line(arguments: "list[str]", words: str) -> None:
    done = subprocess.run([sys.executable, "-m", "samewhere.plot", *arguments], capture_output=True, text=True)
    assert done.returncode == 2 and words in done.stderr and done.stderr.count("\n") == 1


def test_plots_do_not_load_the_library() -> None:
    code = "import sys, samewhere.plot; sys.exit('samewhere._core' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code]).returncode == 0
    help_text = subprocess.run([sys.executable, "-m", "samewhere.plot", "--help"], capture_output=True, text=True).stdout
    assert "examples:" in help_text and "--truth" in help_text
