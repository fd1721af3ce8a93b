"""What a run leaves behind: the results folder, opened."""

from __future__ import annotations

import csv
import gzip
import html
import json
import os
import xml.etree.ElementTree as ElementTree
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from .plot import Plot

UNITS = {
    "s": "s", "m": "m", "n": "N", "j": "J", "pa": "Pa", "kg": "kg", "hz": "Hz", "rad": "rad", "m_s": "m/s", "m_s2": "m/s²",
    "n_s": "N s", "n_m": "N m", "n_m_s": "N m s", "rad_s": "rad/s", "rad_s2": "rad/s²", "m2": "m²", "j_m3": "J/m³",
}


class Summary:
    """A table of the summary: its entries as attributes, or by name as those of a dict."""

    def __init__(self, entries: dict[str, Any]) -> None:
        self._entries = entries

    def __getattr__(self, name: str) -> Any:
        entries = object.__getattribute__(self, "_entries")
        for key in (name, name.replace("_", "-"), name.replace("_", " ")):
            if key in entries:
                return _wrap(entries[key])
        raise AttributeError(f"no `{name}` in the summary; there are: {', '.join(entries)}")

    def __getitem__(self, name: str) -> Any:
        return _wrap(self._entries[name])

    def __iter__(self) -> Iterator[str]:
        return iter(self._entries)

    def __contains__(self, name: object) -> bool:
        return name in self._entries

    def __len__(self) -> int:
        return len(self._entries)

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *(key.replace("-", "_").replace(" ", "_") for key in self._entries)]

    def __repr__(self) -> str:
        return json.dumps(self._entries, indent=2, ensure_ascii=False)

    def items(self) -> list[tuple[str, Any]]:
        """Names and values."""
        return [(name, self[name]) for name in self._entries]

    def to_dict(self) -> dict[str, Any]:
        """The plain dict."""
        return self._entries


def _wrap(value: Any) -> Any:
    if isinstance(value, dict):
        return Summary(value)
    if isinstance(value, list):
        return [_wrap(one) for one in value]
    return value


def unit(column: str) -> str:
    """The unit in the name of a column of a table, such as `m/s` of `probe.tip.velocity_x_m_s`; empty where there is none."""
    words = column.rsplit(".", 1)[-1].split("_")
    for count in (3, 2, 1):
        if len(words) > count and "_".join(words[-count:]) in UNITS:
            return UNITS["_".join(words[-count:])]
    return ""


class Fields(Sequence["Any"]):
    """The instants of `fields.pvd`: each is read when it is asked for, as a PyVista data set, or a block of several.

    Attributes:
        times: instants, s.
    """

    def __init__(self, folder: Path) -> None:
        path = folder / "fields.pvd"
        if not path.is_file():
            raise FileNotFoundError(f"{path}: the case asks for no fields; give it a table output.fields")
        by_time: dict[float, list[tuple[str, Path]]] = {}
        for entry in ElementTree.parse(path).iter("DataSet"):
            file = folder / entry.attrib["file"]
            by_time.setdefault(float(entry.attrib["timestep"]), []).append((file.stem.rsplit("-", 1)[0], file))
        self._files = [by_time[time] for time in sorted(by_time)]
        self.times = np.array(sorted(by_time))

    def __len__(self) -> int:
        return len(self._files)

    def __getitem__(self, place: Any) -> Any:
        import pyvista

        if isinstance(place, slice):
            return [self[k] for k in range(*place.indices(len(self)))]
        files = self._files[place]
        if len(files) == 1:
            return pyvista.read(files[0][1])
        return pyvista.MultiBlock({name: pyvista.read(file) for name, file in files})

    def __repr__(self) -> str:
        if not len(self):
            return "<no fields>"
        return f"<fields at {len(self)} instants from {self.times[0]:.6g} s to {self.times[-1]:.6g} s>"

    def at(self, time: float) -> Any:
        """The instant nearest to a time, s."""
        return self[int(np.argmin(np.abs(self.times - time)))]


