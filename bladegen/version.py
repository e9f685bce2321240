"""The version of bladegen, and of the libraries that it stands on."""

__all__ = ["__version__", "of_libraries"]

__version__ = "2.0.0rc1"
LIBRARIES = ("numpy", "scipy", "cadquery", "cadquery-ocp", "trimesh", "pyvista", "vtk", "h5py")


def of_libraries() -> dict[str, str]:
    """Return the versions of the libraries that are installed."""
    from importlib.metadata import PackageNotFoundError, version

    found = {}
    for library in LIBRARIES:
        try:
            found[library] = version(library)
        except PackageNotFoundError:
            continue
    return found
