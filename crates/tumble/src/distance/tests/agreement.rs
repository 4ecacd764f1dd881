//! Distance, sign, gradient and closest triangle against independent computations.

use fearless_simd::Level;

use super::*;

/// Distance and sign at many points of a mesh, against loops over all triangles.
fn check(mesh: &Mesh, count: usize, seed: u64) {
    let distance = SignedDistance::new(mesh).unwrap();
    let (low, high) = distance.bounds();
    let size = (high - low).max_element();
    for p in points(mesh, count, seed) {
        let found = distance.query(p, NO_HINT, f64::INFINITY).unwrap();
        let plain = plain_distance(mesh, p);
        let error = (found.distance.abs() - plain).abs();
        assert!(error <= 1e-14 * size, "{p}: {} and {plain}", found.distance);
        let corners = mesh.triangles[found.triangle as usize].map(|i| mesh.vertices[i as usize]);
        assert!((to_triangle(p, corners) - plain).abs() <= 1e-14 * size, "{p}");
        assert!((found.gradient.length() - 1.0).abs() < 1e-12, "{p}: {}", found.gradient);
        if plain > 1e-12 * size {
            assert_eq!(found.distance < 0.0, plain_inside(mesh, p), "{p}: {}", found.distance);
            // the closest point is on the surface
            let foot = p - found.gradient * found.distance;
            assert!(plain_distance(mesh, foot) <= 1e-13 * size, "{p}");
        }
    }
}

#[test]
fn primitives_agree_with_plain_loops() {
    for name in Primitive::NAMES {
        check(&primitive(name), 300, 7);
    }
}

