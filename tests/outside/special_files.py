"""Something that is no regular file, or has no end, in place of each file that the program reads."""
import os
import shutil
import stat

from checks import Check, copy_with_links

# a file of this size with nothing in it: 64 GiB
SPARSE_BYTES = 1 << 36
MAX_SECONDS = 10.0


def put_fifo(path):
    os.mkfifo(path)


def put_socket(path):
    os.mknod(path, 0o600 | stat.S_IFSOCK)


def put_device(path):
    """It never ends, either."""
    os.symlink("/dev/zero", path)


def put_folder(path):
    os.mkdir(path)


def put_sparse(path):
    with open(path, "wb") as file:
        file.truncate(SPARSE_BYTES)


def put_dangling_link(path):
    os.symlink(path + ".is-not-there", path)


PUT = {
    "a pipe": put_fifo,
    "a socket": put_socket,
    "a device": put_device,
    "a folder": put_folder,
    "a file of 64 GiB": put_sparse,
    "a link to nothing": put_dangling_link,
}

RUN = ("run", ".", "--out", "out")
LOOPS = ("loops", ".", "--out", "out")

# sample, file that is replaced, command, whether the command cannot do without it. Single pictures of
# a list may be missing, and are then counted.
INPUTS = [
    ("tum", "rgb.txt", RUN, True),
    ("tum", "camera.txt", RUN, True),
    ("tum", "depth.txt", RUN, True),
    ("tum", "groundtruth.txt", RUN, False),
    ("tum", "same_place.txt", LOOPS, False),
    ("tum", "aliased_pairs.csv", LOOPS, False),
    ("tum", "rgb/1.000000.png", RUN, False),
    ("bags", "walk.mcap", ("run", "walk.mcap", "--out", "out"), True),
    ("bags", "walk.db3", ("run", "walk.db3", "--out", "out"), True),
    ("bags", "walk.bag", ("run", "walk.bag", "--out", "out"), True),
    ("bags", "walk.bag", ("info", "walk.bag"), True),
    ("tum", "rgb/1.300000.png", RUN, False),
    ("tum", "depth/1.000000.png", RUN, False),
    ("tum", "depth/1.300000.png", RUN, False),
    ("euroc", "mav0/cam0/data.csv", RUN, True),
    ("euroc", "mav0/cam0/sensor.yaml", RUN, True),
    ("euroc", "mav0/cam0/data/1200000000.png", RUN, True),
    ("euroc", "mav0/cam1/data.csv", RUN, True),
    ("euroc", "mav0/cam1/sensor.yaml", RUN, True),
    ("euroc", "mav0/cam1/data/1200000000.png", RUN, True),
    ("euroc", "mav0/imu0/data.csv", RUN, False),
    ("euroc", "mav0/imu0/sensor.yaml", RUN, False),
    ("euroc", "mav0/state_groundtruth_estimate0/data.csv", RUN, False),
    ("euroc", "mav0/state_groundtruth_estimate0/sensor.yaml", RUN, False),
    ("kitti", "calib.txt", RUN, True),
    ("kitti", "times.txt", RUN, True),
    ("kitti", "poses.txt", RUN, False),
    ("kitti", "image_0/000002.png", RUN, True),
    ("kitti", "image_1/000002.png", RUN, True),
    ("seven_scenes", "camera.txt", RUN, True),
    ("seven_scenes", "frame-000002.color.png", RUN, True),
    ("seven_scenes", "frame-000002.depth.png", RUN, True),
    ("seven_scenes", "frame-000002.pose.txt", RUN, False),
    ("seven_scenes", "same_place.pgm", LOOPS, False),
    ("hololens", "K.txt", RUN, True),
    ("hololens", "poses.txt", RUN, False),
    ("hololens", "images/00002.png", RUN, True),
    ("hololens", "depth/00002.png", RUN, True),
    ("images", "000002.png", LOOPS, True),
    ("images", "000006.jpg", LOOPS, True),
    ("images", "camera.txt", RUN, True),
    ("images", "groundtruth.tum", LOOPS, False),
    ("image_list", "list.txt", ("loops", "list.txt", "--out", "out"), True),
    ("image_list", "pictures/000002.png", ("loops", "list.txt", "--out", "out"), False),
    ("video", "walk.avi", ("loops", "walk.avi", "--out", "out"), True),
    ("video", "camera.txt", ("run", "walk.avi", "--camera", "camera.txt", "--out", "out"), True),
    ("graph_2d", "graph.g2o", ("optimize", "graph.g2o", "--out", "solved.g2o"), True),
    ("config", "mine.yaml", ("config", "--config", "mine.yaml"), True),
    ("tum+extras", "words.bin",
     ("loops", ".", "--set", "retrieve.vocabulary=./words.bin", "--out", "out"), True),
    ("tum+extras", "net.onnx",
     ("loops", ".", "--set", "describe.method=autoencoder", "--set",
      "describe.network=./net.onnx", "--out", "out"), True),
    ("tum+extras", "known.sw", ("run", ".", "--map", "known.sw", "--out", "out"), True),
    ("images", "000002.png",
     ("calibrate", ".", "--board", "9x6", "--square", "0.02", "--out", "camera-found.txt"), True),
    ("run", "map.sw", ("map", "map.sw", "info"), True),
    ("run", "map.sw", ("ledger", ".", "show", "0", "--picture", "pair.svg"), True),
    ("run", "map.sw", ("ledger", ".", "reject", "0"), True),
    ("run", "loops.json", ("ledger", ".", "list"), True),
    ("run", "loops.json", ("eval", "."), True),
    ("run", "config.yaml", ("eval", "."), True),
    ("run", "config.yaml", ("dense", "."), True),
    ("run", "config.yaml", ("ledger", ".", "show", "0"), True),
    ("run", "frames.csv", ("eval", "."), True),
    ("run", "trajectory.tum", ("eval", "."), True),
    ("run", "odometry.tum", ("eval", "."), True),
    ("run", "trajectory.tum", ("dense", "."), True),
    ("run", "timing.json", ("eval", ".", "--stages"), True),
    ("loops", "matches.txt", ("eval", "."), True),
    ("loops", "accepted.txt", ("eval", "."), True),
    ("loops", "walk.txt", ("eval", ".", "--walk", "walk.txt"), True),
    ("run", "truth.tum", ("eval", ".", "--truth", "truth.tum"), True),
]


