#![allow(clippy::unwrap_used)]

use super::*;
use crate::contact_points::contact_points;
use crate::{MassModel, Mesh, Primitive, Sampling, Shape};

/// Energy and force, over k, of a point in a cube with an edge of 2 m.
fn contact(normals: &[DVec3], fade: f64, turn: DMat3, place: DVec3) -> (f64, DVec3) {
    let mesh = Primitive::Box { size: DVec3::splat(2.0), divisions: 1 }.mesh().unwrap();
    let mesh = SignedDistance::new(&mesh).unwrap();
    let nearest = mesh.query(place, 0, f64::INFINITY).unwrap();
    let point = SurfacePoint { half_segment: DVec3::ZERO, normals, fade };
    let contact = point.contact(&mesh, turn, place, &nearest);
    contact.map_or((0.0, DVec3::ZERO), |(_, PointContact { outward, depth, weight, .. })| {
        (0.5 * weight * depth * depth, outward * (weight * depth))
    })
}

#[test]
fn the_force_is_the_gradient_of_the_energy_everywhere_below_a_face_and_its_rim() {
    let sharp = [-DVec3::Y, DVec3::X, DVec3::Z];
    for (normals, fade) in [(&sharp[..1], 0.2), (&sharp[..], 0.0), (&sharp[1..2], 0.05)] {
        for place in [
            DVec3::new(0.3, 0.95, 0.1),
            DVec3::new(0.9, 0.95, 0.1),
            DVec3::new(0.98, 0.9, 0.1),
            DVec3::new(0.98, 0.97, 0.99),
            DVec3::new(0.7, 0.2, 0.3),
        ] {
            let turn = DMat3::from_rotation_z(0.02);
            let energy = |place| contact(normals, fade, turn, place).0;
            let (_, force) = contact(normals, fade, turn, place);
            for axis in DVec3::AXES {
                let h = axis * 1e-6;
                let slope = (energy(place - h) - energy(place + h)) / 2e-6;
                assert!((slope - force.dot(axis)).abs() < 1e-5, "{fade} {place} {force}");
            }
        }
    }
}

#[test]
fn a_flat_point_near_a_side_face_is_pushed_up_not_out() {
    // 0.01 below the top and 0.005 from the side: the nearest face is the side
    let place = DVec3::new(0.995, 0.99, 0.0);
    let (energy, force) = contact(&[-DVec3::Y], 0.005, DMat3::IDENTITY, place);
    assert!(energy > 0.0 && force.y > 0.0);
    // halfway through a fade of 0.5, half of the force is left
    let place = DVec3::new(0.75, 0.99, 0.0);
    let (_, force) = contact(&[-DVec3::Y], 0.5, DMat3::IDENTITY, place);
    assert!((force.y - 0.005).abs() < 1e-12 && force.x < 2e-4, "{force}");
}

#[test]
fn the_energy_is_continuous_as_the_point_turns() {
    let place = DVec3::new(0.97, 0.95, 0.1);
    let mut before = None;
    for step in 0..2000 {
        let turn = DMat3::from_rotation_z(f64::from(step) * 0.002);
        let (energy, _) = contact(&[-DVec3::Y], 0.01, turn, place);
        if let Some(before) = before {
            let change: f64 = energy - before;
            assert!(change.abs() < 4e-5, "{step}: {before} {energy}");
        }
        before = Some(energy);
    }
}

/// Two equal bodies that pass into each other and back, each pose a function of s from 0 to 1.
struct Passage {
    shape: Shape,
    points: ContactPoints,
    mesh: SignedDistance,
    direction: DVec3,
    axis: DVec3,
    start: f64,
    /// Distance of the centres at the deepest (m).
    closest: f64,
}

fn tetrahedron() -> Mesh {
    let corner = |x: f64, y: f64, z: f64| DVec3::new(x, y, z) * 0.25;
    Mesh {
        vertices: vec![
            corner(1.0, 1.0, 1.0),
            corner(1.0, -1.0, -1.0),
            corner(-1.0, 1.0, -1.0),
            corner(-1.0, -1.0, 1.0),
        ],
        triangles: vec![[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]],
    }
}

/// A prism with a U as its base.
fn trough() -> Mesh {
    let outline = [
        [0.0, 0.0],
        [0.4, 0.0],
        [0.4, 0.4],
        [0.3, 0.4],
        [0.3, 0.1],
        [0.1, 0.1],
        [0.1, 0.4],
        [0.0, 0.4],
    ];
    let base = [[0, 1, 4], [0, 4, 5], [1, 2, 3], [1, 3, 4], [0, 5, 6], [0, 6, 7]];
    let at = |z: f64| outline.map(|[x, y]| DVec3::new(x - 0.2, y - 0.2, z));
    let mut triangles: Vec<[u32; 3]> = Vec::new();
    for [a, b, c] in base {
        triangles.extend([[a, c, b], [a + 8, b + 8, c + 8]]);
    }
    for i in 0..8 {
        let j = (i + 1) % 8;
        triangles.extend([[i, j, j + 8], [i, j + 8, i + 8]]);
    }
    Mesh { vertices: [at(-0.2), at(0.2)].concat(), triangles }
}

