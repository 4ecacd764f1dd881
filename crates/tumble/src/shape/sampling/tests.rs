use super::*;
use crate::shape::Primitive;
use glam::DQuat;

fn named(name: &str) -> Mesh {
    Primitive::from_name(name).unwrap().mesh().unwrap()
}

fn on_surface(mesh: &Mesh, spacing: f64) -> Vec<DVec3> {
    mesh.sample(Sampling::Surface { spacing }).unwrap()
}

fn inside(mesh: &Mesh, spacing: f64) -> Vec<DVec3> {
    mesh.sample(Sampling::Volume { spacing }).unwrap()
}

fn mapped(mesh: &Mesh, map: impl Fn(DVec3) -> DVec3) -> Mesh {
    Mesh {
        vertices: mesh.vertices.iter().map(|&v| map(v)).collect(),
        triangles: mesh.triangles.clone(),
    }
}

fn nearest(points: &[DVec3], place: DVec3) -> f64 {
    points.iter().map(|p| p.distance(place)).fold(f64::INFINITY, f64::min)
}

#[test]
fn vertex_sampling_returns_the_vertices_in_order() {
    let mesh = named("box");
    assert_eq!(mesh.sample(Sampling::Vertices).unwrap(), mesh.vertices);
}

#[test]
fn surface_points_keep_the_minimum_distance_and_cover_the_surface() {
    for (name, spacing) in [("box", 0.02), ("sphere", 0.03), ("knot", 0.02), ("t-handle", 0.013)] {
        let mesh = named(name);
        let points = on_surface(&mesh, spacing);
        for (i, p) in points.iter().enumerate() {
            assert!(nearest(&points[..i], *p) >= 0.8 * spacing * (1.0 - 1e-12), "{name}");
        }
        // probe corners, edges and middles, and a spread within each triangle
        let steps = 12;
        for t in &mesh.triangles {
            let [a, b, c] = mesh.corners(*t).unwrap();
            for i in 0..=steps {
                for j in 0..=steps - i {
                    let (u, v) = (i as f64 / steps as f64, j as f64 / steps as f64);
                    let hole = nearest(&points, a + (b - a) * u + (c - a) * v);
                    assert!(hole <= 0.9 * spacing, "{name}: {hole}");
                }
            }
        }
    }
}

#[test]
fn surface_points_lie_on_the_surface_with_the_documented_density() {
    let mesh = Primitive::Box { size: DVec3::ONE, divisions: 1 }.mesh().unwrap();
    let spacing = 0.02;
    let points = on_surface(&mesh, spacing);
    assert!(points.iter().all(|p| (p.abs().max_element() - 0.5).abs() < 1e-15));
    let density = points.len() as f64 * spacing * spacing / 6.0;
    assert!((1.0..1.2).contains(&density), "{density}");
    // evenly: each face has its sixth, and the centre stays at the centre
    let top = points.iter().filter(|p| p.y > 0.499_999).count() as f64;
    assert!((top / points.len() as f64 * 6.0 - 1.0).abs() < 0.03, "{top}");
    let mean = points.iter().sum::<DVec3>() / points.len() as f64;
    assert!(mean.length() < 0.003, "{mean}");
}

#[test]
fn the_density_of_surface_points_does_not_depend_on_the_triangulation() {
    let coarse =
        on_surface(&Primitive::Box { size: DVec3::ONE, divisions: 1 }.mesh().unwrap(), 0.05);
    let fine =
        on_surface(&Primitive::Box { size: DVec3::ONE, divisions: 200 }.mesh().unwrap(), 0.05);
    let ratio = fine.len() as f64 / coarse.len() as f64;
    assert!((ratio - 1.0).abs() < 0.1, "{ratio}");
    // a fan of slivers on a square
    let n = 1000;
    let mut vertices = vec![DVec3::ZERO];
    vertices.extend((0..=n).map(|i| DVec3::new(1.0, i as f64 / n as f64, 0.0)));
    let fan = Mesh::new(vertices, (1..=n).map(|i| [0, i, i + 1]).collect()).unwrap();
    let density = on_surface(&fan, 0.02).len() as f64 * 4e-4 / 0.5;
    assert!((1.0..1.2).contains(&density), "{density}");
}

#[test]
fn a_spacing_larger_than_the_mesh_gives_one_surface_point() {
    assert_eq!(on_surface(&named("sphere"), 10.0).len(), 1);
    assert_eq!(on_surface(&named("sphere"), 1e300).len(), 1);
}

