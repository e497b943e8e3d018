"""Command lines that are wrong, each with the words that its one line must hold."""
import os

from checks import Check

WRONG = [
    (("rnu", "."), ["rnu", "run"]),
    (("lops", "."), ["lops", "loops"]),
    (("optimise", "graph.g2o"), ["optimise", "optimize"]),
    (("legder", "."), ["legder", "ledger"]),
    (("evla",), ["evla", "eval"]),
    (("xyzzy-is-nothing",), ["xyzzy-is-nothing"]),
    (("run", ""), ["SOURCE"]),
    (("loops", ""), ["SOURCE"]),
    (("run", ".", "--out", ""), ["--out"]),
    (("run", ".", "--map", ""), ["--map"]),
    (("run", ".", "--camera", ""), ["--camera"]),
    (("run", ".", "--config", ""), ["--config"]),
    (("run", ".", "--set", ""), ["--set"]),
    (("run", ".", "--profile", ""), ["--profile"]),
    (("eval", ""), ["RUN"]),
    (("eval", ".", "--walk", ""), ["--walk"]),
    (("dense", ""), ["RUN"]),
    (("dense", ".", "--cloud", ""), ["--cloud"]),
    (("ledger", "", "list"), ["RUN"]),
    (("map", "", "info"), ["FILE"]),
    (("map", "map.sw", "export", "--ply", ""), ["--ply"]),
    (("optimize", ""), []),
    (("optimize", "graph.g2o", "--out", ""), ["--out"]),
    (("calibrate", "", "--board", "9x6", "--square", "0.02", "--out", "c.txt"), ["IMAGES"]),
    (("twin", ""), []),
    (("twin", "twin:hotel", "--out", ""), ["--out"]),
    (("config", "--config", ""), ["--config"]),
    (("ledger", ".", "list", "--stage", "nope"), ["nope", "odometry", "matches"]),
]


def check_of(arguments, names):
    def check(lab, folder):
        outcome = lab.run(*arguments, cwd=folder)
        problems = outcome.faults()
        if outcome.exit != 2:
            problems.append(f"exit {outcome.exit}, expected 2: {outcome}")
        problems += [f"the line does not hold {name}: {outcome}" for name in names
                     if name not in outcome.err]
        if os.listdir(folder):
            problems.append(f"left behind: {os.listdir(folder)}")
        return problems

    shown = " ".join(argument or '""' for argument in arguments)
    return Check(f"words: {shown}", check)


def checks():
    return [check_of(*row) for row in WRONG]
