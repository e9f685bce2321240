"""What rotors do, drawn: power and thrust over tip speed ratio, and the power curve."""

from collections.abc import Sequence
from pathlib import Path

from bladegen.blade.aero.evaluation import Evaluation
from bladegen.errors import visible
from bladegen.views.plots.figures import figure, save_figure
from bladegen.views.plots.style import BASELINE, VARIANT

__all__ = ["draw"]

LINES = ((BASELINE, "--"), (VARIANT, "-"))


def draw(found: Evaluation, names: Sequence[str], path: Path) -> None:
    """Draw one rotor, or a variant beside its baseline, into a PNG, SVG or PDF.

    Parameters
    ----------
    found : Evaluation
        Of one blade, or of a baseline and a variant.
    names : sequence of str
        How they are called.
    path : Path
        Where to.

    Raises
    ------
    ExportError
        If the suffix is none of PNG, SVG and PDF.
    """
    best = found.performance
    drawn, ((left, middle, right),) = figure(1, 3, width=12, height=3.6)
    for row, name in enumerate(names):
        colour, style = LINES[row - len(names)]
        line = {"color": colour, "linestyle": style, "label": visible(name)}
        left.plot(best.ratios, best.power[row], **line)
        left.plot(best.ratio[row], best.best[row, 0], "o", color=colour, markersize=4)
        middle.plot(best.ratios, best.thrust[row], **line)
        right.plot(found.conditions.winds, found.power[row] / 1e6, **line)
    left.set(xlabel="tip speed ratio", title="power coefficient", ylim=(0.0, None))
    middle.set(xlabel="tip speed ratio", title="thrust coefficient", ylim=(0.0, None))
    right.set(xlabel="wind speed, m/s", title="power, MW", ylim=(0.0, None))
    left.legend(fontsize=8, loc="lower center")
    save_figure(drawn, path)
