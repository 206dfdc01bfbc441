"""The paper's experiments, one file each, and what turns them into pictures and a page.

| file | the paper |
| --- | --- |
| `two_joints` | 3.4, Figs. 4 and 6 |
| `gradient_field` | 3.4, Figs. 5 and 7 |
| `velocity`, `nearest` | 3.3 |
| `planar_chains` | 4.3, Fig. 9 |
| `five_joints` | 4.3, Figs. 11 and 12 |
| `three_joints` | 5.3, Figs. 14 and 15 |
| `sphere` | 5.3, Table 1 |
| `touch` | 6.2, Figs. 18 and 19 |
| `errata` | the misprints of equations |

Another package adds an experiment by an entry point in the group `gaik.experiments` that names an `Experiment`.
"""

from gaik_core.experiments.findings import Comparison, Erratum, Experiment, Findings, Iterates, Table
from gaik_core.experiments.registry import experiment_names, load_experiment

__all__ = [
    "Comparison",
    "Erratum",
    "Experiment",
    "Findings",
    "Iterates",
    "Table",
    "experiment_names",
    "load_experiment",
]
