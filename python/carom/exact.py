"""Exact solutions of impact problems, in SI units."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _carom


@dataclass(frozen=True)
class Bar:
    """A uniform elastic bar. Its axis runs from the contact end into the bar: a bar that approaches has a negative velocity.

    Attributes:
        length: m.
        area: m².
        modulus: of the longitudinal wave, Pa.
        density: kg/m³.
        velocity: at the start, m/s, positive away from the contact.
        strain: at the start, positive in tension.
        gravity: m/s², positive towards the contact.
        clamped: whether the far end is held.
    """

    length: float
    area: float
    modulus: float
    density: float
    velocity: float = 0.0
    strain: float = 0.0
    gravity: float = 0.0
    clamped: bool = False

    @property
    def wave_speed(self) -> float:
        """c = sqrt(E/rho), m/s."""
        return float(np.sqrt(self.modulus / self.density))

    @property
    def impedance(self) -> float:
        """Z = rho c A, N s/m."""
        return self.density * self.wave_speed * self.area

    def _given(self) -> tuple[list[float], bool]:
        numbers = [self.length, self.area, self.modulus, self.density, self.velocity, self.strain, self.gravity]
        return numbers, self.clamped


@dataclass(frozen=True)
class Contact:
    """An interval of contact: start and end (s), largest force (N), impulse (N s)."""

    start: float
    end: float
    peak_force: float
    impulse: float


class Impact:
    """The exact impact of one bar on a rigid wall, or of two bars, from time 0 to `end` (s). Functions of time take numbers or arrays."""

    def __init__(self, bars: list[Bar], gap: float, end: float) -> None:
        self.bars = bars
        self._raw = _carom.Impact([bar._given() for bar in bars], gap, end)

    @property
    def contacts(self) -> list[Contact]:
        """The intervals of contact."""
        return [Contact(*numbers) for numbers in self._raw.contacts]

    def force(self, time: ArrayLike) -> Any:
        """Contact force, N."""
        return _over(time, self._raw.force)

    def impulse(self, time: ArrayLike) -> Any:
        """Integral of the contact force, N s."""
        return _over(time, self._raw.impulse)

    def gap(self, time: ArrayLike) -> Any:
        """Distance of the contact ends, m."""
        return _over(time, self._raw.gap)

    def energy(self, time: ArrayLike) -> Any:
        """Kinetic, strain and potential energy, J."""
        return _over(time, self._raw.energy)

    def velocity(self, bar: int, place: float, time: ArrayLike) -> Any:
        """Velocity (m/s, away from the contact) of a bar at a place (m from its contact end)."""
        return _over(time, lambda times: self._raw.velocity(bar, place, times))

    def displacement(self, bar: int, place: float, time: ArrayLike) -> Any:
        """Displacement (m, away from the contact) of a bar at a place (m from its contact end)."""
        return _over(time, lambda times: self._raw.displacement(bar, place, times))


def _over(time: ArrayLike, function: Any) -> Any:
    times: NDArray[np.float64] = np.asarray(time, dtype=float)
    values = np.array(function(times.ravel().tolist())).reshape(times.shape)
    return values if times.ndim else float(values)


def two_bars(first: Bar, second: Bar, *, end: float, gap: float = 0.0) -> Impact:
    """Two bars on one line that meet; `gap` in m, `end` of the solution in s."""
    return Impact([first, second], gap, end)


def bar_on_wall(bar: Bar, *, end: float, gap: float = 0.0) -> Impact:
    """A bar that meets a rigid wall."""
    return Impact([bar], gap, end)


@dataclass(frozen=True)
class Sphere:
    """A sphere: radius (m, infinite for a plane), Young's modulus (Pa, infinite for a rigid one), Poisson's ratio, mass (kg, infinite for a
    fixed one)."""

    radius: float
    young: float
    poisson: float
    mass: float


@dataclass(frozen=True)
class Collision:
    """Hertz's collision: duration (s), and force (N), approach (m), radius of the contact (m) and pressure in its middle (Pa) at their largest."""

    duration: float
    force: float
    approach: float
    radius: float
    pressure: float


def hertz(first: Sphere, second: Sphere, speed: float) -> Collision:
    """Two spheres that meet head-on with the speed of approach (m/s): m* d'' = -4/3 E* sqrt(R) d^(3/2)."""
    given = [[s.radius, s.young, s.poisson, s.mass] for s in (first, second)]
    return Collision(*_carom.hertz_collision(given, speed))


class MassOnBar:
    """A rigid mass (kg) that strikes the end of a bar at rest with a speed (m/s): Saint-Venant's problem.

    Attributes:
        duration: of the contact, s.
    """

    def __init__(self, mass: float, bar: Bar, speed: float, *, transits: int = 40) -> None:
        self._given = ([mass, bar.impedance, speed, 2.0 * bar.length / bar.wave_speed], bar.clamped, transits)
        self.duration, _ = _carom.mass_on_bar(*self._given, [])

    def force(self, time: ArrayLike) -> Any:
        """Contact force (N) at times (s) after the mass has struck."""
        return _over(time, lambda times: _carom.mass_on_bar(*self._given, times)[1])


def beam_on_stop(
    *,
    bending: float,
    line: float,
    length: float,
    load: float,
    stiffness: float,
    gap: float,
    dt: float,
    steps: int,
    cantilever: bool = True,
    modes: int = 60,
) -> NDArray[np.float64]:
    """Force (N) on a stop at the ends of steps of `dt` (s), by the exact modes of a slender beam.

    Args:
        bending: E I, N m².
        line: mass per length, kg/m.
        length: m.
        load: acceleration towards the stop, m/s².
        stiffness: of the stop, N/m.
        gap: of the stop, m.
        cantilever: with the stop at its tip; otherwise simply supported with the stop at mid-span.
    """
    problem = ([bending, line, length], load, [stiffness, gap], modes)
    return np.array(_carom.beam_on_stop(cantilever, problem, (dt, steps)))
