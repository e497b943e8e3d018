"""Figures 3 to 9 from results.json of samewhere bench paper; needs no library."""

import copy
import json
import pathlib
from typing import Any

import pytest

from samewhere import paper

LOOP = {"query": [1, 0, 1], "match": [0, 0, 0], "false": True}


def recognition_row(method: str, search: str, draws: int, seed: int) -> dict[str, Any]:
    curve = [[0.2, 1.0, 0.9], [0.6, 1.0, 0.8], [1.0, 0.7 + 0.001 * draws, 0.1]]
    return {"recording": "hall", "method": method, "search": search, "draws": draws, "seed": seed,
            "result": {"auc": 0.5 + 0.004 * draws + 0.01 * seed, "curve": curve}, "ms": {"together": {"median": 3 + draws / 100}}}


def slam_row(configuration: str, seed: int) -> dict[str, Any]:
    path = [[[i, 0.1 * i, i % 3], [i + 0.1, 0.1 * i, i % 3]] for i in range(20)]
    return {"recording": "hall", "configuration": configuration, "seed": seed, "ate_m": {"rmse": 0.1 + seed}, "loops_true": 1, "loops_false": 1,
            "path": path, "loops": [LOOP]}


def results() -> dict[str, Any]:
    sampled = [recognition_row("paper", "sampled", draws, seed) for draws in (10, 50) for seed in (0, 1)]
    sequence = {"name": "published one", "auc_by_draws": [0.5] * 7, "ms_by_draws": [40] * 7}
    return {
        "version": 1,
        "recordings": ["hall"],
        "published": {"draws": [10, 20, 30, 40, 50, 60, 70], "draws_of_use": 50, "points": [[0.35, 1]], "sequences": [sequence]},
        "methods": [{"name": "paper", "title": "published method"}, {"name": "ours", "title": "samewhere"}],
        "configurations": [{"name": "off", "title": "off"}, {"name": "default", "title": "samewhere"}],
        "recognition": [*sampled, recognition_row("paper", "exact", 0, 0), recognition_row("ours", "own", 0, 0)],
        "slam": [slam_row(configuration, seed) for configuration in ("off", "default") for seed in (0, 1)],
    }


def write(folder: pathlib.Path, content: dict[str, Any]) -> pathlib.Path:
    folder.mkdir(exist_ok=True)
    (folder / "results.json").write_text(json.dumps(content))
    return folder


def test_draws_every_figure_twice_to_the_same_bytes(tmp_path: pathlib.Path) -> None:
    names = [f"figure-{number}.{kind}" for number in range(3, 10) for kind in ("svg", "pdf")]
    first = paper.draw(write(tmp_path / "one", results()))
    assert [file.name for file in first] == names
    listed = json.loads((tmp_path / "one/figures/figures.json").read_text())
    assert [figure["file"] for figure in listed] == names[::2]
    assert listed[1]["title"].startswith("Figure 4: AUC")
    second = paper.draw(write(tmp_path / "two", results()))
    assert [file.read_bytes() for file in first] == [file.read_bytes() for file in second]


def test_the_figures_say_what_the_rows_say(tmp_path: pathlib.Path) -> None:
    paper.draw(write(tmp_path / "a", results()))
    figures = tmp_path / "a/figures"
    for number, words in {3: ["L = 50", "exact search"], 4: ["published, published one", "draws L"], 6: ["published method", "samewhere"],
                          7: ["samewhere: 1 right, 1 wrong"], 8: ["truth"], 9: ["ATE RMSE (m)"]}.items():
        text = (figures / f"figure-{number}.svg").read_text()
        assert all(word in text for word in words), number
    wrong = (figures / "figure-7.svg").read_bytes()
    right = copy.deepcopy(results())
    for row in right["slam"]:
        row["loops"] = [{**LOOP, "false": False}]
    paper.draw(write(tmp_path / "a", right))
    assert (figures / "figure-7.svg").read_bytes() != wrong, "a false loop has a colour of its own"


def test_what_has_no_row_is_not_drawn(tmp_path: pathlib.Path) -> None:
    without_slam = {**results(), "slam": []}
    names = {file.name for file in paper.draw(write(tmp_path / "a", without_slam))}
    assert "figure-6.svg" in names and "figure-8.svg" not in names


@pytest.mark.parametrize("content, word", [(None, "no such file"), ("{", "no JSON"), ('{"version": 9}', "version 9")])
def test_bad_input_is_one_line(tmp_path: pathlib.Path, capsys: pytest.CaptureFixture[str], content: Any, word: str) -> None:
    if content is not None:
        (tmp_path / "results.json").write_text(content)
    assert paper.main([str(tmp_path)]) == 2
    error = capsys.readouterr().err
    assert error.startswith("paper: ") and error.count("\n") == 1 and word in error
