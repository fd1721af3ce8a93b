//! Models from seeds, as they are and changed.

use std::fmt::Write;
use std::path::Path;

use carom_testing::Random;

use super::file::Meshed;

/// What is changed of a model.
#[derive(Clone, Copy, Debug)]
pub struct Change {
    /// Velocity added along the plane, m/s.
    pub velocity: f64,
    /// Bodies, meshes and contacts have names in the reversed order, which is what decides on their order.
    pub reversed: bool,
    /// Factor of lengths and times: velocities and strains stay.
    pub scale: f64,
    /// Axes turned by 90°.
    pub turned: bool,
    /// x reversed.
    pub mirrored: bool,
    /// Each gap more by this, and blocks sideways of each other by less, m.
    pub raised: f64,
    /// Distance of the origin, m.
    pub distance: f64,
    /// What is far away besides.
    pub bystander: Option<Bystander>,
    /// Secondary sides are primary ones, and primary secondary.
    pub swapped: bool,
    /// The mesh is that of a file.
    pub meshed: Option<Meshed>,
}

impl Default for Change {
    fn default() -> Change {
        Change {
            velocity: 0.0,
            reversed: false,
            scale: 1.0,
            turned: false,
            mirrored: false,
            raised: 0.0,
            distance: 0.0,
            bystander: None,
            swapped: false,
            meshed: None,
        }
    }
}

/// A body that touches nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Bystander {
    /// One that flies, and is larger.
    Flies,
    /// A rigid one that flies.
    Rigid,
    /// One that a load moves.
    Loaded,
    /// One that falls on a plane of its own, with friction.
    Strikes,
}

impl Change {
    /// Components of a vector.
    fn turn(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let x = if self.mirrored { -x } else { x };
        if self.turned { [-y, x] } else { [x, y] }
    }

    /// The number in the name of a block or of a contact above it.
    fn number(&self, k: usize) -> usize {
        if self.reversed { 9 - k } else { k }
    }

    /// The name of a contact as the model has it.
    pub fn contact(&self, k: usize) -> String {
        format!("c{}", self.number(k))
    }

    /// The name of a block.
    fn block(&self, k: usize) -> String {
        format!("b{}", self.number(k))
    }

    /// A place.
    pub fn place(&self, x: [f64; 2]) -> [f64; 2] {
        let [x, y] = self.turn(x.map(|x| self.scale * x));
        [x + self.distance, y - 0.3 * self.distance]
    }

    /// The name of a side of a block.
    fn side(&self, side: &'static str) -> &'static str {
        match (side, self.turned) {
            ("bottom", true) => "right",
            ("top", true) => "left",
            (side, _) => side,
        }
    }
}

/// A block of a model.
#[derive(Clone, Debug)]
pub struct Block {
    /// Corner of least x and y, m.
    pub origin: [f64; 2],
    /// Extent in x and y, m.
    pub size: [f64; 2],
    /// Quadrilaterals along x and y.
    pub elements: [usize; 2],
    velocity: [f64; 2],
    young: f64,
}

/// A model: blocks above each other, the lowest above a plane or free.
#[derive(Clone, Debug)]
pub struct Model {
    blocks: Vec<Block>,
    on_plane: bool,
    finite: bool,
    law: &'static str,
    scheme: &'static str,
    friction: f64,
    explicit: bool,
}

const LAWS: [&str; 5] = [
    "law.velocity = {}",
    "law.displacement = {}",
    "law.penalty = { stiffness = STIFFNESS }",
    "law.restitution = { coefficient = 0.0 }",
    "law.velocity = { capture = \"half\" }",
];

/// Least speed of a block that falls, m/s.
const SPEED: f64 = 1.0;

const SCHEMES: [&str; 3] = [
    "scheme.theta = { theta = 0.5 }",
    "scheme.newmark = {}",
    "scheme.theta = { theta = 0.6 }",
];

impl Model {
    /// Of a seed.
    pub fn new(seed: u64) -> Model {
        let mut random = Random(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15).wrapping_add(1));
        let mut of =
            |count: usize| ((random.between(0.0, 1.0) * count as f64) as usize).min(count - 1);
        let (count, on_plane) = [(1, true), (2, true), (2, false), (3, false)][of(4)];
        let finite = of(2) == 1;
        let explicit = of(3) == 0;
        let law = match explicit {
            true => LAWS[[0, 2, 3][of(3)]],
            false => LAWS[of(LAWS.len())],
        };
        let scheme = if explicit {
            "scheme.central-difference = {}"
        } else {
            SCHEMES[of(3)]
        };
        let friction = if finite && of(3) == 0 { 0.3 } else { 0.0 };
        let mut blocks = Vec::new();
        let mut y = 0.0;
        for k in 0..count {
            y += 2e-4 + 1e-4 * of(5) as f64;
            // no wider than what is below: a contact whose points are all beyond the rim cannot act
            let below: Option<&Block> = blocks.last();
            let inset = below.map_or(0.013, |_| 0.01) * of(3) as f64;
            let [left, width] = below.map_or([0.0, 0.25 + 0.01 * of(10) as f64], |below| {
                [below.origin[0], below.size[0]]
            });
            let size = [
                width - inset - 0.01 * of(3) as f64,
                0.05 + 0.01 * of(5) as f64,
            ];
            let fall = SPEED + of(4) as f64;
            blocks.push(Block {
                origin: [left + inset, y],
                size,
                elements: [1 + of(3), 1 + of(2)],
                velocity: [0.0, if k == 0 && !on_plane { 0.0 } else { -fall }],
                young: [1e8, 1e9, 2e9][of(3)],
            });
            y += size[1];
        }
        Model {
            blocks,
            on_plane,
            finite,
            law,
            scheme,
            friction,
            explicit,
        }
    }

