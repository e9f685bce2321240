"""Pages, as data and in a browser that is cut off from every network."""

import base64
import json
import re
import shutil
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from playwright.sync_api import sync_playwright

import bladegen as bg
from bladegen.errors import RenderError
from bladegen.views import page
from bladegen.views.rendering import keys
from bladegen.views.rendering.blade_scene import scene_of

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser")
TWO_FRAMES = "new Promise((f) => requestAnimationFrame(() => requestAnimationFrame(f)))"
FLAGS = (
    "--no-sandbox --disable-gpu --disable-quic --no-first-run --disable-background-networking "
    "--disable-component-update --disable-sync --enable-unsafe-swiftshader --use-angle=swiftshader"
)


@pytest.fixture(scope="module")
def scene():
    plain = replace(bg.read("nrel5mw"), description="<thick>")
    blade = bg.Blade.from_definition(plain, landmarks=101)
    return scene_of(blade.perturbed(thickness=1.1), blade, sections=60)


def data_of(text):
    return json.loads(re.search(r'id="scene">(.*?)</script>', text, re.DOTALL)[1])


def test_a_page_holds_the_scene(scene):
    data = data_of(page.document(scene, keys.On(colour="distance")))
    points = np.frombuffer(base64.b64decode(data["points"]), "<f4").reshape(-1, 3)
    faces = np.frombuffer(base64.b64decode(data["faces"]), "<u4").reshape(-1, 3)
    normals = np.frombuffer(base64.b64decode(data["normals"]), np.int8).reshape(-1, 4)
    assert len(faces) == len(scene.surface.faces)
    assert len(points) == len(normals) >= len(scene.surface.vertices)
    a, b, c = (points[faces[:, i]].astype(float) for i in range(3))
    volume = np.sum(a * np.cross(b, c)) / 6
    assert volume == pytest.approx(scene.surface.volume, rel=1e-5)
    facing = np.sum(np.cross(b - a, c - a) * normals[faces[:, 0], :3], axis=1)
    assert np.mean(facing > 0) > 0.99
    assert_allclose(np.linalg.norm(normals[:, :3], axis=1), 127, atol=1.5)
    values = np.frombuffer(base64.b64decode(data["fields"][1]["values"]), np.uint8)
    field = scene.field("distance")
    shown = field.low + values / 255 * (field.high - field.low)
    clipped = np.clip(field.values, field.low, field.high)
    assert_allclose([shown.min(), shown.max()], [clipped.min(), clipped.max()], atol=0.5)
    assert data["on"] == {"layers": ["stations"], "colour": "distance", "view": "oblique"}
    assert set(data["keys"]) == set("swtbgcd123456h")


def test_a_page_asks_for_nothing_and_escapes_names(scene):
    text = page.document(scene, keys.On())
    assert "<thick>" not in text
    assert "&lt;thick&gt;" in text
    assert not re.findall(r"""(?:src|href)=["'](?!data:)""", text)
    assert "http" not in re.sub(r'http-equiv="Content', "", text)
    assert "default-src 'none'" in text


def test_a_page_too_large_to_send_is_refused(scene, tmp_path, monkeypatch):
    monkeypatch.setattr(page, "LARGEST", 100_000)
    with pytest.raises(RenderError, match=r"\d MB for \d+ triangles, allowed are 0.1 MB"):
        page.write_page(scene, tmp_path / "a.html")
    assert list(tmp_path.iterdir()) == []


def test_a_bundled_blade_makes_a_page_of_4_mb(tmp_path):
    blade = bg.Blade.from_definition(bg.read("dtu10mw"), landmarks=401)
    found = scene_of(blade, blade, landmarks=page.LANDMARKS)
    page.write_page(found, tmp_path / "a.html")
    assert 3.5e6 < (tmp_path / "a.html").stat().st_size < 4.2e6


def test_unknown_colours_are_refused(scene, tmp_path):
    with pytest.raises(RenderError, match="colour: got 'warmth'"):
        page.write_page(scene, tmp_path / "a.html", colour="warmth")


def test_a_page_turns_in_a_browser_without_a_network(scene, tmp_path):
    if CHROMIUM is None:
        pytest.fail("the tests need Chromium; on Debian: apt-get install chromium")
    path = tmp_path / "a.html"
    page.write_page(scene, path, colour="distance")
    with sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=CHROMIUM, args=FLAGS.split())
        context = browser.new_context(viewport={"width": 800, "height": 450}, offline=True)
        shown = context.new_page()
        errors, requests = [], []
        shown.on("pageerror", lambda error: errors.append(str(error)))
        shown.on("console", lambda m: m.type == "error" and errors.append(m.text))
        shown.on("request", lambda r: requests.append(r.url))
        shown.goto(path.as_uri())

        def picture():
            shown.evaluate(
                "new Promise((f) => requestAnimationFrame(() => requestAnimationFrame(f)))"
            )
            return shown.evaluate("document.getElementById('view').toDataURL()")

        def coloured():
            """How many pixels are neither grey nor white."""
            return shown.evaluate(
                """() => {
                  const view = document.getElementById("view"), flat = new OffscreenCanvas(
                    view.width, view.height).getContext("2d");
                  flat.drawImage(view, 0, 0);
                  const data = flat.getImageData(0, 0, view.width, view.height).data;
                  let count = 0;
                  for (let i = 0; i < data.length; i += 4)
                    count += Math.abs(data[i] - data[i + 1]) > 24;
                  return count; }"""
            )

        first = picture()
        assert coloured() > 2000
        shown.mouse.move(400, 200)
        shown.mouse.down()
        shown.mouse.move(480, 240, steps=3)
        shown.mouse.up()
        turned = picture()
        assert turned != first
        shown.keyboard.press("1")
        assert picture() == first
        for key in "swtbgd":
            before = picture()
            shown.keyboard.press(key)
            assert picture() != before, key
            shown.keyboard.press(key)
            assert picture() == before, key
        shown.keyboard.press("c")
        assert picture() != first
        assert shown.inner_text("figcaption") == "mean curvature, 1/m"
        shown.click("button[data-key='2']")
        assert picture() != first
        shown.mouse.wheel(0, -300)
        assert picture() != first
        shown.keyboard.press("h")
        assert not shown.is_visible("button[data-key='s']")
        browser.close()
    assert errors == []
    assert requests == [path.as_uri()]
