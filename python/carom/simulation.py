"""Stepping: a run that a program drives."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Iterator, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import _carom


class Simulation:
    """A case between two steps.

    `for step in simulation:` takes the steps to the end of the case and gives the simulation itself after each of them. With a
    results folder, use it as a context (`with case.simulate(folder) as simulation:`): however the block ends, the folder is
    complete, with a checkpoint, figures, a report and a summary.

    The arrays are views, without a copy, of memory that the simulation owns and renews after each step: take them once, before the
    loop. They are read-only; copy what must stay. Arrays at nodes have a row of three components for each node of the mesh, in its
    order; arrays at contact points have one number for each point of all contacts, see `contact_points`.
    """

    def __init__(self, raw: _carom.Simulation, folder: str | os.PathLike[str] | None) -> None:
        self._raw = raw
        self._folder = folder

    def __iter__(self) -> Iterator[Simulation]:
        take = self._raw.__next__
        try:
            while True:
                take()
                yield self
        except StopIteration:
            return

    def __enter__(self) -> Simulation:
        return self

    def __exit__(self, *_: object) -> None:
        self.finish()

    def __repr__(self) -> str:
        return f"<carom.Simulation step {self.steps}, t = {self.time:.6g} s of {self.end:.6g} s>"

    def step(self, count: int = 1) -> None:
        """Takes steps, also beyond the end of the case as long as no results folder has been completed there.

        Args:
            count: number of steps.

        Raises:
            ValueError: a negative number of steps.
            RunError: a step failed; the state is the one before it.
        """
        if count < 0:
            raise ValueError(f"{count} steps; accepted: zero or more")
        take = self._raw.step
        for _ in range(count):
            take()

    def run(self) -> Simulation:
        """Takes all steps to the end of the case."""
        for _ in self:
            pass
        return self

    def finish(self) -> None:
        """Ends the run here. With a results folder: writes the checkpoint, the figures, the report and the summary."""
        self._raw.finish()

    def add_force(
        self,
        on: str,
        direction: Sequence[float],
        size: float | Callable[[Simulation], float] | None = None,
    ) -> _carom.Force:
        """Adds a force, before the first step and the first view.

        Args:
            on: group of nodes of the mesh, with equal shares.
            direction: components of a force of size 1, as many as the space has; together on all nodes.
            size: size in N; or a function of the simulation that is called before each step: a load or a controller.

        Returns:
            A handle whose `value` (N) may be set between steps. The force is constant over each step.

        A run with added forces cannot be continued by `carom.resume`, which has no program to set them; use `save` and `restore`.

        Raises:
            CaseError: no such group, or a case with zones or a static stage that does not take the force.
        """
        given: Any = size
        if callable(size):
            function = size

            def given(_: Any) -> float:
                return float(function(self))

        return self._raw.add_force(on, [float(c) for c in direction], given)

    def save(self) -> bytes:
        """Everything that the run goes on from."""
        return self._raw.save()

    def restore(self, saved: bytes) -> None:
        """Goes back to what `save` gave, of the same case; the steps after it have the same bits. Only without a results folder.

        Raises:
            RunError: another model, or a results folder.
        """
        self._raw.restore(saved)

    @property
    def time(self) -> float:
        """Time reached, s."""
        return self._raw.time

    @property
    def steps(self) -> int:
        """Steps taken."""
        return self._raw.steps

    @property
    def end(self) -> float:
        """End of the case, s."""
        return self._raw.end_time

    @property
    def dt(self) -> float:
        """Step, s; the largest of an adaptive step."""
        return self._raw.dt

    @property
    def done(self) -> bool:
        """Whether the end of the case is reached."""
        return self._raw.done

    @property
    def displacement(self) -> NDArray[np.float64]:
        """Displacement of the nodes, m; shape (nodes, 3). A view."""
        return self._raw.displacement

    @property
    def velocity(self) -> NDArray[np.float64]:
        """Velocity of the nodes, m/s; shape (nodes, 3). A view."""
        return self._raw.velocity

    @property
    def acceleration(self) -> NDArray[np.float64]:
        """Acceleration of the nodes, m/s²; shape (nodes, 3). A view."""
        return self._raw.acceleration

    @property
    def force(self) -> NDArray[np.float64]:
        """Normal force of the contact points in the last step, N, positive in compression. A view."""
        return self._raw.force

    @property
    def gap(self) -> NDArray[np.float64]:
        """Gap of the contact points, m, positive when open; infinite where a point faces nothing. A view."""
        return self._raw.gap

    @property
    def gap_rate(self) -> NDArray[np.float64]:
        """Rate of the gap that laws in the rate constrain, m/s. A view."""
        return self._raw.gap_rate

    @property
    def pressure(self) -> NDArray[np.float64]:
        """Force over the area that a contact point stands for, Pa. A view."""
        return self._raw.pressure

    @property
    def status(self) -> NDArray[np.bool_]:
        """Whether the contact points are closed. A view."""
        return self._raw.closed

    @property
    def contact_forces(self) -> dict[str, float]:
        """Normal force of each contact in the last step, N."""
        return dict(self._raw.contact_forces)

    @property
    def contact_points(self) -> dict[str, slice]:
        """Where the points of each contact are in the arrays at contact points."""
        return {name: slice(first, last) for name, first, last in self._raw.contact_points}

    @property
    def places(self) -> NDArray[np.float64]:
        """Reference places of the nodes, m; shape (nodes, 3). A copy."""
        return np.array(self._raw.places)

    def nodes(self, group: str) -> NDArray[np.intp]:
        """Nodes of a group of the mesh: rows of the arrays at nodes."""
        return np.array(self._raw.nodes(group), dtype=np.intp)

    @property
    def energy_residual(self) -> float:
        """Residual of the energy balance since the start over the largest energy."""
        residual, largest = self._raw.energy
        return residual / largest if largest > 0.0 else 0.0

    @property
    def summary(self) -> Any:
        """Summary of a finished run with a results folder."""
        from .results import Summary

        text = self._raw.summary_json
        return None if text is None else Summary(json.loads(text))
