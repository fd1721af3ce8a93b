//! Two models in one mesh, their weighted forces, and dense solves.

use carom_arlequin::{Model, Models, Overlap, Row, Rows};
use carom_elements::{MAX_NODES, map};
use carom_mesh::{ElementId, Mesh, gather, generate};

/// SplitMix64. Steele, Lea and Flood (2014).
pub struct Random(pub u64);

impl Random {
    /// A number in [0, 1).
    pub fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// Two models in one mesh.
pub struct Pair {
    pub mesh: Mesh,
    pub inner: Vec<ElementId>,
    pub outer: Vec<ElementId>,
}

impl Pair {
    /// `inner` and `outer`: meshes whose cells are the group `cells`.
    pub fn new(inner: Mesh, outer: Mesh) -> Pair {
        let mut mesh = Mesh::new(inner.dim);
        let mut groups = Vec::new();
        for (name, part) in [("inner", inner), ("outer", outer)] {
            let mut part = part;
            let cells = part.groups["cells"].clone();
            part.groups.clear();
            part.groups.insert(name.to_owned(), cells);
            mesh.merge(name, part).unwrap();
            groups.push(mesh.groups[name].elements.clone());
        }
        let (inner, outer) = (groups[0].clone(), groups[1].clone());
        Pair { mesh, inner, outer }
    }

    pub fn models(&self) -> Models<'_> {
        Models {
            mesh: &self.mesh,
            inner: &self.inner,
            outer: &self.outer,
        }
    }

    /// Moves every node.
    pub fn mapped(mut self, map: impl Fn([f64; 3]) -> [f64; 3]) -> Pair {
        for x in &mut self.mesh.nodes {
            *x = map(*x);
        }
        self
    }
}

/// A bar on the first axis.
pub fn line(from: f64, to: f64, n: usize) -> Mesh {
    generate::line("cells", [from, 0.0, 0.0], [to, 0.0, 0.0], n, 1)
}

/// A rectangle from one corner to the other.
pub fn plate(from: [f64; 2], to: [f64; 2], n: [usize; 2], triangles: bool) -> Mesh {
    let size = [to[0] - from[0], to[1] - from[1]];
    generate::rectangle("cells", from, size, n, triangles)
}

/// A box from one corner to the other.
pub fn block(from: [f64; 3], to: [f64; 3], n: [usize; 3], tets: bool) -> Mesh {
    let size = [0, 1, 2].map(|i| to[i] - from[i]);
    generate::box_("cells", from, size, n, tets)
}

/// Keeps the cells whose middle passes a test.
pub fn keep(mut mesh: Mesh, test: impl Fn([f64; 3]) -> bool) -> Mesh {
    let middle = |id: ElementId| {
        let mut x = [[0.0; 3]; MAX_NODES];
        let x = gather(&mesh.nodes, mesh.element_nodes(id), &mut x);
        [0, 1, 2].map(|i| x.iter().map(|x| x[i]).sum::<f64>() / x.len() as f64)
    };
    let mut group = mesh.groups["cells"].clone();
    group.elements.retain(|&id| test(middle(id)));
    mesh.groups.insert("cells".to_owned(), group);
    mesh
}

/// Calls `each(cell position, N, dN/dx, weight)` at the points of the stiffness rule (or the mass rule) of some cells.
pub fn at_points(
    mesh: &Mesh,
    cells: &[ElementId],
    mass: bool,
    mut each: impl FnMut(usize, &[f64], &[[f64; 3]], f64),
) {
    for (i, &id) in cells.iter().enumerate() {
        let table = mesh.kind(id).table();
        let rule = if mass {
            table.mass_rule
        } else {
            table.stiffness_rule
        };
        let mut x = [[0.0; 3]; MAX_NODES];
        let x = gather(&mesh.nodes, mesh.element_nodes(id), &mut x);
        let (mut n, mut dn, mut g) = (
            [0.0; MAX_NODES],
            [[0.0; 3]; MAX_NODES],
            [[0.0; 3]; MAX_NODES],
        );
        for (xi, w) in rule.points.iter().zip(rule.weights) {
            (table.shape)(xi, &mut n[..table.nodes]);
            (table.gradient)(xi, &mut dn[..table.nodes]);
            let (j, det) = map::jacobian(x, &dn[..table.nodes], table.dim);
            map::physical_gradient(&j, det, &dn[..table.nodes], &mut g[..table.nodes]);
            each(i, &n[..table.nodes], &g[..table.nodes], w * det.abs());
        }
    }
}

/// Nodal values of a cell within flat per-cell values.
pub struct Flat<'a> {
    starts: Vec<usize>,
    values: &'a [f64],
}