    /// The same with blocks as wide as the lowest, of as many elements along their sides, an even number, and of one material: nodes lie on nodes.
    pub fn matching(mut self) -> Model {
        let lowest = self.blocks[0].clone();
        for block in &mut self.blocks {
            (block.origin[0], block.size[0]) = (lowest.origin[0], lowest.size[0]);
            block.elements[0] = 2 * lowest.elements[0];
            block.young = lowest.young;
        }
        self
    }

    /// The same at small strain, without friction: which side of a contact is the secondary one does not matter where nodes stay on nodes.
    pub fn symmetric(mut self) -> Model {
        (self.finite, self.friction) = (false, 0.0);
        self.matching()
    }

    /// The same of blocks that fall on a plane together, matching.
    pub fn together(mut self) -> Model {
        self.on_plane = true;
        let velocity = [0.0, -SPEED];
        for block in &mut self.blocks {
            block.velocity = velocity;
        }
        self.matching()
    }

    /// Its blocks.
    pub fn blocks(&self) -> &[Block] {
        &self.blocks
    }

    /// Least speed of a block that falls, m/s.
    pub fn speed(&self) -> f64 {
        SPEED
    }

    /// Whether a change has it: explicit steps have no rigid bodies.
    pub fn takes(&self, bystander: Bystander) -> bool {
        !(self.explicit && bystander == Bystander::Rigid)
    }

    /// What its solves leave, relative.
    pub fn tolerance(&self) -> f64 {
        if self.finite { 1e-6 } else { 1e-9 }
    }

    /// Step, s.
    pub fn step(&self) -> f64 {
        if self.explicit { 2e-6 } else { 5e-6 }
    }

    /// End, s.
    pub fn end(&self) -> f64 {
        100.0 * self.step() + 6e-4
    }

    /// The case file; with a mesh of a file if there is one.
    pub fn text(&self, change: &Change, file: Option<&Path>) -> String {
        let mut meshes: Vec<String> = Vec::new();
        let mut tables: Vec<String> = Vec::new();
        meshes.extend(file.map(|file| format!("file = {file:?}")));
        for (k, block) in self.blocks.iter().enumerate() {
            let mut raised = block.clone();
            // upwards, and sideways by less
            raised.origin[0] += 0.3 * change.raised * (k * k) as f64;
            raised.origin[1] += change.raised * (k + 1) as f64;
            if file.is_none() {
                meshes.push(mesh(&change.block(k), &raised, change));
            }
            if k == 0 || change.meshed != Some(Meshed::Joined) {
                tables.push(self.body(&change.block(k), block, change));
            }
            if change.meshed == Some(Meshed::Split) {
                tables.push(self.body(&format!("b{k}r"), block, change));
            }
        }
        self.contacts(&mut tables, change);
        if let Some(bystander) = change.bystander {
            self.add(bystander, change, (&mut meshes, &mut tables));
        }
        format!(
            "carom = 1\n[mesh]\n{}\n{}\n[time]\nend = {:?}\nstep = {:?}\n{}\n{}\n",
            meshes.join("\n"),
            tables.join("\n"),
            change.scale * self.end(),
            change.scale * self.step(),
            self.scheme,
            // what iterations leave grows as much as rounding does: it must be as small
            if self.finite && !self.explicit {
                "newton.tolerance = 1e-12"
            } else {
                ""
            }
        )
    }

