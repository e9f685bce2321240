"""A blade in motion: there and back along coordinates of shape and affine parameters, endlessly.

`Motion` says which blades; `frames` renders each, coloured by its distance from the baseline, over
some of its sections; `write_gif` and `write_mp4` make a file of them.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np

from bladegen.blade.blade import Blade
from bladegen.blade.changes.deformation import RANGES
from bladegen.blade.variants.factors import factors
from bladegen.errors import ExportError, RenderError, visible
from bladegen.shapes.shape_space import ShapeSpace
from bladegen.support.arrays import Array, Indices
from bladegen.support.files import require_suffix
from bladegen.surface.mesh import TriangleMesh, surface
from bladegen.views.plots import style
from bladegen.views.rendering.blade_scene import DISTANCE, MILLIMETRES
from bladegen.views.rendering.cameras import VIEWS, View
from bladegen.views.rendering.drawing import (
    add_colour_bar,
    add_lines,
    add_surface,
    add_words,
    dress,
    look,
    shaded,
    signed_distances,
)
from bladegen.views.rendering.renderer import quietly, require_renderer, shot
from bladegen.views.rendering.scene import Field, reach_of

__all__ = ["Motion", "frames", "require_encoder", "write_gif", "write_mp4"]

SIZE = (1280, 720)  # pixels
SECTIONS, EVERY = 160, 4  # of the surface: sections, and landmarks of 401
PROFILES = (0.2, 0.4, 0.6, 0.8, 0.95)  # span fractions of the sections below
APART = 1.25  # chords from one of them to the next
SHARE = 0.62  # of the height, for the blade
DEFAULT_REACH = 0.5  # of the space's bounds along its first mode
FEWEST, MOST = 4, 400  # frames
COLOURS = 256  # of a GIF
FPS = 20


@dataclass(frozen=True, eq=False)
class Motion:
    """Blades along a straight line between two corners of a box of factors, there and back.

    Parameters
    ----------
    blade : Blade
        The baseline.
    space : ShapeSpace
        Whose coordinates t1, t2, ... move.
    bounds : mapping of str to (low, high)
        Names of coordinates and of affine parameters, in radians; all move together.
    count : int
        Frames of the whole loop.
    """

    blade: Blade
    space: ShapeSpace
    bounds: Mapping[str, tuple[float, float]]
    count: int = 40

    def __post_init__(self) -> None:
        if not FEWEST <= self.count <= MOST:
            raise RenderError(f"frames: got {self.count}, allowed is {FEWEST} to {MOST}")
        if not self.bounds:
            ends = self.space.lower[0], self.space.upper[0]
            first = tuple(float(DEFAULT_REACH * end) for end in ends)
            object.__setattr__(self, "bounds", {"t1": first})
        factors(self.space, self.bounds)  # says which name or bound is not allowed

    @property
    def shares(self) -> Array:
        """How far from the low to the high corner each frame is, (count,): a cosine in time."""
        shares: Array = 0.5 - 0.5 * np.cos(2.0 * np.pi * np.arange(self.count) / self.count)
        return shares

    def at(self, share: float) -> tuple[Blade, str]:
        """Return the blade at a share of the way, and its factors in words."""
        values = {
            name: low + share * (high - low) for name, (low, high) in sorted(self.bounds.items())
        }
        t = np.array([values.get(f"t{k + 1}", 0.0) for k in range(self.space.dimension)])
        affine: Any = {name: value for name, value in values.items() if name in RANGES}
        blade = self.blade.perturbed(  # to see where it leads
            self.space, t, allow_extrapolation=True, allow_odd=True, **affine
        )
        return blade, ", ".join(_word(name, value) for name, value in values.items())


def frames(
    motion: Motion,
    *,
    size: tuple[int, int] = SIZE,
    progress: Callable[[int], None] = lambda _: None,
) -> Iterator[Indices]:
    """Render a motion, frame by frame.

    Each place on the way is rendered once: the way back shows the pictures of the way there.

    Parameters
    ----------
    motion : Motion
        What moves.
    size : (int, int)
        Pixels.
    progress : callable
        Told how many frames are rendered.

    Raises
    ------
    RenderError
        If this machine cannot render, or a picture came out blank.
    PerturbationError
        If a blade on the way is not sound.
    """
    require_renderer()
    with quietly():
        stage = _Stage(motion, size)
    half = motion.count // 2
    kept: list[Indices] = []
    for place, share in enumerate(motion.shares.tolist()):
        if place <= half:
            with quietly():
                kept.append(stage.image(share))
        progress(place + 1)
        yield kept[min(place, motion.count - place)]
    stage.plotter.close()


def write_gif(images: Sequence[Indices], path: Path, *, fps: int = FPS) -> None:
    """Write images as a GIF that loops for ever, all in the colours of the first and the middle.

    Raises
    ------
    ExportError
        If the file's name does not end in .gif.
    """
    require_suffix(path, (".gif",))
    from PIL import Image

    pictures = [Image.fromarray(image) for image in images]
    both = np.concatenate([images[0], images[len(images) // 2]])
    palette = Image.fromarray(both).quantize(COLOURS, method=Image.Quantize.MAXCOVERAGE)
    plain = [picture.quantize(palette=palette, dither=Image.Dither.NONE) for picture in pictures]
    plain[0].save(
        path,
        format="GIF",
        save_all=True,
        append_images=plain[1:],
        duration=round(1000 / fps),
        loop=0,
        disposal=1,
    )


def require_encoder(path: Path) -> None:
    """Raise `ExportError` if no film can be written: the extra `video` brings the encoder."""
    if find_spec("imageio_ffmpeg") is None:
        raise ExportError(
            f"{path}: MP4 needs an encoder: pip install 'bladegen[video]'; --gif needs none"
        )


def write_mp4(images: Sequence[Indices], path: Path, *, fps: int = FPS, about: str = "") -> None:
    """Write images as an H.264 film that any player shows, with a comment about it.

    Raises
    ------
    ExportError
        If there is no encoder, or the file's name does not end in .mp4.
    """
    require_suffix(path, (".mp4",))
    require_encoder(path)
    import imageio_ffmpeg

    height, width, _ = images[0].shape
    writer = imageio_ffmpeg.write_frames(
        str(path),
        (width, height),
        fps=fps,
        quality=7,
        macro_block_size=2,
        output_params=["-metadata", f"comment={about}"] if about else [],
    )
    writer.send(None)
    for image in images:
        writer.send(np.ascontiguousarray(image))
    writer.close()


def _word(name: str, value: float) -> str:
    """Return a factor and its value, twist in degrees."""
    if name == "twist":
        return f"twist {np.degrees(value):+.2f} deg"
    return f"{name} = {value:.3f}" if name in RANGES else f"{name} = {value:+.4f} rad"


class _Stage:
    """A plotter in which the blade of each share of the way takes the place of the last one."""

    def __init__(self, motion: Motion, size: tuple[int, int]) -> None:
        import pyvista as pv

        self.motion = motion
        self._eta = motion.blade.stations(max(SECTIONS, len(motion.blade.eta) + 2))
        self._baseline = self._surface(motion.blade)
        self._reach = max(reach_of(*self._moved(share)[::-1]) for share in (0.0, 1.0))
        self.plotter = pv.Plotter(
            off_screen=True,
            window_size=list(size),
            shape=(2, 1),
            row_weights=[SHARE, 1.0 - SHARE],
            border=False,
        )
        self._place = 20, int(SHARE * size[1]) - 76
        for row in (0, 1):
            self.plotter.subplot(row, 0)
            dress(self.plotter)
        self._add_below(size)
        self.plotter.subplot(0, 0)
        aspect = size[0] / (SHARE * size[1])
        look(self.plotter, self._baseline.vertices, VIEWS["oblique"], aspect)

    def image(self, share: float) -> Indices:
        """Render the blade at a share of the way over its sections and the baseline's."""
        blade, words = self.motion.at(share)
        mesh, distance = self._moved(share, blade)
        field = Field.within("distance", DISTANCE, distance, self._reach)
        self.plotter.subplot(0, 0)
        actor = add_surface(self.plotter, shaded(mesh, (field,)), field, name="blade")
        if not self.plotter.scalar_bars:
            add_colour_bar(self.plotter, actor, field.label)
        title = visible(self.motion.blade.definition.description or self.motion.blade.name)
        add_words(self.plotter, f"{title}\n{words}", self._place, 12, name="words")
        self.plotter.subplot(1, 0)
        self._add_profiles(blade, style.VARIANT, 2.5, "variant")
        return shot(self.plotter, "the sweep")

    def _surface(self, blade: Blade) -> TriangleMesh:
        every = EVERY if (len(blade.u) - 1) % (2 * EVERY) == 0 else 1
        return surface(blade.sections(self._eta)[:, ::every])

    def _moved(self, share: float, blade: Blade | None = None) -> tuple[TriangleMesh, Array]:
        """Return the surface at a share of the way, and its distances from the baseline [mm]."""
        mesh = self._surface(blade or self.motion.at(share)[0])
        return mesh, MILLIMETRES * signed_distances(mesh, self._baseline)

    def _add_below(self, size: tuple[int, int]) -> None:
        """Add the baseline's sections and what does not change."""
        self._add_profiles(self.motion.blade, style.BASELINE, 1.5, "baseline")
        wide = APART * (len(PROFILES) - 1) + 1.0
        corners = np.array([[-0.1, -0.4, 0.0], [wide + 0.1, 0.36, 0.0]])
        aspect = size[0] / ((1.0 - SHARE) * size[1])
        look(self.plotter, corners, View((0.0, 0.0, 1.0), (0.0, 1.0, 0.0)), aspect)
        middle = APART * np.arange(len(PROFILES)) + 0.5
        self.plotter.add_point_labels(
            np.stack([middle, np.full_like(middle, -0.36), np.zeros_like(middle)], axis=-1),
            [f"{100 * eta:.0f} % of the span" for eta in PROFILES],
            text_color=style.INK,
            font_size=15,
            bold=False,
            shape=None,
            show_points=False,
            always_visible=True,
            justification_horizontal="center",
        )
        add_words(self.plotter, "sections over those of the baseline (thin)", (20, 10), 9)

    def _add_profiles(self, blade: Blade, colour: str, width: float, name: str) -> None:
        """Add unit-chord sections side by side."""
        outlines = blade.profiles(np.array(PROFILES))
        placed = np.zeros((*outlines.shape[:2], 3))
        placed[..., :2] = outlines
        placed[..., 0] += APART * np.arange(len(PROFILES))[:, None]
        add_lines(self.plotter, (placed,), colour, width, name=name)