impl<'a> Flat<'a> {
    pub fn new(mesh: &Mesh, cells: &[ElementId], values: &'a [f64]) -> Flat<'a> {
        let mut starts = vec![0];
        for &id in cells {
            starts.push(starts[starts.len() - 1] + mesh.kind(id).table().nodes);
        }
        assert_eq!(starts[cells.len()], values.len());
        Flat { starts, values }
    }

    pub fn of(&self, cell: usize) -> &'a [f64] {
        &self.values[self.starts[cell]..self.starts[cell + 1]]
    }

    /// The weight at a point with these shape functions.
    pub fn at(&self, cell: usize, n: &[f64]) -> f64 {
        self.of(cell).iter().zip(n).map(|(w, n)| w * n).sum()
    }
}

/// Weighted internal forces of a constant stress, f_a = ∫ δ σ ∇N_a, three numbers per node of the mesh.
pub fn internal_forces(
    mesh: &Mesh,
    cells: &[ElementId],
    delta: &[f64],
    stress: &[[f64; 3]; 3],
) -> Vec<f64> {
    let delta = Flat::new(mesh, cells, delta);
    let mut force = vec![0.0; 3 * mesh.nodes.len()];
    at_points(mesh, cells, false, |i, n, g, w| {
        let weight = w * delta.at(i, n);
        for (&node, g) in mesh.element_nodes(cells[i]).iter().zip(g) {
            for k in 0..3 {
                let s: f64 = (0..3).map(|j| stress[k][j] * g[j]).sum();
                force[3 * node as usize + k] += weight * s;
            }
        }
    });
    force
}

/// Coefficients (unknown, coefficient) of a row in the residual f_c - C_cᵀ L, f_s + C_sᵀ L.
pub fn entries(row: &Row) -> Vec<(usize, f64)> {
    let key = |t: &carom_arlequin::Term| 3 * t.node as usize + t.component as usize;
    let inner = row.inner.iter().map(|t| (key(t), t.coefficient));
    let outer = row.outer.iter().map(|t| (key(t), -t.coefficient));
    inner.chain(outer).collect()
}

/// Least residual |f - Cᵀ L| over L, on the unknowns that count, over |f| of the largest: conjugate gradients on the
/// normal equations.
pub fn imbalance(rows: &Rows, force: &[f64], counts: &[bool]) -> f64 {
    let lists: Vec<Vec<(usize, f64)>> = rows
        .rows
        .iter()
        .map(|row| entries(row).into_iter().filter(|e| counts[e.0]).collect())
        .collect();
    let mut r: Vec<f64> = force
        .iter()
        .zip(counts)
        .map(|(f, c)| if *c { *f } else { 0.0 })
        .collect();
    let largest = force.iter().fold(0.0, |m: f64, f| m.max(f.abs()));
    let apply = |r: &[f64]| -> Vec<f64> {
        lists
            .iter()
            .map(|l| l.iter().map(|e| e.1 * r[e.0]).sum())
            .collect()
    };
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let mut s = apply(&r);
    let mut p = s.clone();
    let mut gamma = dot(&s, &s);
    let first = gamma;
    for _ in 0..2000 {
        if gamma <= 1e-30 * first {
            break;
        }
        let mut q = vec![0.0; r.len()];
        for (list, p) in lists.iter().zip(&p) {
            list.iter().for_each(|e| q[e.0] += e.1 * p);
        }
        let alpha = gamma / dot(&q, &q);
        r.iter_mut().zip(&q).for_each(|(r, q)| *r -= alpha * q);
        s = apply(&r);
        let next = dot(&s, &s);
        p.iter_mut()
            .zip(&s)
            .for_each(|(p, s)| *p = s + next / gamma * *p);
        gamma = next;
    }
    r.iter().fold(0.0, |m: f64, f| m.max(f.abs())) / largest
}

/// Residual |f - Cᵀ L| over the largest |f|, on the unknowns that count, for the best L that is the same at every
/// mediator node.
pub fn imbalance_of_constant(rows: &Rows, force: &[f64], counts: &[bool], dim: usize) -> f64 {
    let mut columns = vec![vec![0.0; force.len()]; dim];
    for row in &rows.rows {
        for (key, value) in entries(row).into_iter().filter(|e| counts[e.0]) {
            columns[row.component as usize][key] += value;
        }
    }
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let gram = columns
        .iter()
        .map(|a| columns.iter().map(|b| dot(a, b)).collect());
    let right = columns.iter().map(|a| dot(a, force));
    let multiplier = solve(gram.collect(), right.collect());
    let largest = force.iter().fold(0.0, |m: f64, f| m.max(f.abs()));
    let left = (0..force.len()).filter(|&i| counts[i]).map(|i| {
        let carried: f64 = columns.iter().zip(&multiplier).map(|(c, l)| c[i] * l).sum();
        (force[i] - carried).abs()
    });
    left.fold(0.0, f64::max) / largest
}