#[test]
fn surface_points_translate_rotate_and_scale_with_the_mesh() {
    let turn = DQuat::from_axis_angle(DVec3::new(3.0, -1.0, 2.0).normalize(), 1.1);
    let shift = DVec3::new(4.0, -5.0, 6.0);
    for name in ["box", "sphere", "torus"] {
        let mesh = named(name);
        let points = on_surface(&mesh, 0.03);
        for scale in [1e-6, 1.0, 1e6] {
            let map = |v: DVec3| scale * (turn * v + shift);
            let images = on_surface(&mapped(&mesh, map), 0.03 * scale);
            assert_eq!(images.len(), points.len(), "{name} at {scale}");
            let far = |(p, q): (&DVec3, &DVec3)| map(*p).distance(*q) > 1e-12 * scale;
            assert!(!points.iter().zip(&images).any(far), "{name} at {scale}");
        }
    }
}

#[test]
fn sampling_is_reproducible_and_scales_exactly_by_powers_of_two() {
    for name in ["t-handle", "capsule"] {
        let mesh = named(name);
        for scale in [2f64.powi(-20), 2f64.powi(20)] {
            let scaled = mapped(&mesh, |v| scale * v);
            for make in
                [|spacing| Sampling::Surface { spacing }, |spacing| Sampling::Volume { spacing }]
            {
                let points = mesh.sample(make(0.017)).unwrap();
                assert_eq!(points, mesh.sample(make(0.017)).unwrap());
                let back: Vec<DVec3> = scaled
                    .sample(make(0.017 * scale))
                    .unwrap()
                    .iter()
                    .map(|p| *p / scale)
                    .collect();
                assert_eq!(points, back, "{name}");
            }
        }
    }
}

#[test]
fn a_box_is_filled_layer_by_layer() {
    let mesh = named("box");
    // 0.3 × 0.2 × 0.1 at 0.01: no layer lost or doubled at the faces
    assert_eq!(inside(&mesh, 0.01).len(), 30 * 20 * 10);
    assert_eq!(inside(&mesh, 0.1).len(), 3 * 2);
    assert_eq!(inside(&mesh, 10.0), [DVec3::ZERO]);
    assert_eq!(inside(&mesh, 1e300), [DVec3::ZERO]);
}

#[test]
fn lattices_through_edges_and_walls_stay_symmetric_and_outside_the_surface() {
    // an octahedron's edges and vertices lie on the lattice's own lines; |x|+|y|+|z| < 1 is its inside
    let axes = [DVec3::X, DVec3::Y, DVec3::Z, DVec3::NEG_X, DVec3::NEG_Y, DVec3::NEG_Z];
    let faces =
        [[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2], [1, 0, 5], [3, 1, 5], [4, 3, 5], [0, 4, 5]];
    let mesh = Mesh::new(axes.to_vec(), faces.to_vec()).unwrap();
    for layers in [1i32, 2, 3, 4, 7, 8, 20, 31] {
        let sampling = Sampling::Volume { spacing: 2.0 / f64::from(layers) };
        // at two layers all eight points lie outside
        let points = mesh.sample(sampling).unwrap_or_default();
        // in units of half a spacing, whole numbers decide
        let at = |i: i32| 2 * i - (layers - 1);
        let mut expected = 0;
        for i in 0..layers {
            for j in 0..layers {
                expected += (0..layers)
                    .filter(|&k| at(i).abs() + at(j).abs() + at(k).abs() < layers)
                    .count();
            }
        }
        assert_eq!(points.len(), expected, "{layers} layers");
        assert!(points.iter().sum::<DVec3>().length() < 1e-12);
    }
    // walls of the T's handle on a lattice plane: both count as outside, or neither
    let mean: DVec3 = inside(&named("t-handle"), 0.05).iter().sum();
    assert!(mean.x.abs() < 1e-15 && mean.z.abs() < 1e-15, "{mean}");
}

