import numpy as np
import pytest

import bladegen as bg
from bladegen.errors import RenderError
from bladegen.views import preview
from bladegen.views.rendering import keys, renderer
from bladegen.views.rendering.blade_scene import scene_of
from bladegen.views.rendering.cameras import VIEWS
from bladegen.views.rendering.window import Window

SIZE = (640, 360)


@pytest.fixture(scope="module")
def scene():
    blade = bg.Blade.from_definition(bg.read("nrel5mw"), landmarks=101)
    return scene_of(blade.perturbed(thickness=1.1, name="thick"), blade, sections=60)


@pytest.fixture(scope="module")
def window(scene):
    with preview.quietly():
        made = Window(scene, off_screen=True, size=SIZE)
        yield made
        made.plotter.close()


def image(window):
    window.plotter.render()
    return np.asarray(window.plotter.screenshot(None, return_img=True)).astype(int)


@pytest.mark.parametrize("key", [*"swtbgcd", *"23456", "h"])
def test_every_key_changes_the_picture_and_its_second_press_undoes_it(window, key):
    before = image(window)
    window.press(key)
    after = image(window)
    assert np.count_nonzero(np.abs(after - before).max(axis=2) > 40) > 30
    window.press("1" if key in keys.TURNS else key)
    assert np.abs(image(window) - before).max() <= 2


def test_the_legend_marks_what_is_on(window):
    assert "t [x] stations of the definition" in window.legend()
    assert "c [ ] mean curvature as colour" in window.legend()
    assert "1 [x] oblique" in window.legend()
    assert window.legend().count("\n") == len(window.keys) - 1
    window.press("h")
    assert window.legend() == "h     keys"
    window.press("h")


def test_keys_are_distinct_and_in_the_help():
    tables = keys.LAYERS, keys.COLOURS, keys.TURNS, keys.OTHERS
    assert len(set().union(*tables)) == sum(map(len, tables))
    for table in tables:
        for key, about in table.items():
            assert f"{key} {about.help}" in keys.help_text()
    assert [about.target for about in keys.TURNS.values()] == list(VIEWS)


def test_pressing_twice_is_not_pressing():
    on = keys.On()
    for key in (*keys.LAYERS, *keys.COLOURS, "h"):
        assert keys.pressed(keys.pressed(on, key), key) == on
        assert keys.pressed(on, key) != on
    assert keys.pressed(on, "x") is on
    assert keys.pressed(keys.pressed(on, "c"), "d").colour == "distance"


def test_keys_without_anything_to_show_are_left_out():
    assert set("gcd").isdisjoint(keys.usable(("sections", "stations"), ()))
    assert set("stw").issubset(keys.usable(("sections", "stations", "wireframe"), ()))


def test_without_a_display_a_window_is_refused(scene, monkeypatch):
    monkeypatch.delenv("DISPLAY", raising=False)
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)
    with pytest.raises(RenderError, match=r"no display here; use --screenshot .* or --html"):
        preview.show(scene)


def test_a_window_opens_with_the_scene_and_its_keys(scene, monkeypatch):
    import pyvista

    shown, bound = [], {}
    monkeypatch.setattr(renderer, "_display_opens", lambda: True)
    monkeypatch.setattr(pyvista.Plotter, "show", lambda self, **options: shown.append(options))
    monkeypatch.setattr(
        pyvista.Plotter, "add_key_event", lambda self, key, action: bound.update({key: action})
    )
    monkeypatch.setattr(Window, "_own_letters", lambda self: None)
    monkeypatch.setattr(Window, "close", lambda self: shown.append("closed"))
    original = pyvista.Plotter.__init__

    def off_screen(self, *args, **options):
        original(self, *args, **{**options, "off_screen": True})

    monkeypatch.setattr(pyvista.Plotter, "__init__", off_screen)
    preview.show(scene, colour="distance")
    assert shown == [{"title": "bladegen - NREL 5 MW; perturbed: thickness 1.1"}]
    assert set("swtbgcd123456hq") <= set(bound)
    bound["s"]()
    bound["q"]()
    assert shown[-1] == "closed"
    with pytest.raises(RenderError, match="colour"):
        preview.show(scene, colour="warmth")
