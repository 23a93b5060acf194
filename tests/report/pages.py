"""What a browser makes of the pages in a folder (tests/report/check.sh): draws, zooms, plays, on a desk, in the dark, on a phone."""

import os
import struct
import sys
import zlib

from browser import Browser

FULL = os.environ.get("GRANDAMP_FULL", "0") not in ("", "0")
failures = []


def check(good, what):
    print("ok     " if good else "FAILED ", what)
    if not good:
        failures.append(what)


def pixels(png):
    """Width, height and rows of RGB(A) bytes of a PNG of 8 bits a channel, not interlaced."""
    at, data = 8, b""
    while at < len(png):
        length, kind = struct.unpack(">I4s", png[at:at + 8])
        if kind == b"IHDR":
            width, height, _, colour = struct.unpack(">IIBB", png[at + 8:at + 18])
        elif kind == b"IDAT":
            data += png[at + 8:at + 8 + length]
        at += 12 + length
    channels, raw, rows = {2: 3, 6: 4}[colour], zlib.decompress(data), []
    above = bytearray(width * channels)
    for y in range(height):
        start = y * (width * channels + 1)
        filtered, row = raw[start], bytearray(raw[start + 1:start + 1 + width * channels])
        for k in range(len(row)):
            left = row[k - channels] if k >= channels else 0
            corner = above[k - channels] if k >= channels else 0
            if filtered == 1:
                guess = left
            elif filtered == 2:
                guess = above[k]
            elif filtered == 3:
                guess = (left + above[k]) // 2
            elif filtered == 4:
                estimate = left + above[k] - corner
                guess = min((left, above[k], corner), key=lambda one: abs(estimate - one))
            else:
                guess = 0
            row[k] = (row[k] + guess) & 255
        rows.append(bytes(row))
        above = row
    return width, height, channels, rows


def colours(png):
    """How many different colours every third row has."""
    _, _, channels, rows = pixels(png)
    return len({row[k:k + 3] for row in rows[::3] for k in range(0, len(row), channels)})


def darkness(png):
    _, _, channels, rows = pixels(png)
    return sum(row[0] + row[1] + row[2] for row in rows) / (3 * len(rows))


def quiet(browser, name):
    others = [url for url in browser.requests if not (url.startswith("file://") and url.endswith("/report.html")) and not url.startswith("data:")]
    check(not browser.errors, f"{name}: no errors on the console {browser.errors[:2]}")
    check(not others, f"{name}: asks for nothing from anywhere {others[:2]}")
    browser.errors.clear()
    browser.requests.clear()


def inked(browser, figure):
    """Whether the canvases of a figure have something drawn on them."""
    return browser.run(f"""[...document.querySelectorAll('#{figure} .live canvas')].some(canvas => {{
      const bytes = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data;
      for (let k = 3; k < bytes.length; k += 4) if (bytes[k]) return true;
      return false; }})""")


def show(browser, figure):
    browser.run(f"document.getElementById('{figure}').scrollIntoView({{block: 'center'}})")
    browser.frames(4)


def key(browser, name, code, number):
    for kind in ("keyDown", "keyUp"):
        browser.call("Input.dispatchKeyEvent", type=kind, key=name, code=code, windowsVirtualKeyCode=number)


def histories(browser, save):
    for figure in ("displacement", "velocity", "excitation", "reaction", "contacts", "losses", "stored", "balance"):
        show(browser, figure)
        check(inked(browser, figure), f"{figure} is drawn")
    show(browser, "displacement")
    before = browser.run("grandamp.histories.range()")
    box = browser.run("""(() => { const b = document.querySelector('#displacement .dygraph').getBoundingClientRect();
      return [b.x, b.y, b.width, b.height]; })()""")
    x, y = box[0] + 0.5 * box[2], box[1] + 0.5 * box[3]
    for kind, at in (("mousePressed", x), ("mouseMoved", x + 60), ("mouseMoved", x + 120), ("mouseReleased", x + 120)):
        browser.call("Input.dispatchMouseEvent", type=kind, x=at, y=y, button="left", clickCount=1, buttons=1)
    browser.frames(3)
    after = browser.run("grandamp.histories.range()")
    check(after[1] - after[0] < 0.3 * (before[1] - before[0]), f"dragging zooms: {before} to {after}")
    rows = browser.run("grandamp.histories.charts[0].graph.numRows()")
    check(100 < rows <= 2400, f"zoomed, the chart holds the {rows} rows of that time")
    check(browser.run("Math.abs(grandamp.histories.charts[1].graph === undefined ? 0 : grandamp.histories.charts[1].graph.xAxisRange()[0] - "
                      f"{after[0]}) < 1e-6"), "the other charts follow")
    browser.run("[...document.querySelectorAll('#histories button')].find(b => b.textContent === 'Whole run').click()")
    check(browser.run("grandamp.histories.range()") == before, "a button shows the whole run again")
    browser.run("[...document.querySelectorAll('#histories button')].find(b => b.textContent === '+').focus()")
    key(browser, "Enter", "Enter", 13)
    browser.call("Input.dispatchKeyEvent", type="char", text="\r")
    browser.frames(2)
    check(browser.run("grandamp.histories.range()") != before, "the keyboard zooms")
    browser.run("grandamp.histories.show(grandamp.histories.whole)")
    # Every value of the run lies in what a chart of it all shows.
    check(browser.run("""(() => { const n = grandamp.report.histories.rows, all = grandamp.data('histories', Float32Array).subarray(0, n);
      const graph = grandamp.histories.charts[0].graph, factor = grandamp.report.figures.displacement.factor;
      let low = Infinity, high = -Infinity;
      for (let k = 0; k < graph.numRows(); ++k) { low = Math.min(low, graph.getValue(k, 1)); high = Math.max(high, graph.getValue(k, 1)); }
      return low === Math.min(...all) * factor && high === Math.max(...all) * factor; })()"""), "the overview has lost no peak")
    save("histories", browser.picture())


