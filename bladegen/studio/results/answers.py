"""Answers about a state beside its baseline: first about a section, then about the whole blade.

Each part of an answer is there twice, or says in a line why it cannot be had.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Generic, TypeVar

import numpy as np

from bladegen.blade.blade import Blade
from bladegen.blade.layup.layup import Layup
from bladegen.blade.layup.pieces import Section, section
from bladegen.errors import BladegenError, PerturbationError
from bladegen.studio.results.aerodynamics import Lift, Rotor, Working
from bladegen.studio.results.question import Question
from bladegen.studio.state import State

__all__ = [
    "Beside",
    "BladeAnswer",
    "Inside",
    "SectionAnswer",
    "about_blade",
    "about_section",
    "load",
]

DRAWN = 301  # points of an outline with its layers
BARE = "the file names no webs and layers"
UNSOUND = "known of usable blades only"
MIDDLE = State("").at  # what is known of a whole blade is the same whatever section is looked at
T = TypeVar("T")


@dataclass(frozen=True, eq=False)
class Beside(Generic[T]):
    """Something of a state, and the same of its baseline; or why there is none."""

    now: T | None = None
    before: T | None = None
    trouble: str = ""


@dataclass(frozen=True, eq=False)
class Inside:
    """A section with its layers and webs, and what it weighs [kg/m]."""

    section: Section
    mass: float


@dataclass(frozen=True, eq=False)
class SectionAnswer:
    """What is known of the section looked at: lift and drag, and what lies inside it."""

    state: State
    lift: Beside[Lift]
    inside: Beside[Inside]


@dataclass(frozen=True, eq=False)
class BladeAnswer:
    """What is known of the whole blade: its rotor, the point that this works at, its mass [kg]."""

    state: State
    rotor: Beside[Rotor]
    working: Working | None
    mass: Beside[float]


def about_section(question: Question) -> SectionAnswer:
    """Return what is known of the section looked at."""
    return SectionAnswer(question.state, _beside(question, _lift), _beside(question, _inside))


def about_blade(question: Question) -> BladeAnswer:
    """Return what is known of the whole blade."""
    anywhere = _anywhere(question)
    rotor = _beside(anywhere, _rotor)
    known = None if rotor.trouble else _working(_plain(anywhere))
    return BladeAnswer(question.state, rotor, known, _beside(anywhere, _mass))


def _beside(question: Question, made: Callable[[Question], T]) -> Beside[T]:
    """Make something of a state and of its baseline, or say why it cannot be made."""
    try:
        return Beside(made(question), made(_plain(question)))
    except PerturbationError:
        return Beside(trouble=UNSOUND)
    except BladegenError as error:
        return Beside(trouble=" ".join(str(error).split()))


def _plain(question: Question) -> Question:
    """Return the question about the baseline's section."""
    return replace(question, state=question.state.reset())


def _anywhere(question: Question) -> Question:
    return replace(question, state=replace(question.state, at=MIDDLE))


@lru_cache(4)
def _working(plain: Question) -> Working:
    """Return at what the rotor of a question without changes works."""
    return Working.of(_variant(plain))


@lru_cache(4)
def _variant(anywhere: Question) -> Blade:
    return anywhere.baseline.variant(anywhere.state)


@lru_cache(32)
def _lift(question: Question) -> Lift:
    anywhere = _anywhere(question)
    return _working(_plain(anywhere)).lift(_variant(anywhere), question.state.at)


@lru_cache(8)
def _rotor(anywhere: Question) -> Rotor:
    return _working(_plain(anywhere)).rotor(_variant(anywhere))


@lru_cache(32)
def _inside(question: Question) -> Inside:
    eta, blade = question.state.at, _variant(_anywhere(question))
    laid = _layup(blade).at(np.array([eta]))
    drawn = section(blade, eta, laid=laid, points=DRAWN)
    return Inside(drawn, float(laid.mass_per_length[0]))


@lru_cache(8)
def _mass(anywhere: Question) -> float:
    return _layup(_variant(anywhere)).mass


def _layup(blade: Blade) -> Layup:
    found: Layup | None = blade.layup
    if found is None:
        raise BladegenError(BARE)
    return found


def load() -> None:
    """Import what answers need, before somebody asks."""
    from bladegen.blade.aero import momentum  # noqa: F401

    try:
        import neuralfoil  # noqa: F401
    except ImportError:
        return  # which is said when it is asked for
