"""The studio: how long after a slider moves the blade does, and a newcomer's first two minutes.

    python benchmarks/studio.py [BLADE] [--moves N] [--pictures FOLDER]

Serves the studio on a thread and looks at it in Chromium without a screen or a GPU, so that the
browser draws in software.  Times run in the browser, from the key press on a slider to the frame
that is drawn with the new surface; beside it what a scene takes by itself.  The newcomer opens
the page, draws random variants until one is sound and less than a metre off the baseline,
exports it as STEP, and checks the file as `bladegen check` does.
"""

import shutil
import sys
import tempfile
import threading
import time
from pathlib import Path

from figures import figure, parser
from playwright.sync_api import sync_playwright

import bladegen as bg
from bladegen.measures import checks
from bladegen.studio.model import Baseline
from bladegen.studio.server import serve
from bladegen.studio.state import State

FLAGS = (
    "no-sandbox disable-gpu disable-quic no-first-run disable-background-networking "
    "disable-component-update disable-sync use-angle=swiftshader enable-unsafe-swiftshader"
)
STAMPS = """() => {
    const stage = document.querySelector(".stage");
    new MutationObserver(() => {
        if (!window.drawnAt && Number(stage.dataset.drawn) > window.shownBefore)
            window.drawnAt = performance.now();
    }).observe(stage, { attributes: true, attributeFilter: ["data-drawn"] });
    document.addEventListener("keydown", () => {
        window.shownBefore = Number(stage.dataset.shown);
        window.pressedAt = performance.now();
        window.drawnAt = 0;
    }, true);
}"""
DRAWN = '.stage[data-drawn]:not([data-drawn="0"])'
SLIDERS = ("Shape 1 [rad]", "Thickness", "Twist [deg]", "Prebend", "Fade to")
KEYS = ("ArrowRight", "ArrowLeft")  # in turns, so that no slider comes to its end


def latencies(tab, name, moves):
    """Milliseconds from key to drawn frame, a move at a time."""
    tab.get_by_role("slider", name=name, exact=True).focus()
    found = []
    for move in range(moves):
        tab.keyboard.press(KEYS[move % 2])
        tab.wait_for_function("() => window.drawnAt > 0")
        found.append(tab.evaluate("() => window.drawnAt - window.pressedAt"))
    return found


def newcomer(browser, address, blade):
    """Seconds until a variant's STEP file is held, and what stands in it."""
    start = time.perf_counter()
    tab = browser.new_page(viewport={"width": 1280, "height": 720})
    tab.goto(address)
    tab.wait_for_selector(DRAWN, timeout=120_000)
    seen = time.perf_counter() - start
    draws = 0
    while True:
        before = tab.locator(".stage").get_attribute("data-drawn")
        tab.get_by_role("button", name="A random sound variant").click()
        tab.wait_for_selector(f'.stage:not([data-drawn="{before}"])')
        draws += 1
        off = tab.locator('[data-check="Off baseline"] .figure').inner_text()
        sound = tab.locator('[data-check="Valid"].good').count()
        if sound and abs(float(off.split(" mm")[0])) < 1000:
            break
    with tempfile.TemporaryDirectory() as folder:
        with tab.expect_download(timeout=300_000) as download:
            tab.get_by_role("button", name="Export a file").first.click()
            tab.get_by_label("Export .step").click()
        path = Path(folder) / download.value.suggested_filename
        download.value.save_as(path)
        held = time.perf_counter() - start
        check = checks.check_file(path)
    tab.close()
    case = f"variant {draws}, {'; '.join(check.problems) or 'valid and closed'}"
    figure("a newcomer sees the blade", blade, "s", seen)
    figure("and holds a STEP file", case, "s", held)


def shots(browser, address, blade, folder):
    """Pictures for the docs."""
    query = f"?blade={blade}&t=0.06,-0.05,0.03,0.02&thickness=1.05&twist=1&at=0.3"
    for name, size, theme in (
        ("studio", (1280, 720), "light"),
        ("studio-dark", (1280, 720), "dark"),
        ("studio-tablet", (820, 1180), "light"),
        ("studio-phone", (390, 844), "light"),
    ):
        context = browser.new_context(
            viewport={"width": size[0], "height": size[1]}, color_scheme=theme
        )
        tab = context.new_page()
        tab.goto(address + query)
        tab.wait_for_selector(DRAWN, timeout=120_000)
        tab.evaluate("() => document.fonts.ready")
        tab.wait_for_selector(".figures:not(.stale) table", timeout=120_000)
        tab.wait_for_selector(".stage[data-fine=true]")
        tab.screenshot(path=folder / f"{name}.png")
        context.close()


def main():
    options = parser(__doc__)
    options.add_argument("blade", nargs="?", default="iea15mw")
    options.add_argument("--moves", type=int)
    options.add_argument("--pictures", type=Path)
    asked = options.parse_args()
    moves = asked.moves or (3 if asked.quick else 30)

    blade = bg.Blade.from_definition(bg.read(asked.blade))
    baseline = Baseline(asked.blade, blade, bg.ShapeSpace.bundled())
    spent = []
    for k in range(moves + 1):  # the first warms up
        state = State(asked.blade, (0.001 * k, 0.0, 0.0, 0.0), thickness=1.05)
        start = time.process_time()
        baseline.scene(state).packet()
        spent.append(1e3 * (time.process_time() - start))
    case = f"{asked.blade}, {len(baseline.eta)} sections"
    figure("a studio scene, processor time", case, "ms", spent[1:])

    path = next(filter(None, map(shutil.which, ("chromium", "chromium-browser"))), None)
    if path is None:
        sys.exit("needs Chromium; on Debian: apt-get install chromium")
    served, ready = [], threading.Event()

    def told(serving):
        served.append(serving)
        ready.set()

    start = time.perf_counter()
    place = asked.blade, "127.0.0.1", 0
    threading.Thread(target=serve, args=(*place, told), daemon=True).start()
    ready.wait()
    figure("the studio is served", asked.blade, "s", time.perf_counter() - start)
    with sync_playwright() as playwright:
        flags = [f"--{flag}" for flag in FLAGS.split()]
        browser = playwright.chromium.launch(executable_path=path, args=flags)
        newcomer(browser, served[0].address, asked.blade)
        tab = browser.new_page(viewport={"width": 1280, "height": 720})
        tab.goto(served[0].address)
        tab.wait_for_selector(DRAWN, timeout=120_000)
        tab.evaluate(STAMPS)
        for name in SLIDERS:
            spent = latencies(tab, name, moves)
            figure("from slider to picture", name.removesuffix(" [rad]"), "ms", spent)
        if asked.pictures:
            shots(browser, served[0].address, asked.blade, asked.pictures)
        browser.close()
    served[0].stop()


if __name__ == "__main__":
    main()
