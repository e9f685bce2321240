"""VTK data sets to their XML files and back: VTK writes into memory and Python to the disk.

At a full disk VTK's own writers leave a file that is cut short, or crash.
"""

from pathlib import Path
from typing import Any

import numpy as np

from bladegen.errors import ExportError, FileError
from bladegen.support.arrays import Array, Indices

__all__ = ["save", "triangles"]


def save(data: Any, path: Path) -> None:
    """Write poly data (.vtp) or an unstructured grid (.vtu).

    Parameters
    ----------
    data : pyvista.PolyData or pyvista.UnstructuredGrid
        The data set.
    path : Path
        Where to.

    Raises
    ------
    ExportError
        If VTK cannot write the data.
    """
    from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter, vtkXMLUnstructuredGridWriter

    kinds = {
        "vtkPolyData": vtkXMLPolyDataWriter,
        "vtkUnstructuredGrid": vtkXMLUnstructuredGridWriter,
    }
    name = next(name for name in kinds if data.IsA(name))
    writer = kinds[name]()
    writer.SetInputData(data)
    writer.SetDataModeToBinary()
    writer.WriteToOutputStringOn()
    if not writer.Write():
        raise ExportError(f"{path}: VTK could not write the file")
    path.write_text(writer.GetOutputString(), encoding="utf-8")


def triangles(path: Path) -> tuple[Array, Indices]:
    """Read poly data (.vtp): vertices (v, 3) and triangles (f, 3), polygons cut to fans.

    VTK crashes on damaged files: this runs in a process of its own (`foreign_reader`).

    Raises
    ------
    FileError
        If VTK cannot read the file.
    """
    from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

    reader = vtkXMLPolyDataReader()
    reader.SetFileName(str(path))
    reader.Update()
    data = reader.GetOutput()
    if reader.GetErrorCode() or data is None or not data.GetNumberOfPoints():
        raise FileError(str(path), ["is no VTK poly data that can be read"])
    vertices = np.array(data.GetPoints().GetData(), dtype=np.float64).reshape(-1, 3)
    polygons = data.GetPolys()
    if not polygons.GetNumberOfCells():
        return vertices, np.zeros((0, 3), dtype=np.int64)
    starts = np.array(polygons.GetOffsetsArray(), dtype=np.int64)
    corners = np.array(polygons.GetConnectivityArray(), dtype=np.int64)
    counts = np.diff(starts)
    if starts[0] or (counts < 3).any() or starts[-1] > len(corners):
        raise FileError(str(path), ["has polygons whose corners are not in the file"])
    fans = np.repeat(np.arange(len(counts)), counts - 2)
    step = np.arange(len(fans)) - np.repeat(np.cumsum(counts - 2) - (counts - 2), counts - 2)
    first = starts[fans]
    return vertices, corners[np.stack([first, first + step + 1, first + step + 2], axis=1)]
