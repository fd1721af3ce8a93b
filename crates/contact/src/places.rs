//! Where the nodes of a system are, and which unknowns move them.

use carom_algebra::rotation::Rotation;
use carom_algebra::tensor::{Mat3, Vec3};
use carom_algebra::unknowns::{Kind, Unknowns};
use carom_elements::MAX_FACE_NODES;
use carom_mesh::Face;

/// Rotations of the nodes that have any.
#[derive(Clone, Copy, Debug, Default)]
pub struct Frames<'a> {
    /// At the start of the step, in the order of [`Unknowns::turning`].
    pub start: &'a [Rotation],
    /// Whether the displacement is that of the middle of the step: places carried by a node are then the means of those
    /// at both ends, with twice its increment.
    pub middle: bool,
    /// Where moments balance; none where the nodes are.
    pub balance: Option<Balance<'a>>,
}

/// The instant of a step in whose frames moments balance.
#[derive(Clone, Copy, Debug)]
pub struct Balance<'a> {
    /// Displacement at the end of the step, a system vector: the whole increments of the rotations.
    pub end: &'a [f64],
    /// Fraction of the step.
    pub fraction: f64,
}

/// Positions of the system's nodes: reference coordinates and a displacement.
#[derive(Clone, Copy, Debug)]
pub struct Places<'a> {
    /// Unknowns of the nodes.
    pub unknowns: &'a Unknowns,
    /// Time, s: where obstacles are that move.
    pub time: f64,
    /// Reference coordinates by system number, m.
    pub x: &'a [[f64; 3]],
    /// Displacement, a system vector, m; of rotations the increment since the start of the step, rad.
    pub u: &'a [f64],
    /// Rotations that the increments begin from.
    pub frames: Frames<'a>,
}

impl Places<'_> {
    /// Current position of a node in m.
    #[inline(always)]
    pub fn of(&self, node: u32) -> [f64; 3] {
        // nearly all nodes have translations of their own
        let own = self.unknowns.translations_of(node);
        match (self.u.get(own), self.unknowns.carrier(node)) {
            (Some(&[u, v, w]), None) => {
                let x = &self.x[node as usize];
                [x[0] + u, x[1] + v, x[2] + w]
            }
            (Some(&[u, v]), None) => {
                let x = &self.x[node as usize];
                [x[0] + u, x[1] + v, x[2]]
            }
            _ => self.of_any(node),
        }
    }

    #[cold]
    fn of_any(&self, node: u32) -> [f64; 3] {
        let own = self.unknowns.moved_by(node);
        let mut place = self.x[own as usize];
        for (x, u) in place
            .iter_mut()
            .zip(&self.u[self.unknowns.translations_of(own)])
        {
            *x += u;
        }
        match self.unknowns.carrier(node) {
            None if self.unknowns.of(node).is_empty() => {
                let moved = self.unknowns.vector(node, self.u);
                [0, 1, 2].map(|i| place[i] + moved[i])
            }
            None => place,
            Some(carrier) => {
                let arm = Vec3::from(carrier.arm);
                let arm = match self.unknowns.frame(own) {
                    Some(_) => {
                        let [start, turned] = self.turn(own);
                        start * turned * arm
                    }
                    // small rotations are linear
                    None => arm + Vec3::from(self.unknowns.spin(own, self.u)).cross(&arm),
                };
                [0, 1, 2].map(|i| place[i] + arm[i])
            }
        }
    }

    /// Current positions of the nodes of a face in m, zero beyond their number.
    pub(crate) fn of_face(&self, face: &Face) -> [[f64; 3]; MAX_FACE_NODES] {
        let mut positions = [[0.0; 3]; MAX_FACE_NODES];
        for (position, &node) in positions.iter_mut().zip(face.corners()) {
            *position = self.of(node);
        }
        positions
    }

    /// Dimension of space.
    pub fn dim(&self) -> usize {
        self.unknowns.dim()
    }

    /// Calls `visit` with the unknowns that move a node, and what a unit force along `direction` does to them: of translations
    /// its components, of rotations its moment about the axes of the frame at the instant of the balance.
    ///
    /// With R the rotation at the start of the step, y the arm from there (in the axes of R) and z = y × Rᵀ n the moment
    /// about these axes, the moment about those of R C is Cᵀ z. In a mid-point rule it is A z, A = I - θ̂/2: that gives
    /// the angular momentum R A⁻¹ A z, the moment R y × R n in space, and where y is the mean of the arms at both ends the
    /// work n · Δx.
    pub fn each_derivative(
        &self,
        node: u32,
        direction: &[f64; 3],
        mut visit: impl FnMut(usize, f64),
    ) {
        let own = self.unknowns.moved_by(node);
        for (unknown, &n) in self.unknowns.translations_of(own).zip(direction) {
            visit(unknown, n);
        }
        let Some(carrier) = self.unknowns.carrier(node) else {
            return;
        };
        let (arm, direction) = (Vec3::from(carrier.arm), Vec3::from(*direction));
        let moment = match self.unknowns.frame(own) {
            None => arm.cross(&direction),
            Some(_) => {
                let [start, turned] = self.turn(own);
                let moment = (turned * arm).cross(&start.tr_mul(&direction));
                self.balanced(own, &turned, &moment)
            }
        };
        self.each_rotation(own, &moment, &mut visit);
    }

    /// Calls `visit` with the rotations that turn a node, if any, and what a moment on it does to them. `moment`: about the axes
    /// of coordinates, of a unit force in m.
    pub fn each_moment(&self, node: u32, moment: &[f64; 3], mut visit: impl FnMut(usize, f64)) {
        let (own, moment) = (self.unknowns.moved_by(node), Vec3::from(*moment));
        let moment = match self.unknowns.frame(own) {
            None => moment,
            Some(_) => {
                let [start, turned] = self.turn(own);
                self.balanced(own, &turned, &start.tr_mul(&moment))
            }
        };
        self.each_rotation(own, &moment, &mut visit);
    }

    fn each_rotation(&self, node: u32, moment: &Vec3, visit: &mut dyn FnMut(usize, f64)) {
        for unknown in self.unknowns.rotations_of(node) {
            if let Kind::Rotation(axis) = self.unknowns.kind(unknown) {
                visit(unknown, moment[axis]);
            }
        }
    }

    /// A moment about the axes of the frame at the start of the step, about those in which moments balance.
    fn balanced(&self, node: u32, turned: &Mat3, moment: &Vec3) -> Vec3 {
        let Some(balance) = self.frames.balance else {
            return turned.tr_mul(moment);
        };
        let increment: Vec3 = self.unknowns.spin(node, balance.end).into();
        match balance.fraction == 0.5 {
            true => moment - (increment * 0.5).cross(moment),
            false => {
                let turned = Rotation::cayley(&(increment * balance.fraction));
                turned.matrix().tr_mul(moment)
            }
        }
    }

    /// Matrix of the frame at the start of the step, and of what the increment turns in it: cay(θ), or in the middle
    /// A⁻¹ = (I + cay(θ))/2 of the whole increment θ, twice that of the middle.
    fn turn(&self, node: u32) -> [Mat3; 2] {
        let frame = self.unknowns.frame(node);
        let start = frame.and_then(|frame| self.frames.start.get(frame));
        let start = start.copied().unwrap_or_default().matrix();
        let increment: Vec3 = self.unknowns.spin(node, self.u).into();
        let turned = match self.frames.middle {
            false => Rotation::cayley(&increment).matrix(),
            true => (Mat3::identity() + Rotation::cayley(&(increment * 2.0)).matrix()) * 0.5,
        };
        [start, turned]
    }
}
