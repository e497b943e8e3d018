#!/usr/bin/env python3
"""ros1_bags.py SAMEWHERE FOLDER: bags of `samewhere convert` against python3-rosbag, the reader and writer of ROS 1.

FOLDER is empty. A short rendered sequence is written as .bag with each compression; python3-rosbag has to read the same
messages from all of them. What python3-rosbag writes (none, lz4, bz2) is converted once more and has to hold the same.
Exit status 77: python3-rosbag or python3-sensor-msgs is not installed.
"""
import hashlib
import pathlib
import subprocess
import sys

try:
    import rosbag
except ImportError:
    print("python3-rosbag is not installed")
    sys.exit(77)

COMPRESSIONS = ("none", "lz4", "bz2")


def digest(path):
    """Number of messages, and a checksum of topics, times and bytes."""
    total, count = hashlib.sha256(), 0
    with rosbag.Bag(str(path)) as bag:
        for topic, message, time in bag.read_messages(raw=True):
            # message: type, bytes, checksum of the type, position, class
            total.update(f"{topic} {time.to_nsec()} {message[0]} {message[2]}".encode() + message[1])
            count += 1
    return count, total.hexdigest()


def main():
    program, folder = sys.argv[1], pathlib.Path(sys.argv[2])
    source = ["twin:mirror?seed=3", "--set", "twin.num_frames=10"]
    found = set()
    for method in COMPRESSIONS:
        path = folder / f"ours-{method}.bag"
        subprocess.run([program, "convert", source[0], str(path), "--quiet", "--compression", method, *source[1:]],
                       check=True, stdout=subprocess.DEVNULL)
        found.add(digest(path))
    for method in COMPRESSIONS:
        theirs = folder / f"theirs-{method}.bag"
        with rosbag.Bag(str(folder / "ours-none.bag")) as bag, \
                rosbag.Bag(str(theirs), "w", compression=method) as out:
            for topic, message, time in bag.read_messages():
                out.write(topic, message, time)
        back = folder / f"back-{method}.bag"
        subprocess.run([program, "convert", str(theirs), str(back), "--quiet"], check=True, stdout=subprocess.DEVNULL)
        found.add(digest(back))
    if len(found) != 1:
        sys.exit(f"expected one content, found {sorted(found)}")
    count, checksum = found.pop()
    print(f"{count} messages in each of {2 * len(COMPRESSIONS)} bags, {checksum[:16]}")


main()
