"""Meshes: the structured grid beside OCCT's tessellation of the same blade's solid."""

import tempfile
import time
from pathlib import Path
from statistics import median

import bladegen as bg
from bladegen import cad, mesh, properties

RUNS = 7


def main() -> None:
    """Print two rows a blade."""
    from OCP.BRepMesh import BRepMesh_IncrementalMesh
    from OCP.StlAPI import StlAPI_Writer

    print("blade     way           triangles  mesh + STL s  watertight  volume off by")
    for name in bg.bundled():
        blade = bg.Blade.from_definition(bg.read(name))
        wanted = properties.volume(blade)
        solid = cad.solid(blade)
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "blade.stl"
            spent = []
            for _ in range(RUNS):
                start = time.perf_counter()
                bg.export(blade, path)
                spent.append(time.perf_counter() - start)
            again = mesh.read(path)
            print(
                f"{name:9s} grid       {len(again.faces):12d}  {median(spent):12.3f}  "
                f"{again.is_watertight!s:10s}  {again.volume / wanted - 1:+.1e}"
            )
            start = time.perf_counter()
            BRepMesh_IncrementalMesh(solid.shape, 1.0, False, 0.1, True)
            StlAPI_Writer().Write(solid.shape, str(path))
            took = time.perf_counter() - start
            again = mesh.read(path)
            print(
                f"{name:9s} tessellate {len(again.faces):12d}  {took:12.3f}  "
                f"{again.is_watertight!s:10s}  {again.volume * 1e-9 / wanted - 1:+.1e}"
            )


if __name__ == "__main__":
    main()
