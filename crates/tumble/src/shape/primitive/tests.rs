//! Meshes of the built-in shapes: closed, centred, accurate, evenly spread.

use std::f64::consts::PI;

use glam::DVec3;

use super::*;

fn mesh(shape: Primitive) -> Mesh {
    shape.mesh().unwrap()
}

fn defaults() -> impl Iterator<Item = Primitive> {
    Primitive::NAMES.into_iter().map(|name| Primitive::from_name(name).unwrap())
}

/// A copy with resolution `n`.
fn at(shape: Primitive, n: u32) -> Primitive {
    let mut shape = shape;
    match &mut shape {
        Primitive::Sphere { subdivisions: r, .. }
        | Primitive::Box { divisions: r, .. }
        | Primitive::THandle { divisions: r, .. }
        | Primitive::Cylinder { segments: r, .. }
        | Primitive::Capsule { segments: r, .. }
        | Primitive::Torus { segments: r, .. }
        | Primitive::Tube { segments: r, .. }
        | Primitive::Dumbbell { segments: r, .. }
        | Primitive::Knot { segments: r, .. } => *r = n,
        Primitive::Tetrahedron { .. } => {}
    }
    shape
}

#[test]
fn every_name_gives_the_shape_of_that_name() {
    for name in Primitive::NAMES {
        assert_eq!(Primitive::from_name(name).map(|s| s.name()), Some(name));
    }
    assert_eq!(Primitive::from_name("teapot"), None);
}

#[test]
fn defaults_have_the_documented_vertex_counts() {
    let counts: Vec<_> = defaults().map(|s| (s.name(), mesh(s).vertices.len())).collect();
    let expected = [
        ("sphere", 642),
        ("box", 8),
        ("cylinder", 830),
        ("capsule", 572),
        ("torus", 474),
        ("tube", 1344),
        ("dumbbell", 404),
        ("t-handle", 154),
        ("tetrahedron", 4),
        ("knot", 1332),
    ];
    assert_eq!(counts, expected);
    assert_eq!(mesh(Primitive::Sphere { radius: 1.0, subdivisions: 1 }).vertices.len(), 42);
    assert_eq!(mesh(Primitive::Box { size: DVec3::ONE, divisions: 5 }).vertices.len(), 152);
}

#[test]
fn all_meshes_are_closed_manifolds_wound_outwards_at_every_resolution() {
    for shape in defaults() {
        for n in [3, 4, 5, 6, 7, 13, 40] {
            let n = if matches!(shape, Primitive::Sphere { .. }) { n / 4 % 7 } else { n };
            let mesh = mesh(at(shape, n));
            let found = mesh.watertightness();
            assert!(found.is_manifold(), "{} at {n}: {found}", shape.name());
            assert_eq!(found.ignored_triangles, 0);
            // Euler: V − E + F = 2 − 2 genus, with E = 3F/2; it fails if there are duplicate vertices
            let euler = mesh.vertices.len() as i64 - mesh.triangles.len() as i64 / 2;
            let round = matches!(
                shape,
                Primitive::Torus { .. } | Primitive::Tube { .. } | Primitive::Knot { .. }
            );
            assert_eq!(euler, if round { 0 } else { 2 }, "{} at {n}", shape.name());
            assert!(signed_volume(&mesh) > 0.0, "{} at {n}", shape.name());
        }
    }
}

fn signed_volume(mesh: &Mesh) -> f64 {
    let corner = |i: u32| mesh.vertices[i as usize];
    let det = |t: &[u32; 3]| corner(t[0]).dot(corner(t[1]).cross(corner(t[2])));
    mesh.triangles.iter().map(det).sum::<f64>() / 6.0
}

#[test]
fn defaults_are_about_0_3_m_large_and_centred() {
    for shape in defaults() {
        let mesh = mesh(shape);
        let size = mesh.bounds().unwrap().size();
        assert!((0.2..0.35).contains(&size), "{} is {size} m large", shape.name());
        let centre = mesh.solid_integrals().unwrap().centre;
        assert!(centre.length() < 1e-15, "{}: {centre}", shape.name());
        // the mean of the vertices is at the origin too, except for the T-handle
        let mean = mesh.vertices.iter().sum::<DVec3>() / mesh.vertices.len() as f64;
        let uneven = matches!(shape, Primitive::THandle { .. });
        assert!(uneven || mean.length() < 1e-15, "{}: {mean}", shape.name());
    }
}

