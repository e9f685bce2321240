"""Titles of columns in other languages: they are not guessed at, but it is said what to write."""

import re
from collections.abc import Sequence

__all__ = ["chords_elsewhere", "in_english"]

ENGLISH = {  # German, French, Spanish and Portuguese, Italian, Dutch, Danish
    "chord": "sehne sehnenlänge profiltiefe blatttiefe corde cuerda corda koorde korde",
    "twist": "verwindung schränkung vrillage torsión torsion svergolamento verdraaiing vridning",
    "r": "rayon radio raggio raio straal",
    "airfoil": "profil profilname profilo perfil profiel",
    "rthick": "dicke dickenverhältnis épaisseur espesor spessore dikte",
}
_WORDS = {word: name for name, words in ENGLISH.items() for word in words.split()}


def chords_elsewhere() -> tuple[str, ...]:
    """Return what a column of chords is called in other languages."""
    return tuple(ENGLISH["chord"].split())


def in_english(titles: Sequence[object]) -> str:
    """Say what to write for titles in other languages, "" if there are none.

    >>> in_english(["Radius", "Sehne [m]", "Verwindung"])
    "; write chord for 'Sehne', twist for 'Verwindung', units as they are"
    """
    words = [re.split(r"[\s\[\](){}_,;/]", str(title).strip(), maxsplit=1)[0] for title in titles]
    found = {word: _WORDS[word.lower()] for word in words if word.lower() in _WORDS}
    said = ", ".join(f"{name} for {word!r}" for word, name in found.items())
    return f"; write {said}, units as they are" if said else ""
