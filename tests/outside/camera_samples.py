"""Camera files in every format that is read, of the pictures of samples.py."""
from samples import CAMERA, FOCAL_PX, HEIGHT, WIDTH, write

F, CX, CY = FOCAL_PX, WIDTH / 2, HEIGHT / 2
MATRIX = f"{F}, 0, {CX}, 0, {F}, {CY}, 0, 0, 1"

FILES = {
    "rows.txt": CAMERA,
    "depth-factor.txt": CAMERA + "depth_factor 5000\n",
    "rational.txt": CAMERA.replace("0.01 0 0 0 0", "0.01 0 0 0 0 0.01 0 0"),
    "fisheye.txt": CAMERA.replace("0.01 0 0 0 0", "fisheye 0.01 0 0 0"),
    "opencv.yaml": ("%YAML:1.0\n---\nimage_width: {w}\nimage_height: {h}\ncamera_matrix: "
                    "!!opencv-matrix\n   rows: 3\n   cols: 3\n   dt: d\n   data: [ {m} ]\n"
                    "distortion_coefficients: !!opencv-matrix\n   rows: 1\n   cols: 5\n   dt: d\n"
                    "   data: [ 0.01, 0., 0., 0., 0. ]\n"),
    "opencv.xml": ("<?xml version=\"1.0\"?>\n<opencv_storage>\n<image_width>{w}</image_width>\n"
                   "<image_height>{h}</image_height>\n<camera_matrix type_id=\"opencv-matrix\">\n"
                   "<rows>3</rows><cols>3</cols><dt>d</dt><data>{s}</data></camera_matrix>\n"
                   "<distortion_coefficients type_id=\"opencv-matrix\"><rows>1</rows><cols>5</cols>"
                   "<dt>d</dt><data>0.01 0. 0. 0. 0.</data></distortion_coefficients>\n"
                   "</opencv_storage>\n"),
    "orbslam2.yaml": ("%YAML:1.0\nCamera.fx: {f}\nCamera.fy: {f}\nCamera.cx: {x}\nCamera.cy: {y}\n"
                      "Camera.k1: 0.01\nCamera.k2: 0.0\nCamera.p1: 0.0\nCamera.p2: 0.0\n"
                      "Camera.width: {w}\nCamera.height: {h}\nCamera.fps: 30.0\n"
                      "DepthMapFactor: 5000.0\n"),
    "orbslam3.yaml": ("%YAML:1.0\nCamera.type: \"KannalaBrandt8\"\nCamera1.fx: {f}\nCamera1.fy: {f}\n"
                      "Camera1.cx: {x}\nCamera1.cy: {y}\nCamera1.k1: 0.01\nCamera1.k2: 0.0\n"
                      "Camera1.k3: 0.0\nCamera1.k4: 0.0\nCamera.width: {w}\nCamera.height: {h}\n"),
    "camera_info.yaml": ("image_width: {w}\nimage_height: {h}\ncamera_name: left\ncamera_matrix:\n"
                         "  rows: 3\n  cols: 3\n  data: [{m}]\ndistortion_model: plumb_bob\n"
                         "distortion_coefficients:\n  rows: 1\n  cols: 5\n  data: [0.01, 0, 0, 0, 0]\n"),
    "camchain.yaml": ("cam0:\n  camera_model: pinhole\n  distortion_coeffs: [0.01, 0.0, 0.0, 0.0]\n"
                      "  distortion_model: radtan\n  intrinsics: [{f}, {f}, {x}, {y}]\n"
                      "  resolution: [{w}, {h}]\n  rostopic: /cam0\ncam1:\n  camera_model: pinhole\n"
                      "  distortion_coeffs: [0.01, 0.0, 0.0, 0.0]\n  distortion_model: equidistant\n"
                      "  intrinsics: [{f}, {f}, {x}, {y}]\n  resolution: [{w}, {h}]\n"),
    "vins.yaml": ("%YAML:1.0\n---\nmodel_type: PINHOLE\ncamera_name: camera\nimage_width: {w}\n"
                  "image_height: {h}\ndistortion_parameters:\n   k1: 0.01\n   k2: 0\n   p1: 0\n"
                  "   p2: 0\nprojection_parameters:\n   fx: {f}\n   fy: {f}\n   cx: {x}\n   cy: {y}\n"),
    "cameras.txt": "# CAMERA_ID, MODEL, WIDTH, HEIGHT, PARAMS[]\n1 OPENCV {w} {h} {f} {f} {x} {y} 0.01 0 0 0\n",
    "transforms.json": ('{{"camera_model": "OPENCV", "fl_x": {f}, "fl_y": {f}, "cx": {x}, "cy": {y}, '
                        '"w": {w}, "h": {h}, "k1": 0.01, "k2": 0.0, "p1": 0.0, "p2": 0.0, "frames": '
                        '[{{"file_path": "000000.png", "transform_matrix": [[1, 0, 0, 0]]}}]}}\n'),
    "open3d.json": ('{{"width": {w}, "height": {h}, "intrinsic_matrix": [{f}, 0, 0, 0, {f}, 0, {x}, '
                    '{y}, 1]}}\n'),
    "keys.yaml": "fx: {f}\nfy: {f}\ncx: {x}\ncy: {y}\nwidth: {w}\nheight: {h}\n",
}


def cameras(folder):
    for name, text in FILES.items():
        if "{f}" in text or "{m}" in text or "{s}" in text:
            text = text.format(f=F, x=CX, y=CY, w=WIDTH, h=HEIGHT, m=MATRIX,
                               s=MATRIX.replace(",", ""))
        write(folder, name, text)
