"""Cases: what a case file holds, as nested dicts."""

from __future__ import annotations

import copy
import json
import os
from collections.abc import Callable, Iterator, Mapping, MutableMapping
from pathlib import Path
from typing import Any

from . import _carom
from .progress import bar
from .results import Results
from .simulation import Simulation
from .words import inline


class Check:
    """What a case that can be run amounts to.

    Attributes:
        facts: sizes, wave speeds, steps, first possible impact, by name.
        warnings: what is strange but not wrong.
    """

    def __init__(self, facts: dict[str, str], warnings: list[str]) -> None:
        self.facts = facts
        self.warnings = warnings

    def __repr__(self) -> str:
        lines = [f"{name:<18} {value}" for name, value in self.facts.items()]
        return "\n".join(lines + [f"{'warning':<18} {warning}" for warning in self.warnings])


class Case(MutableMapping[str, Any]):
    """A case, with the tables and keys of the case file.

    Args:
        source: a case file, its tables as a dict, or another case.
        folder: folder that paths in the case start from. Default: that of the file or the other case; of a dict the working folder.
        tables: tables beside those of `source`, which they replace: `Case(time={"end": "1 ms"}, ...)`.

    Values are those of TOML: numbers in SI units, or texts with units such as "1 us". Arrays of NumPy are lists, schemes and laws
    as objects are their tables; what is `None` is left out. A case that was changed after it was read is written anew, without the comments of its file.

    Raises:
        CaseError: the file cannot be read, or is no TOML.
    """

    def __init__(
        self,
        source: str | os.PathLike[str] | Mapping[str, Any] | None = None,
        *,
        folder: str | os.PathLike[str] | None = None,
        **tables: Any,
    ) -> None:
        self._name = ""
        self._text: str | None = None
        self._tables: dict[str, Any] = {}
        self._read: dict[str, Any] = {}
        base: Path | str = ""
        self.folder: Path
        if isinstance(source, Case):
            base = source.folder
        if isinstance(source, Mapping):
            self._tables = copy.deepcopy(dict(source))
        elif source is not None:
            self._name = os.fspath(source)
            self._text = _carom.read_file(self._name)
            base = os.path.dirname(self._name)
            try:
                self._tables = _carom.read_toml(self._text)
            except ValueError:
                # the check says where, with the message of the command
                _carom.check(self._given())
                raise
        self._read = copy.deepcopy(self._tables)
        self._tables.update(copy.deepcopy(tables))
        self.folder = Path(base if folder is None else folder)

    def __getitem__(self, key: str) -> Any:
        return self._tables[key]

    def __setitem__(self, key: str, value: Any) -> None:
        self._tables[key] = value

    def __delitem__(self, key: str) -> None:
        del self._tables[key]

    def __iter__(self) -> Iterator[str]:
        return iter(self._tables)

    def __len__(self) -> int:
        return len(self._tables)

    def __repr__(self) -> str:
        title = self._tables.get("title", self._name or "without a title")
        return f"<carom.Case {title!r}>"

    def copy(self) -> Case:
        """A case of its own with the same tables."""
        return copy.deepcopy(self)

    @property
    def text(self) -> str:
        """The case as TOML: the text of its file as long as nothing was changed."""
        if self._text is not None and self._tables == self._read:
            return self._text
        return _carom.write_toml(self._tables)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the case as a file. Paths in it then start from the folder of that file."""
        Path(path).write_text(self.text, encoding="utf-8")

    def _given(self) -> tuple[str, str, str, list[str]]:
        folder = str(getattr(self, "folder", os.path.dirname(self._name)))
        folder = "" if folder == "." else folder
        if self._text is not None and self._tables == self._read:
            return (self._name, self._text, folder, [])
        # a text that nobody has seen has no lines to point at
        return ("", _carom.write_toml(self._tables), folder, [])

    def _default(self, ending: str) -> str:
        if not self._name:
            raise ValueError("a case that is no file needs a folder for its results")
        return str(Path(self._name).with_suffix(ending))

    def check(self) -> Check:
        """Checks the case without running it.

        Raises:
            CaseError: with every problem, as the command `carom check` tells them, each with the path of its key.
        """
        facts, warnings = _carom.check(self._given())
        return Check(dict(facts), warnings)

    def run(
        self,
        folder: str | os.PathLike[str] | None = None,
        *,
        progress: bool | Callable[[float, float], None] = False,
        callback: Callable[[Simulation], None] | None = None,
    ) -> Results:
        """Runs the case and returns its results.

        Args:
            folder: results folder; an earlier one is replaced. Default: as of the command, the name of the case file with the
                ending `.carom`.
            progress: a bar, in notebooks too; or a function of the simulated time and the end, s.
            callback: called with the simulation after every step; the run then holds the lock of Python.

        Other threads of Python go on meanwhile. Ctrl-C ends the run before its next step, with a checkpoint in the folder, and
        raises KeyboardInterrupt; an exception in `progress` or `callback` does the same and is raised.

        Raises:
            CaseError: the case is wrong; nothing was written.
            RunError: a step failed; the folder holds what was computed before.
        """
        folder = self._default(".carom") if folder is None else os.fspath(folder)
        if callback is not None:
            with self.simulate(folder) as simulation, bar(progress) as show:
                for step in simulation:
                    callback(step)
                    if show is not None:
                        show(step.time, step.end)
            return Results(folder)
        with bar(progress) as show:
            _carom.run(self._given(), folder, show)
        return Results(folder)

    def simulate(self, folder: str | os.PathLike[str] | None = None) -> Simulation:
        """The case as a simulation, to be stepped: `for step in case.simulate(): ...`.

        Args:
            folder: results folder. Default: nothing is written.

        Raises:
            CaseError: the case is wrong.
        """
        raw = _carom.Simulation(self._given(), None if folder is None else os.fspath(folder))
        return Simulation(raw, folder)


def resume(
    folder: str | os.PathLike[str],
    *,
    until: float | str | None = None,
    set: Mapping[str, Any] | None = None,
    progress: bool | Callable[[float, float], None] = False,
) -> Results:
    """Goes on with the run in a results folder, from its newest checkpoint, with the same bits.

    Args:
        folder: results folder of a run that was interrupted, or came to its end.
        until: another end, s or with a unit.
        set: values of the case that the model does not depend on, by key path: `{"output.fields.every": "1 us"}`.
        progress: as in `Case.run`.

    Raises:
        CaseError: the case in the folder is another one than that of the checkpoint.
        RunError: there is no checkpoint that can be used, or a step fails.
    """
    changes = dict(set or {})
    if until is not None:
        changes["time.end"] = until
    overrides = [f"{key}={inline(value)}" for key, value in changes.items()]
    with bar(progress) as show:
        _carom.resume(os.fspath(folder), overrides, show)
    return Results(folder)


def schema() -> dict[str, Any]:
    """The JSON schema of a case."""
    tables: dict[str, Any] = json.loads(_carom.schema())
    return tables
