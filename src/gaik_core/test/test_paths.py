"""The paths: points on the curves, velocities by finite differences, and the paper's 126 points."""

import math

import numpy as np
import pytest

from gaik_core import KinematicChain, LevenbergMarquardt, solve_path
from gaik_core.errors import GaikError, UnknownNameError
from gaik_core.paths import PATHS, Circle, Lemniscate, path_by_name

PHASES = np.linspace(0, 2 * math.pi, 200)


def test_circle_keeps_its_radius_and_lies_in_its_plane():
    circle = Circle(radius=0.07, tilt=0.4, centre=(0.1, -0.2, 0.3))
    offsets = circle.position(PHASES) - [0.1, -0.2, 0.3]
    assert np.allclose(np.linalg.norm(offsets, axis=1), 0.07, atol=1e-15)
    assert np.allclose(offsets @ [0, -math.sin(0.4), math.cos(0.4)], 0, atol=1e-15)


def test_lemniscate_satisfies_bernoullis_equation():
    """(x² + y²)² = a² (x² - y²), in its plane."""
    a = 0.09
    x, y, z = Lemniscate(half_width=a).position(PHASES).T
    assert np.allclose((x**2 + y**2) ** 2, a**2 * (x**2 - y**2), atol=1e-15)
    assert np.allclose(z, 0) and x.max() == pytest.approx(a)


@pytest.mark.parametrize("path", [Circle(), Lemniscate(), Lemniscate(tilt=0.5, centre=(1, 2, 3))])
def test_derivative_is_the_slope_and_the_curve_closes(path):
    h = 1e-6
    differences = (path.position(PHASES + h) - path.position(PHASES - h)) / (2 * h)
    assert np.allclose(path.derivative(PHASES), differences, atol=1e-9)
    assert np.allclose(path.position(0.0), path.position(2 * math.pi), atol=1e-15)
    assert path.position(0.3).shape == (3,) and path.position(PHASES.reshape(20, 10)).shape == (20, 10, 3)


def test_the_paper_has_126_points_in_one_lap():
    points = Circle().points()
    assert points.shape == (126, 3)
    assert 125 * 0.05 < 2 * math.pi < 126 * 0.05
    assert np.allclose(points[125], Circle().position(6.25))


@pytest.mark.parametrize(
    ("rate", "period", "count"), [(100, 6.3, 630), (1000, 2.0, 2000), (7, 1.0, 7), (3, 0.5, 2)]
)
def test_sampling_covers_one_lap(rate, period, count):
    points = Circle().sample(rate, period)
    assert points.shape == (count, 3)
    assert np.allclose(points[1], Circle().position(2 * math.pi / (rate * period)))


@pytest.mark.parametrize("name", PATHS)
def test_default_paths_lie_inside_the_device_limits(name):
    device = KinematicChain.load("touch_device")
    points = path_by_name(name).sample(100, 6.3)
    lap = solve_path(device, np.vstack([points, points[0]]), rule=LevenbergMarquardt(), tolerance=1e-9)
    assert lap.converged.all()
    turned = device.axis_angles(lap.angles)
    assert (turned > device.axis_lower).all() and (turned < device.axis_upper).all()
    assert (lap.angles > device.lower).all() and (lap.angles < device.upper).all()


def test_bad_sizes_are_named():
    with pytest.raises(GaikError, match="radius is -1"):
        Circle(radius=-1)
    with pytest.raises(GaikError, match="half_width is nan"):
        Lemniscate(half_width=math.nan)
    with pytest.raises(GaikError, match="centre is"):
        Circle(centre=(0, 0))
    with pytest.raises(GaikError, match="rate is 0"):
        Circle().sample(0, 1)
    with pytest.raises(UnknownNameError, match="known: circle, lemniscate"):
        path_by_name("square")
