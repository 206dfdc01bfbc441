"""The reachable workspace as a closed surface: the tip's positions counted in cells, and the surface around them."""

from __future__ import annotations

import itertools
import math

import numpy as np
from numpy.typing import NDArray

from gaik_core import KinematicChain

Array = NDArray[np.float64]
Faces = NDArray[np.int64]

SAMPLES = 600_000  # joint values tried
CELLS = 40  # along the longest side of the workspace
FREE = math.pi  # rad: how far a joint without a limit is turned to either side
BLURS = 3
CORNERS = np.array(list(itertools.product((0, 1), repeat=3)))


def reachable_points(chain: KinematicChain, samples: int = SAMPLES) -> Array:
    """Positions of the tip (n, 3) m over all joint values inside the limits, evenly spread, the same each time."""
    lower = np.where(np.isfinite(chain.lower), chain.lower, chain.home - FREE)
    upper = np.where(np.isfinite(chain.upper), chain.upper, chain.home + FREE)
    values = lower + (upper - lower) * _even(samples, chain.dof)
    axes = chain.axis_angles(values)
    inside = ((axes >= chain.axis_lower) & (axes <= chain.axis_upper)).all(axis=-1)
    return chain.forward(values[inside])


def _even(count: int, dimensions: int) -> Array:
    """Points (count, dimensions) in the unit cube without clusters: the recurrence of the generalised golden ratio."""
    ratio = 2.0
    for _ in range(50):
        ratio = (1.0 + ratio) ** (1.0 / (dimensions + 1))
    steps = ratio ** -np.arange(1.0, dimensions + 1.0)
    return np.asarray(np.arange(1, count + 1)[:, np.newaxis] * steps % 1.0)


def surface_around(points: Array, cells: int = CELLS) -> tuple[Array, Faces]:
    """Vertices (v, 3) m and triangles (f, 3) of a smooth closed surface around points (n, 3); empty for a flat set."""
    lowest, highest = points.min(axis=0), points.max(axis=0)
    size = float((highest - lowest).max()) / cells
    if size == 0.0 or float((highest - lowest).min()) < size:
        return np.empty((0, 3)), np.empty((0, 3), dtype=np.int64)
    margin = BLURS + 1
    indices = np.floor((points - lowest) / size).astype(int) + margin
    field = np.zeros(indices.max(axis=0) + margin + 1)
    field[tuple(indices.T)] = 1.0
    for _ in range(BLURS):
        field = _blurred(field)
    vertices, faces = surface_net(field, 0.5)
    return lowest + (vertices - margin + 0.5) * size, faces


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
