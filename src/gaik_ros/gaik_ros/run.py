"""Run nodes: start, spin, loops on their thread, and a quiet end on SIGINT or SIGTERM.

The order of the end matters: first the loops stop, then the executor, then the nodes go, then the context. A
thread still spinning while the interpreter exits would abort the process.
"""

from __future__ import annotations

import contextlib
import sys
import threading
from collections.abc import Callable, Iterator, Sequence

import rclpy
from rclpy.context import Context
from rclpy.exceptions import InvalidParameterTypeException, NameValidationException
from rclpy.executors import Executor, ExternalShutdownException, SingleThreadedExecutor
from rclpy.impl.implementation_singleton import rclpy_implementation
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions
from rclpy.task import Future
from rclpy.utilities import get_default_context, remove_ros_args
from rclpy.validate_namespace import validate_namespace

from gaik_ros.deadline_loop import DeadlineLoop, LoopThread
from gaik_ros.parameters import ParameterTable
from gaik_ros.signals import stopped_by_signals

WAKE = 0.1  # s: how often a spinning thread looks whether it should stop

SWITCH_INTERVAL = (
    5e-4  # s: how long a thread may keep the interpreter from another; 5 ms by default, too long here
)

BAD_ARGUMENTS = 2  # exit code for a mistake of the user

UnknownROSArgsError = rclpy_implementation.UnknownROSArgsError

ROS_ARGUMENT_ERRORS = (
    NameValidationException,
    InvalidParameterTypeException,  # of the parameters that rclpy itself declares, such as use_sim_time
    rclpy_implementation.RCLInvalidROSArgsError,
    UnknownROSArgsError,
    rclpy_implementation.RCLError,
)
"""What rclpy raises, beside ValueError, where a user's arguments, parameters or names are wrong."""


def check_namespace(namespace: str) -> str:
    """A namespace as nodes take it, with slashes between names only; empty for none.

    Raises NameValidationException where it can be none: said here in one line, by a node in several.
    """
    clean = namespace.strip("/")
    validate_namespace(f"/{clean}")
    return clean


def make_executor(context: Context | None = None) -> Executor:
    """The events executor where rclpy has it, otherwise the single-threaded one; never the multi-threaded."""
    try:
        from rclpy.experimental import EventsExecutor
    except ImportError:
        return SingleThreadedExecutor(context=context)
    return EventsExecutor(context=context)


class Runner:
    """Spins nodes and runs their loops until `stop`, or `ask_to_stop` from a signal handler."""

    def __init__(self, nodes: Sequence[Node], context: Context | None = None) -> None:
        self._nodes = list(nodes)
        self._context = context or get_default_context()
        self._executor = make_executor(self._context)
        self._asked = False
        self._stopped = Future(executor=self._executor)
        loops = [loop for loop in (getattr(node, "loop", None) for node in nodes) if loop is not None]
        self._loops = LoopThread(
            [loop for loop in loops if isinstance(loop, DeadlineLoop)], self._loop_failed
        )

    def _loop_failed(self, error: BaseException) -> None:
        self.stop()

    def stop(self) -> None:
        """Have `spin` return at once; not for a signal handler."""
        self._asked = True
        if not self._stopped.done():
            self._stopped.set_result(None)

    def ask_to_stop(self) -> None:
        """Have `spin` return within WAKE s.

        For signal handlers: it takes no lock, as the thread that they interrupt may be the one that holds it.
        """
        self._asked = True

    def spin(self) -> None:
        """Spin until `stop` or until the context is shut down. Raises what a loop's tick raised."""
        for node in self._nodes:
            self._executor.add_node(node)
        interval = sys.getswitchinterval()
        sys.setswitchinterval(SWITCH_INTERVAL)
        self._loops.start()
        try:
            with contextlib.suppress(ExternalShutdownException):
                while self._context.ok() and not self._asked:
                    # Without a timeout the events executor burns a core and fires nothing.
                    self._executor.spin_until_future_complete(self._stopped, timeout_sec=WAKE)
        finally:
            self._loops.stop()
            self._executor.shutdown()
            sys.setswitchinterval(interval)
        if self._loops.error is not None:
            raise self._loops.error

    def destroy(self) -> None:
        """Destroy the nodes, once `spin` has returned."""
        for node in self._nodes:
            node.destroy_node()


