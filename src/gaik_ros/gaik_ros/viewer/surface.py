"""The reachable workspace as a smooth closed surface around the cells that are reached."""

from __future__ import annotations

import itertools

import numpy as np
from numpy.typing import NDArray

from gaik_core.workspace import Workspace

Array = NDArray[np.float64]
Faces = NDArray[np.int64]

BLURS = 3
CORNERS = np.array(list(itertools.product((0, 1), repeat=3)))


def surface_of(workspace: Workspace) -> tuple[Array, Faces]:
    """Vertices (v, 3) m and triangles (f, 3) around a workspace; none where it has no volume."""
    if workspace.dimension < 3 or min(workspace.reached.shape) < 2:
        return np.empty((0, 3)), np.empty((0, 3), dtype=np.int64)
    margin = BLURS + 1
    field = np.pad(workspace.reached.astype(np.float64), margin)
    for _ in range(BLURS):
        field = _blurred(field)
    vertices, faces = surface_net(field, 0.5)
    return workspace.corner + (vertices - margin + 0.5) * workspace.cell, faces


def _blurred(field: Array) -> Array:
    """Every cell mixed with its neighbours along each side, 1 : 2 : 1; what leaves at an end comes in at the other."""
    for side in range(3):
        field = 0.25 * np.roll(field, 1, side) + 0.5 * field + 0.25 * np.roll(field, -1, side)
    return field


def surface_net(field: Array, level: float) -> tuple[Array, Faces]:
    """The surface where `field` (nx, ny, nz) crosses `level`: vertices in units of its indices, and triangles.

    Naive surface nets (Gibson 1998): one vertex for each cube of eight samples that the surface passes, at the mean
    of the crossings on its edges; and two triangles for each crossed edge, between the four cubes around it. They
    turn counterclockwise as seen from below the level, that is from outside.
    """
    inside = field > level
    cubes = np.array(field.shape) - 1
    total, count = np.zeros((*cubes, 3)), np.zeros(cubes)
    for a, b in _edges():
        fa, fb = _corner(field, a), _corner(field, b)
        crossed = _corner(inside, a) != _corner(inside, b)
        along = np.where(crossed, (level - fa) / np.where(crossed, fb - fa, 1.0), 0.0)
        total += np.where(crossed[..., np.newaxis], a + along[..., np.newaxis] * (b - a), 0.0)
        count += crossed
    passed = count > 0
    number = np.full(cubes, -1)
    number[passed] = np.arange(passed.sum())
    vertices = np.argwhere(passed) + total[passed] / count[passed][:, np.newaxis]
    return vertices, np.concatenate([_faces(inside, number, side) for side in range(3)])


def _edges() -> list[tuple[Array, Array]]:
    """The twelve edges of a cube, each from its lower corner to its upper one."""
    return [(a, b) for a in CORNERS for b in CORNERS if (b - a).sum() == 1 and (b >= a).all()]


def _corner(field: NDArray, corner: Array) -> NDArray:  # type: ignore[type-arg]
    """The samples at one corner of every cube."""
    x, y, z = (slice(c, c - 1 or None) for c in corner.tolist())
    return field[x, y, z]


def _faces(inside: NDArray[np.bool_], number: NDArray[np.int64], side: int) -> Faces:
    """The triangles (n, 3) across the crossed edges that run along one side."""
    inside, number = np.moveaxis(inside, side, 0), np.moveaxis(number, side, 0)
    # An edge from sample (i, j, k) to (i + 1, j, k) lies between the four cubes (i, j - 1 … j, k - 1 … k).
    leaves = inside[:-1, 1:-1, 1:-1] & ~inside[1:, 1:-1, 1:-1]
    enters = ~inside[:-1, 1:-1, 1:-1] & inside[1:, 1:-1, 1:-1]
    around = (number[:, :-1, :-1], number[:, 1:, :-1], number[:, 1:, 1:], number[:, :-1, 1:])
    if side == 1:  # moving y to the front exchanged the sense of the two others
        leaves, enters = enters, leaves
    quads = np.concatenate(
        [np.stack([n[leaves] for n in around], -1), np.stack([n[enters] for n in around[::-1]], -1)]
    )
    return np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