def granules(browser, save):
    browser.run("document.querySelector('#granules_picture').scrollIntoView({block: 'start'})")
    browser.await_true("grandamp.granules && grandamp.granules.drawn() > 0")
    browser.frames(3)
    still = browser.picture("#granules_picture .viewer")
    save("granules", still)
    check(colours(still) > 60, f"granules are drawn, in {colours(still)} colours")
    first = browser.run("grandamp.granules.frame()")
    browser.run("[...document.querySelectorAll('#granules_picture button')].find(b => b.textContent === 'Play').click()")
    browser.await_true(f"grandamp.granules.frame() !== {first} && grandamp.granules.frame() > 5")
    browser.run("grandamp.granules.play(false)")
    moved = browser.picture("#granules_picture .viewer")
    save("granules_playing", moved)
    check(moved != still, "playing moves them")
    frame = browser.run("grandamp.granules.frame()")
    browser.run("document.querySelector('#granules_picture canvas').focus()")
    for name, code, number in (("ArrowLeft", "ArrowLeft", 37), ("ArrowUp", "ArrowUp", 38)):
        for _ in range(4):
            key(browser, name, code, number)
    browser.frames(3)
    turned = browser.picture("#granules_picture .viewer")
    check(turned != moved and browser.run("grandamp.granules.frame()") == frame, "arrow keys turn them")
    for way in ("population", "contacts", "spin"):
        browser.run(f"""(() => {{ const s = [...document.querySelectorAll('#granules_picture select')].pop(); s.value = '{way}';
          s.dispatchEvent(new Event('change')); }})()""")
        browser.frames(2)
        other = browser.picture("#granules_picture .viewer")
        save("granules_" + way, other)
        check(other != turned, f"coloured by {way} they look otherwise")
        turned = other
    def rate(body):
        return browser.run(f"""new Promise(done => {{ let n = 0; const start = performance.now();
          const turn = () => {{ {body}; ++n;
            if (performance.now() - start > 1500) done(n / 1.5); else requestAnimationFrame(turn); }};
          turn(); }})""")
    text = rate("document.querySelector('#granules h2').textContent = n")
    turning = rate("grandamp.granules.turn(0.05, 0, 1)")
    print(f"        turning draws {turning:.0f} pictures a second, in software; a changing heading alone {text:.0f}")
    if FULL:
        check(turning > 0.25 * text, "turning is about as smooth as this browser draws anything here")


def main(work, pictures):
    def save(name, png):
        if pictures:
            os.makedirs(pictures, exist_ok=True)
            with open(os.path.join(pictures, name + ".png"), "wb") as file:
                file.write(png)

    page = {name: os.path.join(work, name, "report.html") for name in ("box", "evil", "study")}
    with Browser() as browser:
        browser.screen(1280, 900)
        browser.open(page["study"])  # the browser is warm then
        show(browser, "error_time")
        check(inked(browser, "error_time"), "study: the frontier is drawn")
        quiet(browser, "study")
        seconds = browser.open(page["box"])
        print(f"        2,000 granules and 201 snapshots: opens in {seconds:.2f} s")
        if FULL:
            check(seconds < 3.0, "opens in less than 3 s")
        save("desk", browser.picture())
        histories(browser, save)
        show(browser, "amplitude")
        check(inked(browser, "amplitude") and inked(browser, "profile") is not None, "the amplitude per cycle is drawn")
        granules(browser, save)
        quiet(browser, "box")
        check(len(browser.pdf()) > 50_000, "it prints")

        browser.screen(1280, 900, dark=True)
        browser.open(page["box"])
        dark = darkness(browser.picture())
        save("dark", browser.picture())
        browser.screen(1280, 900)
        browser.frames(3)
        light = darkness(browser.picture())
        check(dark < 90 < 200 < light, f"dark mode is dark ({dark:.0f} of 255, else {light:.0f})")

        browser.screen(390, 844, phone=True)
        for name in ("box", "study"):
            browser.open(page[name])
            browser.run("document.querySelectorAll('details').forEach(one => { one.open = true; })")
            for part in range(12):
                browser.run(f"scrollTo(0, {part} * document.documentElement.scrollHeight / 12)")
                browser.frames(2)
            wide = browser.run("document.documentElement.scrollWidth")
            check(wide <= 390, f"{name}: nothing is wider than a phone ({wide})")
            browser.run("scrollTo(0, 0)")
            save("phone_" + name, browser.picture())
        quiet(browser, "phone")

        browser.screen(1280, 900)
        browser.open(page["evil"])
        check(browser.run("document.documentElement.dataset.evil") is None, "a title is no code")
        check("Do not rely on" in browser.run("document.querySelector('#verdict').textContent"), "an unfinished run is told of as such")
        save("evil", browser.picture())
    print(f"{len(failures)} failed")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], sys.argv[2] if len(sys.argv) > 2 else None))
