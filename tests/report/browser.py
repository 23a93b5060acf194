"""A headless Chromium, spoken to through its DevTools protocol."""

import base64
import json
import os
import shutil
import signal
import subprocess
import tempfile
import time
import urllib.request

import websocket


class Browser:
    """Starts a browser of its own and ends it again; `errors` and `requests` are what pages did that they must not."""

    def __init__(self, width=1280, height=900):
        self.folder = tempfile.mkdtemp(prefix="grandamp-browser-")
        self.process = subprocess.Popen(
            ["chromium", "--headless=new", "--no-sandbox", "--disable-dev-shm-usage", "--use-angle=swiftshader",
             "--enable-unsafe-swiftshader", "--hide-scrollbars", "--remote-debugging-port=0", "--no-first-run",
             "--disable-background-networking", "--disable-component-update", "--remote-allow-origins=*",
             "--user-data-dir=" + self.folder, f"--window-size={width},{height}", "about:blank"],
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True)
        self.errors, self.requests, self.number = [], [], 0
        address = self.await_address()
        self.socket = websocket.create_connection(address, timeout=60, max_size=None)
        for domain in ("Page", "Runtime", "Log", "Network"):
            self.call(domain + ".enable")

    def await_address(self):
        port_file = os.path.join(self.folder, "DevToolsActivePort")
        for _ in range(300):
            if self.process.poll() is not None:
                raise RuntimeError("chromium ended at once")
            if os.path.exists(port_file) and open(port_file).read().count("\n"):
                port = open(port_file).readline().strip()
                with urllib.request.urlopen(f"http://127.0.0.1:{port}/json/list") as answer:
                    pages = [page for page in json.load(answer) if page["type"] == "page"]
                if pages:
                    return pages[0]["webSocketDebuggerUrl"]
            time.sleep(0.1)
        raise RuntimeError("chromium does not answer")

    def close(self):
        try:
            self.socket.close()
        finally:
            os.killpg(self.process.pid, signal.SIGTERM)
            try:
                self.process.wait(10)
            except subprocess.TimeoutExpired:
                os.killpg(self.process.pid, signal.SIGKILL)
            shutil.rmtree(self.folder, ignore_errors=True)

    def __enter__(self):
        return self

    def __exit__(self, *ignored):
        self.close()

    def take_event(self, message):
        method, facts = message.get("method"), message.get("params", {})
        if method == "Runtime.exceptionThrown":
            self.errors.append(json.dumps(facts["exceptionDetails"])[:600])
        elif method == "Runtime.consoleAPICalled" and facts["type"] in ("error", "warning", "assert"):
            self.errors.append(json.dumps(facts["args"])[:600])
        elif method == "Log.entryAdded" and facts["entry"]["level"] in ("error", "warning"):
            self.errors.append(facts["entry"]["text"][:600])
        elif method == "Network.requestWillBeSent":
            self.requests.append(facts["request"]["url"][:200])

    def call(self, method, **parameters):
        self.number += 1
        self.socket.send(json.dumps({"id": self.number, "method": method, "params": parameters}))
        while True:
            message = json.loads(self.socket.recv())
            if message.get("id") == self.number:
                if "error" in message:
                    raise RuntimeError(f"{method}: {message['error']}")
                return message["result"]
            self.take_event(message)

    def run(self, script):
        """The value of a JavaScript expression; promises are awaited."""
        result = self.call("Runtime.evaluate", expression=script, returnByValue=True, awaitPromise=True)
        if "exceptionDetails" in result:
            raise RuntimeError(json.dumps(result["exceptionDetails"])[:800])
        return result["result"].get("value")

    def await_true(self, script, seconds=60):
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            if self.run(script):
                return
            time.sleep(0.05)
        raise RuntimeError(f"not within {seconds} s: {script}")

    def open(self, path):
        """Opens a page from the disk; returns the seconds until its scripts were done and two frames were drawn."""
        start = time.monotonic()
        self.call("Page.navigate", url="file://" + os.path.abspath(path))
        self.await_true("document.readyState === 'complete' && document.documentElement.dataset.ready !== undefined")
        self.frames(2)
        return time.monotonic() - start

    def frames(self, count):
        self.run(f"new Promise(done => {{ let n = {count}; const next = () => n-- ? requestAnimationFrame(next) : done(true); next(); }})")

    def screen(self, width, height, dark=False, phone=False, scale=1):
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=scale, mobile=phone)
        self.call("Emulation.setTouchEmulationEnabled", enabled=phone)
        self.call("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": "dark" if dark else "light"}])

    def picture(self, selector=None):
        """A PNG of what is seen, or of one element."""
        options = {}
        if selector:
            box = self.run(f"(() => {{ const e = document.querySelector({json.dumps(selector)}); e.scrollIntoView({{block: 'center'}});"
                           "const b = e.getBoundingClientRect();"
                           "return {x: b.x + scrollX, y: b.y + scrollY, width: b.width, height: b.height, scale: 1}; })()")
            self.frames(3)
            options = {"clip": box, "captureBeyondViewport": False}
        return base64.b64decode(self.call("Page.captureScreenshot", format="png", **options)["data"])

    def pdf(self):
        return base64.b64decode(self.call("Page.printToPDF", printBackground=True, paperWidth=8.27, paperHeight=11.69)["data"])
