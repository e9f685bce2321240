"""Where a grid's blocks join, as CGNS describes it: two edges and a signed transform."""

from dataclasses import dataclass

from bladegen.surface.grids.blocks import Block

__all__ = ["Corner", "Interface", "interfaces"]

Corner = tuple[int, int]


@dataclass(frozen=True)
class Interface:
    """Two edges of blocks with the same points in the same order.

    Parameters
    ----------
    block, donor : int
        The blocks' places in the grid.
    start, stop, donor_start, donor_stop : (int, int)
        Indices, from 0, of the edges' first and last points.
    transform : (int, int)
        For i and j of the block: which index of the donor goes along, 1 or 2, negative if it
        runs the other way (as CGNS writes it).
    """

    block: int
    donor: int
    start: Corner
    stop: Corner
    donor_start: Corner
    donor_stop: Corner
    transform: Corner


def interfaces(blocks: list[Block], edge_cells: int) -> tuple[Interface, ...]:
    """List where blocks join, each pair of edges once.

    Parameters
    ----------
    blocks : list of Block
        Of `blocks.Frame`.
    edge_cells : int
        Cells across the trailing edge, and across the tip.
    """
    place = {block.name: i for i, block in enumerate(blocks)}
    rims, cores = (blocks[place[f"tip {name}"]].eta.shape for name in ("rim", "core"))
    top, last, layers, across = len(blocks[0].eta) - 1, rims[1] - 1, rims[0] - 1, cores[0] - 1
    middle = last // 2
    corner = middle - across // 2
    side, rim, core, edge = "suction side", "tip rim", "tip core", "trailing edge"
    other, ring, disc = "pressure side", "edge ring", "edge core"
    joints: list[tuple[str, Corner, Corner, str, Corner, Corner]] = [
        (side, (0, middle), (top, middle), other, (0, 0), (top, 0)),
        (side, (top, 0), (top, middle), rim, (0, 0), (0, middle)),
        (other, (top, 0), (top, middle), rim, (0, middle), (0, last)),
        (core, (0, 0), (0, corner), rim, (layers, 0), (layers, corner)),
        (core, (0, corner), (across, corner), rim, (layers, corner), (layers, corner + across)),
        (core, (across, corner), (across, 0), rim, (layers, corner + across), (layers, last)),
    ]
    inner = layers + across
    if edge in place:
        joints += [
            (other, (0, middle), (top, middle), edge, (0, 0), (top, 0)),
            (edge, (0, edge_cells), (top, edge_cells), side, (0, 0), (top, 0)),
        ]
    if ring in place:
        far, rest = inner + layers, edge_cells - layers
        joints += [
            (edge, (top, 0), (top, layers), ring, (0, 0), (0, layers)),
            (edge, (top, layers), (top, rest), disc, (0, 0), (0, across)),
            (edge, (top, rest), (top, edge_cells), ring, (far, layers), (far, 0)),
            (disc, (0, 0), (layers, 0), ring, (0, layers), (layers, layers)),
            (disc, (layers, 0), (layers, across), ring, (layers, layers), (inner, layers)),
            (disc, (layers, across), (0, across), ring, (inner, layers), (far, layers)),
            (ring, (0, 0), (layers, 0), rim, (0, last), (layers, last)),
            (ring, (layers, 0), (inner, 0), core, (across, 0), (0, 0)),
            (ring, (inner, 0), (far, 0), rim, (layers, 0), (0, 0)),
        ]
    elif edge in place:
        joints += [
            (edge, (top, 0), (top, layers), rim, (0, last), (layers, last)),
            (edge, (top, layers), (top, inner), core, (across, 0), (0, 0)),
            (edge, (top, inner), (top, edge_cells), rim, (layers, 0), (0, 0)),
        ]
    else:
        joints.append((other, (0, middle), (top, middle), side, (0, 0), (top, 0)))
    found = []
    for name, start, stop, donor, donor_start, donor_stop in joints:
        a, b = place[name], place[donor]
        transform = _transform(
            blocks[a].points.shape, start, stop, blocks[b].points.shape, donor_start, donor_stop
        )
        found.append(Interface(a, b, start, stop, donor_start, donor_stop, transform))
    return tuple(found)


def _transform(
    shape: tuple[int, ...],
    start: Corner,
    stop: Corner,
    donor_shape: tuple[int, ...],
    donor_start: Corner,
    donor_stop: Corner,
) -> Corner:
    """Return the signed axes of the donor that continue i and j of a block across an edge."""
    (axis, sense, out), (other, other_sense, into) = (
        _edge(shape, start, stop),
        _edge(donor_shape, donor_start, donor_stop),
    )
    signed = {axis: sense * other_sense * (other + 1), 1 - axis: -out * into * (2 - other)}
    return signed[0], signed[1]


def _edge(shape: tuple[int, ...], start: Corner, stop: Corner) -> tuple[int, int, int]:
    """Return an edge's axis, its sense, and the sign of the other axis out of the block."""
    axis = 0 if start[0] != stop[0] else 1
    out = 1 if start[1 - axis] == shape[1 - axis] - 1 else -1
    return axis, 1 if stop[axis] > start[axis] else -1, out
