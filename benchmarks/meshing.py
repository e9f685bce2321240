"""Meshes: the structured grid beside OCCT's tessellation of the same blade's solid at 1 mm."""

import tempfile
from pathlib import Path

from figures import figure, seconds

import bladegen as bg
from bladegen import cad, mesh, properties

RUNS = 7


def main() -> None:
    """Print each blade's figures."""
    from OCP.BRepMesh import BRepMesh_IncrementalMesh
    from OCP.StlAPI import StlAPI_Writer

    for name in bg.bundled():
        blade = bg.Blade.from_definition(bg.read(name))
        wanted = properties.volume(blade)
        solid = cad.solid(blade)
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "blade.stl"

            def tessellated(solid: cad.Solid = solid, path: Path = path) -> None:
                BRepMesh_IncrementalMesh(solid.shape, 1.0, False, 0.1, True)
                StlAPI_Writer().Write(solid.shape, str(path))

            def measured(
                scale: float, path: Path = path, wanted: float = wanted
            ) -> tuple[int, float]:
                again = mesh.read(path)
                if not again.is_watertight:
                    raise SystemExit(f"{path.name} is not watertight")
                return len(again.faces), abs(again.volume * scale / wanted - 1)

            ours = seconds(lambda blade=blade, path=path: bg.export(blade, path), RUNS)
            count, off = measured(1.0)
            # once: a solid keeps its triangles, a second call would find them made
            other = seconds(tessellated, runs=1, warm=False)
            count_other, off_other = measured(1e-9)
            beside = "OCCT's tessellation"
            figure("STL, made and written", name, ours, "s", beside=beside, baseline=other)
            figure("STL, triangles", name, count, "", beside=beside, baseline=count_other)
            figure("STL, volume off by", name, off, "", beside=beside, baseline=off_other)


if __name__ == "__main__":
    main()
