"""What a blade is as a beam: mass and stiffness at span fractions, in SI units and degrees."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from bladegen.support.arrays import Array
from bladegen.support.values import brief

__all__ = ["BeamProperties"]


@dataclass(frozen=True, eq=False, repr=False)
class BeamProperties:
    """What a blade is as a beam, at k span fractions.

    Parameters
    ----------
    eta : (k,) array
    axis : (k, 3) array
        The reference axis, blade frame, which is BeamDyn's [m].
    pitch_axis : (k,) array
        How far the nose lies before the axis, over the chord.
    twist : (k,) array
        [deg]
    mass : (k,) array
        Per length [kg/m].
    flap, edge, torsion : (k,) array
        Stiffness about the elastic centre, out of and in the chord's plane, and in torsion [N m2].
    axial : (k,) array
        [N]
    stiffness, inertia : (k, 6, 6) array
        About the axis, in the chord's axes, as BeamDyn has them.
    """

    eta: Array
    axis: Array
    pitch_axis: Array
    twist: Array
    mass: Array
    flap: Array
    edge: Array
    torsion: Array
    axial: Array
    stiffness: Array
    inertia: Array

    __repr__ = brief

    @cached_property
    def along(self) -> Array:
        """Lengths along the axis from the first span fraction on (k,) [m]."""
        steps = np.linalg.norm(np.diff(self.axis, axis=0), axis=-1)
        return np.append(0.0, np.cumsum(steps))

    @cached_property
    def whole_mass(self) -> float:
        """The mass of the beam, which changes evenly between span fractions [kg]."""
        return float(np.trapezoid(self.mass, self.along))

    def distributed(self, *, pitch_axis: bool) -> list[str]:
        """Return ElastoDyn's table, with the column that OpenFAST 5 has no more or without."""
        columns = [
            ("BlFract", "(-)", self.axis[:, 2] / self.axis[-1, 2]),
            ("PitchAxis", "(-)", self.pitch_axis),
            ("StrcTwst", "(deg)", self.twist),
            ("BMassDen", "(kg/m)", self.mass),
            ("FlpStff", "(Nm^2)", self.flap),
            ("EdgStff", "(Nm^2)", self.edge),
        ]
        if not pitch_axis:
            del columns[1]
        heads = ["  ".join(column[k].center(16) for column in columns).rstrip() for k in (0, 1)]
        rows = np.stack([values for *_, values in columns], axis=-1)
        return [*heads, *("  ".join(f"{value: .9e}" for value in row) for row in rows)]

    def matrices(self) -> list[str]:
        """Return BeamDyn's distributed properties."""
        lines = []
        places = self.along / self.along[-1]
        for place, *pair in zip(places, self.stiffness, self.inertia, strict=True):
            lines.append(f"  {place:.9f}")
            for matrix in pair:
                lines += ["  " + "  ".join(f"{value: .9e}" for value in row) for row in matrix]
                lines.append("")
        return lines

    def elastodyn(self) -> str:
        """Return the table of ElastoDyn's blade file up to OpenFAST 4.

        `bladegen.export(blade, "NAME.elastodyn_blade.dat")` writes a whole file.
        """
        return "\n".join(self.distributed(pitch_axis=True)) + "\n"

    def beamdyn(self) -> str:
        """Return the distributed properties of BeamDyn's blade file.

        `bladegen.export(blade, "NAME.beamdyn_blade.dat")` writes a whole file.
        """
        return "\n".join(self.matrices()) + "\n"
