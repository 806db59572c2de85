#!/usr/bin/env python3
"""Opens a page of `gnomon report` in headless chromium and reports what is wrong with it.

    check_report_page.py index.html [--plots N] [--screenshot-folder DIR]

The browser is $CHROMIUM or `chromium`, controlled with its DevTools protocol through a pipe. A window of headless
chromium is never narrower than 500 pixels, so a phone has to be emulated.
"""

import argparse
import base64
import fcntl
import json
import os
import pathlib
import select
import shutil
import subprocess
import sys
import tempfile
import time

BROWSER = os.environ.get("CHROMIUM", "chromium")
WIDTHS_PX = {"desktop": 1400, "phone": 390}
WINDOW_HEIGHT_PX = {"desktop": 900, "phone": 844}
# A busy machine with software rendering takes half a minute for 33 plots; a page that hangs never ends.
TIMEOUT_S = 90.0
# Chromium refuses screenshots that are taller than its largest texture.
MAX_SCREENSHOT_HEIGHT_PX = 16000
# A script that returns the page's state. The page's report.js sets data-ready and data-overflow.
PROBE = """(() => { const root = document.documentElement; return {
    ready: root.dataset.ready || "", overflow_px: root.scrollWidth - root.clientWidth,
    reported_overflow_px: root.dataset.overflow || "", width_px: root.clientWidth, height_px: root.scrollHeight,
    plot_count: document.querySelectorAll("svg.plot").length,
    blank_count: [...document.querySelectorAll("svg.plot")].filter((plot) => !plot.querySelector("path, circle")).length,
    title: document.title, markers: (document.body.innerText.match(/\\{\\{[A-Z]+\\}\\}/g) || []).join(" "),
    failure: document.querySelector("#fatal")?.innerText || "" }; })()"""


def make_high_pipe():
    """Return the ends of a pipe as descriptors of 10 and above, so that mapping one to 3 or 4 cannot close another one."""
    ends = []
    for low in os.pipe():
        ends.append(fcntl.fcntl(low, fcntl.F_DUPFD_CLOEXEC, 10))
        os.close(low)
    return ends


class Browser:
    """A headless chromium with one tab. `problems` collects exceptions, console messages and unexpected network requests."""

    def __init__(self):
        self.problems = []
        self.buffer = b""
        self.responses = {}
        self.message_count = 0
        self.session = None
        self.folder = tempfile.mkdtemp(prefix="check_report_page_")
        to_browser, self.out = make_high_pipe()
        self.input, from_browser = make_high_pipe()
        # The protocol uses exactly descriptors 3 and 4. The shell maps ours to them.
        command = 'exec "$0" "$@" 3<&%d 4>&%d' % (to_browser, from_browser)
        options = ["--headless=new", "--no-sandbox", "--disable-gpu", "--hide-scrollbars", "--no-first-run"]
        # Containers often have 64 MB of shared memory, too little for chromium.
        options += ["--disable-dev-shm-usage", "--disable-background-networking", "--user-data-dir=" + self.folder]
        options += ["--remote-debugging-pipe", "about:blank"]
        self.process = subprocess.Popen(
            ["bash", "-c", command, BROWSER, *options],
            pass_fds=(to_browser, from_browser),
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        os.close(to_browser)
        os.close(from_browser)

    def __enter__(self):
        target = self.call("Target.createTarget", url="about:blank")["targetId"]
        self.session = self.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Log", "Network"):
            self.call(domain + ".enable")
        return self

    def __exit__(self, *_):
        try:
            self.session = None
            self.call("Browser.close")
            self.process.wait(10)
        except (OSError, RuntimeError, subprocess.TimeoutExpired):
            self.process.kill()
            self.process.wait()
        os.close(self.out)
        os.close(self.input)
        shutil.rmtree(self.folder, ignore_errors=True)

    def call(self, method, **parameters):
        """Call a method of the DevTools protocol and return its result. Raises RuntimeError if it fails or takes too long."""
        self.message_count += 1
        message = {"id": self.message_count, "method": method, "params": parameters}
        if self.session:
            message["sessionId"] = self.session
        data = json.dumps(message).encode() + b"\0"
        while data:
            data = data[os.write(self.out, data) :]
        end = time.monotonic() + TIMEOUT_S
        while message["id"] not in self.responses:
            self.receive(end, method)
        response = self.responses.pop(message["id"])
        if "error" in response:
            raise RuntimeError("%s: %s" % (method, response["error"].get("message")))
        return response["result"]

    def receive(self, end, method):
        if not select.select([self.input], [], [], max(0.0, end - time.monotonic()))[0]:
            raise RuntimeError("%s did not reply to %s within %g s" % (BROWSER, method, TIMEOUT_S))
        data = os.read(self.input, 1 << 20)
        if not data:
            raise RuntimeError("%s ended before it replied to %s" % (BROWSER, method))
        *messages, self.buffer = (self.buffer + data).split(b"\0")
        for text in messages:
            message = json.loads(text)
            if "id" in message:
                self.responses[message["id"]] = message
            else:
                self.record_problem(message["method"], message["params"])

    def record_problem(self, event, parameters):
        """Record a problem if the page writes to the console or requests anything but itself."""
        if event == "Runtime.exceptionThrown":
            details = parameters["exceptionDetails"]
            text = details.get("exception", {}).get("description", details["text"])
            self.problems.append("exception: " + text)
        elif event == "Runtime.consoleAPICalled" and parameters["type"] in ("error", "warning", "assert"):
            values = [str(item.get("value", item.get("description", ""))) for item in parameters["args"]]
            self.problems.append("console: " + " ".join(values))
        elif event == "Log.entryAdded" and parameters["entry"]["level"] in ("error", "warning"):
            self.problems.append("browser: %s %s" % (parameters["entry"]["text"], parameters["entry"].get("url", "")))
        elif event == "Network.requestWillBeSent":
            url = parameters["request"]["url"]
            if parameters.get("type") != "Document" and not url.startswith(("data:", "blob:")):
                self.problems.append("request: the page loads " + url)

    def evaluate(self, script):
        result = self.call("Runtime.evaluate", expression=script, returnByValue=True, awaitPromise=True)
        if "exceptionDetails" in result:
            raise RuntimeError(result["exceptionDetails"].get("exception", {}).get("description", script))
        return result["result"].get("value")

    def open(self, url, width_px, height_px, is_phone=False, scheme="light"):
        """Open a page and wait until it is ready, failed, or threw, or TIMEOUT_S is over."""
        self.call(
            "Emulation.setDeviceMetricsOverride",
            width=width_px,
            height=height_px,
            deviceScaleFactor=1,
            mobile=is_phone,
        )
        self.call("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": scheme}])
        # A URL that differs only in its fragment would not reload the page.
        self.call("Page.navigate", url="about:blank")
        self.call("Page.navigate", url=url)
        end = time.monotonic() + TIMEOUT_S
        while time.monotonic() < end:
            if self.evaluate("document.readyState == 'complete' && document.documentElement.dataset.ready"):
                return
            if any(text.startswith("exception") for text in self.problems):
                return
            time.sleep(0.1)

    def save_screenshot(self, path, width_px, height_px):
        clip = {"x": 0, "y": 0, "width": width_px, "height": min(height_px, MAX_SCREENSHOT_HEIGHT_PX), "scale": 1}
        result = self.call("Page.captureScreenshot", captureBeyondViewport=True, clip=clip)
        pathlib.Path(path).write_bytes(base64.b64decode(result["data"]))


