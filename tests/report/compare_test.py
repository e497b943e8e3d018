#!/usr/bin/python3
"""compare_test.py PROGRAM: the page of `samewhere compare` in headless Chromium.

One rendered walk through two look-alike corridors, with drifting odometry, is run with the profile `usual` and as
shipped. Exit status 77 (skipped) without Chromium or Selenium.
"""
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

import page_test

SOURCE = "twin:twin-corridors?seed=22&speed=2&similarity=1"

COUNT_PIXELS_OF = """
  const column = samewhere.comparison.columns[arguments[0]], shown = column.canvas;
  if (column.map.renderNow) column.map.renderNow();
  const canvas = document.createElement('canvas');
  canvas.width = shown.width; canvas.height = shown.height;
  const pen = canvas.getContext('2d');
  pen.drawImage(shown, 0, 0);
  const data = pen.getImageData(0, 0, canvas.width, canvas.height).data;
  let drawn = 0;
  for (let i = 0; i < data.length; i += 4)
    if (Math.abs(data[i] - data[0]) + Math.abs(data[i + 1] - data[1]) + Math.abs(data[i + 2] - data[2]) > 24) ++drawn;
  return drawn / (data.length / 4);
"""
NUM_FALSE = "return samewhere.comparison.runs.map((run) => run.candidates.filter((candidate) => candidate.kind === 'false').length)"
NUM_ACCEPTED = "return samewhere.comparison.runs.map((run) => run.candidates.filter((candidate) => candidate.verdict === 'LOOP').length)"


def make(program, folder):
    os.environ["SAMEWHERE_CACHE"] = str(folder / "pictures")
    wheels = str(folder / "wheels.tum")

    def call(*arguments):
        return subprocess.run([program, *arguments], check=True, stdout=subprocess.PIPE, text=True).stdout

    call("twin", SOURCE, "--odometry", wheels, "--degrade", "2%+0.3deg/m")
    for name, profile in (("usual", "usual"), ("shipped", "default")):
        call("run", SOURCE, "--odometry", wheels, "--profile", profile, "--out", str(folder / name))
    text = call("compare", str(folder / "usual"), str(folder / "shipped"), "--out", str(folder / "compare.html"))
    return folder / "compare.html", text


def check(page, folder, text, has_webgl):
    loops = [json.loads((folder / name / "loops.json").read_text())["candidates"] for name in ("usual", "shipped")]
    page.check("the page is ready", page.load_s is not None, f"{page.load_s} s")
    for i in range(2):
        share = page.run(COUNT_PIXELS_OF, i)
        page.check(f"map {i + 1} is drawn", share > 0.01, f"{100 * share:.1f} % of the pixels")
    accepted = page.run(NUM_ACCEPTED)
    page.check("accepted loops are those of loops.json", accepted == [sum(c["verdict"] == "LOOP" for c in run) for run in loops], accepted)
    false = page.run(NUM_FALSE)
    page.check("the usual loop closing is fooled by the look-alike corridor", false[0] > 5, false)
    page.check("ours is not", false[1] == 0, false)
    page.check("the terminal counts them as the page does", f"The {false[0]} false loops of usual" in text)
    bars = page.run("return Array.from(document.querySelectorAll('#judged .check b')).reduce((sum, b) => sum + Number(b.textContent), 0)")
    page.check("the bars count each of them once", bars == false[0], bars)
    page.run("const c = samewhere.comparison.columns[0]; c.state.set('selected', c.run.candidates.find((x) => x.kind === 'false'))")
    articles = page.run("return Array.from(document.querySelectorAll('#details article')).map((a) => a.textContent)")
    page.check("a false loop shows the verdict of both", len(articles) == 2 and "false by the ground truth" in articles[0] and any(word in articles[1] for word in ("rejected", "ambiguous", "no candidate")), len(articles))
    page.check("the settings that differ are listed", "verify.min_inliers" in page.by_id("settings").text)
    if has_webgl:
        page.by_id("view-top").click()
        page.wait("return false", 0.6)
        cameras = page.run("return samewhere.comparison.columns.map(({map}) => map.camera.position.toArray().map((v) => v.toFixed(3)).join())")
        page.check("one camera for both maps", cameras[0] == cameras[1], cameras[0])
    page_test.check_quiet(page)


def main():
    if not shutil.which("chromium") or not shutil.which("chromedriver"):
        page_test.skip("chromium and chromium-driver are not installed")
    num_failed = 0
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as name:
        folder = pathlib.Path(name)
        report, text = make(sys.argv[1], folder)
        for has_webgl in (True, False):
            print("with WebGL" if has_webgl else "without WebGL")
            driver = page_test.browser(1400, 1000, False, has_webgl, f"{name}/profile-{has_webgl}")
            try:
                page = page_test.Page(driver, report)
                check(page, folder, text, has_webgl)
                num_failed += page.num_failed
            finally:
                driver.quit()
    print(f"{num_failed} failed" if num_failed else "all passed")
    sys.exit(1 if num_failed else 0)


if __name__ == "__main__":
    main()
