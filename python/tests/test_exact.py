"""Exact solutions, schemes and laws as objects, against formulas."""

import math

import numpy as np
import pytest

from carom import exact
from carom.laws import Law, spring
from carom.schemes import Scheme

STEEL = dict(length=0.254, area=645e-6, modulus=207e9, density=7844.0)


def test_two_bars_press_with_half_the_impedance_for_a_round_trip():
    striker, target = exact.Bar(**STEEL, velocity=-5.1359), exact.Bar(**STEEL)
    impact = exact.two_bars(striker, target, end=150e-6)
    force, trip = striker.impedance * 5.1359 / 2, 2 * 0.254 / striker.wave_speed
    (contact,) = impact.contacts
    assert contact.peak_force == pytest.approx(force, rel=1e-12)
    assert contact.end == pytest.approx(trip, rel=1e-12)
    times = np.array([[10e-6, 50e-6], [90e-6, 120e-6]])
    assert np.allclose(impact.force(times), [[force, force], [force, 0.0]], rtol=1e-12)
    assert impact.impulse(150e-6) == pytest.approx(force * trip, rel=1e-12)
    assert impact.energy(0.0) == pytest.approx(impact.energy(140e-6), rel=1e-12)
    # the striker stands and the target moves on
    assert abs(impact.velocity(0, 0.1, 140e-6)) < 1e-9
    assert impact.velocity(1, 0.1, 140e-6) == pytest.approx(5.1359, rel=1e-9)


def test_a_bar_comes_back_from_a_wall():
    bar = exact.Bar(**STEEL, velocity=-2.0)
    impact = exact.bar_on_wall(bar, end=1e-3, gap=1e-4)
    (contact,) = impact.contacts
    assert contact.start == pytest.approx(1e-4 / 2.0, rel=1e-12)
    assert contact.impulse == pytest.approx(2 * 2.0 * 7844.0 * 0.254 * 645e-6, rel=1e-12)


def test_hertz_keeps_the_energy_and_takes_his_time():
    sphere = exact.Sphere(radius=0.01, young=210e9, poisson=0.3, mass=0.033)
    found = exact.hertz(sphere, sphere, 1.0)
    modulus, radius, mass = 210e9 / (2 * (1 - 0.09)), 0.005, 0.0165
    # 8/15 E* sqrt(R) d^(5/2) = m* v²/2
    assert 8 / 15 * modulus * math.sqrt(radius) * found.approach**2.5 == pytest.approx(mass / 2, rel=1e-12)
    assert found.force == pytest.approx(4 / 3 * modulus * math.sqrt(radius) * found.approach**1.5, rel=1e-12)
    # Johnson (1985), equation 11.24: 2.87 (m²/(R E² v))^(1/5)
    assert found.duration == pytest.approx(2.87 * (mass**2 / (radius * modulus**2)) ** 0.2, rel=1e-3)


def test_a_mass_on_a_long_bar_decays():
    bar = exact.Bar(length=10.0, area=1e-4, modulus=210e9, density=7800.0)
    hit = exact.MassOnBar(1.0, bar, 2.0)
    times = np.array([0.0, 1e-4, 5e-4])
    assert np.allclose(hit.force(times), bar.impedance * 2.0 * np.exp(-bar.impedance * times))


def test_a_beam_that_never_reaches_its_stop_does_not_press():
    beam = dict(bending=1680.0, line=1.872, length=1.0, load=9.81, stiffness=5e5, dt=1e-4, steps=400)
    # the tip of a cantilever under a sudden load swings to twice the static deflection at most, nearly
    reach = 9.81 * 1.872 / (8 * 1680.0)
    assert not exact.beam_on_stop(**beam, gap=2.5 * reach).any()
    assert exact.beam_on_stop(**beam, gap=reach).max() > 0.0


def test_spectral_radii_are_those_of_the_textbooks():
    trapezoid = Scheme("newmark", beta=0.25, gamma=0.5)
    assert np.allclose(trapezoid.spectral_radius([0.1, 1.0, 10.0]), 1.0, atol=1e-7)
    central = Scheme("central-difference")
    assert central.critical == pytest.approx(2.0)
    assert central.spectral_radius(1.9) == pytest.approx(1.0, abs=1e-7)
    assert central.spectral_radius(2.1) > 1.5
    # generalised-alpha: the radius at high frequency is its parameter (Chung and Hulbert 1993)
    for radius in (0.5, 0.8):
        name = Scheme("generalised-alpha", rho_inf=radius)
        assert name.spectral_radius(1e6) == pytest.approx(radius, rel=1e-3)
    # period error of the trapezoid: tan(ω̄ dt/2) = ω dt/2
    values = np.linalg.eigvals(trapezoid.amplification(0.4))
    angle = np.abs(np.angle(values[np.abs(values) > 0.5])).max()
    assert math.tan(angle / 2) == pytest.approx(0.2, rel=1e-9)
    with pytest.raises(ValueError):
        Scheme("newmrk")
    with pytest.raises(ValueError):
        Scheme("newmark", betta=0.25)
    with pytest.raises(ValueError, match="between two states"):
        Scheme("energy-momentum").amplification(1.0)


def test_the_map_of_a_step_is_that_of_the_formula():
    rows = Scheme("newmark", beta=0.3, gamma=0.6).step_map(0.1)
    assert rows["displacement"].v == 0.1 and rows["displacement"].x == pytest.approx(0.3 * 0.01)
    assert rows["velocity"].x == pytest.approx(0.06) and rows["inertia"].x == 1.0


def test_laws_say_what_they_constrain():
    assert Law("displacement").level == "gap" and Law("velocity", capture="half").level == "rate"
    stop = spring(2e5)
    assert stop.level == "gap and rate" and stop.relation == {"gap": 2e5, "rate": 0.0, "compliance": 1.0, "offset": 0.0}
    with pytest.raises(ValueError):
        Law("nothing")
