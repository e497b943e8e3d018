"""The kinds of work that `kills` kills, and what must hold of each afterwards."""
import filecmp
import shutil

import samples

# with a window so short, and no two views held to be connected, neighbours close loops
LOOPS = ["--set", "retrieve.window_frames=4", "--set", "map.min_shared=1000",
         "--set", "map.min_tracked_ratio=0.95"]
NUM_FRAMES = 14
LISTS = ["loops.json", "trajectory.tum", "odometry.tum", "frames.csv", "map.ply"]
DENSE = ["cloud.ply", "map.pgm", "map.yaml", "map.bt"]


class Kind:
    """One kind of work. `start(number)` returns the words of the command and the folder it works in;
    `check(what, folder)` looks at what is left there."""

    def __init__(self, lab):
        self.lab = lab
        self.seconds = 0.0  # that the work takes
        self.num_kills = 0
        self.num_cut = 0  # of these, before the end

    def copy(self, source, number):
        folder = self.lab.folder / f"{type(self).__name__}-{number}"
        shutil.copytree(source, folder)
        return folder


class Run(Kind):
    """run: the folder is new."""

    def prepare(self):
        self.seconds = self.lab.timed("run", self.lab.recording, *LOOPS, "--out", self.lab.base)

    def start(self, number):
        folder = self.lab.folder / f"run-{number}"
        return ["run", self.lab.recording, *LOOPS, "--out", folder], folder

    def check(self, what, folder):
        if (folder / "map.sw").exists():
            self.lab.check_map(what, folder / "map.sw")


class RunOver(Kind):
    """run --force: in place of an earlier run."""

    def prepare(self):
        folder = self.copy(self.lab.base, "first")
        self.seconds = self.lab.timed(*self.words(folder))

    def words(self, folder):
        return ["run", self.lab.recording, *LOOPS, "--out", folder, "--force"]

    def start(self, number):
        folder = self.copy(self.lab.base, number)
        return self.words(folder), folder

    def check(self, what, folder):
        if (folder / "map.sw").exists():
            self.lab.check_map(what, folder / "map.sw")
        if self.lab.expect_done(what, self.lab.call(*self.words(folder))):
            self.lab.expect_files(f"{what}, again", folder, self.lab.base)


class RunMap(Kind):
    """run --map: session 0 stays whole."""

    def prepare(self):
        known = self.lab.folder / "known.sw"
        shutil.copy(self.lab.base / "map.sw", known)
        self.num_poses = self.lab.num_poses(known)
        self.seconds = self.lab.timed(*self.words(known, self.lab.folder / "extended"))

    def words(self, known, out):
        return ["run", self.lab.recording, *LOOPS, "--map", known, "--out", out]

    def start(self, number):
        folder = self.lab.folder / f"known-{number}"
        folder.mkdir()
        shutil.copy(self.lab.base / "map.sw", folder / "map.sw")
        return self.words(folder / "map.sw", folder / "out"), folder

    def check(self, what, folder):
        self.lab.check_map(what, folder / "map.sw")
        found = self.lab.num_poses(folder / "map.sw")
        if found != self.num_poses:
            self.lab.fail(f"{what}: session 0 has {found} poses of {self.num_poses}")


class Change(Kind):
    """ledger reject and ledger force: map and lists change together."""
    word = ""

    def prepare_from(self, before, name):
        self.before = before
        self.after = self.lab.folder / name
        shutil.copytree(before, self.after)
        self.seconds = self.lab.timed("ledger", self.after, self.word, "0")
        if filecmp.cmp(before / "loops.json", self.after / "loops.json", shallow=False):
            self.lab.fail(f"ledger {self.word}: changes nothing")

    def start(self, number):
        folder = self.copy(self.before, number)
        return ["ledger", folder, self.word, "0"], folder

    def check(self, what, folder):
        self.lab.expect_done(what, self.lab.call("map", folder / "map.sw", "info"))
        if not self.lab.expect_done(what, self.lab.call("ledger", folder, "list")):
            return
        is_changed = filecmp.cmp(folder / "loops.json", self.after / "loops.json", shallow=False)
        expected = self.after if is_changed else self.before
        self.check_lists(what, folder, expected)
        if not is_changed:
            self.lab.expect_done(what, self.lab.call("ledger", folder, self.word, "0"))
            self.check_lists(f"{what}, again", folder, self.after)
            self.lab.expect_files(f"{what}, again", folder, self.after)

    def check_lists(self, what, folder, expected):
        for name in LISTS:
            if not filecmp.cmp(folder / name, expected / name, shallow=False):
                self.lab.fail(f"{what}: {name} is not that of {expected.name}")
        points = self.lab.folder / "points.ply"
        exported = self.lab.call("map", folder / "map.sw", "export", "--ply", points)
        if self.lab.expect_done(what, exported) and not filecmp.cmp(points, folder / "map.ply",
                                                                    shallow=False):
            self.lab.fail(f"{what}: the map is not that of its lists")


class Reject(Change):
    word = "reject"

    def prepare(self):
        self.prepare_from(self.lab.base, "rejected")


class Force(Change):
    word = "force"

    def prepare(self):
        self.prepare_from(self.lab.folder / "rejected", "forced")


class Dense(Kind):
    """dense, over what it made before with other settings."""

    def prepare(self):
        self.before = self.copy(self.lab.base, "before")
        self.after = self.copy(self.lab.base, "after")
        self.lab.timed("dense", self.before, "--set", "dense.voxel_m=0.05", "--set",
                       "dense.grid_cell_m=0.1", "--set", "dense.octree_voxel_m=0.1")
        self.seconds = self.lab.timed("dense", self.after)
        for name in DENSE:
            if filecmp.cmp(self.before / name, self.after / name, shallow=False):
                self.lab.fail(f"dense: {name} does not tell before from after")

    def start(self, number):
        folder = self.copy(self.before, number)
        return ["dense", folder], folder

    def check(self, what, folder):
        self.lab.expect_before_or_after(what, DENSE, folder, self.before, self.after)
        if self.lab.expect_done(what, self.lab.call("dense", folder)):
            self.lab.expect_before_or_after(f"{what}, again", DENSE, folder, self.after, self.after)
            self.lab.expect_files(f"{what}, again", folder, self.after)


class Calibrate(Kind):
    """calibrate, over a camera file that was there."""

    def prepare(self):
        self.boards = self.lab.folder / "boards"
        samples.boards(self.boards)
        self.before = self.lab.folder / "camera-before"
        self.after = self.lab.folder / "camera-after"
        for folder in (self.before, self.after):
            folder.mkdir()
            (folder / "camera.txt").write_text(samples.CAMERA)
        self.seconds = self.lab.timed(*self.words(self.after))

    def words(self, folder):
        return ["calibrate", self.boards, *samples.BOARD, "--out", folder / "camera.txt"]

    def start(self, number):
        folder = self.copy(self.before, number)
        return self.words(folder), folder

    def check(self, what, folder):
        self.lab.expect_before_or_after(what, ["camera.txt"], folder, self.before, self.after)
        if self.lab.expect_done(what, self.lab.call(*self.words(folder))):
            self.lab.expect_before_or_after(f"{what}, again", ["camera.txt"], folder, self.after,
                                            self.after)
            self.lab.expect_files(f"{what}, again", folder, self.after)


# in this order: some start from what others have prepared
KINDS = {"run": Run, "run --force": RunOver, "run --map": RunMap, "ledger reject": Reject,
         "ledger force": Force, "dense": Dense, "calibrate": Calibrate}
