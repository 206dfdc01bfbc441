"""The misprints of equations, each put beside what holds and measured.

Every function here writes an equation as the paper prints it, evaluates it, and evaluates what it should say.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from gaik_core.cga import Multivector, distance, down, line, up
from gaik_core.cga.blades import e0, e4, e5, e12, e13, e24, e25, einf
from gaik_core.chain import KinematicChain
from gaik_core.experiments.findings import Comparison, Erratum, Experiment, Findings
from gaik_core.quaternion import Quaternion

Array = NDArray[np.float64]

EXACT = 1e-12
SAMPLES = 200
SEED = 3
ROBOTS = ("planar2", "planar6", "arm3", "arm5", "touch")

X, Y, Z = np.eye(3)


def samples(count: int) -> Array:
    """Seeded angles (SAMPLES, count), evenly over a turn."""
    return np.random.default_rng(SEED).uniform(-np.pi, np.pi, (SAMPLES, count))


def largest(difference: Callable[[Array], Array], count: int) -> float:
    """The largest component of a difference over the samples of `count` angles."""
    return max(float(np.abs(difference(angles)).max()) for angles in samples(count))


def turned(rotation: Quaternion, vector: Array, real: float = 0.0) -> Quaternion:
    """Q v q~ of a vector embedded with a real part."""
    return rotation * (Quaternion.from_vector(vector) + real) * ~rotation


def central_difference(forward: Callable[[Array], Array], angles: Array) -> Array:
    """Derivative (3, dof) of a position by the angles."""
    h = 1e-5
    return np.stack(
        [(forward(angles + h * e) - forward(angles - h * e)) / (2.0 * h) for e in np.eye(len(angles))], axis=1
    )


# --- section 2 -------------------------------------------------------------------------------------------------------


def embedding() -> Erratum:
    """Eq. 3, seen in eq. 23: each link brings its real part along."""
    q1, q2 = (Quaternion.from_axis_angle(Z, angle) for angle in (0.4, 0.9))
    printed, right = (turned(q1, 0.1 * X, real) + turned(q1 * q2, 0.1 * X, real) for real in (1.0, 0.0))
    return Erratum(
        "eq. 3",
        "v = 1 + xi + yj + zk",
        "v = 0 + xi + yj + zk",
        f"eq. 23 then has the real part {printed.scalar:.1f}, where eq. 24 has 0; with the pure quaternion "
        f"{abs(right.scalar):.1f}",
        bool(printed.scalar > 1.0 and abs(right.scalar) < EXACT),
    )


def rotation() -> Erratum:
    """Eqs. 6 and 7 lost the vector."""
    q = Quaternion.from_axis_angle([1.0, 2.0, -0.5], 0.7)
    v = np.array([0.3, -0.2, 0.5])
    printed = q * ~q
    length = np.linalg.norm(turned(q, v).vector)
    return Erratum(
        "eqs. 6, 7",
        "v' = q q~",
        "v' = q v q~",
        f"q q~ is {printed.scalar:.3f} for any v; q v q~ keeps |v| = {np.linalg.norm(v):.4f} at {length:.4f}",
        bool(abs(printed.scalar - 1.0) < EXACT and abs(length - np.linalg.norm(v)) < EXACT),
    )


def null_basis() -> Erratum:
    """Eq. 10's sign, seen in eqs. 47 and 48."""
    printed_e0 = 0.5 * (e4 - e5)
    a, b = np.array([0.3, -0.2, 0.5]), np.array([-0.1, 0.4, 0.2])

    def squared(origin: Multivector) -> float:
        p, q = (Multivector.from_vector(v) + 0.5 * float(v @ v) * einf + origin for v in (a, b))
        return float(-2.0 * p.scalar_product(q))

    exact = float((a - b) @ (a - b))
    return Erratum(
        "eq. 10",
        "e0 = (e4 - e5)/2",
        "e0 = (e5 - e4)/2",
        f"e0·einf is {printed_e0.scalar_product(einf):+.0f} as printed and {e0.scalar_product(einf):+.0f} as "
        f"it must be; -2 p·q of two points {np.sqrt(exact):.4f} m apart is {squared(printed_e0):.4f} as "
        f"printed, {squared(e0):.4f} right",
        bool(
            squared(printed_e0) < 0.0
            and abs(squared(e0) - exact) < EXACT
            and abs(distance(up(a), up(b)) ** 2 - exact) < EXACT
        ),
    )


def line_and_angle() -> Erratum:
    """Eqs. 12 to 14: how far a screw rotor turns, and about which lines."""
    angle, point = np.radians(60.0), np.array([0.3, 0.0, 0.0])
    axis = line(Z, np.zeros(3))
    motor = np.cos(angle / 2.0) - np.sin(angle / 2.0) * axis
    moved = down(motor * up(point) * ~motor)
    went = np.degrees(np.arctan2(moved[1], moved[0]))
    square = (line(2.0 * Z, np.zeros(3)) ** 2).scalar
    return Erratum(
        "eqs. 13, 14",
        "a rotation of θ/2, about the line of any two points",
        "a rotation of θ, about a line with |a - b| = 1, positive from b to a",
        f"θ = 60 deg turns by {went:+.4f} deg about the line from 0 to z; with |a - b| = 2, L² is {square:.0f}",
        bool(abs(went - 60.0) < 1e-9 and abs((axis**2).scalar + 1.0) < EXACT and abs(square + 4.0) < EXACT),
    )


