"""Figures of histories by Matplotlib. Each method draws into `axes`, or into new ones, and returns them."""

from __future__ import annotations

from typing import Any

from numpy.typing import NDArray


class Plot:
    """Figures of the histories of a run."""

    def __init__(self, columns: dict[str, NDArray[Any]]) -> None:
        self._columns = columns

    def columns(self, *names: str, axes: Any = None) -> Any:
        """Columns of the histories over time, by their names.

        Raises:
            KeyError: there is no such column; the message lists those there are.
        """
        import matplotlib.pyplot as pyplot

        if axes is None:
            axes = pyplot.figure().add_subplot()
        for name in names:
            if name not in self._columns:
                raise KeyError(f"no column `{name}`; there are: {', '.join(self._columns)}")
            axes.plot(self._columns["time_s"], self._columns[name], label=name)
        axes.set_xlabel("time, s")
        axes.legend()
        return axes

    def _of(self, start: str, end: str, what: str, axes: Any) -> Any:
        names = [name for name in self._columns if name.startswith(start) and name.endswith(end)]
        if not names:
            raise KeyError(f"the histories have no {what}")
        axes = self.columns(*names, axes=axes)
        axes.set_ylabel(what)
        return axes

    def force(self, axes: Any = None) -> Any:
        """Force of each contact, N."""
        return self._of("contact.", ".force_n", "contact force, N", axes)

    def gap(self, axes: Any = None) -> Any:
        """Gap of each contact, m."""
        return self._of("contact.", ".gap_m", "gap, m", axes)

    def energy(self, axes: Any = None) -> Any:
        """Energies, J."""
        return self._of("energy.", "_j", "energy, J", axes)
