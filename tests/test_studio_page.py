"""The studio in a real browser: Debian's Chromium without a screen, driven by playwright.

One server in this process and one browser serve all tests; each test has a context of its own.
Conditions are waited for, nothing sleeps.
"""

import re
import shutil
import threading
from concurrent.futures import Future
from dataclasses import replace
from pathlib import Path
from urllib.parse import parse_qs, urlsplit

import numpy as np
import pytest
from test_readers_tables import TABLE, table

import bladegen as bg
from bladegen.blade.layup.pieces import Piece, Section
from bladegen.errors import StudioError
from bladegen.measures import checks
from bladegen.studio import server
from bladegen.studio.library import Library
from bladegen.studio.page.live import Live
from bladegen.studio.page.tab import Page
from bladegen.studio.process import Worker
from bladegen.studio.results.aerodynamics import Lift
from bladegen.studio.results.answers import (
    Beside,
    BladeAnswer,
    Inside,
    SectionAnswer,
    about_blade,
    about_section,
)
from bladegen.studio.results.optimum import Optimum, Wish, optimise
from bladegen.studio.server import serve
from bladegen.studio.visits import MOST, Visits

WAIT = 600_000  # ms; far more than is needed, for machines that are busy
FLAGS = [
    f"--{flag}"
    for flag in (
        "no-sandbox",
        "disable-gpu",
        "disable-quic",
        "no-first-run",
        "disable-background-networking",
        "disable-component-update",
        "disable-sync",
        "use-angle=swiftshader",
        "enable-unsafe-swiftshader",
    )
]
# keeps all notes that a page shows: they go after seconds, which a busy machine may miss
LISTEN = """
window.notes = "";
new MutationObserver(() => {
    for (const note of document.querySelectorAll(".q-notification__message"))
        window.notes += `${note.textContent}\\n`;
}).observe(document, { childList: true, characterData: true, subtree: true });
"""
BROWSERS = ("chromium", "chromium-browser", "google-chrome")


@pytest.fixture(scope="session")
def address():
    """The address of a studio that is served on a thread, once in a process.

    It lets a tab that a busy machine keeps away come back, instead of loading its page anew.
    """
    served, began = [], threading.Event()

    def told(serving):
        served.append(serving)
        began.set()

    def run():
        try:
            serve("nrel5mw", "127.0.0.1", 0, told)
        finally:
            began.set()

    thread = threading.Thread(target=run, daemon=True)
    with pytest.MonkeyPatch.context() as patch:
        for name in ("RECONNECT", "PREPARING"):
            patch.setattr(server, name, WAIT / 1000)
        patch.setattr(Visits.__init__, "__defaults__", (MOST, WAIT / 1000))
        thread.start()
        assert began.wait(WAIT / 1000)
    assert served, "the studio could not be served"
    yield served[0].address
    served[0].stop()
    thread.join(WAIT / 1000)
    assert not thread.is_alive()


@pytest.fixture(scope="module")
def browser():
    from playwright.sync_api import sync_playwright

    path = next(filter(None, map(shutil.which, BROWSERS)), None)
    if path is None:
        pytest.fail("the studio's tests need Chromium; on Debian: apt-get install chromium")
    with sync_playwright() as playwright:
        running = playwright.chromium.launch(executable_path=path, args=FLAGS)
        yield running
        running.close()


@pytest.fixture(autouse=True)
def asked(monkeypatch):
    """Keep the states that answers are asked for; nothing is computed but where a test looks."""
    kept = []
    monkeypatch.setattr(Live, "ask", lambda live, state: kept.append(state))
    return kept


def told(make, given):
    """Answer as the other process does, with figures that cost nothing and move with the state."""
    state = given.question.state if isinstance(given, Wish) else given.state
    alpha, square = np.linspace(-20.0, 20.0, 81), np.array([[0, 0], [2, 0], [2, 1], [0, 1]])
    lift = Beside(*[Lift(alpha, 0.1 * alpha, 0.01 + 0 * alpha, 6.0, 1e7, 0.99)] * 2)
    drawn = Section(square, (Piece("cap", "carbon", 0.5 * square),))
    if make is about_section:
        return SectionAnswer(state, lift, Beside(*[Inside(drawn, 100.0)] * 2))
    if make is about_blade:
        return BladeAnswer(state, Beside(trouble="no rotor"), None, Beside(state.thickness, 1.0))
    assert make is optimise
    return Optimum(replace(state, t=(0.01, 0.02, 0.0, 0.0)), 100.0, 120.0, 7)


