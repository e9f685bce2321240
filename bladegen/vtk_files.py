"""VTK data sets to their XML files: VTK writes into memory and Python to the disk.

At a full disk VTK's own writers leave a file that is cut short, or crash.
"""

from pathlib import Path
from typing import Any

from bladegen.errors import ExportError

__all__ = ["save"]


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
