"""The inputs of SAMEWHERE_CASES, a folder each with a README: what should happen with them."""
import gzip
import os
import re
import shutil

from checks import Check

CASES = {}


def case(name, title):
    """Registers a check of the handed folder `name`; it works on a copy."""

    def register(function):
        CASES.setdefault(name, []).append((title, function))
        return function

    return register


def expect(condition, what):
    return [] if condition else [what]


def well(outcome):
    """Exit 0, and nothing that no input may bring about."""
    return outcome.faults() + expect(outcome.exit == 0, f"expected exit 0: {outcome}")


def refused(outcome, *words):
    found = outcome.faults() + expect(outcome.exit == 2, f"expected exit 2: {outcome}")
    return found + [f"the refusal does not name {word}: {outcome}" for word in words
                    if word not in outcome.err]


def warned(outcome, *words):
    return well(outcome) + [f"no warning names {word}: {outcome}" for word in words
                            if word not in outcome.err]


def figure(outcome, name):
    """What is printed behind a name, the first number of it."""
    found = re.search(rf"^ *{name}\D*?(-?[\d.]+(?:e[-+]?\d+)?)", outcome.out, re.MULTILINE)
    return float(found.group(1)) if found else None


def num_frames(outcome_folder):
    with open(os.path.join(outcome_folder, "frames.csv"), encoding="utf-8") as file:
        return sum(1 for line in file if line[:1].isdigit())


def near(found, expected, what, ratio=1e-4):
    is_near = found is not None and abs(found - expected) <= ratio * abs(expected)
    return expect(is_near, f"{what}: found {found}, expected {expected}")


# ---- text


@case("01-bom", "a byte order mark is skipped")
def bom(lab, folder):
    return well(lab.run("optimize", "bom.g2o", "--out", "o.g2o", cwd=folder))


@case("03-name-with-blank", "a blank in a name of rgb.txt and of a list is part of the name")
def blank(lab, folder):
    return (well(lab.run("loops", ".", "--out", "o", cwd=folder)) +
            well(lab.run("run", "list.txt", "--camera", "camera.txt", "--out", "p", cwd=folder)) +
            expect(num_frames(os.path.join(folder, "p")) == 2, "not all pictures were read"))


@case("04-truth-stops-the-run", "a broken row of the truth warns")
def truth(lab, folder):
    return (warned(lab.run("run", "tum", "--out", "o", cwd=folder), "groundtruth.txt") +
            warned(lab.run("loops", "tum", "--out", "p", cwd=folder), "groundtruth.txt"))


@case("05-camera-option", "--camera stands for a calibration that is not there; loops needs none")
def camera_option(lab, folder):
    problems = []
    for name in ("euroc", "kitti"):
        problems += well(lab.run("run", name, "--camera", "camera.txt", "--out", f"o-{name}",
                                 cwd=folder))
        problems += well(lab.run("loops", name, "--out", f"p-{name}", cwd=folder))
        problems += refused(lab.run("run", name, "--out", f"q-{name}", cwd=folder), "--camera")
    return problems


@case("06-stereo-hole", "pictures without a partner are left out and counted")
def stereo_hole(lab, folder):
    return (well(lab.run("run", "euroc", "--out", "o", cwd=folder)) +
            well(lab.run("loops", "euroc", "--out", "p", cwd=folder)))


@case("07-model-names", "other names of the same lens model are read")
def model_names(lab, folder):
    return well(lab.run("run", ".", "--out", "o", cwd=folder))


@case("10-decimal-names", "names that are decimals are ordered by value")
def decimals(lab, folder):
    problems = well(lab.run("run", ".", "--out", "o", cwd=folder))
    with open(os.path.join(folder, "o", "frames.csv"), encoding="utf-8") as file:
        names = re.findall(r"161123456\d\.\d+", file.read())
    with_dot = [float(name) for name in names]
    return problems + expect(with_dot == sorted(with_dot), f"the order is {names}")


def write_camera(folder):
    with open(os.path.join(folder, "any.txt"), "w", encoding="utf-8") as file:
        file.write("60 0 32\n0 60 24\n0 0 1\n")


@case("11-digits-as-frame-number", "steps that are no frame numbers are stamps, or warn")
def digits(lab, folder):
    problems = []
    for name in ("ms", "us"):
        write_camera(folder)
        outcome = lab.run("run", name, "--camera", "any.txt", "--out", f"o-{name}", cwd=folder)
        problems += well(outcome)
        with open(os.path.join(folder, f"o-{name}", "frames.csv"), encoding="utf-8") as file:
            rows = [line.split(",") for line in file if line[:1].isdigit()]
        step_s = float(rows[1][1]) - float(rows[0][1])
        problems += expect(step_s < 0.5 or "warning" in outcome.err,
                           f"{name}: frames are {step_s} s apart without a word")
    return problems


