"""Comparisons and studies: a case run in several ways."""

from __future__ import annotations

import json
import os
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from . import _carom
from .cases import Case
from .results import Report, Results


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
        """Results of the run of this name."""
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


def _words(choices: Iterable[str | Mapping[str, Mapping[str, Any]]]) -> list[str]:
    """Schemes or laws as the command takes them: a name, or a name with parameters."""
    words = []
    for choice in choices:
        if isinstance(choice, str):
            words.append(choice)
            continue
        for name, parameters in choice.items():
            inner = ", ".join(f"{key} = {json.dumps(value)}" for key, value in parameters.items())
            words.append(f"{name} = {{ {inner} }}" if inner else name)
    return words


def compare(
    case: Case,
    schemes: Iterable[str | Mapping[str, Mapping[str, Any]]] = (),
    laws: Iterable[str | Mapping[str, Mapping[str, Any]]] = (),
    *,
    folder: str | os.PathLike[str] | None = None,
    reference: str | None = None,
    contact: str | None = None,
    jobs: int = 1,
) -> Table:
    """Runs a case under several schemes and contact laws, as `carom compare`.

    Args:
        case: the case.
        schemes: `"newmark"`, `{"newmark": {"beta": 0.5, "gamma": 0.9}}`, or `"case"` for the scheme of the case.
        laws: contact laws for all contacts, in the same form.
        folder: common folder. Default: the name of the case file with the ending `.compare`.
        reference: `exact`, `finest`, `none`, or the name of a run.
        contact: the contact whose force is compared.
        jobs: runs at a time; results do not depend on it.
    """
    folder = case._default(".compare") if folder is None else os.fspath(folder)
    choices = (_words(schemes), _words(laws), reference)
    runs = _carom.compare(case._given(), choices, (folder, contact, jobs))
    return Table(folder, "comparison.csv", runs)


def study(
    case: Case,
    *axes: Mapping[str, Sequence[Any]],
    folder: str | os.PathLike[str] | None = None,
    contact: str | None = None,
    jobs: int = 1,
) -> Table:
    """Runs a case over the values of keys, as `carom study`.

    Args:
        case: the case.
        axes: values by key path, `{"time.step.courant": [1, 0.5, 0.25]}`. Keys of one axis vary together; several axes are run in
            all combinations.
        folder: common folder. Default: the name of the case file with the ending `.study`.
        contact: the contact that is looked at.
        jobs: runs at a time, on as many cores; results do not depend on it.
    """
    folder = case._default(".study") if folder is None else os.fspath(folder)
    texts = [
        "; ".join(f"{key}={','.join(json.dumps(value) for value in values)}" for key, values in axis.items())
        for axis in axes
    ]
    runs = _carom.study(case._given(), texts, (folder, contact, jobs))
    return Table(folder, "study.csv", runs)
