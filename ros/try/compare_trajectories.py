#!/usr/bin/python3
# compare_trajectories.py ONE.tum OTHER.tum [MAX_M]: the poses of both at equal stamps, after the best rigid
# alignment. Prints n, RMSE and maximum in metres; fails if the RMSE is above MAX_M.
import math
import sys

import numpy


def read(path):
    rows = [line.split() for line in open(path, encoding="utf-8") if line.strip() and not line.startswith("#")]
    return {round(float(row[0]), 4): [float(value) for value in row[1:4]] for row in rows}


def main():
    one, other = read(sys.argv[1]), read(sys.argv[2])
    stamps = sorted(one.keys() & other.keys())
    if len(stamps) < 3:
        sys.exit(f"{len(stamps)} common stamps, expected 3 or more")
    a, b = (numpy.array([poses[stamp] for stamp in stamps]) for poses in (one, other))
    a, b = a - a.mean(axis=0), b - b.mean(axis=0)
    u, _, vt = numpy.linalg.svd(a.T @ b)
    turn = vt.T @ numpy.diag([1, 1, numpy.linalg.det(vt.T @ u.T)]) @ u.T
    errors = numpy.linalg.norm(a @ turn.T - b, axis=1)
    rmse = math.sqrt((errors**2).mean())
    print(f"n {len(stamps)}  RMSE {rmse:.4f} m  maximum {errors.max():.4f} m")
    if len(sys.argv) > 3 and rmse > float(sys.argv[3]):
        sys.exit(f"RMSE above {sys.argv[3]} m")


main()