@case("12-hidden-files", "names that begin with a dot are no pictures")
def hidden(lab, folder):
    with open(os.path.join(folder, "._000000.png"), "wb") as file:
        file.write(b"\0\5\x16\7" + bytes(76))
    return (well(lab.run("run", ".", "--out", "o", cwd=folder)) +
            expect(num_frames(os.path.join(folder, "o")) == 2, "expected two frames"))


@case("14-calibrate-one-odd-picture", "a picture of another zoom is left out and named")
def odd_picture(lab, folder):
    outcome = lab.run("calibrate", ".", "--board", "9x6", "--square", "0.025", "--out", "c.txt",
                      cwd=folder, timeout_s=60)
    problems = well(outcome)
    focal = figure(outcome, "fx")
    left_out = [line for line in (outcome.out + outcome.err).splitlines()
                if "board_07" in line and "left out" in line]
    return problems + near(focal, 520, "fx", 0.003) + expect(left_out, "board_07 is not left out")


@case("16-camera-files", "camera files of the field are read")
def camera_files(lab, folder):
    problems = []
    pictures = os.path.join(lab.samples["pictures-640"])
    for name in sorted(os.listdir(folder)):
        if name.startswith("cam-"):
            problems += well(lab.run("run", pictures, "--camera", name, "--out", "o-" + name,
                                     cwd=folder))
    return problems


# ---- graphs


def cost_after(outcome):
    found = re.search(r"cost before / after +\S+ / (\S+)", outcome.out)
    return float(found.group(1)) if found else None


@case("08-g2o-gaps", "gaps in the numbers change nothing")
def gaps(lab, folder):
    problems, counts = [], {}
    for name in ("basebad", "gap2bad", "rtabids"):
        outcome = lab.run("optimize", f"{name}.g2o", "--out", f"{name}-o.g2o", cwd=folder)
        problems += well(outcome)
        edges = re.search(r"edges\D*(\d+): (\d+)", outcome.out)
        counts[name] = edges.groups() if edges else None
        problems += near(cost_after(outcome), 3.37099, f"{name}: cost", 1e-3)
    return problems + expect(len(set(counts.values())) == 1, f"edges are told apart: {counts}")


@case("09-g2o-poor-start", "a poor start ends at the optimum with all loops")
def poor_start(lab, folder):
    outcome = lab.run("optimize", "ring-200-2.g2o", "--out", "o.g2o", cwd=folder)
    found = cost_after(outcome)
    is_optimum = found is not None and min(abs(found - 13.604), abs(found - 6.802)) < 0.01
    return well(outcome) + expect(is_optimum, f"cost {found}, expected 13.604 or half of it")


@case("19-g2o-far-from-zero", "coordinates far from zero solve as at the origin")
def far_from_zero(lab, folder):
    outcome = lab.run("optimize", "utm3.g2o", "--out", "o.g2o", cwd=folder)
    found = cost_after(outcome)
    is_optimum = found is not None and min(abs(found - 3.38394), abs(found - 6.76788)) < 0.001
    return well(outcome) + expect(is_optimum, f"cost {found}, expected 3.38394")


# ---- files


@case("30-02-camera-distortion-1e200", "a distortion that no lens has is refused")
def distortion(lab, folder):
    problems = refused(lab.run("run", ".", "--out", "o", cwd=folder), "camera.txt")
    for value in ("1e100", "-1e6", "nan"):
        text = f"250 0 160\n0 250 120\n0 0 1\n{value} 0 0 0 0\n"
        with open(os.path.join(folder, "other.txt"), "w", encoding="utf-8") as file:
            file.write(text)
        outcome = lab.run("run", ".", "--camera", "other.txt", "--out", "o", cwd=folder)
        problems += refused(outcome, "other.txt")
    return problems


def put_victim(folder):
    with open(os.path.join(folder, "victim"), "w", encoding="utf-8") as file:
        file.write("mine\n")


def victim_lives(folder):
    with open(os.path.join(folder, "victim"), encoding="utf-8") as file:
        return expect(file.read() == "mine\n", "the file behind the link was overwritten")


@case("30-08-links-are-followed", "writing into a run's folder follows no link")
def links(lab, folder):
    put_victim(folder)
    os.mkdir(os.path.join(folder, "o"))
    os.symlink(os.path.join(folder, "victim"), os.path.join(folder, "o", ".writable"))
    problems = lab.run("run", lab.samples["tum"], "--out", "o", cwd=folder).faults()
    problems += victim_lives(folder)
    os.symlink(os.path.join(folder, "victim"), os.path.join(folder, "x.g2o.partial"))
    graph = os.path.join(lab.samples["graph_2d"], "graph.g2o")
    problems += lab.run("optimize", graph, "--out", "x.g2o", cwd=folder).faults()
    problems += victim_lives(folder)
    shutil.copytree(lab.samples["run"], os.path.join(folder, "r"))
    for name, command in (("trajectory.tum", ("ledger", "r", "reject", "0")),
                          ("cloud.ply", ("dense", "r"))):
        link = os.path.join(folder, "r", name)
        if os.path.lexists(link):
            os.remove(link)
        os.symlink(os.path.join(folder, "victim"), link)
        problems += lab.run(*command, cwd=folder).faults() + victim_lives(folder)
    return problems


