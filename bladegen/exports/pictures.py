"""Pictures of a blade that say what they are made from: what `Blade.plot` does."""

from pathlib import Path

from bladegen.blade.blade import Blade
from bladegen.errors import RenderError
from bladegen.exports.marks import marked
from bladegen.exports.provenance import made_from
from bladegen.support.arguments import path_of
from bladegen.support.files import require_suffix
from bladegen.views import preview

__all__ = ["plot_blade"]


def plot_blade(
    blade: Blade,
    *,
    baseline: Blade | None = None,
    colour: str = "plain",
    screenshot: str | Path | None = None,
) -> None:
    """Show a blade: as a PNG, a picture in a notebook, or a window.  For `Blade.plot`."""
    if screenshot is None:
        preview.show_blade(blade, baseline=baseline, colour=colour)
        return
    target = path_of(screenshot, "screenshot", RenderError)
    require_suffix(target, (".png",), "screenshot")
    with marked(target, made_from(blade, {})) as temporary:
        preview.picture(blade, temporary, baseline=baseline, colour=colour)
