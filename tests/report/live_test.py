#!/usr/bin/python3
"""live_test.py PROGRAM: the live viewer in headless Chromium.

Follows short runs of `samewhere run` and `samewhere loops` from their first frames to their reports, pauses them, and compares their
results with those of the same runs without a viewer; then overrides a verdict on the page of the finished run. Exit status 77
(skipped) without Chromium or Selenium.

  live_test.py PROGRAM --pictures FOLDER   keeps screenshots
"""
import argparse
import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time

import page_test

SOURCE = "twin:twin-corridors?seed=22&speed=2"
# short, and with accepted loops between views near to each other
SETTINGS = ["twin.num_frames=120", "retrieve.window_frames=10", "map.min_shared=1000", "verify.min_look_alike_distance_m=0.3"]
SAME_FILES = {"run": ["trajectory.tum", "odometry.tum", "loops.json", "frames.csv", "map.ply"],
              "loops": ["loops.json", "matches.txt", "accepted.txt"]}
FEW_FRAMES = ("--set", "twin.num_frames=50")  # recognition verifies each view with all before
NUM_UPDATES = 30


class LivePage(page_test.Page):
    """A page that a server gives."""

    def __init__(self, driver, url):
        self.driver = driver
        self.num_failed = 0
        driver.get(url)

    def mode(self):
        return self.run("return document.documentElement.dataset.mode")

    def num_frames(self):
        return self.run("return typeof samewhere !== 'undefined' && samewhere.run ? samewhere.run.num : 0")


def command_of(program, command, out, *more):
    sets = [word for setting in SETTINGS for word in ("--set", setting)]
    return [program, command, SOURCE, "--out", str(out), "--quiet", *sets, *more]


def url_of(process):
    for line in process.stderr:
        found = re.search(r"http://\S+", line)
        if found:
            return found.group(0)
    raise RuntimeError("the program printed no address")


def check_pause(page, pictures):
    page.by_id("live-pause").click()
    page.check("the button says that the run is paused", page.wait("return document.documentElement.dataset.paused === 'true'"))
    time.sleep(1.5)  # what was on its way
    before = page.num_frames()
    time.sleep(1.5)
    page.check("a pause stops the run", page.num_frames() == before, before)
    if pictures:
        page.picture(pictures / "live.png")
    page.by_id("live-step").click()
    page.check("a step processes one frame", page.wait(f"return samewhere.run.num === {before + 1}"), page.num_frames())
    time.sleep(1.0)
    page.check("and no other", page.num_frames() == before + 1)
    page.run("const s = document.getElementById('live-speed'); s.value = '0.1'; s.dispatchEvent(new Event('change'))")
    time.sleep(2.0)
    slow = page.num_frames()
    time.sleep(3.0)
    # 15 frames per second were recorded: at a tenth, 1.5
    page.check("slow motion is slow", 1 <= page.num_frames() - slow <= 12, page.num_frames() - slow)
    page.run("const s = document.getElementById('live-speed'); s.value = '0'; s.dispatchEvent(new Event('change'))")


def check_live(page, pictures):
    page.check("the page follows the run", page.wait("return typeof samewhere !== 'undefined' && samewhere.run && samewhere.run.num > 20", 90), page.num_frames())
    page.check("it is a live page", page.mode() == "live", page.mode())
    page.check("landmarks are drawn", page.run(page_test.COUNT_PIXELS) > 0.01)
    page.check("the image has tracked features", page.wait("return Number(document.getElementById('view-features').dataset.tracked) > 20", 10))
    page.check("the slider is at the newest frame", page.run("return samewhere.live.isAtEnd()"))
    page.by_id("view-follow").click()
    page.check("the view follows the camera", page.run("return samewhere.state.get('isFollowing')"))
    check_pause(page, pictures)
    page.wait("return samewhere.run.candidates.some((candidate) => candidate.kind === 'accepted')", 60)
    check_buffers(page)


