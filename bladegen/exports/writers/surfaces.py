"""Files of a blade's mesh, its structured grid, the volume around it, and its picture."""

from pathlib import Path

import numpy as np

from bladegen.exports.cases import volume_mesh
from bladegen.exports.options import UNITS, Kind
from bladegen.exports.products import Products
from bladegen.surface import gltf, mesh_files
from bladegen.surface.grids import grid_files
from bladegen.surface.volumes import volume_files
from bladegen.views import preview

__all__ = [
    "write_3mf",
    "write_cgns",
    "write_fmt",
    "write_glb",
    "write_obj",
    "write_p3d",
    "write_ply",
    "write_png",
    "write_regions_stl",
    "write_stl",
    "write_volume_cgns",
    "write_volume_fmt",
    "write_volume_foam",
    "write_volume_p3d",
    "write_vtp",
    "write_vtu",
]


def write_stl(products: Products, path: Path) -> None:
    """Write the mesh as binary STL."""
    scaled = mesh_files.to_trimesh(products.mesh, scale=UNITS[products.options.unit])
    path.write_bytes(scaled.export(file_type="stl"))


def write_regions_stl(products: Products, path: Path) -> None:
    """Write the mesh as STL in text, a solid a region."""
    text = mesh_files.stl_text(products.mesh, scale=UNITS[products.options.unit])
    path.write_text(text, encoding="ascii")


def write_obj(products: Products, path: Path) -> None:
    """Write the mesh as Wavefront OBJ."""
    unit = products.options.unit
    header = f"bladegen {' '.join(products.blade.name.split())}, unit: {unit}"
    text = mesh_files.obj_text(products.mesh, header, scale=UNITS[unit])
    path.write_text(text, encoding="utf-8")


def write_ply(products: Products, path: Path) -> None:
    """Write the mesh as PLY."""
    scaled = mesh_files.to_trimesh(products.mesh, scale=UNITS[products.options.unit])
    path.write_bytes(scaled.export(file_type="ply", vertex_normal=False))


def write_glb(products: Products, path: Path) -> None:
    """Write the mesh as binary glTF."""
    name = products.blade.name
    path.write_bytes(gltf.glb(name, [gltf.Standing(name, products.mesh, np.eye(3), np.zeros(3))]))


def write_3mf(products: Products, path: Path) -> None:
    """Write the mesh as 3MF."""
    scaled = mesh_files.to_trimesh(products.mesh, scale=UNITS["mm"])
    package = mesh_files.with_steady_ids(scaled.export(file_type="3mf"))
    path.write_bytes(mesh_files.with_materials(package, products.mesh, products.blade.name))


def write_vtp(products: Products, path: Path) -> None:
    """Write the mesh as VTK poly data."""
    preview.write_vtp(products.mesh, path, scale=UNITS[products.options.unit])


def write_p3d(products: Products, path: Path) -> None:
    """Write the grid as PLOT3D."""
    grid_files.write_plot3d(products.grid, path, scale=UNITS[products.options.unit])


def write_fmt(products: Products, path: Path) -> None:
    """Write the grid as PLOT3D in text."""
    grid_files.write_plot3d_text(products.grid, path, scale=UNITS[products.options.unit])


def write_cgns(products: Products, path: Path) -> None:
    """Write the grid as CGNS."""
    made = products.made_from(Kind.grid, ".cgns")
    grid_files.write_cgns(products.grid, path, note=made.text)


def write_vtu(products: Products, path: Path) -> None:
    """Write the grid as VTK's unstructured cells."""
    grid_files.write_vtu(products.grid, path, scale=UNITS[products.options.unit])


def write_png(products: Products, path: Path) -> None:
    """Write a picture of the blade."""
    products.progress("rendering")
    preview.picture(products.blade, path)


def write_volume_p3d(products: Products, path: Path) -> None:
    """Write the volume as PLOT3D."""
    scale = UNITS[products.options.unit]
    volume_files.write_plot3d(products.volume, path, scale=scale)


def write_volume_fmt(products: Products, path: Path) -> None:
    """Write the volume as PLOT3D in text."""
    scale = UNITS[products.options.unit]
    volume_files.write_plot3d_text(products.volume, path, scale=scale)


def write_volume_foam(products: Products, path: Path) -> None:
    """Write the volume as OpenFOAM's mesh, packed."""
    made = products.made_from(Kind.volume, ".volume.foam.zip")
    volume_mesh.write_zip(products.volume, path, note=made.text)


def write_volume_cgns(products: Products, path: Path) -> None:
    """Write the volume as CGNS."""
    made = products.made_from(Kind.volume, ".volume.cgns")
    volume_files.write_cgns(products.volume, path, note=made.text)
