"""Every file that the program reads, for the fuzzer: those of special_files.py and one of each further format."""
import os
import shutil

import camera_samples
import pictures
import samples
from special_files import INPUTS, LOOPS, RUN

PICTURES = {"000000.pgm": pictures.pgm, "000001.bmp": pictures.bmp, "000002.tif": pictures.tiff,
            "000003.webp": pictures.webp, "000004.jpg": pictures.cmyk_jpeg,
            "000005.png": pictures.png16, "000006.png": pictures.colour_png}
CALIBRATE = ("calibrate", ".", *samples.BOARD, "--out", "camera-found.txt")
CALIBRATE_VIDEO = ("calibrate", "walk.avi", *samples.BOARD, "--out", "camera-found.txt")


def formats(folder):
    rows = pictures.texture(samples.WIDTH, samples.HEIGHT)
    for name, make in PICTURES.items():
        samples.write(folder, name, make(rows, samples.WIDTH))


def cameras(folder):
    camera_samples.cameras(folder)
    samples.images(os.path.join(folder, "pictures"))
    os.remove(os.path.join(folder, "pictures", "camera.txt"))


def associated(folder):
    """As other programs want a TUM recording: associations.txt in place of two lists."""
    samples.tum(folder)
    names = [(f"{1 + i / 10:.6f}") for i in range(samples.NUM_FRAMES)]
    samples.write(folder, "associations.txt",
                  "".join(f"{n} rgb/{n}.png {n} depth/{n}.png\n" for n in names))
    for name in ("rgb.txt", "depth.txt"):
        os.remove(os.path.join(folder, name))


def two_folders(folder):
    """rgb/ and depth/ without lists."""
    samples.tum(folder)
    for name in ("rgb.txt", "depth.txt"):
        os.remove(os.path.join(folder, name))


def board_video(folder):
    frames = []

    def take(rows, _width):
        frames.append(pictures.bottom_up(rows))
        return b""

    boards = os.path.join(folder, "boards")
    samples.boards(boards, take, "none")
    shutil.rmtree(boards)
    samples.write(folder, "walk.avi", pictures.avi(frames, 2 * samples.WIDTH, 1, b"DIB "))


def make_changed(made, lab, root):
    """A run with loops, and the same with one taken back by hand."""
    settings = []
    for setting in ("retrieve.window_frames=5", "verify.min_matches=12", "verify.min_inliers=10",
                    "verify.min_spread_ratio=0", "map.min_shared=1000",
                    "map.min_tracked_ratio=0.95"):
        settings += ["--set", setting]
    made["looped"] = os.path.join(root, "looped")
    made["changed"] = os.path.join(root, "changed")
    for command in (("run", os.path.join(root, "long"), *settings, "--out", made["looped"]),
                    ("ledger", made["changed"], "reject", "0")):
        if command[0] == "ledger":
            shutil.copytree(made["looped"], made["changed"])
        outcome = lab.run(*command, cwd=root, timeout_s=60)
        if outcome.exit != 0:
            raise SystemExit(f"no sample of a changed run: {outcome}")


MAKERS = {"formats": formats, "cameras": cameras, "associated": associated,
          "two_folders": two_folders, "boards": samples.boards, "board_video": board_video}


def make_more(lab, made, root):
    for name, make in MAKERS.items():
        made[name] = os.path.join(root, name)
        os.makedirs(made[name], exist_ok=True)
        make(made[name])
    make_changed(made, lab, root)


def _row(sample, name, command):
    return sample, name, command, True


FUZZED = INPUTS + [_row("formats", name, LOOPS) for name in PICTURES] + [
    _row("cameras", name, ("run", "pictures", "--camera", name, "--out", "out"))
    for name in camera_samples.FILES] + [
    _row("associated", "associations.txt", RUN),
    _row("two_folders", "depth/1.300000.png", RUN),
    _row("boards", "000003.png", CALIBRATE),
    _row("board_video", "walk.avi", CALIBRATE_VIDEO),
    _row("video", "walk.avi", ("run", "walk.avi", "--out", "out")),
    _row("graph_3d", "graph.g2o", ("optimize", "graph.g2o", "--out", "solved.g2o")),
    _row("looped", "loops.json", ("ledger", ".", "reject", "0")),
    _row("looped", "frames.csv", ("ledger", ".", "reject", "0")),
    _row("looped", "config.yaml", ("ledger", ".", "reject", "0")),
    _row("changed", "loops.json", ("ledger", ".", "force", "0")),
    _row("changed", "map.sw", ("ledger", ".", "list")),
    _row("looped", "loops.json", ("ledger", ".", "replay", "--set", "verify.min_inliers=80")),
    _row("run", "frames.csv", ("dense", ".")),
    _row("run", "map.sw", ("map", "map.sw", "export", "--ply", "p.ply", "--g2o", "p.g2o", "--tum",
                           "p.tum")),
    _row("tum+extras", "known.sw", ("run", ".", "--map", "known.sw", "--localize", "--out", "out")),
    _row("loops", "loops.json", ("eval", ".")),
    _row("kitti", "poses.txt", ("run", ".", "--set", "input.depth=false", "--out", "out")),
]
