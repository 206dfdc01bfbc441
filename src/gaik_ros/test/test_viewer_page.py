"""The page in a real browser without a window: what a user does with the mouse arrives on the topics."""

import time

import numpy as np
import pytest
import rclpy
from headless_browser import MISSING, browser_page, browser_path
from ros_bench import PATIENCE, Bench, overrides, wait_until

from gaik_core import KinematicChain
from gaik_core.paths import Circle
from gaik_core.quaternion import conjugate, rotate
from gaik_ros.conversions import point_to_array
from gaik_ros.ik_node import IkNode
from gaik_ros.pid_controller import PidController
from gaik_ros.run import running
from gaik_ros.trajectory_publisher import TrajectoryPublisher

pytest.importorskip("viser", reason="no viser; install it with: pip install 'viser>=1.1,<2'")
if browser_path() is None:
    pytest.skip(MISSING, allow_module_level=True)

pytestmark = pytest.mark.slow

CHAIN = KinematicChain.load("touch_device")
X = np.array([1.0, 0.0, 0.0])
SETTLED = 2e-3  # m
QUIET = 0.7  # s; far longer than between two setpoints of a drag or of a path


class Visit:
    """A suite, a viewer of it and a browser that shows the viewer's page."""

    def __init__(self, bench, viewer, ik, controller, page):
        self.bench, self.viewer, self.ik, self.controller, self.page = bench, viewer, ik, controller, page

    @property
    def tip(self):
        return CHAIN.forward(self.bench.angles)

    @property
    def ball(self):
        """Where the ball is that is dragged, (3,) m."""
        return np.array(self.viewer.page.server.scene.get_handle_by_name("/setpoint").position)

    def pixel(self, point):
        """Where the browser shows a point (3,) m of the scene."""
        (client,) = self.viewer.page.server.get_clients().values()
        camera = client.camera  # OpenCV's axes: x right, y down, z into the picture
        x, y, z = rotate(conjugate(camera.wxyz), point - camera.position)
        focal = 0.5 * camera.image_height / np.tan(0.5 * camera.fov)
        return 0.5 * camera.image_width + focal * x / z, 0.5 * camera.image_height + focal * y / z

    @property
    def view_is_set(self):
        """Whether the browser looks from where the page opens; until its first frame it looks from elsewhere."""
        (client,) = self.viewer.page.server.get_clients().values()
        return np.allclose(client.camera.position, self.viewer.page.server.initial_camera.position, atol=1e-6)

    def pixel_of_ball(self):
        """Where the browser shows the ball, once its cursor there says that it can be taken."""
        wait_until(self._is_ball_under_mouse, "the browser does not show the ball where it is")
        return self.pixel(self.ball)

    def _is_ball_under_mouse(self):
        self.page.hover(*self.pixel(self.ball))
        return self.page.evaluate(
            "[...document.querySelectorAll('canvas')].some(c => c.style.cursor === 'pointer')"
        )

    def settled(self):
        """The newest setpoint, once no more come and the tip is there."""
        end = time.monotonic() + PATIENCE
        count = -1
        while len(self.bench.setpoints) != count:
            assert time.monotonic() < end, "setpoints do not end"
            count = len(self.bench.setpoints)
            time.sleep(QUIET)
        last = point_to_array(self.bench.setpoints[-1])
        wait_until(lambda: np.linalg.norm(self.tip - last) < SETTLED, f"the tip does not come to {last}")
        return last


@pytest.fixture(scope="module")
def visit():
    from gaik_ros.viewer.node import Viewer

    context = rclpy.Context()
    rclpy.init(context=context)
    bench = Bench(context)
    bench.angles, bench.publishing, bench.moving = CHAIN.home.copy(), True, True
    ik = IkNode(context=context)
    controller = PidController(context=context, parameter_overrides=overrides(rate=200.0))
    trajectory = TrajectoryPublisher(context=context, parameter_overrides=overrides(autostart=False))
    viewer = Viewer(context=context, parameter_overrides=overrides(port=0, rate=15.0))
    try:
        with (
            running([bench, ik, controller, trajectory, viewer], context),
            browser_page(1000, 600, scale=0.4) as page,
        ):
            page.open(viewer.page.address)
            wait_until(lambda: viewer.page.visitors == 1, "the browser does not come")
            wait_until(lambda: "pid_controller" in page.text(), "the page shows no nodes")
            visit = Visit(bench, viewer, ik, controller, page)
            wait_until(lambda: visit.view_is_set, "the scene is not drawn")
            yield visit
    finally:
        rclpy.try_shutdown(context=context)


