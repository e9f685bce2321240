"""A state as a command line and as a Python script that make the same blade."""

import shlex

from bladegen.blade.lofting.paths import DEFAULT
from bladegen.studio.choices.delivery import USUAL
from bladegen.studio.controls import AFFINE
from bladegen.studio.library import Entry
from bladegen.studio.state import State

__all__ = ["python", "shell"]


def shell(state: State, entry: Entry, stem: str) -> str:
    """Return the command that builds the blade of a state into ``out/``."""
    words = ["bladegen", "perturb" if state.changed else "build", entry.named, "-o", "out/"]
    if entry.airfoils is not None:
        words += ["--airfoils", entry.airfoils]
    if state.loft.path != DEFAULT:
        words += ["--path", state.loft.path]
    if state.loft.fairing is not None:
        words += ["--fair-planform", str(state.loft.fairing)]
    if state.files.unit != USUAL.unit:
        words += ["--unit", state.files.unit]
    if state.files.tolerance != USUAL.tolerance:
        words += ["--tolerance", f"{state.files.tolerance:g}mm"]
    if any(state.t):
        # a value that starts with a minus would be taken for an option
        words.append("--pga=" + ",".join(f"{value:g}" for value in state.t))
        words += ["--allow-extrapolation", "--allow-odd"]  # the checks have shown it
    over = state.over_span
    for control in AFFINE:
        if control.moved(state) and control.keyword not in over:
            value = f"{getattr(state, control.name):g}"
            words += [f"{control.option}={value}"] if control.low < 0 else [control.option, value]
    for name, curve in over.items():
        knots = zip(curve.grid, curve.values, strict=True)
        words.append(f"--over={name}=" + ",".join(f"{value:.10g}@{at:g}" for at, value in knots))
    if state.changed:
        if state.window is not None:
            words.append("--window={:g},{:g}".format(*state.window))
        words += ["--name", stem]
    return shlex.join(words)


def python(state: State, entry: Entry, stem: str) -> str:
    """Return the script that makes the blade of a state and writes ``<stem>.step``."""
    folder = "" if entry.airfoils is None else f", airfoils={entry.airfoils!r}"
    loft = "" if state.loft.path == DEFAULT else f", path={state.loft.path!r}"
    if state.loft.fair:
        loft += ", fair_planform=bg.PlanformFairing()"
    over = state.over_span
    turned = "twist" in over or any(
        control.unit == "deg" and control.moved(state) for control in AFFINE
    )
    lines = [
        *(["from math import radians", ""] if turned else []),
        "import bladegen as bg",
        "",
        f"blade = bg.Blade.from_definition(bg.read({entry.named!r}{folder}){loft})",
    ]
    if state.changed:
        asked = []
        if any(state.t):
            asked += ["bg.ShapeSpace.bundled()", repr(list(state.t))]
            asked += ["allow_extrapolation=True", "allow_odd=True"]  # the checks have shown it
        for name, curve in over.items():
            spans, values = f"{curve.grid.tolist()}", f"{curve.values.tolist()}"
            values = f"[radians(x) for x in {values}]" if name == "twist" else values
            asked.append(f"{name}=bg.Distribution({spans}, {values})")
        for control in AFFINE:
            value = repr(getattr(state, control.name))
            if control.moved(state) and control.keyword not in over:
                said = f"radians({value})" if control.unit == "deg" else value
                asked.append(f"{control.keyword}={said}")
        if state.window is not None:
            asked.append("window=bg.Window({!r}, {!r})".format(*state.window))
        asked.append(f"name={stem!r}")
        lines += ["blade = blade.perturbed(", *(f"    {word}," for word in asked), ")"]
    files = ""
    if state.files.unit != USUAL.unit:
        files += f", unit={state.files.unit!r}"
    if state.files.tolerance != USUAL.tolerance:
        files += f", tolerance={state.files.tolerance:g}e-3"
    lines.append(f"bg.export(blade, {stem + '.step'!r}{files})")
    return "\n".join(lines) + "\n"
