"""Small good inputs of every kind that the program reads. Each function fills a folder that is there."""
import os

from pictures import avi, board, depth_png, jpeg, png, texture

WIDTH, HEIGHT = 160, 120
NUM_FRAMES = 6
STEP_PX = 3
FOCAL_PX = 130.0
DEPTH_M = 2.0
TUM_UNITS_PER_M = 5000
MM_PER_M = 1000
CAMERA = (f"{FOCAL_PX} 0 {WIDTH / 2}\n0 {FOCAL_PX} {HEIGHT / 2}\n0 0 1\n0.01 0 0 0 0\n"
          f"{WIDTH} {HEIGHT}\n")


def write(folder, name, content):
    path = os.path.join(folder, name)
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "wb") as file:
        file.write(content if isinstance(content, bytes) else content.encode())


def positions(num_frames, step_px=STEP_PX):
    """There and back, so that places are seen again."""
    there = list(range(0, num_frames // 2 * step_px, step_px))
    return (there + there[::-1] + [0] * num_frames)[:num_frames]


def views(num_frames=NUM_FRAMES, shift_px=0, make=png, step_px=STEP_PX):
    """Pictures of a wall that the camera passes sideways."""
    wall = texture(WIDTH + step_px * num_frames + 40, HEIGHT)
    for x in positions(num_frames, step_px):
        left = x + 20 - shift_px
        yield make([row[left:left + WIDTH] for row in wall], WIDTH)


def lateral_m(x_px):
    return x_px * DEPTH_M / FOCAL_PX


def matrix(x_m):
    return f"1 0 0 {x_m:.6f} 0 1 0 0 0 0 1 0"


def tum(folder, num_frames=NUM_FRAMES, step_px=STEP_PX):
    rgb, depth, truth = [], [], []
    for i, picture in enumerate(views(num_frames, step_px=step_px)):
        stamp = f"{1 + i / 10:.6f}"
        write(folder, f"rgb/{stamp}.png", picture)
        write(folder, f"depth/{stamp}.png",
              depth_png(WIDTH, HEIGHT, int(DEPTH_M * TUM_UNITS_PER_M)))
        rgb.append(f"{stamp} rgb/{stamp}.png\n")
        depth.append(f"{stamp} depth/{stamp}.png\n")
        truth.append(f"{stamp} {lateral_m(positions(num_frames, step_px)[i]):.6f} 0 0 0 0 0 1\n")
    write(folder, "rgb.txt", "".join(rgb))
    write(folder, "depth.txt", "".join(depth))
    write(folder, "groundtruth.txt", "# stamp x y z qx qy qz qw\n" + "".join(truth))
    write(folder, "camera.txt", CAMERA)
    write(folder, "same_place.txt", places_text(num_frames))
    write(folder, "aliased_pairs.csv", "query,match\n5,0\n")


def places_text(num_frames):
    row = " ".join(["0"] * num_frames)
    return (row + "\n") * num_frames


def places_pgm(num_frames):
    return f"P5\n{num_frames} {num_frames}\n255\n".encode() + bytes(num_frames * num_frames)


def sensor_yaml(baseline_m=0.0):
    return (f"sensor_type: camera\nrate_hz: 10\nresolution: [{WIDTH}, {HEIGHT}]\n"
            "camera_model: pinhole\n"
            f"intrinsics: [{FOCAL_PX}, {FOCAL_PX}, {WIDTH / 2}, {HEIGHT / 2}]\n"
            "distortion_model: radial-tangential\n"
            "distortion_coefficients: [0.01, 0.0, 0.0, 0.0]\n" + body_from_sensor(baseline_m))


def body_from_sensor(x_m):
    return (f"T_BS:\n  rows: 4\n  cols: 4\n  data: [1, 0, 0, {x_m}, 0, 1, 0, 0, 0, 0, 1, 0, "
            "0, 0, 0, 1]\n")


BASELINE_M = 0.1
IMU_YAML = ("sensor_type: imu\nrate_hz: 100\ngyroscope_noise_density: 1e-4\n"
            "gyroscope_random_walk: 1e-5\naccelerometer_noise_density: 1e-3\n"
            "accelerometer_random_walk: 1e-4\n" + body_from_sensor(0.0))


def euroc(folder, num_frames=NUM_FRAMES):
    disparity_px = round(FOCAL_PX * BASELINE_M / DEPTH_M)
    stamps = [1_000_000_000 + 100_000_000 * i for i in range(num_frames)]
    for camera in range(2):
        base = f"mav0/cam{camera}"
        for stamp, picture in zip(stamps, views(num_frames, -camera * disparity_px)):
            write(folder, f"{base}/data/{stamp}.png", picture)
        write(folder, f"{base}/data.csv",
              "#timestamp [ns],filename\n" + "".join(f"{s},{s}.png\n" for s in stamps))
        write(folder, f"{base}/sensor.yaml", sensor_yaml(camera * BASELINE_M))
    imu = range(stamps[0], stamps[-1] + 1, 10_000_000)
    write(folder, "mav0/imu0/data.csv",
          "#stamp,wx,wy,wz,ax,ay,az\n" + "".join(f"{s},0,0,0,0,0,9.81\n" for s in imu))
    write(folder, "mav0/imu0/sensor.yaml", IMU_YAML)
    states = "".join(f"{s},{lateral_m(x):.6f},0,0,1,0,0,0,0,0,0,0,0,0,0,0,0\n"
                     for s, x in zip(stamps, positions(num_frames)))
    write(folder, "mav0/state_groundtruth_estimate0/data.csv", "#stamp,p,q,v,bw,ba\n" + states)
    write(folder, "mav0/state_groundtruth_estimate0/sensor.yaml", body_from_sensor(0.0))


def kitti(folder, num_frames=NUM_FRAMES):
    disparity_px = round(FOCAL_PX * BASELINE_M / DEPTH_M)
    for camera in range(2):
        for i, picture in enumerate(views(num_frames, -camera * disparity_px)):
            write(folder, f"image_{camera}/{i:06d}.png", picture)
    rows = ""
    for camera in range(2):
        shift = -FOCAL_PX * BASELINE_M * camera
        rows += (f"P{camera}: {FOCAL_PX} 0 {WIDTH / 2} {shift} 0 {FOCAL_PX} {HEIGHT / 2} 0 "
                 "0 0 1 0\n")
    write(folder, "calib.txt", rows)
    write(folder, "times.txt", "".join(f"{i / 10:.6f}\n" for i in range(num_frames)))
    write(folder, "poses.txt",
          "".join(matrix(lateral_m(x)) + "\n" for x in positions(num_frames)))


def seven_scenes(folder, num_frames=NUM_FRAMES):
    for i, picture in enumerate(views(num_frames)):
        write(folder, f"frame-{i:06d}.color.png", picture)
        write(folder, f"frame-{i:06d}.depth.png", depth_png(WIDTH, HEIGHT, int(DEPTH_M * MM_PER_M)))
        pose = matrix(lateral_m(positions(num_frames)[i])).split()
        rows = [" ".join(pose[k:k + 4]) for k in range(0, 12, 4)] + ["0 0 0 1"]
        write(folder, f"frame-{i:06d}.pose.txt", "\n".join(rows) + "\n")
    write(folder, "camera.txt", CAMERA)
    write(folder, "same_place.pgm", places_pgm(num_frames))


def hololens(folder, num_frames=NUM_FRAMES):
    for i, picture in enumerate(views(num_frames)):
        write(folder, f"images/{i:05d}.png", picture)
        write(folder, f"depth/{i:05d}.png", depth_png(WIDTH, HEIGHT, int(DEPTH_M * MM_PER_M)))
    write(folder, "K.txt", "\n".join(CAMERA.splitlines()[:3]) + "\n")
    write(folder, "poses.txt",
          "".join(f"{matrix(lateral_m(x))} 0 0 0 1\n" for x in positions(num_frames)))


def images(folder, num_frames=NUM_FRAMES):
    for i, picture in enumerate(views(num_frames)):
        write(folder, f"{i:06d}.png", picture)
    for i, picture in enumerate(views(2, make=jpeg)):
        write(folder, f"{num_frames + i:06d}.jpg", picture)
    write(folder, "camera.txt", CAMERA)
    write(folder, "groundtruth.tum",
          "".join(f"{i / 30:.6f} {i} 0 0 0 0 0 1\n" for i in range(num_frames)))


def image_list(folder, num_frames=NUM_FRAMES):
    images(os.path.join(folder, "pictures"), num_frames)
    write(folder, "list.txt", "".join(f"pictures/{i:06d}.png\n" for i in range(num_frames)))


def video(folder, num_frames=NUM_FRAMES):
    write(folder, "walk.avi", avi(list(views(num_frames, make=jpeg)), WIDTH))
    write(folder, "camera.txt", CAMERA)


BOARD = ("--board", "6x4", "--square", "0.03")


def boards(folder, make=png, ending="png"):
    """Pictures of a checkerboard, for `calibrate`."""
    poses = [((0.0, 0.0), (0, 0, 9)), ((0.5, 0.0), (0.5, 0, 9)), ((-0.5, 0.1), (0, 0.5, 9)),
             ((0.0, 0.5), (-0.5, 0, 9)), ((0.1, -0.5), (0, -0.5, 9)), ((0.35, 0.35), (1.5, 1, 11)),
             ((-0.35, 0.35), (-1.5, 1, 11)), ((0.3, -0.4), (1, -1, 10))]
    size_px = (2 * WIDTH, 2 * HEIGHT)
    for i, (tilt_rad, centre) in enumerate(poses):
        rows = board(size_px, 2 * FOCAL_PX, (6, 4), tilt_rad, centre)
        write(folder, f"{i:06d}.{ending}", make(rows, size_px[0]))


def graph_2d(folder):
    """A square that is driven round twice, with its loops."""
    lines, corners = [], [(0, 0), (1, 0), (1, 1), (0, 1)]
    for i in range(8):
        x, y = corners[i % 4]
        lines.append(f"VERTEX_SE2 {i} {x + 0.01 * i} {y} {i % 4 * 1.5707963}")
    information = "500 0 0 500 0 500"
    lines += [f"EDGE_SE2 {i} {i + 1} 1 0 1.5707963 {information}" for i in range(7)]
    lines += [f"EDGE_SE2 {i} {i + 4} 0 0 0 {information}" for i in range(4)]
    write(folder, "graph.g2o", "\n".join(lines) + "\n")


def graph_3d(folder):
    lines = [f"VERTEX_SE3:QUAT {i} {i} 0 0.01 0 0 0 1" for i in range(6)]
    rows = ["0"] * 21
    for diagonal in (0, 6, 11, 15, 18, 20):
        rows[diagonal] = "100"
    information = " ".join(rows)
    lines += [f"EDGE_SE3:QUAT {i} {i + 1} 1 0 0 0 0 0 1 {information}" for i in range(5)]
    lines.append(f"EDGE_SE3:QUAT 0 5 5 0.1 0 0 0 0 1 {information}")
    write(folder, "graph.g2o", "\n".join(lines) + "\n")


def config(folder):
    write(folder, "mine.yaml", "seed: 3\nverify:\n  min_inliers: 30\nfeatures:\n  num_features: 500\n")


RECORDINGS = {
    "tum": tum,
    "euroc": euroc,
    "kitti": kitti,
    "seven_scenes": seven_scenes,
    "hololens": hololens,
    "images": images,
}


def plain_pictures(folder, width, height, num_frames=3):
    for i in range(num_frames):
        rows = texture(width, height, seed=5)
        write(folder, f"{i:06d}.png", png(rows, width))