#[test]
fn rotated_and_translated_primitives_agree_with_plain_loops() {
    for name in ["box", "tetrahedron", "t-handle", "knot"] {
        check(&moved(&primitive(name), |v| turn() * v), 300, 3);
        check(&moved(&primitive(name), |v| turn() * v + DVec3::new(1.0, -0.7, 0.3)), 300, 5);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn stars_agree_with_plain_loops(seed in 1u64..) {
        check(&star(seed), 120, seed);
    }

    #[test]
    fn hints_simd_levels_and_the_grid_do_not_change_any_bit(seed in 1u64.., hints in prop::collection::vec(any::<u32>(), 8)) {
        let mesh = star(seed);
        let mut distance = SignedDistance::new(&mesh).unwrap();
        for p in points(&mesh, 60, seed) {
            for within in [f64::INFINITY, 0.1, 0.0] {
                let bits = |n: Option<Nearest>| n.map(|n| {
                    let [x, y, z] = n.gradient.to_array().map(f64::to_bits);
                    (n.distance.to_bits(), x, y, z, n.triangle)
                });
                distance.level = Level::new();
                let plain = bits(distance.query(p, NO_HINT, within));
                for &hint in &hints {
                    let hint = if hint % 4 == 0 { hint } else { hint % 400 };
                    prop_assert_eq!(bits(distance.query(p, hint, within)), plain);
                }
                for level in crate::lanes::levels() {
                    distance.level = level;
                    prop_assert_eq!(bits(distance.query(p, hints[0] % 320, within)), plain);
                }
                // nor does the grid
                let grid = distance.grid.take();
                prop_assert_eq!(bits(distance.query(p, NO_HINT, within)), plain);
                distance.grid = grid;
            }
        }
    }

    #[test]
    fn distances_scale_exactly_by_powers_of_two(seed in 1u64.., exponent in -40i32..40) {
        let mesh = star(seed);
        let factor = libm::ldexp(1.0, exponent);
        let scaled = SignedDistance::new(&moved(&mesh, |v| v * factor)).unwrap();
        let plain = SignedDistance::new(&mesh).unwrap();
        prop_assert_eq!(scaled.thickness(), plain.thickness() * factor);
        for p in points(&mesh, 60, seed) {
            let a = plain.query(p, NO_HINT, 0.3);
            let b = scaled.query(p * factor, NO_HINT, 0.3 * factor);
            let a = a.map(|n| Nearest { distance: n.distance * factor, ..n });
            prop_assert_eq!(a, b);
        }
    }

    #[test]
    fn the_gradient_agrees_with_finite_differences(seed in 1u64.., p in vector()) {
        let distance = SignedDistance::new(&star(seed)).unwrap();
        let at = |p: DVec3| distance.query(1.5 * p, NO_HINT, f64::INFINITY).unwrap();
        let here = at(p);
        let step = 1e-6;
        let slope = |axis: DVec3| (at(p + axis * step).distance - at(p - axis * step).distance) / (3.0 * step);
        let slope = DVec3::new(slope(DVec3::X), slope(DVec3::Y), slope(DVec3::Z));
        // the gradient is discontinuous where the closest point jumps
        let near = [DVec3::X, DVec3::Y, DVec3::Z].iter().any(|&axis| {
            [axis, -axis].iter().any(|&a| at(p + a * step).gradient.distance(here.gradient) > 1e-3)
        });
        prop_assume!(!near && here.distance.abs() > 1e-4);
        prop_assert!(slope.distance(here.gradient) < 1e-3, "{} and {}", slope, here.gradient);
    }

    #[test]
    fn the_result_is_none_beyond_the_limit(seed in 1u64.., within in 0.0..1.0f64) {
        let mesh = star(seed);
        let distance = SignedDistance::new(&mesh).unwrap();
        for p in points(&mesh, 60, seed) {
            let all = distance.query(p, NO_HINT, f64::INFINITY).unwrap();
            let some = distance.query(p, NO_HINT, within);
            prop_assert_eq!(some, (all.distance <= within).then_some(all));
            prop_assert_eq!(distance.is_ball_outside(p, within), all.distance > within);
        }
    }
}

#[test]
fn the_distance_to_a_rotated_box_is_exact() {
    let size = DVec3::new(0.3, 0.2, 0.1);
    let mesh = Primitive::Box { size, divisions: 3 }.mesh().unwrap();
    let distance = SignedDistance::new(&moved(&mesh, |v| turn() * v)).unwrap();
    let mut state = 5;
    for _ in 0..2000 {
        let p = DVec3::from_array([(); 3].map(|()| random(&mut state) - 0.5));
        // the formula of a box
        let beyond = p.abs() - 0.5 * size;
        let exact = beyond.max(DVec3::ZERO).length() + beyond.max_element().min(0.0);
        let found = distance.query(turn() * p, NO_HINT, f64::INFINITY).unwrap();
        assert!((found.distance - exact).abs() < 1e-14 * 0.3, "{p}: {found:?} {exact}");
    }
}

#[test]
fn sphere_and_torus_agree_within_the_sagitta() {
    let (radius, tube) = (0.1, 0.04);
    let sphere = Primitive::Sphere { radius, subdivisions: 4 }.mesh().unwrap();
    let torus = Primitive::Torus { radius, tube_radius: tube, segments: 96 }.mesh().unwrap();
    let to_sphere = |p: DVec3| p.length() - radius;
    let to_torus = |p: DVec3| {
        let across = DVec3::new(p.x, 0.0, p.z).length() - radius;
        libm::sqrt(across * across + p.y * p.y) - tube
    };
    for (mesh, is_torus, curvature) in [(&sphere, false, radius), (&torus, true, tube)] {
        let exact = |p| if is_torus { to_torus(p) } else { to_sphere(p) };
        let distance = SignedDistance::new(mesh).unwrap();
        let edge = mesh.triangles.iter().flat_map(|&[a, b, c]| [(a, b), (b, c), (c, a)]);
        let longest = edge
            .map(|(a, b)| mesh.vertices[a as usize].distance(mesh.vertices[b as usize]))
            .fold(0.0, f64::max);
        let sagitta = longest * longest / (2.0 * curvature);
        for p in points(mesh, 500, 9) {
            let found = distance.query(p, NO_HINT, f64::INFINITY).unwrap();
            assert!((found.distance - exact(p)).abs() <= sagitta, "{p}: {found:?} {}", exact(p));
        }
    }
}

#[test]
fn the_gradient_on_the_surface_is_its_normal() {
    let mesh = primitive("box");
    let distance = SignedDistance::new(&mesh).unwrap();
    for &corner in &mesh.vertices {
        let found = distance.query(corner, NO_HINT, 1e-15).unwrap();
        assert!(found.distance.abs() < 1e-16, "{found:?}");
        assert!(found.gradient.dot(corner.signum()) > 1.7, "{corner}: {found:?}");
    }
    // middles of edges and faces
    let on = [DVec3::new(0.15, 0.1, 0.0), DVec3::new(0.15, 0.02, 0.01)];
    for (p, normal) in on.into_iter().zip([DVec3::new(1.0, 1.0, 0.0).normalize(), DVec3::X]) {
        let found = distance.query(p, NO_HINT, 1e-15).unwrap();
        assert!(found.distance.abs() < 1e-16, "{found:?}");
        assert!(found.gradient.distance(normal) < 1e-12, "{p}: {found:?}");
    }
    // on a face in a coordinate plane distance and normal are exact
    let found = distance.query(DVec3::new(0.15, 0.02, 0.01), NO_HINT, 0.0).unwrap();
    assert_eq!((found.distance.to_bits(), found.gradient), (0, DVec3::X));
}