@pytest.fixture
def answering(asked, monkeypatch):
    """Answer at once; that answers are right tell other tests, and one by night."""
    monkeypatch.undo()

    def submit(worker, make, given):
        future = Future()
        future.set_result(told(make, given))
        return future

    monkeypatch.setattr(Worker, "submit", submit)


@pytest.fixture
def opened(browser, address):
    """Open tabs on addresses of the studio; in the end, nothing may stand in their consoles."""
    contexts, said = [], []

    def open_tab(query="", width=1280, height=720, **more):
        context = browser.new_context(viewport={"width": width, "height": height}, **more)
        context.set_default_timeout(WAIT)
        context.add_init_script(LISTEN)
        contexts.append(context)
        tab = context.new_page()
        tab.on("console", lambda m: m.type == "error" and said.append(m.text))
        tab.on("pageerror", lambda error: said.append(str(error)))
        tab.goto(address + query)
        drawn(tab, 1)
        return tab

    yield open_tab
    for context in contexts:
        context.close()
    assert said == []


def test_a_second_studio_in_a_process_is_refused(address):
    with pytest.raises(StudioError, match=r"^serves one studio a process, .* start another one$"):
        serve("nrel5mw", "127.0.0.1", 0)


def drawn(tab, least):
    """Wait until so many surfaces were drawn."""
    tab.wait_for_function(
        "least => Number(document.querySelector('.stage')?.dataset.drawn ?? 0) >= least", arg=least
    )


def count(tab):
    return int(tab.locator(".stage").get_attribute("data-shown"))


def holds(tab, **wanted):
    """Wait until the tab's address holds values."""
    tab.wait_for_function(
        """wanted => {
            const words = new URLSearchParams(location.search);
            return Object.entries(wanted).every(([key, value]) => words.get(key) === value);
        }""",
        arg=wanted,
    )


def state(tab):
    return {key: value[0] for key, value in parse_qs(urlsplit(tab.url).query).items()}


def picture(tab):
    """Return the 3D view's pixels, once it rests."""
    tab.wait_for_function(
        """() => {
            const { shown, drawn, fine } = document.querySelector(".stage").dataset;
            return shown === drawn && fine === "true";
        }"""
    )
    return tab.locator(".stage canvas").screenshot()


def noted(tab, words):
    """Wait until the tab has shown a note, though it may be gone again."""
    tab.wait_for_function("words => window.notes.includes(words)", arg=words)


def slider(tab, name):
    return tab.get_by_role("slider", name=name, exact=True)


def press(tab, name, key="ArrowRight", times=1):
    slider(tab, name).focus()
    for _ in range(times):
        tab.keyboard.press(key)


def figure(tab, check):
    return tab.locator(f'[data-check="{check}"] .figure').inner_text()


def click(tab, name):
    tab.get_by_role("button", name=name).first.click()


def test_a_slider_moves_the_picture_and_the_numbers(opened):
    tab = opened()
    seen, before = picture(tab), count(tab)
    shape = tab.locator(".section .now").get_attribute("d")
    thinnest = figure(tab, "Thinnest")
    press(tab, "Thickness", times=5)
    holds(tab, thickness="1.05")
    drawn(tab, before + 1)
    tab.wait_for_function(
        "before => document.querySelector('.section .now').getAttribute('d') !== before", arg=shape
    )
    assert picture(tab) != seen
    assert figure(tab, "Thinnest") != thinnest
    assert re.fullmatch(r"[+-]\d+ mm at \d+ % span", figure(tab, "Off baseline"))
    assert tab.get_by_role("spinbutton", name="Thickness, value").input_value() == "1.05"
    label = tab.locator(".section svg").get_attribute("aria-label")
    assert label.startswith("Section at 50 % of the span")


