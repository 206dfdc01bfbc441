"""Chains and targets that several tests share."""

import numpy as np

from gaik_core import Joint, KinematicChain

ROBOTS = KinematicChain.names()
ALGEBRAS = ("quaternion", "conformal")


def random_chain(rng, axes, prismatic=False):
    """A chain with random axes and links, every third axis coupled to the first joint."""
    joints = []
    for i in range(axes):
        slides = prismatic and i % 3 == 2
        joints.append(
            Joint(
                name=f"j{i}",
                axis=tuple(rng.normal(size=3)),
                link=tuple(rng.normal(size=3) * 0.3),
                kind="prismatic" if slides else "revolute",
                coupling={"j0": 0.5} if i % 3 == 1 else {},
                offset=float(rng.normal()) * 0.2,
            )
        )
    quaternion = rng.normal(size=4)
    return KinematicChain(
        joints, origin=rng.normal(size=3), orientation=quaternion / np.linalg.norm(quaternion)
    )


def inside(chain, rng, count):
    """Random angles (count, dof) inside the limits, of the axes too."""
    low = np.where(np.isfinite(chain.lower), chain.lower, -3.0)
    high = np.where(np.isfinite(chain.upper), chain.upper, 3.0)
    kept = []
    while len(kept) < count:
        angles = rng.uniform(low, high)
        turned = chain.axis_angles(angles)
        if (turned >= chain.axis_lower).all() and (turned <= chain.axis_upper).all():
            kept.append(angles)
    return np.array(kept)


def rotation_matrix(axis, angle):
    """Rodrigues' formula: a reference that uses neither algebra."""
    x, y, z = np.asarray(axis) / np.linalg.norm(axis)
    k = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * k + (1 - np.cos(angle)) * k @ k


def matrix_walk(chain, angles):
    """Tip position and orientation matrix by homogeneous matrices, from the joints' description alone."""
    position, rotation = np.array(chain.packed[2][:3]), np.eye(3)
    for joint, turned in zip(chain.joints, chain.axis_angles(angles), strict=True):
        if joint.kind == "revolute":
            rotation = rotation @ rotation_matrix(joint.axis, turned)
        else:
            position = position + rotation @ (turned * np.array(joint.axis))
        position = position + rotation @ np.array(joint.link)
    w, x, y, z = chain.packed[2][6:10]
    turn = (
        rotation_matrix([x, y, z], 2 * np.arctan2(np.linalg.norm([x, y, z]), w)) if x or y or z else np.eye(3)
    )
    return position, rotation @ turn


def table1_sphere():
    """Table 1's 200 points as placed for the reproduction: a Fibonacci sphere of 0.2 m around [0.4, 0.6, 0]."""
    i = np.arange(200)
    z = 1 - (2 * i + 1) / 200
    azimuth = -np.pi * (3 - np.sqrt(5)) * (i + 0.5)
    radius = np.sqrt(1 - z**2)
    return np.array([0.4, 0.6, 0.0]) + 0.2 * np.stack(
        [radius * np.cos(azimuth), radius * np.sin(azimuth), z], -1
    )