# What the graphics card holds after an update of all parts, and after many more.
def check_buffers(page):
    count = f"""
        const update = (num) => {{
          for (let i = 0; i < num; ++i) {{
            samewhere.state.set('changed', {{ all: true, points: true, frames: true, candidates: true }});
            samewhere.map.renderNow();
          }}
          const {{ geometries, textures }} = samewhere.map.renderer.info.memory;
          return [geometries, textures, samewhere.map.renderer.info.programs.length];
        }};
        return [update(2), update({NUM_UPDATES})];"""
    before, after = page.run(count)
    page.check("landmarks, path and camera have buffers", before[0] >= 3, before)  # candidates, once there are some
    page.check("updates leave no buffers behind", before == after, f"{before}, {after}")


def check_end(page, folder, pictures):
    page.check("at the end the page is that of the report", page.wait("return document.documentElement.dataset.mode === 'finished' && typeof samewhere !== 'undefined' && samewhere.run", 300))
    loops = json.loads((folder / "loops.json").read_text())
    page.check("its candidates are those of loops.json", page.shown() == len(loops["candidates"]), page.shown())
    num_frames = len((folder / "frames.csv").read_text().splitlines()) - 1
    page.check("its slider has all frames", page.by_id("time-slider").get_attribute("max") == str(num_frames - 1), num_frames)
    page.check("its scene is drawn", page.run(page_test.COUNT_PIXELS) > 0.01)
    if pictures:
        page.picture(pictures / "live-end.png")


def num_told(page):
    text = page.by_id("live-text").text
    return int(re.sub(r"[^0-9].*", "", text.removeprefix("Frame ").replace("\u202f", ""))) if text.startswith("Frame ") else 0


def check_recognition(page, pictures):
    page.check("recognition has candidates while it goes on", page.wait("return typeof samewhere !== 'undefined' && samewhere.run && samewhere.run.candidates.length > 20", 60))
    page.by_id("live-pause").click()
    page.check("it can be paused", page.wait("return document.documentElement.dataset.paused === 'true'"))
    time.sleep(1.5)
    before = num_told(page)
    time.sleep(1.5)
    page.check("a pause stops it", 0 < before == num_told(page), before)
    page.check("it has no map and no time", not page.by_id("scene").is_displayed() and not page.by_id("time").is_displayed())
    page.check("it shows the current image", page.by_id("view-features").is_displayed() and page.wait(f"return document.getElementById('view-features').dataset.frame === '{before - 1}'"), before)
    page.check("its caption counts the features", re.fullmatch(r"frame \d+ · [\d\u202f]+ features", page.by_id("view-caption").text) is not None, page.by_id("view-caption").text)
    page.run("samewhere.state.set('selected', samewhere.run.candidates[0])")
    page.check("a candidate has the pictures of both views", page.run("const c = samewhere.run.candidates[0]; return Boolean(c.queryPicture && c.matchPicture)"))
    if pictures:
        page.picture(pictures / "live-loops.png")
    page.by_id("live-step").click()
    page.check("a step processes one frame", page.wait(f"return document.getElementById('live-text').textContent.startsWith('Frame {before + 1} ')"), num_told(page))
    page.by_id("live-pause").click()


def check_loops(program, driver, scratch, pictures):
    folder = scratch / "seen-loops"
    for log in ("browser", "performance"):
        driver.get_log(log)  # of pages whose server was ended
    process = subprocess.Popen(command_of(program, "loops", folder, "--view", *FEW_FRAMES), stderr=subprocess.PIPE, text=True)
    try:
        url = url_of(process)
        page = LivePage(driver, url)
        check_recognition(page, pictures)
        page.check("at the end it is a report", page.wait("return document.documentElement.dataset.mode === 'finished' && typeof samewhere !== 'undefined' && samewhere.run", 300))
        page.check("with the candidates of loops.json", page.shown() == len(json.loads((folder / "loops.json").read_text())["candidates"]), page.shown())
        check_quiet(page, url)
        driver.get("about:blank")
        page.check("without a page the program ends", process.wait(timeout=30) == 0)
        check_same(page, program, "loops", folder, scratch / "unseen-loops", *FEW_FRAMES)
        return page.num_failed
    finally:
        process.kill()