@contextlib.contextmanager
def running(nodes: Sequence[Node], context: Context | None = None) -> Iterator[Runner]:
    """Run `nodes` in the background for the length of a with-block, then destroy them.

    The context is the caller's to shut down. What a node's loop raised is raised at the block's end.
    """
    runner = Runner(nodes, context)
    failures: list[BaseException] = []

    def spin() -> None:
        try:
            runner.spin()
        except BaseException as error:
            failures.append(error)

    thread = threading.Thread(target=spin, name="executor", daemon=True)
    thread.start()
    try:
        yield runner
    except BaseException as error:
        _end(runner, thread)
        if failures:  # what the block complains of may come of that
            raise error from failures[0]
        raise
    _end(runner, thread)
    if failures:
        raise failures[0]


def _end(runner: Runner, thread: threading.Thread) -> None:
    runner.stop()
    thread.join()
    runner.destroy()


class StopRequest:
    """A wish to stop from a signal handler, which may come before there is anything to stop."""

    def __init__(self) -> None:
        self._made = False
        self._runner: Runner | None = None

    def make(self) -> None:
        """Ask for the stop."""
        self._made = True
        if self._runner is not None:
            self._runner.ask_to_stop()

    def serve(self, runner: Runner) -> None:
        """Stop `runner` when asked to, or now if that has been."""
        self._runner = runner
        if self._made:
            runner.ask_to_stop()


def spin_together(nodes: Sequence[Node], context: Context | None = None) -> None:
    """Run `nodes` in this thread until SIGINT, SIGTERM or the context's shutdown, then destroy them."""
    request = StopRequest()
    with stopped_by_signals(request.make):
        _spin(nodes, context, request)


def _spin(nodes: Sequence[Node], context: Context | None, request: StopRequest) -> None:
    runner = Runner(nodes, context)
    request.serve(runner)
    try:
        runner.spin()
    finally:
        runner.destroy()


def run(
    factory: Callable[[], Node], args: Sequence[str] | None = None, table: ParameterTable | None = None
) -> int:
    """Main of every executable: make the node, spin it, end quietly. Returns the exit code.

    A mistake in the arguments, parameters or names gives one line on stderr and the exit code 2. With a `table`,
    --help prints its parameters.
    """
    arguments = list(sys.argv if args is None else [sys.argv[0], *args])
    if table is not None and {"-h", "--help"} & set(arguments):
        print(table.help())
        return 0
    request = StopRequest()
    with stopped_by_signals(request.make):
        try:
            # rclpy's own signal handlers would shut the context down under a loop that is publishing.
            rclpy.init(args=arguments, signal_handler_options=SignalHandlerOptions.NO)
            _refuse_stray(arguments)
            node = factory()
        except (ValueError, *ROS_ARGUMENT_ERRORS) as error:
            rclpy.try_shutdown()
            return _complain(explained(error))
        try:
            _spin([node], None, request)
        finally:
            rclpy.try_shutdown()
    return 0


def _refuse_stray(arguments: Sequence[str]) -> None:
    stray = remove_ros_args(arguments)[1:]
    if stray:
        raise ValueError(f"unknown argument {stray[0]}; ROS arguments follow --ros-args")


def explained(error: Exception) -> str:
    """What was wrong with a user's arguments, in one line: of arguments that ROS does not know rclpy says no more."""
    line = " ".join(str(error).split())
    return f"unknown ROS arguments {line}" if isinstance(error, UnknownROSArgsError) else line


def _complain(reason: str) -> int:
    name = sys.argv[0].rsplit("/", maxsplit=1)[-1]
    print(f"{name}: {reason}", file=sys.stderr)
    return BAD_ARGUMENTS