# --- section 3 -------------------------------------------------------------------------------------------------------


def loss() -> Erratum:
    """Eq. 28 takes p_fx for p_fz."""
    d, f = np.array([0.05, 0.05, 0.0]), np.array([-0.0614, -0.2236, -0.1306])
    e = d - f
    printed = 0.5 * (e[0] ** 2 + e[1] ** 2 + (d[2] - f[0]) ** 2)
    right = 0.5 * e @ e
    return Erratum(
        "eq. 28",
        "p_dz - p_fx",
        "p_dz - p_fz",
        f"at 6.2's start the loss is {printed:.6f} m² as printed, {right:.6f} m² by eq. 29",
        bool(abs(printed - right) > 1e-3),
    )


def quaternion_jacobian() -> Erratum:
    """Eq. 39 has the rotated links where their derivatives belong."""
    l1, l2 = 0.1, 0.1

    def forward(a: Array) -> Array:  # eq. 24
        return np.array(
            [l1 * np.cos(a[0]) + l2 * np.cos(a[0] + a[1]), l1 * np.sin(a[0]) + l2 * np.sin(a[0] + a[1]), 0.0]
        )

    def links(a: Array) -> tuple[Array, Array]:
        q1, q2 = Quaternion.from_axis_angle(Z, a[0]), Quaternion.from_axis_angle(Z, a[1])
        return turned(q1, l1 * X).vector, turned(q1 * q2, l2 * X).vector

    def printed(a: Array) -> Array:
        first, second = links(a)
        return np.stack([first + second, second], axis=1) - central_difference(forward, a)

    def right(a: Array) -> Array:
        first, second = links(a)
        return np.stack([np.cross(Z, first + second), np.cross(Z, second)], axis=1) - central_difference(
            forward, a
        )

    return Erratum(
        "eq. 39",
        "the rotated links q p q~, and p_1 for the second",
        "∂(q v q~)/∂θ is the axis crossed with the rotated link, p_2 for the second (eq. 40 is right)",
        f"off central differences by up to {largest(printed, 2):.3f} m/rad as printed, by "
        f"{largest(right, 2):.0e} with the axis",
        bool(largest(printed, 2) > 0.1 and largest(right, 2) < 1e-9),
    )


# --- section 5 -------------------------------------------------------------------------------------------------------

L1 = L2 = 0.4


def eq63(a: Array) -> Array:
    """The position of the arm of Fig. 13 as printed, which defines the arm."""
    radius = L1 * np.cos(a[1]) + L2 * np.sin(a[1] + a[2])
    return np.array(
        [np.cos(a[0]) * radius, L1 * np.sin(a[1]) - L2 * np.cos(a[1] + a[2]), np.sin(a[0]) * radius]
    )


def by_quaternions(a: Array, first_axis: Array, third_angle: int) -> Array:
    """Eqs. 57 to 62 put together, with a choice of the first axis and of the angle that q_3 takes."""
    q1 = Quaternion.from_axis_angle(first_axis, a[0])
    q2, q3 = (Quaternion.from_axis_angle(Z, a[i]) for i in (1, third_angle))
    return turned(q1 * q2, L1 * X).vector + turned(q1 * q2 * q3, -L2 * Y).vector


def first_axis() -> Erratum:
    """Eq. 57 against eq. 63."""
    printed = largest(lambda a: by_quaternions(a, Y, 2) - eq63(a), 3)
    right = largest(lambda a: by_quaternions(a, -Y, 2) - eq63(a), 3)
    return Erratum(
        "eqs. 57, 63",
        "q_1 turns about +j",
        "eq. 63 turns about -j; it defines the arm",
        f"the two differ by up to {printed:.2f} m; with -j by {right:.0e} m",
        bool(printed > 0.1 and right < EXACT),
    )


def third_angle() -> Erratum:
    """Eq. 59 against eq. 63."""
    printed = largest(lambda a: by_quaternions(a, -Y, 1) - eq63(a), 3)
    right = largest(lambda a: by_quaternions(a, -Y, 2) - eq63(a), 3)
    return Erratum(
        "eq. 59",
        "q_3 of θ2",
        "q_3 of θ3",
        f"off eq. 63 by up to {printed:.2f} m as printed, by {right:.0e} m with θ3",
        bool(printed > 0.1 and right < EXACT),
    )


def by_screw_rotors(a: Array, lines: tuple[Multivector, ...]) -> Array:
    """Eqs. 44, 64 and 65."""
    motor = Multivector.from_scalar(1.0)
    for angle, axis in zip(a, lines, strict=True):
        motor = motor * (np.cos(angle / 2.0) - np.sin(angle / 2.0) * axis)
    return down(motor * up([L1, -L2, 0.0]) * ~motor)


