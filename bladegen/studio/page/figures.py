"""Figures of another process beside the baseline's: lift, drag, power, moment, mass."""

from collections.abc import Iterable
from dataclasses import dataclass
from html import escape

from bladegen.studio.page.live import Live
from bladegen.studio.page.tab import Page
from bladegen.studio.results.answers import BladeAnswer, SectionAnswer

__all__ = ["Row", "figures", "rows", "table"]

SAME = 5e-4  # of a figure: less is no change
UNSURE = 0.9  # of NeuralFoil's confidence, below which it is shown


@dataclass(frozen=True)
class Row:
    """A figure: what it is, its places, it now and before; or why it is not known."""

    name: str
    places: int = 0
    now: float | None = None
    before: float | None = None
    trouble: str = ""

    @property
    def change(self) -> str:
        """By how much it differs, in per cent."""
        if self.now is None or not self.before:
            return ""
        share = self.now / self.before - 1.0
        return "" if abs(share) < SAME else f"{100.0 * share:+.1f} %".replace("-", "\u2212")


def rows(section: SectionAnswer | None, blade: BladeAnswer | None) -> dict[str, list[Row]]:
    """Return figures by what they are of."""
    found: dict[str, list[Row]] = {}
    if section is not None:
        found[f"Section at {100 * section.state.at:.0f} %"] = [*_lift(section), *_weight(section)]
    if blade is not None:
        found["Blade"] = [*_rotor(blade), *_mass(blade)]
    return found


def _lift(answer: SectionAnswer) -> Iterable[Row]:
    now, before = answer.lift.now, answer.lift.before
    if now is None or before is None:
        yield Row("Lift and drag", trouble=answer.lift.trouble)
        return
    yield Row(f"Lift C<sub>L</sub> at {now.at:.1f}\u00b0", 3, now.lift, before.lift)
    yield Row("Drag C<sub>D</sub>", 4, now.drag, before.drag)
    yield Row("Lift / drag", 1, now.lift / now.drag, before.lift / before.drag)
    if min(now.confidence, before.confidence) < UNSURE:
        yield Row("NeuralFoil's confidence", 2, now.confidence, before.confidence)


def _weight(answer: SectionAnswer) -> Iterable[Row]:
    now, before = answer.inside.now, answer.inside.before
    if now is not None and before is not None:  # else the blade's row says why
        yield Row("Mass, kg/m", 1, now.mass, before.mass)


def _rotor(answer: BladeAnswer) -> Iterable[Row]:
    now, before, working = answer.rotor.now, answer.rotor.before, answer.working
    if now is None or before is None or working is None:
        yield Row("Power", trouble=answer.rotor.trouble)
        return
    yield Row(f"Power C<sub>P</sub> at \u03bb {working.ratio:.1f}", 4, now.power, before.power)
    yield Row("Thrust C<sub>T</sub>", 3, now.thrust, before.thrust)
    yield Row("Root moment C<sub>M</sub>", 4, now.moment, before.moment)


def _mass(answer: BladeAnswer) -> Iterable[Row]:
    now, before = answer.mass.now, answer.mass.before
    if now is None or before is None:
        yield Row("Mass", trouble=answer.mass.trouble)
        return
    yield Row("Mass, t", 2, now / 1e3, before / 1e3)


def table(found: dict[str, list[Row]]) -> str:
    """Return figures as a table of the page."""
    lines = ["<tr><td></td><th>now</th><th>baseline</th><th>change</th></tr>"]
    for title, those in found.items():
        lines.append(f'<tr class="of"><th colspan="4" scope="rowgroup">{escape(title)}</th></tr>')
        for row in those:
            if row.now is None or row.before is None:
                cells = f'<td class="said" colspan="3">{escape(row.trouble)}</td>'
            else:
                values = (f"{value:.{row.places}f}" for value in (row.now, row.before))
                cells = "".join(f"<td>{cell}</td>" for cell in (*values, row.change))
            lines.append(f'<tr><th scope="row">{row.name}</th>{cells}</tr>')
    return f"<table>{''.join(lines)}</table>".replace(">-", ">\u2212")


def figures(page: Page) -> None:
    """Put the table; it follows the page's answers."""
    from nicegui import ui

    board = ui.html("", sanitize=False).classes("figures")
    board.props('aria-label="Figures beside the baseline\'s" role=region')

    def follow() -> None:
        live: Live = page.live
        found = rows(live.section, live.blade)
        said = f'<p class="said">{escape(live.trouble)}</p>' if live.trouble else ""
        board.set_content(said or (table(found) if found else ""))
        board.classes(**{"add" if live.stale else "remove": "stale"})
        board.set_visibility(bool(said or found))

    page.live.followers.append(follow)
    follow()