def test_a_curve_over_span_is_dragged_moved_by_keys_and_undone(opened):
    tab = opened()
    before = count(tab)
    handle = tab.get_by_role("slider", name="Twist at 80 % of the span")
    box = handle.bounding_box()
    middle = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    tab.mouse.move(*middle)
    tab.mouse.down()
    tab.mouse.move(middle[0], middle[1] - 12)
    tab.mouse.up()
    drawn(tab, before + 1)
    tab.wait_for_function("() => location.search.includes('over.twist=0,0,0,')")
    dragged = tab.evaluate("() => location.search")
    handle.focus()
    tab.keyboard.press("ArrowUp")
    tab.wait_for_function("then => location.search !== then", arg=dragged)
    assert tab.evaluate("() => document.activeElement.dataset.curve") == "twist"
    tab.keyboard.press("Control+z")
    tab.wait_for_function("then => location.search === then", arg=dragged)
    tab.keyboard.press("Control+z")
    holds(tab, **{"over.twist": None})


def known(tab, name):
    """Return a row of the figures beside the baseline's, once they are those of the state."""
    tab.wait_for_selector(".figures:not(.stale) table")
    cells = tab.locator(".figures tr", has_text=name).first.locator("td")
    return [words.replace("\u2212", "-") for words in cells.all_inner_texts()]


def looked_at(tab):
    """Move a slider, look at all that follows from it, and optimise the section."""
    assert known(tab, "Mass, t")[2] == ""
    field = tab.get_by_role("spinbutton", name="Thickness, value")
    field.fill("1.05")
    field.press("Enter")
    holds(tab, thickness="1.05")
    assert re.fullmatch(r"\+\d\.\d %", known(tab, "Mass, t")[2])
    for name, kind in (("Lift and drag", ".title"), ("Layers and webs", ".piece")):
        click(tab, name)
        tab.wait_for_selector(f".section {kind}")
    tab.get_by_text("aft loading").hover()
    tab.wait_for_selector(".peek .more")
    click(tab, "Optimise lift over drag of the section")
    click(tab, "Start")
    tab.get_by_text(re.compile(r"lift over drag [\d.]+ → [\d.]+ in \d+ evaluations")).wait_for()
    tab.wait_for_function("() => new URLSearchParams(location.search).has('t')")
    click(tab, "Close")
    tab.locator(".optimising").wait_for(state="detached")
    click(tab, "Undo")
    holds(tab, t=None, thickness="1.05")


def test_figures_charts_and_an_optimum_follow_a_slider_that_rests(opened, answering):
    looked_at(opened("?blade=nrel5mw&at=0.7"))


@pytest.mark.nightly
def test_figures_come_from_a_process_of_their_own(opened, monkeypatch):
    monkeypatch.undo()
    looked_at(opened("?blade=nrel5mw&at=0.7"))


@pytest.mark.parametrize(
    ("press", "key", "value"),
    [
        ("Geodesics", "path", "geodesic"),
        ("Fair", "fair", "yes"),
    ],
)
def test_how_the_blade_is_made_is_one_press_away(opened, press, key, value):
    tab = opened()
    before = count(tab)
    button = tab.get_by_role("button", name=press, exact=True)
    button.click()
    holds(tab, **{key: value})
    drawn(tab, before + 1)
    tab.wait_for_function(
        "b => b.getAttribute('aria-pressed') === 'true'", arg=button.element_handle()
    )
    tab.keyboard.press("Control+z")
    holds(tab, **{key: None})


def test_typed_numbers_undo_redo_and_reset(opened):
    tab = opened("?blade=nrel5mw&twist=1")
    field = tab.get_by_role("spinbutton", name="Twist [deg], value")
    assert field.input_value() == "1.0"
    field.fill("2.5")
    field.press("Enter")
    holds(tab, twist="2.5")
    field.fill("70")
    field.press("Enter")
    noted(tab, "twist: got 70, allowed is -5 to 5 deg")
    tab.wait_for_function("field => field.value === '2.5'", arg=field.element_handle())
    field.blur()
    tab.keyboard.press("Control+z")
    holds(tab, twist="1")
    tab.keyboard.press("Control+Shift+z")
    holds(tab, twist="2.5")
    tab.keyboard.press("0")
    holds(tab, twist=None)
    click(tab, "Undo")
    holds(tab, twist="2.5")
    assert slider(tab, "Twist [deg]").input_value() == "2.5"