    fn body(&self, name: &str, block: &Block, change: &Change) -> String {
        let velocity = change.turn([block.velocity[0] + change.velocity, block.velocity[1]]);
        let kind = if self.finite { "neo-hooke" } else { "elastic" };
        format!(
            "[material.m{name}]\ndensity = 1000.0\n{kind} = {{ young = {:?}, poisson = 0.3 }}\n\
             [body.{name}]\nregion = \"{name}\"\nmaterial = \"m{name}\"\nsection.plane-strain.thickness = {:?}\n\
             initial.velocity = {velocity:?}",
            block.young, change.scale
        )
    }

    fn add(
        &self,
        bystander: Bystander,
        change: &Change,
        (meshes, tables): (&mut Vec<String>, &mut Vec<String>),
    ) {
        let block = Block {
            origin: [40.0, 30.0],
            size: [2.0, 1.0],
            elements: [2, 1],
            velocity: match bystander {
                Bystander::Loaded => [0.0; 2],
                Bystander::Strikes => [3.0, -50.0],
                _ => [30.0, 50.0],
            },
            young: 1e9,
        };
        meshes.push(mesh("z", &block, change));
        let mut body = self.body("z", &block, change);
        if bystander == Bystander::Rigid {
            body += "\nrigid = {}";
        }
        tables.push(body);
        if bystander == Bystander::Loaded {
            let load = "[load.z]\non = \"z.top\"\ntraction = [0.0, 1e6]";
            tables.push(load.to_owned());
        }
        if bystander == Bystander::Strikes {
            let bottom = change.side("bottom");
            tables.push(format!(
                "[contact.z]\nsecondary = \"z.{bottom}\"\nobstacle.plane = {{ point = {:?}, normal = {:?} }}\nlaw.velocity = {{}}\nfriction.coulomb = 0.3",
                change.place([40.0, 29.99]),
                change.turn([0.0, 1.0]),
            ));
        }
    }

    fn contacts(&self, tables: &mut Vec<String>, change: &Change) {
        let law = self
            .law
            .replace("STIFFNESS", &format!("{:?}", 1e10 / change.scale));
        let [top, bottom] = ["top", "bottom"].map(|side| change.side(side));
        let mut rest = law;
        if self.friction > 0.0 && !self.on_plane {
            let _ = write!(rest, "\nfriction.coulomb = {:?}", self.friction);
        }
        if self.on_plane {
            tables.push(format!(
                "[contact.{}]\nsecondary = \"{}.{bottom}\"\nobstacle.plane = {{ point = {:?}, normal = {:?} }}\n{rest}",
                change.contact(0),
                change.block(0),
                change.place([0.0, 0.0]),
                change.turn([0.0, 1.0]),
            ));
        }
        for k in 1..self.blocks.len() {
            let [upper, lower] = [k, k - 1].map(|k| change.block(k));
            let mut sides = [format!("{upper}.{bottom}"), format!("{lower}.{top}")];
            if change.swapped {
                sides.reverse();
            }
            let [secondary, primary] = sides;
            tables.push(format!(
                "[contact.{}]\nsecondary = \"{secondary}\"\nprimary = \"{primary}\"\n{rest}",
                change.contact(k)
            ));
        }
    }
}

fn mesh(name: &str, block: &Block, change: &Change) -> String {
    let far = [0, 1].map(|i| block.origin[i] + block.size[i]);
    let [one, other] = [block.origin, far].map(|x| change.place(x));
    let origin = [0, 1].map(|i| one[i].min(other[i]));
    let (mut size, mut elements) = (block.size.map(|x| change.scale * x), block.elements);
    if change.turned {
        size.reverse();
        elements.reverse();
    }
    format!(
        "generate.{name}.rectangle = {{ origin = {origin:?}, size = {size:?}, elements = {elements:?} }}"
    )
}
