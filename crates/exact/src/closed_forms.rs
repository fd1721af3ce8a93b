//! Closed forms for bars in impact: wave mechanics, and the first step of the discrete schemes.
//!
//! Bars have uniform elements of size h, CFL = c dt/h; the discrete forms hold while the wave has not come back from
//! the far end, to the accuracy of a semi-infinite mesh.

/// Mass matrix of a two-node bar element.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mass {
    /// Row sums on the diagonal.
    Lumped,
    /// ∫ rho N_a N_b.
    Consistent,
}

impl Mass {
    /// The number mu of the formulas below: 1/4 lumped, 1/12 consistent.
    ///
    /// Source: a uniform mesh whose operator has the diagonal D (D/2 at the end node) and the off-diagonal O gives a
    /// unit force on its end node the response 1/sqrt(D²/4 - O²); mu (m/dt²)² is the part of the mass alone.
    pub fn mu(self) -> f64 {
        match self {
            Mass::Lumped => 1.0 / 4.0,
            Mass::Consistent => 1.0 / 12.0,
        }
    }
}

/// Contact force at first touch, N: F0 = Z1 Z2 w/(Z1 + Z2).
///
/// `impedances` Z1, Z2 in N s/m (infinite: a rigid wall), `approach` w the closing speed in m/s.
pub fn impact_force(impedances: [f64; 2], approach: f64) -> f64 {
    contact_impedance(impedances) * approach
}

/// Velocity of the interface of two bars in contact, m/s: (Z1 v1 + Z2 v2)/(Z1 + Z2), velocities along one axis.
pub fn interface_velocity(impedances: [f64; 2], velocities: [f64; 2]) -> f64 {
    let [z1, z2] = impedances;
    (z1 * velocities[0] + z2 * velocities[1]) / (z1 + z2)
}

/// Impedance that the contact sees, N s/m: 1/(1/Z1 + 1/Z2); Z/2 for equal bars, Z on a wall (infinite impedance).
pub fn contact_impedance(impedances: [f64; 2]) -> f64 {
    1.0 / (1.0 / impedances[0] + 1.0 / impedances[1])
}

/// Force of the first contact step of Newmark with an exact multiplier over the exact one:
/// F1/F0 = sqrt(mu + beta CFL²)/(beta CFL).
///
/// Zero gap at the start of the step, equal bars or a rigid wall; independent of gamma.
pub fn newmark_first_force(mass: Mass, beta: f64, cfl: f64) -> f64 {
    (mass.mu() + beta * cfl * cfl).sqrt() / (beta * cfl)
}

/// Mean force of the first contact step of the velocity theta scheme over the exact one:
/// F1/F0 = sqrt(mu + theta² CFL²)/CFL.
///
/// Velocity law at the end of the step, which is wholly in contact; equal bars or a rigid wall.
pub fn theta_first_force(mass: Mass, theta: f64, cfl: f64) -> f64 {
    (mass.mu() + (theta * cfl).powi(2)).sqrt() / cfl
}

/// Part of the striker's kinetic energy that the theta scheme loses in the impact step of two equal bars, the second
/// one at rest: sqrt(mu + theta² CFL²)/(2 n), n `elements` in each bar.
///
/// The limit CFL -> 0, 1/(4 n) for lumped mass, is the loss of the end masses of central difference.
pub fn theta_impact_loss(mass: Mass, theta: f64, cfl: f64, elements: usize) -> f64 {
    (mass.mu() + (theta * cfl).powi(2)).sqrt() / (2.0 * elements as f64)
}

/// The same on a rigid wall: twice [`theta_impact_loss`].
pub fn theta_impact_loss_on_wall(mass: Mass, theta: f64, cfl: f64, elements: usize) -> f64 {
    2.0 * theta_impact_loss(mass, theta, cfl, elements)
}

/// Largest penetration of the velocity law with capture "now", m: (2 - theta) v0 dt, v0 the approach speed in m/s.
pub fn penetration_bound_now(theta: f64, approach: f64, dt: f64) -> f64 {
    (2.0 - theta) * approach * dt
}

/// Largest penetration of the velocity law with capture "half", m: (3/2 - theta) v0 dt, v0 the approach speed in m/s.
pub fn penetration_bound_half(theta: f64, approach: f64, dt: f64) -> f64 {
    (1.5 - theta) * approach * dt
}

/// Contact force of the compliance in velocity P = C_n max(0, -gap') over that of the rigid contact:
/// phi = C_n/(C_n + Z), with `damping` C_n and `impedance` Z of [`contact_impedance`], both in N s/m.
pub fn compliance_ratio(damping: f64, impedance: f64) -> f64 {
    damping / (damping + impedance)
}

/// Part of the striker's energy that the compliance in velocity absorbs between two equal bars: 2 phi (1 - phi).
pub fn compliance_loss(phi: f64) -> f64 {
    2.0 * phi * (1.0 - phi)
}

/// The same on a rigid wall: 4 phi (1 - phi); all of it at C_n = Z.
pub fn compliance_loss_on_wall(phi: f64) -> f64 {
    4.0 * phi * (1.0 - phi)
}