@case("30-10-bad-first-frame", "a run that fails on its first frame costs no earlier results")
def bad_first_frame(lab, folder):
    problems = well(lab.run("run", lab.samples["tum"], "--out", "o", cwd=folder))
    before = sorted(os.listdir(os.path.join(folder, "o")))
    outcome = lab.run("run", "rec", "--out", "o", cwd=folder)
    problems += refused(outcome)
    problems += refused(lab.run("run", "rec", "--out", "o", "--force", cwd=folder))
    return problems + expect(sorted(os.listdir(os.path.join(folder, "o"))) == before,
                             "results of the first run are gone")


@case("30-11-depth-link-broken", "a link to nothing is no missing file")
def broken_link(lab, folder):
    os.symlink("nowhere", os.path.join(folder, "rec", "depth.txt"))
    problems = refused(lab.run("run", "rec", "--out", "o", cwd=folder), "depth.txt")
    os.remove(os.path.join(folder, "rec", "depth.txt"))
    for name in ("rgb.txt", "camera.txt"):
        path = os.path.join(folder, "rec", name)
        os.rename(path, path + ".kept")
        os.symlink("nowhere", path)
        problems += refused(lab.run("run", "rec", "--out", "o", cwd=folder), name)
        os.remove(path)
        os.rename(path + ".kept", path)
    return problems


@case("30-14-terminal-escapes", "what a file says reaches the terminal without control characters")
def escapes(lab, folder):
    problems = []
    shutil.copytree(lab.samples["loops"], os.path.join(folder, "r"))
    path = os.path.join(folder, "r", "loops.json")
    with open(path, encoding="utf-8") as file:
        text = file.read()
    text = re.sub(r'"reason": *"', '"reason": "\\\\u001b[2J\\\\u0007', text)
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)
    for command in (("list",), ("show", "0")):
        problems += well(lab.run("ledger", "r", *command, cwd=folder))
    for name in (b"\x1b[2Jx.png", b"x" * 1_000_000, b"rgb/0.00000\x00.png"):
        with open(os.path.join(folder, "rgb.txt"), "wb") as file:
            file.write(b"1.0 " + name + b"\n")
        outcome = lab.run("loops", ".", "--out", "o", cwd=folder)
        problems += refused(outcome, "does not exist")
        problems += expect(len(outcome.err) < 4500, f"a message of {len(outcome.err)} characters")
    return problems


# ---- maps


def unpack_map(folder):
    with gzip.open(os.path.join(folder, "map.sw.gz")) as packed:
        with open(os.path.join(folder, "map.sw"), "wb") as file:
            file.write(packed.read())


def map_refused(lab, folder):
    unpack_map(folder)
    problems = []
    for options in ((), ("--localize",)):
        outcome = lab.run("run", lab.samples["tum"], "--map", "map.sw", *options, "--out",
                          "o" + "".join(options), cwd=folder)
        problems += refused(outcome, "map.sw")
    for command in (("info",), ("export", "--ply", "x.ply")):
        problems += refused(lab.run("map", "map.sw", *command, cwd=folder), "map.sw")
    return problems


for forged in ("31-map-merge_cycle", "31-map-overflow", "31-map-trigger"):
    case(forged, "a forged map is refused")(map_refused)


# ---- whatever else is handed


def any_case(lab, folder):
    """A folder without a check of its own: no fault, whatever is tried with what lies in it."""
    problems = []
    for base, names, files in os.walk(folder):
        for name in files:
            command = command_for(os.path.relpath(os.path.join(base, name), folder))
            if command:
                problems += lab.run(*command, cwd=folder).faults()
        for command in (("run", base, "--out", "o-run"), ("loops", base, "--out", "o-loops")):
            problems += lab.run(*command, cwd=folder).faults()
        names[:] = [name for name in names if name not in ("rgb", "depth", "data")
                    and not name.startswith("o-")]
    return problems


def command_for(file):
    if file.endswith(".g2o"):
        return ("optimize", file, "--out", "o-solved.g2o")
    if file.endswith(".sw"):
        return ("map", file, "info")
    if file.endswith((".yaml", ".yml")):
        return ("config", "--config", file)
    return None


def check_of(root, name, title, function):
    def check(lab, folder):
        copy = os.path.join(folder, "case")
        shutil.copytree(os.path.join(root, name), copy, symlinks=True)
        if function is any_case and os.path.exists(os.path.join(copy, "map.sw.gz")):
            unpack_map(copy)
        return function(lab, copy)

    return Check(f"{name}: {title}", check)


def checks(root):
    found = []
    for name in sorted(os.listdir(root)):
        if os.path.isdir(os.path.join(root, name)):
            for title, function in CASES.get(name, [("no fault", any_case)]):
                found.append(check_of(root, name, title, function))
    return found
