#!/usr/bin/python3
"""page_test.py PROGRAM: the report page of a short run in headless Chromium.

Renders a run with PROGRAM, opens its report.html and checks what a reader would see. Exit status 77
(skipped) without Chromium or Selenium.

  page_test.py --report FILE [--pictures FOLDER]   checks a page that is there, keeps screenshots
"""
import argparse
import collections
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time

SKIPPED = 77
SOURCE = "twin:twin-corridors?seed=22&speed=2"


def skip(reason):
    print(f"page_test: skipped, {reason}")
    sys.exit(SKIPPED)


try:
    from selenium import webdriver
    from selenium.webdriver.common.by import By
    from selenium.webdriver.common.keys import Keys
except ImportError:
    skip("python3-selenium is not installed")


def browser(width, height, is_dark=False, has_webgl=True, profile=None):
    options = webdriver.ChromeOptions()
    options.binary_location = shutil.which("chromium")
    arguments = ["--headless=new", "--no-sandbox", f"--window-size={width},{height}", "--hide-scrollbars",
                 "--disable-background-networking", "--disable-component-update", f"--user-data-dir={profile}",
                 "--blink-settings=preferredColorScheme=" + ("0" if is_dark else "1")]
    if has_webgl:
        arguments += ["--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
    else:
        arguments += ["--disable-gpu", "--disable-3d-apis"]
    for argument in arguments:
        options.add_argument(argument)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    driver = webdriver.Chrome(options=options)
    driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": False})
    driver.set_page_load_timeout(120)
    return driver


class Page:
    """A report in a browser. Checks print a line each; what failed is counted."""

    def __init__(self, driver, report):
        self.driver = driver
        self.num_failed = 0
        driver.get(report.resolve().as_uri())
        ready_ms = self.wait("return document.documentElement.dataset.ready", 60)
        self.load_s = float(ready_ms) / 1000 if ready_ms else None

    def check(self, name, is_true, detail=""):
        print(f"  {'ok  ' if is_true else 'FAIL'} {name}{f' ({detail})' if detail != '' else ''}", flush=True)
        self.num_failed += 0 if is_true else 1

    def run(self, script, *arguments):
        return self.driver.execute_script(script, *arguments)

    def wait(self, script, limit_s=5.0):
        end = time.monotonic() + limit_s
        while time.monotonic() < end:
            value = self.run(script)
            if value:
                return value
            time.sleep(0.05)
        return self.run(script)

    def by_id(self, name):
        return self.driver.find_element(By.ID, name)

    def shown(self):
        return int(self.by_id("count").get_attribute("data-count"))

    def picture(self, path):
        time.sleep(0.6)
        self.driver.save_screenshot(str(path))


COUNT_PIXELS = """
  const canvas = document.createElement('canvas'), shown = document.getElementById('canvas');
  canvas.width = shown.width; canvas.height = shown.height;
  const pen = canvas.getContext('2d');
  if (samewhere.map.renderNow) samewhere.map.renderNow();
  pen.drawImage(shown, 0, 0);
  const data = pen.getImageData(0, 0, canvas.width, canvas.height).data;
  let drawn = 0;
  for (let i = 0; i < data.length; i += 4)
    if (Math.abs(data[i] - data[0]) + Math.abs(data[i + 1] - data[1]) + Math.abs(data[i + 2] - data[2]) > 24) ++drawn;
  return drawn / (data.length / 4);
"""


def kind_of(candidate):
    """How the page names the verdict of a candidate of loops.json, ground truth apart."""
    if candidate["verdict"] == "NOT" and candidate["stage"] == "withdrawn":
        return "withdrawn"
    return {"LOOP": "accepted", "NOT": "rejected", "AMBIGUOUS": "ambiguous"}[candidate["verdict"]]


def kinds_in(loops):
    """How many candidates the page should show per verdict."""
    return collections.Counter(map(kind_of, loops["candidates"]))


def check_scene(page):
    share = page.run(COUNT_PIXELS)
    page.check("the scene is drawn", share > 0.01, f"{100 * share:.1f} % of the pixels")
    page.run("samewhere.map.look('above', false)")
    page.check("the view from above is drawn", page.run(COUNT_PIXELS) > 0.01)
    page.run("samewhere.map.look('whole', false)")


def check_filters(page, loops):
    kinds = kinds_in(loops)
    page.check("all candidates are listed", page.shown() == len(loops["candidates"]), page.shown())
    for kind, count in kinds.items():
        chip = page.driver.find_element(By.CSS_SELECTOR, f".chip[data-kind={kind}]")
        page.check(f"the filter {kind} counts as loops.json", chip.text.split()[-1] == str(count), chip.text)
        chip.click()
        page.check(f"without {kind} the others are left", page.shown() == len(loops["candidates"]) - count)
        chip.click()
    checks = collections.Counter(c["stage"] for c in loops["candidates"] if c["verdict"] != "LOOP")
    for check, count in checks.items():
        page.run("samewhere.candidates.showCheck(arguments[0])", check)
        page.check(f"the filter of the check {check} counts as loops.json", page.shown() == count, page.shown())
    page.run("samewhere.candidates.showCheck('')")
    page.by_id("near-filter").click()
    near = page.run("const at = samewhere.run.position(samewhere.state.get('row')); return samewhere.run.candidates.filter(({ends}) => ends.some((end) => end && Math.hypot(...end.map((v, k) => v - at[k])) <= 3)).length")
    page.check("the filter of near places counts them", page.shown() == near < len(loops["candidates"]), page.shown())
    page.by_id("near-filter").click()
    page.run("const s = document.getElementById('score-minimum'); s.value = 0.5; s.dispatchEvent(new Event('input'))")
    largest = max((c["scores"].get("num_inliers") or 0 for c in loops["candidates"]), default=0)
    expected = sum((c["scores"].get("num_inliers") or 0) >= int(0.25 * largest + 0.5) for c in loops["candidates"])
    page.check("the filter of the inliers counts as loops.json", page.shown() == expected, page.shown())
    page.run("const s = document.getElementById('score-minimum'); s.value = 0; s.dispatchEvent(new Event('input'))")


def check_click_on_loop(page):
    # the middle of a line that no other crosses nearer
    at = page.run("""
      for (const candidate of samewhere.state.get('candidates')) {
        if (!candidate.hasLine || !candidate.matches) continue;
        const ends = candidate.ends.map((end) => samewhere.map.onCanvas(end));
        const point = [0, 1].map((k) => 0.8 * ends[0][k] + 0.2 * ends[1][k]);
        if (samewhere.map.candidateAt(...point) !== candidate) continue;
        const box = document.getElementById('canvas').getBoundingClientRect();
        const hit = document.elementFromPoint(box.left + point[0], box.top + point[1]);
        if (hit && hit.id === 'canvas') return [Math.round(point[0] - box.width / 2), Math.round(point[1] - box.height / 2), candidate.id];
      }
      return null;""")
    page.check("a loop candidate has a line that can be clicked", at is not None)
    if at is None:
        return
    webdriver.ActionChains(page.driver).move_to_element_with_offset(page.by_id("canvas"), at[0], at[1]).click().perform()
    selected = page.wait("return samewhere.state.get('selected')?.id")
    page.check("a click on its line selects it", selected is not None, selected)
    drawn = page.wait("return document.querySelector('#detail .pair')?.dataset.drawn")
    page.check("its images appear", drawn == str(selected))
    page.check("its scores stand beside thresholds", "≥" in page.by_id("detail").text)
    page.check("its reason is given", len(page.driver.find_element(By.CSS_SELECTOR, ".reason").text) > 10)
    before = page.run("return samewhere.state.get('selected').id")
    page.driver.find_element(By.TAG_NAME, "body").send_keys("j")
    page.check("the key j selects the next", page.run("return samewhere.state.get('selected').id") != before)


def check_time(page):
    camera = "return samewhere.map.frustum ? Array.from(samewhere.map.frustum.geometry.attributes.instanceStart.array.slice(0, 3)) : samewhere.state.get('row')"
    slider = page.by_id("time-slider")
    page.run("arguments[0].value = 20; arguments[0].dispatchEvent(new Event('input'))", slider)
    first, text = page.run(camera), page.by_id("time-text").text
    slider.send_keys(Keys.ARROW_RIGHT * 5)
    page.check("the slider moves the camera", page.run(camera) != first)
    page.check("the text names the frame", page.by_id("time-text").text != text and "frame 25" in page.by_id("time-text").text, page.by_id("time-text").text)
    page.check("a picture near in time is shown", page.by_id("view-picture").get_attribute("src").startswith("data:image/jpeg"))
    page.run("samewhere.plots.zoom(0.5)")
    spans = page.run("return samewhere.plots.plots.map(({chart}) => [chart.scales.x.min, chart.scales.x.max].join())")
    page.check("the plots zoom together", len(spans) >= 3 and len(set(spans)) == 1, len(spans))
    page.run("samewhere.plots.setSpan(samewhere.plots.whole)")


def check_floors(page):
    page.check("one floor has no choice of floors", page.run("return document.getElementById('floor').hidden"))
    floors = page.run("""
      const z = [0, 0, 0, 0, 0.4, 0.8, 1.2, 1.6, 1.6, 1.6, 2.0, 2.4, 2.8, 3.1, 3.1, 3.1, 3.1, 3.5].flatMap((v) => Array(v === 0 || v === 3.1 ? 9 : 3).fill(v));
      return samewhere.floorsOf({num: z.length, positions: z.flatMap((v) => [0, 0, v])})""")
    page.check("floors are found, half landings are none", len(floors) == 2 and abs(floors[0]) < 0.3 and abs(floors[1] - 3.1) < 0.3, floors)


def check_quiet(page):
    errors = [entry for entry in page.driver.get_log("browser") if entry["level"] in ("SEVERE", "WARNING")]
    page.check("the console has no error and no warning", not errors, errors[:3] if errors else "")
    urls = set()
    for entry in page.driver.get_log("performance"):
        message = json.loads(entry["message"])["message"]
        if message["method"] == "Network.requestWillBeSent" and message["params"]["documentURL"].startswith("file:"):
            urls.add(message["params"]["request"]["url"].split(",")[0][:60])
    outside = [url for url in urls if not url.startswith(("file:", "data:", "blob:"))]
    page.check("no request leaves the machine", not outside, outside or f"{len(urls)} local kinds")


def check_page(report, pictures, profiles):
    loops = json.loads((report.parent / "loops.json").read_text())
    num_failed = 0
    for name, width, height, is_dark, has_webgl in [("light", 1400, 900, False, True), ("dark", 1400, 900, True, True),
                                                    ("narrow", 500, 900, True, True), ("without-webgl", 1400, 900, False, False)]:
        print(f"{name}, {width} x {height}")
        driver = browser(width, height, is_dark, has_webgl, f"{profiles}/{name}")
        try:
            page = Page(driver, report)
            page.check("the page is ready", page.load_s is not None, f"{page.load_s} s")
            page.check("the theme is as preferred", page.run("return document.documentElement.dataset.theme") == ("dark" if is_dark else "light"))
            page.check("the map is in 3D where there is WebGL", page.run("return samewhere.map instanceof samewhere.Scene") == has_webgl)
            if pictures:
                page.picture(pictures / f"{name}.png")
            check_scene(page)
            if name in ("light", "without-webgl"):
                check_filters(page, loops)
                check_click_on_loop(page)
                check_time(page)
                check_floors(page)
            elif loops["candidates"]:
                page.run("samewhere.state.set('selected', samewhere.candidates.found[0])")
            if pictures:
                page.picture(pictures / f"{name}-selected.png")
            check_quiet(page)
            num_failed += page.num_failed
        finally:
            driver.quit()
    return num_failed


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("program", nargs="?", help="samewhere")
    parser.add_argument("--report", type=pathlib.Path, help="a page that is there")
    parser.add_argument("--pictures", type=pathlib.Path, help="folder for screenshots")
    options = parser.parse_args()
    if not shutil.which("chromium") or not shutil.which("chromedriver"):
        skip("chromium and chromium-driver are not installed")
    if options.pictures:
        options.pictures.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
        report = options.report
        if report is None:
            report = pathlib.Path(folder) / "run" / "report.html"
            subprocess.run([options.program, "run", SOURCE, "--out", str(report.parent)], check=True, stdout=subprocess.DEVNULL)
        num_failed = check_page(report, options.pictures, folder)
    print(f"{num_failed} failed" if num_failed else "all passed")
    sys.exit(1 if num_failed else 0)


if __name__ == "__main__":
    main()
