"""What is drawn of an arm: a URDF's shapes stand where kinematics puts its links; a workspace has a closed surface."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial import cKDTree

from gaik_core import KinematicChain
from gaik_core import quaternion as q
from gaik_core.errors import UrdfError
from gaik_core.workspace import find_workspace
from gaik_ros.viewer.surface import surface_net, surface_of
from gaik_ros.viewer.urdf_shapes import GREY, UrdfShapes

URDF = """
<robot name="odd">
  <material name="blue"><color rgba="0 0 1 0.5"/></material>
  <link name="base"><visual><geometry><box size="0.1 0.2 0.3"/></geometry><material name="blue"/></visual></link>
  <link name="arm">
    <visual>
      <origin xyz="0 0 0.1" rpy="0.1 -0.2 0.3"/>
      <geometry><cylinder radius="0.01" length="0.2"/></geometry>
      <material name="own"><color rgba="1 0 0 1"/></material>
    </visual>
    <visual><geometry><mesh filename="package://nowhere/arm.stl"/></geometry></visual>
    <visual><geometry><sphere radius="0.02"/></geometry></visual>
  </link>
  <link name="hand"/><link name="finger"/><link name="tip"/>
  <joint name="shoulder" type="revolute">
    <parent link="base"/><child link="arm"/>
    <origin xyz="0 0.1 0.3" rpy="0.5 0.2 -0.4"/><axis xyz="0 1 1"/>
    <limit lower="-2" upper="2" effort="1" velocity="1"/>
  </joint>
  <joint name="follower" type="revolute">
    <parent link="arm"/><child link="hand"/>
    <origin xyz="0 0 0.2"/><axis xyz="1 0 0"/>
    <limit lower="-4" upper="4" effort="1" velocity="1"/><mimic joint="shoulder" multiplier="-1.5" offset="0.2"/>
  </joint>
  <joint name="slide" type="prismatic">
    <parent link="hand"/><child link="finger"/>
    <origin xyz="0.1 0 0" rpy="0 0 1"/><axis xyz="0 0 2"/>
    <limit lower="0" upper="0.3" effort="1" velocity="1"/>
  </joint>
  <joint name="end" type="fixed"><parent link="finger"/><child link="tip"/><origin xyz="0 0.05 0" rpy="1 0 0"/></joint>
