"""What is put on a blade's skin, as people write it: wear as 0.7,0.98,0.03,4mm, dents alike."""

from bladegen.cli.options.parsing import metres
from bladegen.errors import BladegenError

__all__ = ["dented", "eroded"]


def eroded(text: str) -> dict[str, float]:
    """Return the arguments of `DeviationMap.erosion` in a text like ``0.7,0.98,0.03,4mm``."""
    start, end, width, depth = _words(text, "erosion", "FROM,TO,WIDTH,DEPTH", "0.7,0.98,0.03,4mm")
    numbers = _numbers(text, "erosion", start, end, width)
    if not 0.0 < numbers[2] <= 1.0:
        raise BladegenError(
            f"erosion: got a width of {width}, must be more than 0 and at most 1: over the chord"
        )
    spans = dict(zip(("start", "end", "width"), numbers, strict=True))
    return spans | {"depth": metres(depth, "erosion: depth", example="4mm")}


def dented(text: str) -> dict[str, float]:
    """Return the arguments of `DeviationMap.dent` in a text like ``0.5,0.2,600mm,10mm``."""
    eta, u, size, depth = _words(text, "dent", "ETA,U,SIZE,DEPTH", "0.5,0.2,600mm,10mm")
    places = _numbers(text, "dent", eta, u)
    if not all(0.0 <= place <= 1.0 for place in places):
        raise BladegenError(
            f"dent: got {text!r}, the span fraction and the place around the section are 0 to 1"
        )
    across = metres(size, "dent: size", example="600mm")
    if across <= 0.0:
        raise BladegenError(f"dent: got a size of {size}, must be more than 0")
    inward = metres(depth, "dent: depth", example="10mm")
    return {"eta": places[0], "u": places[1], "size": across, "depth": inward}


def _words(text: str, field: str, form: str, example: str) -> list[str]:
    words = text.split(",")
    if len(words) != 4:
        raise BladegenError(f"{field}: got {text!r}, must be {form}, such as {example}")
    return words


def _numbers(text: str, field: str, *words: str) -> list[float]:
    try:
        return [float(word) for word in words]
    except ValueError:
        raise BladegenError(f"{field}: got {text!r}, of which a fraction is no number") from None
