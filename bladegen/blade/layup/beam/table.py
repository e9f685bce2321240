"""A blade's beam properties as a table: one row a span fraction, SI units and degrees."""

import numpy as np

from bladegen.blade.layup.beam.properties import BeamProperties

__all__ = ["table_lines"]

UPPER = tuple(zip(*np.triu_indices(6), strict=True))  # symmetric: the upper half


def table_lines(beam: BeamProperties) -> list[str]:
    """Return the lines of a table (CSV), a row of names first.

    ``K11`` to ``K66`` and ``M11`` to ``M66`` are the upper halves of stiffness and inertia.
    """
    columns = {
        "eta": beam.eta,
        **{f"axis_{name}_m": beam.axis[:, i] for i, name in enumerate("xyz")},
        "along_m": beam.along,
        "pitch_axis": beam.pitch_axis,
        "twist_deg": beam.twist,
        "mass_kg_m": beam.mass,
        "flap_Nm2": beam.flap,
        "edge_Nm2": beam.edge,
        "torsion_Nm2": beam.torsion,
        "axial_N": beam.axial,
        **{f"K{i + 1}{j + 1}": beam.stiffness[:, i, j] for i, j in UPPER},
        **{f"M{i + 1}{j + 1}": beam.inertia[:, i, j] for i, j in UPPER},
    }
    rows = np.stack(list(columns.values()), axis=-1)
    return [",".join(columns), *(",".join(f"{value:.9g}" for value in row) for row in rows)]