def test_the_page_shows_the_suite_and_its_scripts_run(visit):
    wait_until(lambda: "Hz" in visit.page.text(), "no node tells its rate")
    text = visit.page.text()
    for shown in ("gaik · touch_device", "Circle", "Lemniscate", "Stop", "Reset", "Algebra", "P (N·m/rad)"):
        assert shown in text
    assert (
        visit.page.evaluate("Math.max(...[...document.querySelectorAll('canvas')].map(c => c.width))") > 300
    )
    assert visit.page.complaints == []


def test_the_ball_is_dragged_and_the_arm_follows(visit):
    heard, before = len(visit.bench.setpoints), visit.ball
    np.testing.assert_allclose(before, visit.tip, atol=SETTLED)
    x, y = visit.pixel_of_ball()
    visit.page.drag((x, y), (x + 40, y - 60))
    wait_until(lambda: len(visit.bench.setpoints) > heard, "no setpoints come while the ball is dragged")
    last = visit.settled()
    assert np.linalg.norm(last - before) > 0.02
    # The ball goes with the mouse, in the plane of the screen.
    np.testing.assert_allclose(visit.pixel(last), (x + 40, y - 60), atol=8.0)
    wait_until(lambda: "Reached" in visit.page.text(), "the verdict is not shown")
    np.testing.assert_allclose(visit.ball, last, atol=1e-4)


def test_an_arrow_moves_the_setpoint_along_its_axis_alone(visit):
    visit.pixel_of_ball()
    heard, before = len(visit.bench.setpoints), visit.ball
    start, end = visit.pixel(before + 0.06 * X), visit.pixel(before + 0.10 * X)
    visit.page.drag(start, end)
    wait_until(lambda: len(visit.bench.setpoints) > heard, "no setpoints come while the arrow is dragged")
    moved = visit.settled() - before
    assert moved[0] > 0.02
    np.testing.assert_allclose(moved[1:], 0.0, atol=1e-6)


def test_a_path_is_started_and_stopped(visit):
    visit.page.click_on("Circle")
    heard = len(visit.bench.setpoints)
    wait_until(lambda: len(visit.bench.setpoints) > heard + 100, "no path is followed")
    points = np.array([point_to_array(point) for point in visit.bench.setpoints[heard + 1 :]])
    normal = np.array([0.0, -np.sin(Circle().tilt), np.cos(Circle().tilt)])
    np.testing.assert_allclose(np.linalg.norm(points, axis=-1), Circle().radius, atol=1e-9)
    np.testing.assert_allclose(points @ normal, 0.0, atol=1e-9)

    visit.page.click_on("Stop")
    visit.settled()


def test_the_choices_and_sliders_set_the_nodes_real_parameters(visit):
    page = visit.page
    assert visit.ik.get_parameter("algebra").value == "quaternion"
    page.click(*place_of(page, "input[value=quaternion]"))
    page.click(*place_of(page, "[role=option][value=conformal]"))
    wait_until(lambda: visit.ik.get_parameter("algebra").value == "conformal", "the algebra is not set")

    before = visit.controller.get_parameter("gains.p").value
    x, y = place_of(page, "[role=slider][aria-valuemax='8']")
    page.drag((x, y), (x + 30, y))
    wait_until(lambda: visit.controller.get_parameter("gains.p").value > before, "the gain is not set")


def test_what_is_set_elsewhere_is_shown(visit):
    assert visit.bench.change("pid_controller", gains__d=0.25).successful
    wait_until(
        lambda: visit.page.evaluate("[...document.querySelectorAll('input')].some(i => i.value === '0.25')"),
        "the new gain is not shown",
    )


def test_a_setpoint_out_of_reach_is_said_in_words(visit):
    visit.bench.send([0.0, 0.0, 0.9])
    wait_until(lambda: "Out of reach" in visit.page.text(), "the verdict is not shown")
    visit.bench.send([0.0, 0.0, 0.0])
    wait_until(lambda: "Reached" in visit.page.text(), "the verdict is not shown")


def test_reset_holds_where_the_device_is(visit):
    visit.page.click_on("Circle")
    heard = len(visit.bench.setpoints)
    wait_until(lambda: len(visit.bench.setpoints) > heard + 50, "no path is followed")
    visit.page.click_on("Reset")
    wait_until(lambda: "holding where the device is" in visit.page.text(), "the reset is not confirmed")
    visit.settled()
    assert visit.page.complaints == []


def place_of(page, selector):
    """The middle of the element, once it is there and nothing covers it."""
    middle = (
        f"(() => {{ const e = document.querySelector({selector!r}); if (!e) return null;"
        " e.scrollIntoView({block: 'nearest'}); const r = e.getBoundingClientRect();"
        " const x = r.x + r.width / 2, y = r.y + r.height / 2;"
        " return e.contains(document.elementFromPoint(x, y)) ? [x, y] : null })()"
    )
    wait_until(lambda: page.evaluate(middle), f"{selector} is not shown")
    return page.evaluate(middle)
