"""Recordings of files."""

import pathlib

import samewhere


def test_images_that_only_the_plugin_reads(tmp_path: pathlib.Path) -> None:
    for i in range(3):
        (tmp_path / f"{i}.pgm").write_bytes(b"P5 64 48 255\n" + bytes(64 * 48))
    frames = list(samewhere.Recording(str(tmp_path)))
    assert [frame.images[0].shape for frame in frames] == [(48, 64)] * 3