def find_problems(state, expected_plot_count):
    """Return what is wrong according to the result of PROBE. expected_plot_count: None if any number above 0 is right."""
    problems = []
    if state["ready"] != "yes":
        problems.append("data-ready is '%s': %s" % (state["ready"], state["failure"] or "no message"))
    if expected_plot_count is None and state["plot_count"] == 0:
        problems.append("no plot")
    if expected_plot_count is not None and state["plot_count"] != expected_plot_count:
        problems.append("%d plots, expected %d" % (state["plot_count"], expected_plot_count))
    if state["blank_count"] > 0:
        problems.append("%d plots with nothing in them" % state["blank_count"])
    if state["overflow_px"] > 0:
        problems.append("the page is %d pixels wider than the window" % state["overflow_px"])
    if state["reported_overflow_px"] != str(state["overflow_px"]):
        problems.append("data-overflow is '%s', measured %d" % (state["reported_overflow_px"], state["overflow_px"]))
    if state["markers"]:
        problems.append("markers of the template are left: " + state["markers"])
    return problems


def check_page(path, expected_plot_count=None, screenshot_folder=None):
    """Return a list of what is wrong with the page, at both widths.

    Plots are the elements <svg class="plot">: the overview, one per configuration of the matrix with a measured cell,
    one per scaling curve with a point, two per light of an animated scene, and one per stability sweep with an error. If a
    folder is given, screenshots of the whole page are written there."""
    problems = []
    # "#all" draws all plots at once, not only those near the window.
    url = pathlib.Path(path).resolve().as_uri() + "#all"
    with Browser() as browser:
        for kind, width_px in WIDTHS_PX.items():
            browser.problems = []
            browser.open(url, width_px, WINDOW_HEIGHT_PX[kind], is_phone=kind == "phone")
            state = browser.evaluate(PROBE)
            found = find_problems(state, expected_plot_count) + browser.problems
            if state["width_px"] != width_px:
                found.append("the window is %d pixels wide, expected %d" % (state["width_px"], width_px))
            problems += ["%s: %s" % (kind, text) for text in found]
            if screenshot_folder:
                os.makedirs(screenshot_folder, exist_ok=True)
                image_path = os.path.join(screenshot_folder, kind + ".png")
                browser.save_screenshot(image_path, width_px, state["height_px"])
    return problems


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("page")
    parser.add_argument("--plots", type=int, help="how many plots there must be (default: at least one)")
    parser.add_argument("--screenshot-folder", help="writes desktop.png and phone.png there")
    options = parser.parse_args()
    problems = check_page(options.page, options.plots, options.screenshot_folder)
    for problem in problems:
        print(problem)
    print("%s: %s" % (options.page, "%d problems" % len(problems) if problems else "good"))
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
