"""The paper's 16 baseline airfoils, from the bundled blades of the three reference turbines."""

from bladegen.formats.reading import read
from bladegen.support.arrays import Array

__all__ = ["BASELINES", "baselines"]

# The turbines hold 17 lifting airfoils.  DTU's ffaw3480 is its ffaw3360 stretched by 4/3 in y,
# the same point of the Grassmannian; without it there are the paper's 16.
BASELINES = (
    ("nrel5mw", ("DU40_A17", "DU35_A17", "DU30_A17", "DU25_A17", "DU21_A17", "NACA64_A17")),
    ("dtu10mw", ("ffaw3241", "ffaw3301", "ffaw3360")),
    (
        "iea15mw",
        (
            "FFA-W3-211",
            "FFA-W3-241",
            "FFA-W3-270blend",
            "FFA-W3-301",
            "FFA-W3-330blend",
            "FFA-W3-360",
            "SNL-FFA-W3-500",
        ),
    ),
)


def baselines() -> dict[str, Array]:
    """Return the coordinates of the 16 baseline airfoils by name."""
    found = {}
    for turbine, names in BASELINES:
        airfoils = {station.airfoil.name: station.airfoil for station in read(turbine).stations}
        for name in names:
            found[f"{turbine} {name}"] = airfoils[name].coordinates
    return found