class Report:
    """The report of a run; in a notebook it is shown."""

    def __init__(self, path: Path) -> None:
        self.path = path

    @property
    def html(self) -> str:
        """The page: one file that needs no network."""
        return self.path.read_text(encoding="utf-8")

    def _repr_html_(self) -> str:
        # a frame of its own keeps the styles of the page from the notebook
        page = html.escape(self.html, quote=True)
        return f'<iframe srcdoc="{page}" width="100%" height="700" style="border:0"></iframe>'

    def open(self) -> None:
        """Shows it in the browser."""
        import webbrowser

        webbrowser.open(self.path.resolve().as_uri())

    def __repr__(self) -> str:
        return f"<report {self.path}>"


class Results:
    """A results folder.

    Raises:
        FileNotFoundError: there is no `summary.json` in it.
    """

    def __init__(self, folder: str | os.PathLike[str]) -> None:
        self.folder = Path(folder)
        summary = self.folder / "summary.json"
        if not summary.is_file():
            raise FileNotFoundError(f"{self.folder} is no results folder: it has no summary.json")
        text = summary.read_text(encoding="utf-8")
        self.summary = Summary(json.loads(text))
        self._histories: dict[str, NDArray[Any]] | None = None

    def __repr__(self) -> str:
        return f"<carom.Results {self.summary.title!r} in {self.folder}: verdict {self.summary.verdict.grade}>"

    @property
    def good(self) -> bool:
        """Whether every line of the verdict is good."""
        return bool(self.summary.verdict.grade == "good")

    def table(self, name: str = "histories.csv") -> dict[str, NDArray[Any]]:
        """The columns of a table of the folder as arrays, also of a compressed one; empty cells are NaN, texts stay texts."""
        path = self.folder / name
        packed = self.folder / f"{name}.gz"
        opened = gzip.open(packed, "rt", encoding="utf-8", newline="") if packed.is_file() else path.open(encoding="utf-8", newline="")
        with opened as file:
            rows = csv.reader(file)
            heads = next(rows)
            columns = list(zip(*rows)) or [()] * len(heads)
        return {head: _numbers(column) for head, column in zip(heads, columns)}

    @property
    def columns(self) -> dict[str, NDArray[Any]]:
        """The histories as arrays, without pandas; read once."""
        if self._histories is None:
            self._histories = self.table()
        return self._histories

    @property
    def histories(self) -> Any:
        """The histories as a pandas frame over the time (s): see `frame`."""
        return self.frame()

    @property
    def impacts(self) -> Any:
        """The impacts as a pandas frame, a row each."""
        return self.frame("impacts.csv", index=None)

    def frame(
        self,
        name: str = "histories.csv",
        *,
        index: str | None = "time_s",
        library: Literal["pandas", "polars"] = "pandas",
    ) -> Any:
        """A table of the folder as a frame of pandas, with `frame.attrs["units"]`, or of polars. Names of columns hold the units, too.

        Args:
            name: file of the table.
            index: column that becomes the index of a pandas frame.
            library: `pandas` or `polars`.
        """
        columns = self.columns if name == "histories.csv" else self.table(name)
        if library == "polars":
            import polars

            return polars.DataFrame(columns)
        import pandas

        frame = pandas.DataFrame(columns)
        frame.attrs["units"] = {column: unit(column) for column in columns}
        return frame if index is None else frame.set_index(index)

    @property
    def fields(self) -> Fields:
        """The instants of the fields, read when asked for."""
        return Fields(self.folder)

    def report(self) -> Report:
        """The report, which a notebook shows."""
        return Report(self.folder / "report.html")

    @property
    def plot(self) -> Plot:
        """Figures by Matplotlib."""
        return Plot(self.columns)


def _numbers(column: Sequence[str]) -> NDArray[Any]:
    try:
        return np.array([float(cell) if cell else np.nan for cell in column])
    except ValueError:
        return np.array(column, dtype=object)
