//! Mass integrals and samplings of random meshes, against closed formulas.

use proptest::prelude::*;
use tumble::{DMat3, DQuat, DVec3, Mesh, Primitive, Sampling};

fn vector(range: std::ops::Range<f64>) -> impl Strategy<Value = DVec3> {
    [range.clone(), range.clone(), range].prop_map(DVec3::from_array)
}

fn rotation() -> impl Strategy<Value = DQuat> {
    (vector(-1.0..1.0), 0.0..6.3f64).prop_map(|(axis, angle)| {
        DQuat::from_axis_angle(axis.try_normalize().unwrap_or(DVec3::X), angle)
    })
}

fn placed(size: DVec3, divisions: u32, turn: DQuat, shift: DVec3) -> Mesh {
    let mut mesh = Primitive::Box { size, divisions }.mesh().expect("a box");
    for v in &mut mesh.vertices {
        *v = turn * *v + shift;
    }
    mesh
}

fn largest(m: DMat3) -> f64 {
    m.to_cols_array().iter().fold(0.0, |most, x| most.max(x.abs()))
}

proptest! {
    #[test]
    fn the_moments_of_a_box_rotate_with_it(
        size in vector(0.01..10.0),
        turn in rotation(),
        shift in vector(-100.0..100.0),
        divisions in 1u32..4,
    ) {
        let mesh = placed(size, divisions, turn, shift);
        let r = DMat3::from_quat(turn);
        let volume = size.x * size.y * size.z;

        // coordinates near 100 m are rounded to 1e-14 m, felt most by an edge of 0.01 m
        let solid = mesh.solid_integrals().unwrap();
        let own = DMat3::from_diagonal(volume / 12.0 * size * size);
        prop_assert!((solid.measure / volume - 1.0).abs() < 1e-10);
        prop_assert!((solid.centre - shift).length() < 1e-10);
        prop_assert!(largest(solid.second_moment - r * own * r.transpose()) < 1e-10 * largest(own));

        // a shell: each pair of faces lies half an edge from the centre along its own axis
        let shell = mesh.shell_integrals().unwrap();
        let area = DVec3::new(size.y * size.z, size.z * size.x, size.x * size.y) * 2.0;
        let total = area.element_sum();
        let own = (area / 4.0 + (DVec3::splat(total) - area) / 12.0) * size * size;
        prop_assert!((shell.measure / total - 1.0).abs() < 1e-10);
        let own = DMat3::from_diagonal(own);
        prop_assert!(largest(shell.second_moment - r * own * r.transpose()) < 1e-10 * largest(own));
    }

    #[test]
    fn samples_of_a_box_are_on_its_surface_or_inside(
        size in vector(0.1..1.0),
        turn in rotation(),
        shift in vector(-2.0..2.0),
        spacing in 0.05..0.2f64,
    ) {
        let mesh = placed(size, 1, turn, shift);
        let back = |p: &DVec3| (turn.inverse() * (*p - shift)).abs() - 0.5 * size;

        let surface = mesh.sample(Sampling::Surface { spacing }).unwrap();
        for (i, p) in surface.iter().enumerate() {
            prop_assert!(back(p).max_element().abs() < 1e-14);
            prop_assert!(surface[..i].iter().all(|q| p.distance(*q) > 0.79 * spacing));
        }

        // none outside, and as many as follow from the volume, up to a layer at the surface
        let inside = mesh.sample(Sampling::Volume { spacing }).unwrap_or_default();
        prop_assert!(inside.iter().all(|p| back(p).max_element() < 0.0));
        let volume = size.x * size.y * size.z;
        let area = 2.0 * (size.x * size.y + size.y * size.z + size.z * size.x);
        let off = inside.len() as f64 - volume / (spacing * spacing * spacing);
        prop_assert!(off.abs() < area / (spacing * spacing) + 8.0);
    }

    #[test]
    fn finite_meshes_never_cause_a_panic(
        vertices in prop::collection::vec(vector(-1e308..1e308), 1..12),
        scale in prop::sample::select(vec![1.0, 1e-100, 1e-300, 1e-308, 0.0]),
        triangles in prop::collection::vec([0u32..14, 0..14, 0..14], 0..12),
        spacing in prop::sample::select(vec![1e-300, 0.05, 0.3, 1.0, 1e9, 1e300]),
    ) {
        // built by hand, as `Mesh::new` would refuse triangles of missing vertices
        let vertices = vertices.into_iter().map(|v| v * scale).collect();
        let mesh = Mesh { vertices, triangles };
        let _ = mesh.watertightness().to_string();
        let _ = mesh.solid_integrals().map_err(|e| e.to_string());
        let _ = mesh.shell_integrals().map_err(|e| e.to_string());
        let _ = mesh.sample(Sampling::Surface { spacing }).map_err(|e| e.to_string());
        let _ = mesh.sample(Sampling::Volume { spacing }).map_err(|e| e.to_string());
    }

    #[test]
    fn lattice_points_are_exactly_those_inside_random_closed_meshes(
        corners in prop::collection::vec([-3i32..4, -3..4, -3..4], 4..40),
        spacing in prop::sample::select(vec![0.25, 0.5, 1.0, 0.37]),
    ) {
        // tetrahedra with integer coordinates, so that lines along the lattice often hit edges and vertices
        let mut mesh = Mesh::default();
        let mut solids = Vec::new();
        for four in corners.chunks_exact(4) {
            let [a, b, c, d] = [0, 1, 2, 3].map(|i| DVec3::from_array(four[i].map(f64::from)));
            let det = (b - a).cross(c - a).dot(d - a);
            if det == 0.0 {
                continue;
            }
            let four = if det > 0.0 { [a, b, c, d] } else { [a, c, b, d] };
            let start = mesh.vertices.len() as u32;
            mesh.vertices.extend(four);
            let faces = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]];
            mesh.triangles.extend(faces.map(|t| t.map(|i: u32| start + i)));
            solids.push(four);
        }
        prop_assume!(!solids.is_empty());

        // depth below the nearest face of a tetrahedron, from the faces' planes
        let depth = |p: DVec3, [a, b, c, d]: [DVec3; 4]| {
            [(a, c, b), (a, b, d), (b, c, d), (a, d, c)]
                .map(|(x, y, z)| (y - x).cross(z - x).normalize().dot(x - p))
                .into_iter()
                .fold(f64::INFINITY, f64::min)
        };
        let deepest = |p| solids.iter().map(|&s| depth(p, s)).fold(f64::NEG_INFINITY, f64::max);
        let near = |p| solids.iter().any(|&s| depth(p, s).abs() < 1e-4);

        let points = mesh.sample(Sampling::Volume { spacing }).unwrap_or_default();
        // points on a common wall may count either way
        prop_assert!(points.iter().all(|&p| deepest(p) > -1e-12));

        // none inside is missing: compare with a test of each lattice point
        let (mut min, mut max) = (mesh.vertices[0], mesh.vertices[0]);
        for v in &mesh.vertices {
            (min, max) = (min.min(*v), max.max(*v));
        }
        let counts = ((max - min) / spacing + 0.5).floor().max(DVec3::ONE);
        let at = |i: f64, j: f64, k: f64| {
            0.5 * (min + max) + spacing * (DVec3::new(i, j, k) - 0.5 * (counts - 1.0))
        };
        for i in 0..counts.x as u32 {
            for j in 0..counts.y as u32 {
                for k in 0..counts.z as u32 {
                    let p = at(f64::from(i), f64::from(j), f64::from(k));
                    if deepest(p) > 0.0 && !near(p) {
                        let found = points.iter().any(|q| q.distance(p) < 1e-9);
                        prop_assert!(found, "{p} is missing");
                    }
                }
            }
        }
    }
}
