"""Comparisons and studies: a case run in several ways."""

from __future__ import annotations

import json
import os
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from . import _carom
from .cases import Case
from .laws import Law
from .results import Report, Results
from .schemes import Scheme
from .words import inline


class Table:
    """The runs of a comparison or a study.

    Attributes:
        folder: the common folder.
        runs: name, verdict and reason of each run.
    """

    def __init__(self, folder: str | os.PathLike[str], file: str, runs: list[tuple[str, str, str]]) -> None:
        self.folder = Path(folder)
        self.runs = runs
        self._file = file

    def __len__(self) -> int:
        return len(self.runs)

    def __iter__(self) -> Iterator[str]:
        return (name for name, _, _ in self.runs)

    def __getitem__(self, name: str) -> Results:
        """Results of the run of this name.

        Raises:
            KeyError: there is no such run; the message lists those there are.
        """
        if name not in list(self):
            raise KeyError(f"no run `{name}`; there are: {', '.join(self)}")
        return Results(self.folder / name)

    @property
    def frame(self) -> Any:
        """The table as a pandas frame."""
        import pandas

        return pandas.read_csv(self.folder / self._file)

    def report(self) -> Report:
        """The page with the table and figures, which a notebook shows."""
        return Report(self.folder / "report.html")

    def __repr__(self) -> str:
        lines = [f"{name:<32} {verdict} {reason}".rstrip() for name, verdict, reason in self.runs]
        return "\n".join(lines)


Choice = str | Mapping[str, Mapping[str, Any]] | Scheme | Law


def _words(choices: Iterable[Choice]) -> list[str]:
    """Schemes or laws as the command takes them: a name, or a name with parameters."""
    words = []
    for choice in choices:
        if isinstance(choice, str):
            words.append(choice)
            continue
        table = choice.table if isinstance(choice, (Scheme, Law)) else choice
        words.extend(f"{name} = {inline(parameters)}" if parameters else name for name, parameters in table.items())
    return words


def compare(
    case: Case,
    schemes: Iterable[Choice] = (),
    laws: Iterable[Choice] = (),
    *,
    beside: Iterable[Case | str | os.PathLike[str]] = (),
    folder: str | os.PathLike[str] | None = None,
    reference: str | None = None,
    contact: str | None = None,
    jobs: int = 1,
) -> Table:
    """Runs a case under several schemes and contact laws, as `carom compare`.

    Args:
        case: the case.
        schemes: `"newmark"`, `{"newmark": {"beta": 0.5, "gamma": 0.9}}`, `carom.schemes.Scheme("newmark", beta=0.5, gamma=0.9)`, or `"case"`
            for the scheme of the case.
        laws: contact laws for all contacts, in the same forms.
        beside: other cases of the same problem, or their files, which run as they are and get a row in the same table: that of a
            file is named after it, that of a dict or of a changed case `beside`, the next one `beside-2`.
        folder: common folder. Default: the name of the case file with the ending `.compare`.
        reference: `exact`, `finest`, `none`, or the name of a run.
        contact: the contact whose force is compared.
        jobs: runs at a time; results do not depend on it.

    Raises:
        CaseError: a case, a scheme or a law is wrong; nothing was written.
    """
    folder = case._default(".compare") if folder is None else os.fspath(folder)
    others = [other if isinstance(other, Case) else Case(other) for other in beside]
    choices = (_words(schemes), _words(laws), [other._given() for other in others], reference)
    runs = _carom.compare(case._given(), choices, (folder, contact, jobs))
    return Table(folder, "comparison.csv", runs)


@dataclass(frozen=True)
class Fitted:
    """What a fit found; `fit.json` of its folder.

    Attributes:
        key: path of the fitted key.
        goal: the wanted value by the name of the result, or `"force"` for the nearest force history.
        value: of the key, in SI units; `None` where none was found.
        reached: what the case gives with it: the result, or the relative distance of the force.
        run: name of the run with this value.
        reason: why no value was found.
    """

    key: str
    goal: dict[str, float] | str
    value: float | None = None
    reached: float | None = None
    run: str | None = None
    reason: str | None = None


class Study(Table):
    """The runs of a study.

    Attributes:
        fitted: what a fit found; `None` of a study without a fit.
    """

    def __init__(
        self,
        folder: str | os.PathLike[str],
        file: str,
        runs: list[tuple[str, str, str]],
        fitted: Fitted | None = None,
    ) -> None:
        super().__init__(folder, file, runs)
        self.fitted = fitted


def study(
    case: Case,
    *axes: Mapping[str, Iterable[Any]],
    fit: str | None = None,
    between: tuple[float, float] | None = None,
    to: Mapping[str, float | str | os.PathLike[str]] | None = None,
    folder: str | os.PathLike[str] | None = None,
    contact: str | None = None,
    jobs: int = 1,
) -> Study:
    """Runs a case over the values of keys, or looks for the value of a key that gives a wanted result, as `carom study`.

    Args:
        case: the case.
        axes: values by key path, `{"time.step.courant": [1, 0.5, 0.25]}`. Keys of one axis vary together; several axes are run in
            all combinations.
        fit: path of a key whose value is looked for, in place of the axes.
        between: the least and the largest value to try, in SI units.
        to: the result to reach, `{"restitution": 0.98}`, in a column of `study.csv`; or `{"force": "measured.csv"}`, a table with
            the columns `time_s` and one that ends in `force_n`, whose force the case comes nearest to.
        folder: common folder. Default: the name of the case file with the ending `.study`.
        contact: the contact that is looked at.
        jobs: runs at a time, on as many cores; results do not depend on it. The trials of a fit run one after another.

    Returns:
        The table of the runs. Of a fit, `fitted` has the value, what it gives, and its run; or the reason why none was found.

    Raises:
        CaseError: the case, a key or a value is wrong; nothing was written.
        TypeError: arguments that do not go together.
    """
    folder = case._default(".study") if folder is None else os.fspath(folder)
    into = (folder, contact, jobs)
    if fit is not None or between is not None or to is not None:
        if axes or fit is None or between is None or to is None:
            raise TypeError("a fit takes `fit`, `between` and `to`, and no axes")
        (low, high), ((name, goal),) = between, to.items()
        wanted = f"{name}={os.fspath(goal) if isinstance(goal, (str, os.PathLike)) else repr(float(goal))}"
        runs = _carom.fit(case._given(), (fit, f"{float(low)!r},{float(high)!r}", wanted), into)
        found = json.loads((Path(folder) / "fit.json").read_text(encoding="utf-8"))
        return Study(folder, "study.csv", runs, Fitted(**found))
    texts = [
        "; ".join(f"{key}={','.join(map(inline, values))}" for key, values in axis.items())
        for axis in axes
    ]
    return Study(folder, "study.csv", _carom.study(case._given(), texts, into))