def test_a_drag_by_hand_is_one_step(opened):
    tab = opened()
    box = slider(tab, "Prebend").bounding_box()
    middle = box["y"] + box["height"] / 2
    tab.mouse.move(box["x"] + box["width"] / 2, middle)
    tab.mouse.down()
    for share in (0.6, 0.7, 0.8):
        tab.mouse.move(box["x"] + share * box["width"], middle)
    tab.mouse.up()
    tab.wait_for_function("() => Number(new URLSearchParams(location.search).get('prebend')) > 1.5")
    click(tab, "Undo")
    holds(tab, prebend=None)
    assert tab.get_by_role("button", name="Undo").first.is_disabled()


def test_random_draws_are_sound_and_a_link_holds_them(opened):
    tab = opened()
    press(tab, "Section at", times=3)
    holds(tab, at="0.53")
    tab.locator("body").click(position={"x": 640, "y": 715})
    before = count(tab)
    tab.keyboard.press("r")
    drawn(tab, before + 1)
    tab.wait_for_function("() => new URLSearchParams(location.search).has('t')")
    assert figure(tab, "Valid") == "sound all along"
    other = opened("?" + urlsplit(tab.url).query)
    assert state(other) == state(tab)
    assert figure(other, "Off baseline") == figure(tab, "Off baseline")
    path = ".section .now"
    assert other.locator(path).get_attribute("d") == tab.locator(path).get_attribute("d")


def test_a_bad_link_is_said_and_shows_the_baseline(opened):
    tab = opened("?thickness=9")
    noted(tab, "thickness: got 9, allowed is 0.8 to 1.2")
    assert state(tab) == {"blade": "nrel5mw"}
    noted(opened("?blade=gone"), "'gone' is not here")


def test_a_bad_file_is_said_and_keeps_the_state(opened):
    tab = opened("?blade=nrel5mw&chord=1.1")
    before = count(tab)
    tab.set_input_files(
        "input[type=file]",
        files=[{"name": "bad.yaml", "mimeType": "text/yaml", "buffer": b"components: [1, 2"}],
    )
    noted(tab, "bad.yaml: is no YAML")
    assert state(tab) == {"blade": "nrel5mw", "chord": "1.1"}
    assert count(tab) == before
    press(tab, "Chord")
    holds(tab, chord="1.11")


def test_a_good_file_and_another_blade_are_shown(opened):
    tab = opened()
    source = Path(bg.read("dtu10mw").source).read_bytes()
    tab.set_input_files(
        "input[type=file]",
        files=[{"name": "my own.yaml", "mimeType": "text/yaml", "buffer": source}],
    )
    noted(tab, "loaded my own.yaml")
    tab.wait_for_function("() => location.search.startsWith('?blade=my_own-')")
    tab.get_by_text("86.4 m long").wait_for()
    tab.get_by_role("combobox", name="Blade").click()
    tab.get_by_role("option", name="iea15mw").click()
    holds(tab, blade="iea15mw")
    tab.get_by_text("117.0 m long").wait_for()
    click(tab, "Undo")
    tab.get_by_text("86.4 m long").wait_for()
    tab.reload()
    tab.get_by_text("86.4 m long").wait_for()


def test_a_table_is_loaded_with_its_airfoils(opened, tmp_path):
    path = table(tmp_path, TABLE)
    tab = opened()
    tab.set_input_files("input[type=file]", files=[str(path)])
    noted(tab, "what it names must be loaded together with it")
    assert state(tab) == {"blade": "nrel5mw"}
    shapes = sorted((tmp_path / "airfoils").iterdir())
    tab.set_input_files("input[type=file]", files=[str(file) for file in [*shapes, path]])
    noted(tab, "loaded blade.csv")
    tab.wait_for_function("() => location.search.startsWith('?blade=blade-')")
    tab.get_by_text("20.0 m long").wait_for()
    with tab.expect_download() as download:
        click(tab, "Export a file")
        tab.get_by_label("Export .sections.csv").click()
    assert download.value.suggested_filename == "blade.sections.csv"