</robot>
"""


@given(st.floats(-2, 2), st.floats(0, 0.3))
@settings(max_examples=50, deadline=None)
def test_the_links_stand_where_the_kinematics_puts_them(shoulder, slide):
    chain = KinematicChain.from_urdf(URDF)
    position, turn = chain.pose([shoulder, slide])
    drawn, drawn_turn = UrdfShapes(URDF).pose_in_root("tip", {"shoulder": shoulder, "slide": slide})
    np.testing.assert_allclose(drawn, position, atol=1e-12)
    assert abs(np.dot(drawn_turn, turn)) == pytest.approx(1.0, abs=1e-12)


def test_the_frames_of_the_scene_nest_parents_first():
    links = UrdfShapes(URDF).links
    names = [link.name for link in links]
    assert sorted(names) == ["arm", "base", "finger", "hand", "tip"]
    assert all(link.parent == "" or names.index(link.parent) < names.index(link.name) for link in links)


def test_solids_are_drawn_with_size_place_and_colour_and_meshes_are_not():
    shapes = {link.name: link.shapes for link in UrdfShapes(URDF).links}
    (box,) = shapes["base"]
    assert (box.kind, box.size, box.colour) == ("box", (0.1, 0.2, 0.3), (0.0, 0.0, 1.0, 0.5))
    cylinder, sphere = shapes["arm"]
    assert (cylinder.kind, cylinder.size, cylinder.colour) == ("cylinder", (0.01, 0.2), (1.0, 0.0, 0.0, 1.0))
    np.testing.assert_array_equal(cylinder.position, [0, 0, 0.1])
    assert (sphere.kind, sphere.size, sphere.colour) == ("sphere", (0.02,), GREY)


def test_roll_pitch_and_yaw_are_about_fixed_axes():
    cylinder = UrdfShapes(URDF).links[1].shapes[0]
    roll, pitch, yaw = 0.1, -0.2, 0.3
    cr, sr, cp, sp, cy, sy = (f(a) for a in (roll, pitch, yaw) for f in (np.cos, np.sin))
    matrix = (
        np.array([[cy, -sy, 0], [sy, cy, 0], [0, 0, 1]])
        @ np.array([[cp, 0, sp], [0, 1, 0], [-sp, 0, cp]])
        @ np.array([[1, 0, 0], [0, cr, -sr], [0, sr, cr]])
    )
    np.testing.assert_allclose(q.to_matrix(cylinder.orientation), matrix, atol=1e-12)


def test_only_joints_with_a_value_of_their_own_are_wanted():
    assert UrdfShapes(URDF).joint_names == {"shoulder", "slide"}


@pytest.mark.parametrize(
    ("broken", "complaint"),
    [
        (URDF.replace('size="0.1 0.2 0.3"', 'size="0.1 0.2"'), "box has 2 numbers"),
        (URDF.replace('radius="0.02"', 'radius="wide"'), "'wide'; expected numbers"),
        (URDF.replace('xyz="0 1 1"', 'xyz="0 0 0"'), "'shoulder': axis is zero"),
        ("/no/such.urdf", "neither a URDF text nor a file"),
        ("<robot", "not XML"),
    ],
)
def test_a_broken_urdf_is_refused_in_one_line(broken, complaint):
    with pytest.raises(UrdfError, match=complaint) as refused:
        UrdfShapes(broken)
    assert "\n" not in str(refused.value)


def test_a_link_that_is_not_there_is_refused():
    with pytest.raises(UrdfError, match="no link 'tipp'"):
        UrdfShapes(URDF).pose_in_root("tipp", {})


# the workspace


def volume_and_edges(vertices, faces):
    a, b, c = vertices[faces].transpose(1, 0, 2)
    edges = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    return np.einsum("ij,ij->", a, np.cross(b, c)) / 6.0, edges


def closed(edges):
    """Whether every edge is passed once in each direction: a closed surface with one outside."""
    forth = {tuple(edge) for edge in edges.tolist()}
    return len(forth) == len(edges) and all((b, a) in forth for a, b in forth)


def test_the_net_around_a_ball_is_closed_and_has_its_volume():
    grid = np.stack(np.meshgrid(*[np.arange(40.0)] * 3, indexing="ij"), axis=-1)
    radius = 14.0
    field = radius - np.linalg.norm(grid - [19.3, 20.1, 18.7], axis=-1)
    vertices, faces = surface_net(field, 0.0)
    volume, edges = volume_and_edges(vertices, faces)
    assert closed(edges)
    assert volume == pytest.approx(4.0 / 3.0 * np.pi * radius**3, rel=0.01)
    np.testing.assert_allclose(np.linalg.norm(vertices - [19.3, 20.1, 18.7], axis=-1), radius, atol=0.1)


@pytest.mark.parametrize("robot", ["touch_device", "touch", "arm3", "arm5"])
def test_the_surface_of_a_workspace_is_closed_and_holds_its_volume(robot):
    workspace = find_workspace(KinematicChain.load(robot), cells=40, samples=50_000)
    vertices, faces = surface_of(workspace)
    volume, edges = volume_and_edges(vertices, faces)
    assert closed(edges)
    assert volume == pytest.approx(workspace.size, rel=0.05)
    for cells in (
        workspace.reached,
        ~np.pad(workspace.reached, 3),
    ):  # it runs between what is reached and what is not
        pad = 0 if cells is workspace.reached else 3
        centres = workspace.corner + (np.argwhere(cells) - pad + 0.5) * workspace.cell
        distances, _ = cKDTree(centres).query(vertices)
        assert distances.max() < 3.0 * workspace.cell


def test_a_flat_workspace_has_no_surface():
    workspace = find_workspace(KinematicChain.load("planar3"), cells=20, samples=10_000)
    assert len(surface_of(workspace)[1]) == 0