#[test]
fn the_principal_axes_of_the_defaults_are_the_coordinate_axes() {
    for shape in defaults() {
        let c = mesh(shape).solid_integrals().unwrap().second_moment;
        let scale = c.x_axis.x + c.y_axis.y + c.z_axis.z;
        let off = c.x_axis.y.abs().max(c.x_axis.z.abs()).max(c.y_axis.z.abs());
        assert!(off < 1e-14 * scale, "{}: {off}", shape.name());
        if matches!(shape.name(), "cylinder" | "capsule" | "torus" | "knot") {
            assert!((c.x_axis.x - c.z_axis.z).abs() < 1e-14 * scale, "{}", shape.name());
        }
    }
}

#[test]
fn the_t_handle_has_three_distinct_principal_moments() {
    let i = mesh(Primitive::from_name("t-handle").unwrap()).solid_integrals().unwrap().inertia();
    let (x, y, z) = (i.x_axis.x, i.y_axis.y, i.z_axis.z);
    assert!(y > 1.3 * x && z > 1.3 * y, "{x} {y} {z}");
}

#[test]
fn shapes_with_flat_faces_have_the_exact_volume_at_any_resolution() {
    for n in [1, 3, 10] {
        let size = DVec3::new(0.3, 0.2, 0.1);
        let volume = mesh(Primitive::Box { size, divisions: n }).solid_integrals().unwrap().measure;
        assert!((volume / 0.006 - 1.0).abs() < 1e-13);
        let t = Primitive::THandle { length: 0.3, width: 0.2, thickness: 0.05, divisions: n };
        let volume = mesh(t).solid_integrals().unwrap().measure;
        assert!((volume / (0.05 * 0.05 * 0.45) - 1.0).abs() < 1e-13);
    }
    let solid = mesh(Primitive::Tetrahedron { size: 2.0 }).solid_integrals().unwrap();
    assert!((solid.measure / (8.0 / (6.0 * 2f64.sqrt())) - 1.0).abs() < 1e-14);
}

#[test]
fn the_volume_of_round_shapes_converges_with_the_square_of_the_resolution() {
    let (r, h, b) = (0.06f64, 0.2f64, 0.02f64);
    let reach = (r * r - b * b).sqrt();
    let cap = r - reach;
    let knot_length = 15.949_138_7 * 0.09;
    let cases = [
        (Primitive::Cylinder { radius: r, height: h, segments: 0 }, PI * r * r * h),
        (
            Primitive::Capsule { radius: r, height: h, segments: 0 },
            PI * r * r * (h + 4.0 / 3.0 * r),
        ),
        (
            Primitive::Torus { radius: 0.1, tube_radius: 0.04, segments: 0 },
            2.0 * PI * PI * 0.1 * 0.04 * 0.04,
        ),
        (
            // Pappus: cross-section times the path of its centroid, for a frustum too
            Primitive::Tube {
                radius: 0.1,
                bottom_radius: 0.04,
                height: h,
                thickness: 0.02,
                segments: 0,
            },
            0.02 * h * 2.0 * PI * 0.08,
        ),
        (
            Primitive::Dumbbell { radius: r, length: h, bar_radius: b, segments: 0 },
            2.0 * (4.0 / 3.0 * PI * r * r * r - PI * cap * cap * (3.0 * r - cap) / 3.0)
                + PI * b * b * (h - 2.0 * reach),
        ),
        (
            // Pappus: cross-section times length of the centre line
            Primitive::Knot { radius: 0.09, tube_radius: 0.025, segments: 0 },
            PI * 0.025 * 0.025 * knot_length,
        ),
    ];
    for (shape, volume) in cases {
        let error = |n| 1.0 - mesh(at(shape, n)).solid_integrals().unwrap().measure / volume;
        // multiples of six, to which each shape rounds its counts
        let (coarse, fine) = (error(48), error(192));
        assert!(fine > 0.0 && fine < 3e-3, "{}: {fine}", shape.name());
        assert!((8.0..32.0).contains(&(coarse / fine)), "{}: {coarse} {fine}", shape.name());
    }
}

#[test]
fn the_volume_and_inertia_of_the_sphere_converge_with_the_square_of_the_edge_length() {
    let errors = |n| {
        let solid =
            mesh(Primitive::Sphere { radius: 1.0, subdivisions: n }).solid_integrals().unwrap();
        let inertia = solid.inertia().x_axis.x;
        (1.0 - solid.measure / (4.0 / 3.0 * PI), 1.0 - inertia / (8.0 / 15.0 * PI))
    };
    let ((v4, i4), (v5, i5)) = (errors(4), errors(5));
    assert!((v4 / v5 - 4.0).abs() < 0.02, "{v4} {v5}");
    assert!((i4 / i5 - 4.0).abs() < 0.02, "{i4} {i5}");
    assert!(i5 < 2e-3);
}