def test_two_tabs_do_not_disturb_each_other(opened):
    one, two = opened(), opened("?blade=nrel5mw&twist=2")
    seen = picture(two)
    press(one, "Thickness", times=8)
    press(one, "Shape 2 [rad]", "ArrowLeft", times=4)
    holds(one, thickness="1.08", t="0,-0.004,0,0")
    assert state(two) == {"blade": "nrel5mw", "twist": "2"}
    assert picture(two) == seen
    press(two, "Camber", times=1)
    holds(two, camber="1.005", twist="2", thickness=None)
    assert "twist" not in state(one)


def test_downloads_are_what_they_should_be(opened, tmp_path, foreign_here):
    tab = opened("?blade=nrel5mw&t=0.03,-0.02,0.01,0.005&thickness=1.05")
    found = {}
    for suffix in (".stl", ".step"):
        with tab.expect_download() as download:
            click(tab, "Export a file")
            tab.get_by_label(f"Export {suffix}").click()
            noted(tab, f"nrel5mw-variant{suffix}, ")
        assert download.value.suggested_filename == f"nrel5mw-variant{suffix}"
        download.value.save_as(tmp_path / f"a{suffix}")
        check = checks.check_file(tmp_path / f"a{suffix}")
        assert not check.problems
        found[suffix] = check.figures
    assert found[".step"]["one_solid"]
    assert found[".stl"]["watertight"]
    assert found[".stl"]["volume"] == pytest.approx(found[".step"]["volume_m3"], rel=1e-3)


def test_share_shows_a_link_a_command_and_a_script(opened, address):
    tab = opened("?blade=nrel5mw&twist=2")
    click(tab, "A link, a command and a script that make this blade")
    recipe = {
        name: tab.locator(f'[data-recipe="{name}"]').inner_text()
        for name in ("Link", "In a shell", "In Python")
    }
    assert recipe["Link"] == f"{address}?blade=nrel5mw&twist=2"
    assert recipe["In a shell"].startswith("bladegen perturb nrel5mw -o out/ --twist=2")
    assert "twist=radians(2.0)" in recipe["In Python"]


def test_an_unsound_variant_is_marked_and_not_exported(opened):
    tab = opened("?blade=nrel5mw&t=-0.145,0.111,-0.078,0.06")
    assert tab.locator(".checks .bad").count() == 1
    assert "crosses itself at" in figure(tab, "Valid")
    assert tab.get_by_role("button", name="Export a file").first.is_disabled()
    click(tab, "Reset to the baseline")
    tab.wait_for_function("() => !document.querySelector('.checks .bad')")
    assert tab.get_by_role("button", name="Export a file").first.is_enabled()


def test_views_and_overlays_change_the_picture_alone(opened):
    tab = opened("?blade=nrel5mw&thickness=1.2")
    seen = []
    for name in (
        "Whole blade",
        "The root",
        "The tip",
        "From the suction side",
        "From the trailing edge",
        "Colour what lies off the baseline",
        "Outline of the baseline",
        "Light or dark",
    ):
        tab.get_by_role("button", name=name).click()
        tab.evaluate(
            "() => new Promise(done => setTimeout(() => requestAnimationFrame(done), 150))"
        )
        seen.append(picture(tab))
    assert len(set(seen)) == len(seen)
    assert state(tab) == {"blade": "nrel5mw", "thickness": "1.2"}
    before = tab.locator(".section .now").get_attribute("d")
    scale = tab.locator(".legend .ends").inner_text()
    click(tab, "Without affine maps")
    holds(tab, off="affine")
    tab.wait_for_function(
        "before => document.querySelector('.legend .ends').innerText !== before", arg=scale
    )
    click(tab, "Export a file")
    tab.get_by_role("button", name="mm", exact=True).click()
    holds(tab, unit="mm")
    tab.get_by_label("Export .stl: STL, binary triangles, mm").wait_for()
    tab.keyboard.press("Escape")
    tab.locator(".exports").wait_for(state="detached")
    click(tab, "As it stands in the blade, in metres")
    tab.wait_for_function(
        "before => document.querySelector('.section .now').getAttribute('d') !== before", arg=before
    )
    tab.locator("body").press("?")
    tab.get_by_text("a random variant").wait_for()


