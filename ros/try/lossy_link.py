#!/usr/bin/python3
# lossy_link.py ONE OTHER LOSS DELAY_S: a network between two network namespaces, 10.77.0.1 and 10.77.0.2, that loses each packet
# with the probability LOSS and delays it by DELAY_S. As root; until it is ended. For kernels without netem.
import collections
import fcntl
import os
import random
import select
import struct
import subprocess
import sys
import time

TUNSETIFF, IFF_TAP, IFF_NO_PI = 0x400454CA, 2, 0x1000


def ip(*words):
    subprocess.run(["ip", *words], check=True)


def open_link(namespace, address):
    link = os.open("/dev/net/tun", os.O_RDWR | os.O_NONBLOCK)
    name = f"lossy{address}"
    fcntl.ioctl(link, TUNSETIFF, struct.pack("16sH", name.encode(), IFF_TAP | IFF_NO_PI))
    ip("link", "set", name, "txqueuelen", "100000", "netns", namespace)
    ip("-n", namespace, "addr", "add", f"10.77.0.{address}/24", "dev", name)
    ip("-n", namespace, "link", "set", name, "up")
    ip("-n", namespace, "link", "set", "lo", "up")
    ip("-n", namespace, "route", "add", "224.0.0.0/4", "dev", name)
    return link


def main():
    links = [open_link(namespace, i + 1) for i, namespace in enumerate(sys.argv[1:3])]
    loss, delay_s = float(sys.argv[3]), float(sys.argv[4])
    chance = random.Random(1)
    waiting = collections.deque()  # due time, link, packet
    while True:
        timeout = max(0.0, waiting[0][0] - time.monotonic()) if waiting else None
        for link in select.select(links, [], [], timeout)[0]:
            try:
                packet = os.read(link, 65536)
            except BlockingIOError:
                continue
            if chance.random() >= loss:
                waiting.append((time.monotonic() + delay_s, links[1 - links.index(link)], packet))
        while waiting and waiting[0][0] <= time.monotonic():
            try:
                os.write(waiting[0][1], waiting[0][2])
            except OSError:
                pass
            waiting.popleft()


main()
