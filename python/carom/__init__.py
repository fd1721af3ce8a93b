"""Contact-impact dynamics of deformable bodies.

A case is read or written as a dict, checked, run, or stepped; results are opened as tables, fields and figures. All numbers are in
SI units. A gap is positive when open, a force positive in compression.

>>> import carom
>>> case = carom.Case("cases/two-bars/case.toml")
>>> case["time"]["step"] = "0.1 us"
>>> results = case.run("two-bars.carom")
>>> results.summary.verdict.grade
'good'
"""

from . import exact, interface, laws, mesh, schemes
from ._carom import CaseError, RunError, __version__
from .cases import Case, Check, resume, schema
from .matrices import Matrices, MatrixHistory
from .results import Results, Summary
from .simulation import Simulation
from .sweeps import Fitted, Study, Table, compare, study

__all__ = [
    "Case",
    "CaseError",
    "Check",
    "Fitted",
    "Matrices",
    "MatrixHistory",
    "Results",
    "RunError",
    "Simulation",
    "Study",
    "Summary",
    "Table",
    "__version__",
    "compare",
    "exact",
    "interface",
    "laws",
    "mesh",
    "resume",
    "schema",
    "schemes",
    "study",
]
