"""OpenFOAM's dictionaries that mesh a rotor's sector around the blade: snappyHexMesh, by patches.

The blade's faces are patches of their own names, in one group; boundary layers grow on its sides.
References: OpenFOAM's user guide, "Mesh generation with the snappyHexMesh utility".
"""

from collections.abc import Sequence
from dataclasses import dataclass
from math import log
from typing import Any

from bladegen.exports.cases.dictionaries import BLADE
from bladegen.support.arrays import Array
from bladegen.surface.mesh_files import region_word
from bladegen.surface.regions import PRESSURE, SUCTION

__all__ = ["EDGES", "SURFACE", "Layers", "snappy"]

SURFACE, EDGES = "blade.obj", "edges.obj"  # in constant/triSurface
ROUNDED = 0.75, 0.375  # surface cells from both edges, within which they are halved again
LAYERED = (SUCTION, PRESSURE)
BETWEEN = 3  # cells between levels
NEAR = 2.0  # surface cells, within which all are as small: layers end where sizes change
FULL = 0.5  # of a surface cell: how high all layers are
LEAST = 0.17  # of that height, where layers are squeezed; less is none
MOST = 20  # layers
LEANING = 75, 80  # degrees that faces may lean, and where layers would else go: 65 costs a third
FLAT = 1e-6  # least determinant: 1 of a cube; 0.005 would drop layers as flat as 1 to 100
SKEW = 3.8  # of faces; checkMesh complains from 4 on


@dataclass(frozen=True)
class Layers:
    """Layers of cells on the blade.

    Parameters
    ----------
    first : float
        Height of the first cells [m].
    growth : float
        From layer to layer.
    count : int
    """

    first: float
    growth: float
    count: int

    @classmethod
    def under(cls, cell: float, first: float, growth: float) -> "Layers":
        """Return layers that are together less than half as high as a surface cell."""
        count = round(log(1.0 + FULL * cell / first * (growth - 1.0)) / log(growth))
        return cls(first, growth, min(max(1, count), MOST))

    @property
    def height(self) -> float:
        """Of all layers [m]."""
        return self.first * (self.growth**self.count - 1.0) / (self.growth - 1.0)


def snappy(
    level: int, size: float, layers: Layers, inside: Array, regions: Sequence[str]
) -> dict[str, Any]:
    """Return the entries of snappyHexMeshDict.

    Parameters
    ----------
    level : int
        Halvings of background cells on the blade; at its edges there are more.
    size : float
        Of cells there [m].
    layers : Layers
    inside : (3,) array
        A point in the flow [m].
    regions : sequence of str
        Of the blade's surface.
    """
    names = [region_word(name) for name in regions]
    return {
        "castellatedMesh": "true",
        "snap": "true",
        "addLayers": "true",
        "geometry": {
            SURFACE: {
                "type": "triSurfaceMesh",
                "name": BLADE,
                "regions": {name: {"name": name} for name in names},
            },
            EDGES: {"type": "triSurfaceMesh", "name": "edges"},
        },
        "castellatedMeshControls": {
            "maxLocalCells": 100_000_000,
            "maxGlobalCells": 200_000_000,
            "minRefinementCells": 0,
            "nCellsBetweenLevels": BETWEEN,
            "maxLoadUnbalance": 0.1,
            "features": (),
            "refinementSurfaces": {
                BLADE: {
                    "level": (level, level),
                    "patchInfo": {"type": "wall", "inGroups": (BLADE,)},
                },
            },
            "resolveFeatureAngle": 45,
            "refinementRegions": {
                BLADE: {"mode": "distance", "levels": ((NEAR * size, level),)},
                "edges": {
                    "mode": "distance",
                    "levels": tuple(  # nearest first, as OpenFOAM asks for
                        (share * size, level + 1 + i) for i, share in enumerate(ROUNDED)
                    )[::-1],
                },
            },
            "locationInMesh": tuple(inside.tolist()),
            "allowFreeStandingZoneFaces": "false",
        },
        "snapControls": {
            "nSmoothPatch": 3,
            "tolerance": 2.0,
            "nSolveIter": 50,
            "nRelaxIter": 5,
            "nFeatureSnapIter": 10,
            "implicitFeatureSnap": "false",
            "explicitFeatureSnap": "false",
            "multiRegionFeatureSnap": "false",
        },
        "addLayersControls": {
            "relativeSizes": "false",
            "firstLayerThickness": layers.first,
            "expansionRatio": layers.growth,
            "minThickness": LEAST * layers.height,
            "layers": {region_word(name): {"nSurfaceLayers": layers.count} for name in LAYERED},
            "nGrow": 0,
            "featureAngle": 150,
            "slipFeatureAngle": 30,
            "nRelaxIter": 5,
            "nSmoothSurfaceNormals": 1,
            "nSmoothNormals": 3,
            "nSmoothThickness": 10,
            "maxFaceThicknessRatio": 0.5,
            "maxThicknessToMedialRatio": 0.3,
            "minMedialAxisAngle": 90,
            "nMedialAxisIter": 10,
            "nBufferCellsNoExtrude": 0,
            "nLayerIter": 20,
            "nRelaxedIter": 10,
        },
        "meshQualityControls": {
            "maxNonOrtho": LEANING[0],
            "maxBoundarySkewness": SKEW,
            "maxInternalSkewness": SKEW,
            "maxConcave": 80,
            "minVol": 1e-13,
            "minTetQuality": -1e30,  # not asked for: thin layers on curved faces have none
            "minArea": -1,
            "minTwist": 0.02,
            "minDeterminant": FLAT,
            "minFaceWeight": 0.05,
            "minVolRatio": 0.01,
            "minTriangleTwist": -1,
            "nSmoothScale": 4,
            "errorReduction": 0.75,
            "relaxed": {"maxNonOrtho": LEANING[1]},
        },
        "mergeTolerance": 1e-6,
    }
