#!/usr/bin/python3
# check_tf.py OUT.bag LIVE.tum: whether /tf of a bag is one tree of map -> odom -> base with one parent a frame, and whether
# odom -> base never jumps; writes map -> base as it was told live, without rotations.
import sys

import numpy
import rosbag

MAX_STEP_M = 0.15  # of a frame; a camera that is carried moves less


def matrix(transform):
    t, q = transform.translation, transform.rotation
    x, y, z, w = q.x, q.y, q.z, q.w
    out = numpy.eye(4)
    out[:3, :3] = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    out[:3, 3] = [t.x, t.y, t.z]
    return out


def main():
    parents, odom, live = {}, [], []
    with rosbag.Bag(sys.argv[1]) as bag:
        for _, message, _ in bag.read_messages(topics=["/tf"]):
            edges = {}
            for transform in message.transforms:
                child, parent = transform.child_frame_id, transform.header.frame_id
                if parents.setdefault(child, parent) != parent:
                    sys.exit(f"{child} has two parents: {parents[child]} and {parent}")
                edges[child] = transform
            base = [child for child in edges if edges[child].header.frame_id == "odom"]
            if "odom" not in edges or len(base) != 1:
                sys.exit(f"expected map -> odom -> base, found {parents}")
            odom.append(matrix(edges[base[0]].transform)[:3, 3])
            live.append((edges[base[0]].header.stamp.to_sec(), matrix(edges["odom"].transform) @ matrix(edges[base[0]].transform)))
    tree = ", ".join(f"{parent} -> {child}" for child, parent in parents.items())
    step = max(numpy.linalg.norm(b - a) for a, b in zip(odom, odom[1:]))
    print(f"TF: {len(odom)} messages, {tree}; largest step of odom -> base {step:.3f} m")
    if step > MAX_STEP_M:
        sys.exit(f"odom -> base jumps by {step:.3f} m")
    with open(sys.argv[2], "w", encoding="utf-8") as out:
        for stamp, pose in live:
            out.write(f"{stamp:.6f} {pose[0, 3]:.6f} {pose[1, 3]:.6f} {pose[2, 3]:.6f} 0 0 0 1\n")


main()
