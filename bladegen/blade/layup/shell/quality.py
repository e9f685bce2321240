"""How good quadrilaterals of eight nodes are: their Jacobian, how they warp, their aspect."""

from typing import Any

import numpy as np

from bladegen.support.arrays import Array, Indices

__all__ = [
    "areas",
    "corner_normals",
    "figures",
    "integrals",
    "shapes",
    "shared_normals",
    "slopes",
    "wall_jacobians",
]

# parameters of the nodes: corners in turn, then the middles of the sides after each
XI = np.array([-1.0, 1.0, 1.0, -1.0, 0.0, 1.0, 0.0, -1.0])
ETA = np.array([-1.0, -1.0, 1.0, 1.0, -1.0, 0.0, 1.0, 0.0])
ALIKE = np.cos(np.radians(20.0))  # of normals that CalculiX makes one


def slopes(xi: Array, eta: Array) -> Array:
    """Return derivatives (..., 2, 8) of the serendipity shape functions at parameters (...)."""
    x, y = np.asarray(xi)[..., None], np.asarray(eta)[..., None]
    found = np.empty((*x.shape[:-1], 2, 8))
    a, b = XI[:4], ETA[:4]
    found[..., 0, :4] = 0.25 * a * (1.0 + b * y) * (2.0 * a * x + b * y)
    found[..., 1, :4] = 0.25 * b * (1.0 + a * x) * (2.0 * b * y + a * x)
    for node in (4, 6):
        found[..., 0, node] = (-x * (1.0 + ETA[node] * y))[..., 0]
        found[..., 1, node] = (0.5 * ETA[node] * (1.0 - x**2))[..., 0]
    for node in (5, 7):
        found[..., 0, node] = (0.5 * XI[node] * (1.0 - y**2))[..., 0]
        found[..., 1, node] = (-y * (1.0 + XI[node] * x))[..., 0]
    return found


def shapes(xi: Array, eta: Array) -> Array:
    """Return the serendipity shape functions (g, 8) at parameters (g,)."""
    x, y = xi[:, None], eta[:, None]
    found = np.empty((len(xi), 8))
    a, b = XI[:4], ETA[:4]
    found[:, :4] = 0.25 * (1.0 + a * x) * (1.0 + b * y) * (a * x + b * y - 1.0)
    found[:, 4::2] = 0.5 * (1.0 - x**2) * (1.0 + ETA[4::2] * y)
    found[:, 5::2] = 0.5 * (1.0 - y**2) * (1.0 + XI[5::2] * x)
    return found


def corner_normals(points: Array, quads: Indices) -> Array:
    """Return normals (m, 8, 3) of elements at their nodes [m2 a parameter squared]."""
    tangents = slopes(XI, ETA) @ points[quads][:, None]
    return np.cross(tangents[..., 0, :], tangents[..., 1, :])


def shared_normals(unit: Array, quads: Indices) -> Array:
    """Return unit normals (m, 8, 3) at nodes as CalculiX makes walls of them.

    At each node it is the mean of those of the elements there that look nearly the same way.
    """
    flat, order = unit.reshape(-1, 3), np.argsort(quads, axis=None, kind="stable")
    node = quads.reshape(-1)[order]
    found = flat[order].copy()
    for step in range(1, int(np.bincount(node).max())):
        near = (node[step:] == node[:-step]) & (
            np.einsum("ni,ni->n", flat[order[step:]], flat[order[:-step]]) > ALIKE
        )
        found[step:][near] += flat[order[:-step]][near]
        found[:-step][near] += flat[order[step:]][near]
    shared = np.empty_like(found)
    shared[order] = found / np.linalg.norm(found, axis=-1, keepdims=True)
    return shared.reshape(unit.shape)


def wall_jacobians(outer: Array, wall: Array) -> Array:
    """Return the least Jacobian determinant (m,) of walls, at 2 x 2 x 2 Gauss points.

    `outer` are nodes (m, 8, 3) of the outside, `wall` the vectors to them from the inside.
    """
    gauss = np.array([-1.0, 1.0]) / np.sqrt(3.0)
    xi, eta = (one.reshape(-1) for one in np.meshgrid(gauss, gauss))
    found, through = np.full(len(outer), np.inf), shapes(xi, eta) @ wall[:, None]
    for depth in 0.5 * (1.0 + gauss):
        tangents = slopes(xi, eta) @ (outer - depth * wall)[:, None]
        normals = np.cross(tangents[..., 0, :], tangents[..., 1, :])
        sizes = np.einsum("mgi,mgi->mg", normals, through[:, 0])
        found = np.minimum(found, sizes.min(axis=1))
    return found


def areas(points: Array, quads: Indices) -> Array:
    """Return the areas (m,) of elements [m2], by 3 x 3 Gauss points."""
    return integrals(points, quads, np.ones(len(points)))


def integrals(points: Array, quads: Indices, values: Array) -> Array:
    """Return integrals (m,) over elements of what is given at nodes (n,), by 3 x 3 Gauss points."""
    nodes, weights = np.polynomial.legendre.leggauss(3)
    xi, eta = (one.reshape(-1) for one in np.meshgrid(nodes, nodes))
    tangents = slopes(xi, eta) @ points[quads][:, None]
    sizes = np.linalg.norm(np.cross(tangents[..., 0, :], tangents[..., 1, :]), axis=-1)
    found: Array = (sizes * (values[quads] @ shapes(xi, eta).T)) @ np.kron(weights, weights)
    return found


def figures(points: Array, quads: Indices) -> dict[str, Any]:
    """Return figures on elements.

    Returns
    -------
    dict
        `elements`, `nodes`; `smallest_jacobian`, least over nodes of the Jacobian over the largest
        of the element, negative where it folds; `warping_deg`, most between the two triangles of an
        element, by either diagonal; `aspect_most`, `aspect_median`, of the longer over the
        shorter mean side.
    """
    normals = corner_normals(points, quads)
    middle = slopes(np.zeros(1), np.zeros(1))[0] @ points[quads]
    up = np.cross(middle[:, 0], middle[:, 1])
    up /= np.linalg.norm(up, axis=-1, keepdims=True)
    signed = np.einsum("mni,mi->mn", normals, up)
    jacobian = signed.min(axis=1) / np.linalg.norm(normals, axis=-1).max(axis=1)
    a, b, c, d = points[quads[:, :4]].swapaxes(0, 1)
    along = np.linalg.norm(0.5 * (b - a + c - d), axis=-1)
    across = np.linalg.norm(0.5 * (d - a + c - b), axis=-1)
    aspect = np.maximum(along, across) / np.minimum(along, across)
    warped = np.maximum(_bent(a, b, c, d), _bent(b, c, d, a))
    return {
        "elements": len(quads),
        "nodes": len(points),
        "smallest_jacobian": float(jacobian.min()),
        "warping_deg": float(np.degrees(warped.max())),
        "aspect_most": float(aspect.max()),
        "aspect_median": float(np.median(aspect)),
    }


def _bent(a: Array, b: Array, c: Array, d: Array) -> Array:
    """Return the angles (m,) between the triangles on both sides of the diagonal from a to c."""
    one, other = np.cross(b - a, c - a), np.cross(c - a, d - a)
    norms = np.linalg.norm(one, axis=-1) * np.linalg.norm(other, axis=-1)
    cosine = np.einsum("mi,mi->m", one, other) / np.maximum(norms, np.finfo(float).tiny)
    found: Array = np.arccos(np.clip(cosine, -1.0, 1.0))
    return found