def screw_axes() -> Erratum:
    """Eqs. 66 to 68 against eq. 63."""
    printed = (-e13, -e12, -e12 + L1 * e24 + L2 * e25)
    right = (e13, e12, e12 - L1 * e24 - L1 * e25)
    off = largest(lambda a: by_screw_rotors(a, printed) - eq63(a), 3)
    mirrored = largest(lambda a: by_screw_rotors(a, printed) - eq63(-a), 3)
    good = largest(lambda a: by_screw_rotors(a, right) - eq63(a), 3)
    return Erratum(
        "eqs. 66-68",
        "L1 = -e13, L2 = -e12, L3 = -e12 + l1 e24 + l2 e25",
        "L1 = e13, L2 = e12, L3 = e12 - l1 e24 - l1 e25",
        f"as printed off eq. 63 by up to {off:.2f} m, and by {mirrored:.0e} m off eq. 63 at -θ; with what "
        f"holds by {good:.0e} m",
        bool(off > 0.1 and mirrored < EXACT and good < EXACT),
    )


# --- section 6 -------------------------------------------------------------------------------------------------------


def eq78(a: Array) -> Array:
    """The position of the Touch in eq. 78's matrix form."""
    l1 = l2 = 0.135
    l3, l4 = 0.025, l1 + 0.035
    radius = l1 * np.cos(a[1]) + l2 * np.sin(a[2])
    return np.array(
        [-np.sin(a[0]) * radius, l3 + l1 * np.sin(a[1]) - l2 * np.cos(a[2]), -l4 + np.cos(a[0]) * radius]
    )


def parallelogram() -> Erratum:
    """Eq. 78's product against its matrix form."""
    link1, link2, offset = 0.135 * Z, -0.135 * Y, np.array([0.0, 0.025, -0.17])

    def product(a: Array, sign: float, with_q2: bool) -> Array:
        q1, q2, q3 = (
            Quaternion.from_axis_angle(sign * axis, angle) for axis, angle in zip((Y, X, X), a, strict=True)
        )
        second = q1 * q2 * q3 if with_q2 else q1 * q3
        position: Array = turned(q1 * q2, link1).vector + turned(second, link2).vector + offset
        return position

    touch = KinematicChain.load("touch")
    printed = largest(lambda a: product(a, 1.0, True) - eq78(a), 3)
    axes = largest(lambda a: product(a, -1.0, True) - eq78(a), 3)
    right = largest(lambda a: product(a, -1.0, False) - eq78(a), 3)
    robot = largest(lambda a: touch.forward(a) - eq78(a), 3)
    return Erratum(
        "eqs. 71-78",
        "axes +j, +i, +i and q_2 in the second link's product",
        "the matrix form: axes -j, -i, -i, and a second link that does not turn with θ2 (a parallelogram)",
        f"product and matrix differ by up to {printed:.2f} m as printed, {axes:.2f} m with the axes mended, "
        f"{right:.0e} m without q_2; the robot `touch` is off the matrix form by {robot:.0e} m",
        bool(min(printed, axes) > 0.05 and max(right, robot) < EXACT),
    )


# --- what holds ------------------------------------------------------------------------------------------------------


def derivative_error(algebra: str) -> float:
    """How far the Jacobians (eqs. 39 and 50) are off central differences at most, over the paper's arms (m/rad)."""
    worst = 0.0
    for name in ROBOTS:
        chain = KinematicChain.load(name)
        off = largest(lambda a, c=chain: c.jacobian(a, algebra) - central_difference(c.forward, a), chain.dof)  # type: ignore[misc]
        worst = max(worst, off / chain.reach)
    return worst


def algebra_gap() -> tuple[float, float]:
    """The largest difference of position and of Jacobian between the algebras, over the paper's arms (m, m/rad)."""
    position, jacobian = 0.0, 0.0
    for name in ROBOTS:
        chain = KinematicChain.load(name)
        for angles in samples(chain.dof):
            position = max(position, np.abs(chain.forward(angles) - chain.forward(angles, "conformal")).max())
            jacobian = max(
                jacobian, np.abs(chain.jacobian(angles) - chain.jacobian(angles, "conformal")).max()
            )
    return position, jacobian


def run() -> Findings:
    """All of them."""
    position, jacobian = algebra_gap()
    return Findings(
        comparisons=[
            Comparison(
                "Jacobian off central differences, over the reach",
                "1/rad",
                None,
                derivative_error("quaternion"),
                derivative_error("conformal"),
                11,
                "eqs. 39 (mended) and 50, five arms, 200 poses each",
            )
        ],
        errata=[
            embedding(),
            rotation(),
            null_basis(),
            line_and_angle(),
            loss(),
            quaternion_jacobian(),
            first_axis(),
            third_angle(),
            screw_axes(),
            parallelogram(),
        ],
        numbers={"forward_differs_by_m": position, "jacobian_differs_by_m_per_rad": jacobian},
    )


ERRATA = Experiment(
    "errata",
    "2 to 6",
    "Misprints of equations, measured",
    "Each equation is evaluated as printed and as it must be, at 200 random poses. The errors of starts, "
    "targets and learning rates are measured by the experiments they belong to; all are listed below.",
    run,
)