impl Passage {
    /// Angle through which the body turns.
    const ANGLE: f64 = 0.6;

    fn new(mesh: &Mesh, closest: f64, run: u32) -> Self {
        let run = f64::from(run);
        let shape = Shape::from_mesh(mesh, Sampling::Vertices, MassModel::Solid);
        let shape = shape.unwrap();
        Self {
            points: contact_points(&shape),
            shape,
            mesh: SignedDistance::new(mesh).unwrap(),
            direction: DVec3::new(0.3 + 0.1 * run, -0.7, 0.5 - 0.2 * run).normalize(),
            axis: DVec3::new(-0.2, 0.9, 0.3 * run).normalize(),
            start: 0.7 * run,
            closest,
        }
    }

    fn pose(&self, s: f64) -> (DMat3, DVec3) {
        let turn = DMat3::from_axis_angle(self.axis, self.start + Self::ANGLE * s);
        (turn, self.direction * (0.2 * s.min(1.0 - s) - 0.1 - self.closest))
    }

    /// Energy, force and couple of one point, and the place of contact in the body.
    fn contact(&self, s: f64, index: u32) -> (f64, DVec3, DVec3, DVec3) {
        let (turn, shift) = self.pose(s);
        let all = self.points.points(&self.shape);
        let place = turn * all.get(index as usize) + shift;
        let nearest = self.mesh.query(place, 0, f64::INFINITY).unwrap();
        let point = SurfacePoint::new(&self.points, index);
        let touches = nearest.distance < point.half_segment.length();
        let found = touches.then(|| point.contact(&self.mesh, turn, place, &nearest));
        let Some((offset, contact)) = found.flatten() else {
            return (0.0, DVec3::ZERO, DVec3::ZERO, DVec3::ZERO);
        };
        let k = contact.weight * all.weight(index as usize);
        let force = contact.outward * (k * contact.depth);
        let in_body = turn.transpose() * (place + offset - shift);
        (0.5 * k * contact.depth * contact.depth, force, contact.couple, in_body)
    }
}

/// Checks that work and energy agree at every point that is never deeper than a limit (m); returns how many touched. Near the
/// middle of a tube, where all ways out are as long, an edge may have more extrema than the search finds.
fn compare_work_and_energy(passage: &Passage, deepest: f64) -> usize {
    const STEPS: u32 = 4000;
    let count = passage.points.points(&passage.shape).len() as u32;
    let mut touching = 0;
    for index in 0..count {
        let (mut highest, mut error) = (0.0f64, 0.0f64);
        if passage.contact(0.5, index).0 == 0.0 {
            continue;
        }
        let mut before = passage.contact(0.0, index);
        for step in 0..STEPS {
            let [s0, s1] = [step, step + 1].map(|s| f64::from(s) / f64::from(STEPS));
            let (a, b) = (before, passage.contact(s1, index));
            let ((turn0, shift0), (turn1, shift1)) = (passage.pose(s0), passage.pose(s1));
            let moved = |place: DVec3| turn1 * place + shift1 - (turn0 * place + shift0);
            let turned = passage.axis * (Passage::ANGLE / f64::from(STEPS));
            let work = a.1.dot(moved(a.3))
                + b.1.dot(moved(b.3))
                + (a.2 + b.2).dot(turned) * weight_of(passage, index);
            error += b.0 - a.0 + 0.5 * work;
            highest = highest.max(b.0);
            before = b;
        }
        if highest > 0.5 * deepest * deepest {
            continue;
        }
        touching += usize::from(highest > 0.0);
        let is_edge = passage.points.half_segment(index) != DVec3::ZERO;
        assert!(error.abs() < 2e-5 + 5e-3 * highest, "{index} {is_edge}: {error} {highest}");
    }
    touching
}

#[test]
fn the_work_at_convex_bodies_is_the_change_of_energy() {
    for run in 0..4 {
        let touching = compare_work_and_energy(&Passage::new(&tetrahedron(), 0.3, run), 0.2);
        assert!(touching > 1, "{touching}");
    }
}

#[test]
fn the_work_at_concave_bodies_is_the_change_of_energy() {
    let torus = |tube_radius, segments| {
        Primitive::Torus { radius: 0.2, tube_radius, segments }.mesh().unwrap()
    };
    for mesh in [trough(), torus(0.08, 8), torus(0.048, 30)] {
        for run in 0..2 {
            for closest in [0.1, 0.2, 0.4] {
                compare_work_and_energy(&Passage::new(&mesh, closest, run), 0.045);
            }
        }
    }
}

fn weight_of(passage: &Passage, index: u32) -> f64 {
    passage.points.points(&passage.shape).weight(index as usize)
}