def check_same(page, program, command, folder, other, *more):
    subprocess.run(command_of(program, command, other, *more), check=True, stdout=subprocess.DEVNULL)
    for name in SAME_FILES[command]:
        page.check(f"{name} of `{command}` is the same without a viewer", (folder / name).read_bytes() == (other / name).read_bytes())


def check_override(program, folder, driver, pictures):
    loops = json.loads((folder / "loops.json").read_text())["candidates"]
    accepted = [i for i, candidate in enumerate(loops) if candidate["verdict"] == "LOOP"]
    process = subprocess.Popen([program, "view", str(folder)], stderr=subprocess.PIPE, text=True)
    try:
        page = LivePage(driver, url_of(process))
        page.wait("return typeof samewhere !== 'undefined' && samewhere.run", 60)
        page.check("a finished run is shown", page.shown() == len(loops), page.shown())
        page.check("the run has an accepted loop", bool(accepted))
        if accepted:
            page.run("samewhere.state.set('selected', samewhere.run.candidates.find((c) => c.id === arguments[0]))", accepted[0])
            page.run("document.querySelector('.override').click()")
            page.check("it is rejected by hand", page.wait(f"return typeof samewhere !== 'undefined' && samewhere.run && samewhere.run.candidates.find((c) => c.id === {accepted[0]}).verdict === 'NOT'", 60))
            after = json.loads((folder / "loops.json").read_text())["candidates"][accepted[0]]
            page.check("loops.json says so, too", after["verdict"] == "NOT" and "by hand" in after["reason"], after["reason"])
        if pictures:
            page.picture(pictures / "override.png")
        process.send_signal(signal.SIGINT)
        page.check("Ctrl-C ends it", process.wait(timeout=20) == 0)
        return page.num_failed
    finally:
        process.kill()


def check_quiet(page, host):
    errors = [entry for entry in page.driver.get_log("browser") if entry["level"] in ("SEVERE", "WARNING")]
    page.check("the console has no error and no warning", not errors, errors[:3] if errors else "")
    urls = set()
    for entry in page.driver.get_log("performance"):
        message = json.loads(entry["message"])["message"]
        if message["method"] == "Network.requestWillBeSent":
            urls.add(message["params"]["request"]["url"].split(",")[0][:60])
    outside = [url for url in urls if not url.startswith((host, "data:", "blob:", "chrome", "about:"))]
    page.check("no request leaves the machine", not outside, outside or f"{len(urls)} of the server")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("program", help="samewhere")
    parser.add_argument("--pictures", type=pathlib.Path, help="folder for screenshots")
    options = parser.parse_args()
    if not shutil.which("chromium") or not shutil.which("chromedriver"):
        page_test.skip("chromium and chromium-driver are not installed")
    if options.pictures:
        options.pictures.mkdir(parents=True, exist_ok=True)
    os.environ.pop("SAMEWHERE_CACHE", None)  # kept pictures would end the run before its page is open
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as scratch:
        folder = pathlib.Path(scratch) / "seen"
        driver = page_test.browser(1400, 900, False, True, f"{scratch}/profile")
        process = subprocess.Popen(command_of(options.program, "run", folder, "--view"), stderr=subprocess.PIPE, text=True)
        try:
            url = url_of(process)
            page = LivePage(driver, url)
            check_live(page, options.pictures)
            check_end(page, folder, options.pictures)
            check_quiet(page, url)
            driver.get("about:blank")
            page.check("without a page the program ends", process.wait(timeout=30) == 0)
            check_same(page, options.program, "run", folder, pathlib.Path(scratch) / "unseen")
            num_failed = page.num_failed + check_override(options.program, folder, driver, options.pictures)
            num_failed += check_loops(options.program, driver, pathlib.Path(scratch), options.pictures)
        finally:
            process.kill()
            driver.quit()
    print(f"{num_failed} failed" if num_failed else "all passed")
    sys.exit(1 if num_failed else 0)


if __name__ == "__main__":
    main()