@pytest.mark.parametrize(("width", "height"), [(1280, 720), (820, 1180)])
def test_all_is_in_view_and_all_has_a_name(opened, width, height):
    tab = opened(width=width, height=height)
    wide, high = tab.evaluate(
        "() => [document.documentElement.scrollWidth, document.documentElement.scrollHeight]"
    )
    assert (wide, high) == (width, height)
    for place in (".panel", ".view", ".section", ".planform", ".checks li:last-child"):
        box = tab.locator(place).bounding_box()
        assert box["x"] >= 0
        assert box["y"] >= 0
        assert box["x"] + box["width"] <= width
        assert box["y"] + box["height"] <= height
        assert box["height"] > 20
    panel = tab.locator(".panel")
    assert panel.evaluate("panel => panel.scrollHeight <= panel.clientHeight")
    nameless = tab.evaluate(
        """() => [...document.querySelectorAll('button, input, [role=slider], [role=combobox]')]
            .filter(e => !e.closest('[aria-hidden=true]') && !e.ariaLabel && !e.labels?.length)
            .map(e => e.outerHTML)"""
    )
    assert nameless == []


def test_on_a_phone_the_blade_stays_in_sight_of_the_sliders(opened):
    tab = opened(width=390, height=844)
    assert tab.evaluate("() => document.documentElement.scrollWidth") == 390
    for name in ("Shape 1 [rad]", "Fade to", "Section at"):
        slider(tab, name).evaluate("one => one.scrollIntoView({ block: 'end' })")
        view, one = tab.locator(".view").bounding_box(), slider(tab, name).bounding_box()
        assert view["y"] >= 0
        assert view["y"] + view["height"] <= one["y"] <= 844


def test_another_blade_stands_beside_it_and_goes_again(opened):
    tab = opened("?blade=nrel5mw&twist=1&beside=dtu10mw")
    tab.locator(".stage[data-beside=true]").wait_for()
    tab.get_by_text("beside it dtu10mw, 86.4 m long").wait_for()
    for name, there in (("None", None), ("iea15mw", "iea15mw")):
        click(tab, "Another blade beside it")
        tab.get_by_role("menuitem", name=name).click()
        holds(tab, beside=there, twist="1")
        tab.locator(f".stage[data-beside={str(bool(there)).lower()}]").wait_for()


@pytest.mark.nightly
def test_a_blade_beside_it_that_is_not_here_is_said(opened):
    noted(opened("?blade=nrel5mw&beside=gone"), "'gone' is not here")


def test_an_export_that_fails_is_said_and_the_page_goes_on(opened, monkeypatch):
    def submit(worker, make, job):
        failed = Future()
        failed.set_exception(StudioError("the disk is full"))
        return failed

    monkeypatch.setattr(Worker, "submit", submit)
    tab = opened("?blade=nrel5mw&twist=1")
    click(tab, "Export a file")
    tab.get_by_label("Export .step").click()
    noted(tab, "the disk is full")
    tab.get_by_text("STEP: starting").wait_for(state="detached")
    press(tab, "Twist [deg]")
    holds(tab, twist="1.1")


def test_a_state_that_cannot_be_made_is_said_and_taken_back(opened, monkeypatch):
    made = Page.made

    def refusing(page, state):
        if state.chord > 1.0:
            raise StudioError("no such chord")
        return made(page, state)

    monkeypatch.setattr(Page, "made", refusing)
    tab = opened("?blade=nrel5mw&twist=1")
    press(tab, "Chord")
    noted(tab, "no such chord")
    field = tab.get_by_role("spinbutton", name="Chord, value")
    tab.wait_for_function("field => field.value === '1.00'", arg=field.element_handle())
    press(tab, "Camber")
    holds(tab, camber="1.005", chord=None)


def test_a_blade_that_cannot_be_prepared_is_said_and_not_picked(opened, monkeypatch):
    made, tries = Library.baseline, iter(("at first", "again"))

    def refusing(library, key, *path):
        if key == "dtu10mw":
            raise StudioError(f"its file is gone {next(tries)}")
        return made(library, key, *path)

    monkeypatch.setattr(Library, "baseline", refusing)
    tab = opened("?blade=dtu10mw&twist=1")
    noted(tab, "its file is gone at first")
    assert state(tab) == {"blade": "nrel5mw"}
    tab.get_by_role("combobox", name="Blade").click()
    tab.get_by_role("option", name="dtu10mw").click()
    noted(tab, "its file is gone again")
    assert tab.get_by_role("combobox", name="Blade").input_value() == "nrel5mw"