/// Solution of a dense system by Gauss elimination with row pivoting.
pub fn solve(mut a: Vec<Vec<f64>>, mut b: Vec<f64>) -> Vec<f64> {
    let n = b.len();
    for k in 0..n {
        let pivot = (k..n)
            .max_by(|&i, &j| a[i][k].abs().total_cmp(&a[j][k].abs()))
            .unwrap();
        a.swap(k, pivot);
        b.swap(k, pivot);
        let (top, rest) = a.split_at_mut(k + 1);
        let row = &top[k];
        for (i, other) in rest.iter_mut().enumerate() {
            let factor = other[k] / row[k];
            if factor != 0.0 {
                (k..n).for_each(|j| other[j] -= factor * row[j]);
                b[k + 1 + i] -= factor * b[k];
            }
        }
    }
    for k in (0..n).rev() {
        let known: f64 = (k + 1..n).map(|j| a[k][j] * b[j]).sum();
        b[k] = (b[k] - known) / a[k][k];
    }
    b
}

/// A scalar field on two coupled models, at rest: ∫ δ ∇u·∇v with the rows of the first component, u given at some nodes.
/// Returns u at every node of the mesh.
pub fn at_rest(
    overlap: &Overlap,
    deltas: [&[f64]; 2],
    rows: &Rows,
    given: impl Fn(u32, [f64; 3]) -> Option<f64>,
) -> Vec<f64> {
    let mesh = overlap.mesh();
    let mut number = vec![usize::MAX; mesh.nodes.len()];
    let mut n = 0;
    for model in [Model::Inner, Model::Outer] {
        for &node in overlap
            .cells(model)
            .iter()
            .flat_map(|&id| mesh.element_nodes(id))
        {
            if number[node as usize] == usize::MAX {
                number[node as usize] = n;
                n += 1;
            }
        }
    }
    let rows: Vec<&Row> = rows.rows.iter().filter(|row| row.component == 0).collect();
    let mut a = vec![vec![0.0; n + rows.len()]; n + rows.len()];
    let mut b = vec![0.0; n + rows.len()];
    for (model, delta) in [Model::Inner, Model::Outer].into_iter().zip(deltas) {
        let cells = overlap.cells(model);
        let delta = Flat::new(mesh, cells, delta);
        at_points(mesh, cells, false, |i, shape, g, w| {
            let weight = w * delta.at(i, shape);
            let nodes = mesh.element_nodes(cells[i]);
            for (p, gp) in nodes.iter().zip(g) {
                for (q, gq) in nodes.iter().zip(g) {
                    let product: f64 = (0..3).map(|k| gp[k] * gq[k]).sum();
                    a[number[*p as usize]][number[*q as usize]] += weight * product;
                }
            }
        });
    }
    for (i, row) in rows.iter().enumerate() {
        for (key, value) in entries(row).into_iter().filter(|e| e.0 % 3 == 0) {
            let at = number[key / 3];
            a[n + i][at] += value;
            a[at][n + i] += value;
        }
    }
    for (node, &at) in number
        .iter()
        .enumerate()
        .filter(|(_, at)| **at != usize::MAX)
    {
        if let Some(value) = given(node as u32, mesh.nodes[node]) {
            a[at] = vec![0.0; n + rows.len()];
            a[at][at] = 1.0;
            b[at] = value;
        }
    }
    let x = solve(a, b);
    number
        .iter()
        .map(|&at| if at == usize::MAX { 0.0 } else { x[at] })
        .collect()
}

/// Largest error of the gradient of a field in the cells of both models, and its mean square root over both.
pub fn gradient_error(overlap: &Overlap, u: &[f64], exact: [f64; 3]) -> (f64, f64) {
    let mesh = overlap.mesh();
    let (mut worst, mut squares, mut volume) = (0.0f64, 0.0, 0.0);
    for model in [Model::Inner, Model::Outer] {
        let cells = overlap.cells(model);
        at_points(mesh, cells, true, |i, _, g, w| {
            let nodes = mesh.element_nodes(cells[i]);
            let du = [0, 1, 2].map(|k| {
                let sum = nodes
                    .iter()
                    .zip(g)
                    .map(|(&node, g)| u[node as usize] * g[k]);
                sum.sum::<f64>() - exact[k]
            });
            let square: f64 = du.iter().map(|d| d * d).sum();
            worst = worst.max(square.sqrt());
            squares += w * square;
            volume += w;
        });
    }
    (worst, (squares / volume).sqrt())
}