#[test]
fn the_number_of_lattice_points_follows_from_the_volume_in_any_orientation() {
    for name in ["sphere", "cylinder", "torus", "knot", "dumbbell", "t-handle", "tetrahedron"] {
        for angle in [0.0, 0.3, 2.0] {
            let turn = DQuat::from_axis_angle(DVec3::new(1.0, 2.0, -1.0).normalize(), angle);
            let mesh = mapped(&named(name), |v| turn * v);
            let volume = mesh.solid_integrals().unwrap().measure;
            let spacing = libm::cbrt(volume / 20_000.0);
            let count = inside(&mesh, spacing).len() as f64;
            assert!((count / 20_000.0 - 1.0).abs() < 0.03, "{name}: {count}");
        }
    }
}

#[test]
fn lattice_points_in_a_sphere_are_those_within_its_radius() {
    let radius = 0.15;
    let mesh = Primitive::Sphere { radius, subdivisions: 5 }.mesh().unwrap();
    let points = inside(&mesh, 0.01);
    assert!(points.iter().all(|p| p.length() < radius));
    let mut expected = 0;
    let at = |i: i32| 0.01 * (f64::from(i) - 14.5);
    for i in 0..30 {
        for j in 0..30 {
            // the facets lie at most 0.03 % below the sphere
            expected += (0..30)
                .filter(|&k| DVec3::new(at(i), at(j), at(k)).length() < 0.9997 * radius)
                .count();
        }
    }
    assert_eq!(points.len(), expected);
}

#[test]
fn cavities_are_empty_overlaps_count_once_and_the_winding_does_not_matter() {
    let cube = |size| Primitive::Box { size: DVec3::splat(size), divisions: 2 }.mesh().unwrap();
    let joined =
        |a: &Mesh, b: &Mesh, turned: bool| {
            let n = a.vertices.len() as u32;
            let mut mesh = a.clone();
            mesh.vertices.extend(&b.vertices);
            mesh.triangles.extend(b.triangles.iter().map(|&[p, q, r]| {
                if turned { [p + n, r + n, q + n] } else { [p + n, q + n, r + n] }
            }));
            mesh
        };
    let hollow = joined(&cube(1.0), &cube(0.5), true);
    // the cavity's walls lie on the lattice, and so outside
    assert_eq!(inside(&hollow, 0.1).len(), 1000 - 6 * 6 * 6);
    let double = joined(&cube(1.0), &cube(0.5), false);
    assert_eq!(inside(&double, 0.1).len(), 1000);
    let inward = mapped(&cube(1.0), |v| -v);
    assert_eq!(inside(&inward, 0.1).len(), 1000);
}

#[test]
fn impossible_samplings_are_refused_with_a_suggestion() {
    let mesh = named("torus");
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        for sampling in [Sampling::Surface { spacing: bad }, Sampling::Volume { spacing: bad }] {
            assert!(matches!(mesh.sample(sampling), Err(SampleError::Spacing { .. })));
        }
    }

    // the hole of the torus: the suggestion must do
    let error = mesh.sample(Sampling::Volume { spacing: 1.0 }).unwrap_err();
    let SampleError::NoPoints { would_do: Some(would_do), .. } = error else { panic!("{error}") };
    assert!(!inside(&mesh, would_do).is_empty());

    // too fine: refused at once, and the suggestion passes the same check
    for make in [|spacing| Sampling::Surface { spacing }, |spacing| Sampling::Volume { spacing }] {
        for spacing in [1e-5, 1e-30, 1e-300] {
            let error = mesh.sample(make(spacing)).unwrap_err();
            let SampleError::TooMany { would_do, .. } = error else { panic!("{error}") };
            assert!(would_do > spacing && would_do < 0.01, "{error}");
        }
    }

    let mut open = mesh.clone();
    open.triangles.pop();
    let error = open.sample(Sampling::Volume { spacing: 0.01 }).unwrap_err();
    assert!(error.to_string().contains("3 open and 0 wrongly wound edges"), "{error}");
    assert!(open.sample(Sampling::Surface { spacing: 0.01 }).is_ok());

    let cloud = Mesh::new(vec![DVec3::ZERO], vec![]).unwrap();
    let error = cloud.sample(Sampling::Surface { spacing: 1.0 }).unwrap_err();
    assert_eq!(error, SampleError::NoSurface);
}

#[test]
fn sizes_beyond_the_range_of_doubles_are_refused() {
    for scale in [1e-200, 1e150, 1e300] {
        let mesh = mapped(&named("box"), |v| scale * v);
        for sampling in [Sampling::Surface { spacing: scale }, Sampling::Volume { spacing: scale }]
        {
            assert!(mesh.sample(sampling).is_err());
        }
    }
}
