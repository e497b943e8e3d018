"""The samples, and what the program itself writes of them: a finished run, a map."""
import os
import shutil

import samples
import special_files

REPOSITORY = os.path.dirname(os.path.dirname(os.path.dirname(os.path.realpath(__file__))))


def make_samples(lab, root):
    """One folder of each kind, by name. Those of runs are what the program itself writes."""
    made = {}
    makers = dict(samples.RECORDINGS, image_list=samples.image_list, video=samples.video,
                  graph_2d=samples.graph_2d, graph_3d=samples.graph_3d, config=samples.config)
    for name, make in makers.items():
        made[name] = os.path.join(root, name)
        os.makedirs(made[name])
        make(made[name])
    long_walk = os.path.join(root, "long")
    os.makedirs(long_walk)
    samples.tum(long_walk, num_frames=80, step_px=8)
    for command in ("run", "loops"):
        made[command] = os.path.join(root, command)
        outcome = lab.run(command, long_walk, "--set", "retrieve.window_frames=5", "--out",
                          made[command], cwd=root, timeout_s=60)
        if outcome.exit != 0:
            raise SystemExit(f"no sample of a finished run: {outcome}")
    shutil.copy(os.path.join(long_walk, "groundtruth.txt"), os.path.join(made["run"], "truth.tum"))
    samples.write(made["loops"], "walk.txt", "".join(f"{i}.png 0 0\n" for i in range(80)))
    made["bags"] = os.path.join(root, "bags")
    os.makedirs(made["bags"])
    for name, compression in (("walk.mcap", "zstd"), ("walk.db3", "none"), ("walk.bag", "lz4")):
        outcome = lab.run("convert", made["tum"], os.path.join(made["bags"], name), "--quiet",
                          "--compression", compression, cwd=root, timeout_s=60)
        if outcome.exit != 0:
            raise SystemExit(f"no sample of a bag: {outcome}")
    made["tum+extras"] = os.path.join(root, "extras")
    special_files.make_extras(made["tum+extras"], made["tum"], made["run"],
                              os.path.join(REPOSITORY, "models"))
    made["pictures-640"] = os.path.join(root, "pictures-640")
    os.makedirs(made["pictures-640"])
    samples.plain_pictures(made["pictures-640"], 640, 480)
    return made
