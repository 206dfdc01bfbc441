"""The experiments by name: those of gaik_core, and those that other packages add by entry points."""

from __future__ import annotations

from importlib import import_module
from importlib.metadata import entry_points

from gaik_core.errors import GaikError, UnknownNameError
from gaik_core.experiments.findings import Experiment

GROUP = "gaik.experiments"
"""Another package adds an `Experiment` with an entry point `fig21 = package.module:FIG21` in this group."""

OWN = {
    "fig4": "two_joints:FIG4",
    "fig5": "gradient_field:FIG5",
    "fig6": "two_joints:FIG6",
    "fig7": "gradient_field:FIG7",
    "velocity": "velocity:VELOCITY",
    "fig9": "planar_chains:FIG9",
    "fig11": "five_joints:FIG11",
    "fig12": "five_joints:FIG12",
    "fig14": "three_joints:FIG14",
    "fig15": "three_joints:FIG15",
    "table1": "sphere:TABLE1",
    "fig18": "touch:FIG18",
    "fig19": "touch:FIG19",
    "errata": "errata:ERRATA",
}
"""In the paper's order; the last has no figure, it measures the misprints of equations."""


def experiment_names() -> list[str]:
    """All there are: gaik_core's in the paper's order, then the others'; none is imported for it."""
    others = sorted(point.name for point in entry_points(group=GROUP) if point.name not in OWN)
    return [*(name for name in OWN if name != "errata"), *others, "errata"]


def load_experiment(name: str) -> Experiment:
    """The experiment of a name.

    Raises:
        UnknownNameError: there is none; the message lists those there are.
        GaikError: its package lacks something, or its entry point gives no Experiment.
    """
    try:
        experiment = _import(name)
    except (ImportError, AttributeError) as error:
        raise GaikError(f"experiment {name!r} cannot be loaded: {error}") from error
    if not isinstance(experiment, Experiment):
        raise GaikError(f"entry point {name!r} of {GROUP} is {experiment!r}; expected an Experiment")
    return experiment


def _import(name: str) -> object:
    if name in OWN:
        module, attribute = OWN[name].split(":")
        return getattr(import_module(f"gaik_core.experiments.{module}"), attribute)
    for point in entry_points(group=GROUP):
        if point.name == name:
            return point.load()
    raise UnknownNameError("experiment", name, experiment_names())