#[test]
fn vertices_are_spread_evenly() {
    for shape in defaults() {
        let mesh = mesh(at(
            shape,
            match shape {
                Primitive::Sphere { .. } => 3,
                Primitive::Box { .. } | Primitive::THandle { .. } => 4,
                Primitive::Knot { .. } => 12,
                _ => 48,
            },
        ));
        let (mut shortest, mut longest) = (f64::INFINITY, 0.0f64);
        for t in &mesh.triangles {
            let [a, b, c] = mesh.corners(*t).unwrap();
            for edge in [a.distance(b), b.distance(c), c.distance(a)] {
                (shortest, longest) = (shortest.min(edge), longest.max(edge));
            }
        }
        // diagonals of quadrilaterals are edges too
        let ratio = longest / shortest;
        let most =
            if matches!(shape, Primitive::Box { .. } | Primitive::Knot { .. }) { 5.0 } else { 2.4 };
        assert!(ratio < most, "{}: edges from {shortest} to {longest}", shape.name());
    }
}

#[test]
fn impossible_dimensions_are_refused_by_name() {
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e-200, 1e200] {
        let error =
            Primitive::Cylinder { radius: 0.1, height: bad, segments: 12 }.mesh().unwrap_err();
        assert!(matches!(error, PrimitiveError::Dimension { key: "height", .. }), "{error}");
    }
    let error =
        Primitive::Torus { radius: 0.1, tube_radius: 0.2, segments: 12 }.mesh().unwrap_err();
    assert_eq!(
        error.to_string(),
        "tube_radius of the torus is 0.2 m, but must be less than radius (0.1 m)"
    );
    let too_large = [
        Primitive::Torus { radius: 0.1, tube_radius: 0.1, segments: 12 },
        Primitive::Knot { radius: 0.1, tube_radius: 0.042, segments: 12 },
        Primitive::Dumbbell { radius: 0.1, length: 0.5, bar_radius: 0.1, segments: 12 },
        Primitive::Dumbbell { radius: 0.1, length: 0.1, bar_radius: 0.05, segments: 12 },
        Primitive::THandle { length: 0.1, width: 0.3, thickness: 0.1, divisions: 1 },
        Primitive::THandle { length: 0.3, width: 0.1, thickness: 0.1, divisions: 1 },
    ];
    for shape in too_large {
        let error = shape.mesh().unwrap_err();
        assert!(matches!(error, PrimitiveError::TooLarge { .. }), "{error}");
    }
    let error = Primitive::Capsule { radius: 1.0, height: 1e10, segments: 12 }.mesh().unwrap_err();
    assert!(matches!(error, PrimitiveError::Proportion { .. }), "{error}");
}

#[test]
fn impossible_resolutions_are_refused_before_allocating() {
    for shape in defaults().filter(|s| s.name() != "tetrahedron") {
        let error = at(shape, u32::MAX).mesh().unwrap_err();
        assert!(matches!(error, PrimitiveError::TooManyVertices { .. }), "{error}");
        if shape.name() != "sphere" {
            let error = at(shape, 0).mesh().unwrap_err();
            assert!(matches!(error, PrimitiveError::TooCoarse { .. }), "{error}");
        }
    }
    assert!(Primitive::Sphere { radius: 1.0, subdivisions: 10 }.mesh().is_err());
    // a long thin cylinder has too many rings
    let needle = Primitive::Cylinder { radius: 1e-8, height: 1.0, segments: 12 };
    assert!(matches!(needle.mesh(), Err(PrimitiveError::TooManyVertices { .. })));
}

#[test]
fn shapes_of_extreme_proportions_are_closed() {
    let shapes = [
        Primitive::Box { size: DVec3::new(1.0, 1e-9, 1e-3), divisions: 7 },
        Primitive::Cylinder { radius: 1.0, height: 1e-9, segments: 30 },
        Primitive::Torus { radius: 1.0, tube_radius: 1e-9, segments: 30 },
        Primitive::Torus { radius: 1.0, tube_radius: 0.999_99, segments: 300 },
        Primitive::Dumbbell { radius: 1.0, length: 0.2, bar_radius: 0.9999, segments: 60 },
        Primitive::THandle { length: 0.100_001, width: 0.100_001, thickness: 0.1, divisions: 3 },
        Primitive::Knot { radius: 1.0, tube_radius: 0.409, segments: 3 },
    ];
    for shape in shapes {
        let found = mesh(shape).watertightness();
        assert!(found.is_manifold() && found.ignored_triangles == 0, "{shape:?}: {found}");
    }
}