def problems_of(outcome, name, is_needed):
    """What must hold for a file that cannot be read as one."""
    yield from outcome.faults()
    if outcome.is_hung:
        return
    if os.path.basename(name) not in outcome.err:
        yield f"stderr does not name {name}: {outcome}"
    if is_needed and outcome.exit != 2:
        yield f"exit {outcome.exit}, expected 2: {outcome}"
    if not is_needed and outcome.exit not in (0, 2):
        yield f"exit {outcome.exit}, expected 0 with a warning, or 2: {outcome}"


def check_of(kind, sample, name, command, is_needed):
    def check(lab, folder):
        copy_with_links(lab.samples[sample], folder)
        path = os.path.join(folder, name)
        if os.path.lexists(path):
            os.remove(path)
        PUT[kind](path)
        outcome = lab.run(*command, cwd=folder, timeout_s=MAX_SECONDS)
        return problems_of(outcome, name, is_needed)

    return Check(f"{command[0]}: {kind} in place of {sample}/{name}", check)


def checks():
    return [check_of(kind, *row) for row in INPUTS for kind in PUT]


def make_extras(folder, sample, run_folder, models):
    """A recording with a vocabulary, a network and a map beside it."""
    copy_with_links(sample, folder)
    for name, source in (("words.bin", os.path.join(models, "words.bin")),
                         ("net.onnx", os.path.join(models, "autoencoder.onnx")),
                         ("known.sw", os.path.join(run_folder, "map.sw"))):
        shutil.copy(source, os.path.join(folder, name))
