//! Patches do not change any bit of the result.

use super::*;

/// A random walk of many small and some large steps.
fn walk(start: DVec3, step: f64, seed: u64, mut visit: impl FnMut(DVec3)) {
    let mut state = seed | 1;
    let mut point = start;
    for i in 0..60 {
        visit(point);
        let cube = DVec3::from_array([(); 3].map(|()| random(&mut state) - 0.5));
        // including steps of zero length and large steps
        let size = [step, 0.0, 0.1 * step, step, 20.0 * step][i % 5];
        point += cube * size;
    }
}

/// Compares queries with and without patches along random walks.
fn check(mesh: &Mesh, step: f64, seed: u64) -> Result<(), TestCaseError> {
    let distance = SignedDistance::new(mesh).unwrap();
    let (low, high) = distance.bounds();
    let size = (high - low).max_element();
    for (i, start) in points(mesh, 30, seed).into_iter().enumerate() {
        let within = [f64::INFINITY, 0.1 * size, 0.02 * size, 0.0][i % 4];
        let mut patch = Patch::NONE;
        let mut worst = None;
        walk(start, step * size, seed + i as u64, |point| {
            let at_least = patch.lower_bound(point);
            let near = distance.query_cached(point, &mut patch, within);
            let plain = distance.query(point, NO_HINT, within);
            let whole = distance.query(point, NO_HINT, f64::INFINITY).unwrap();
            if near != plain || (at_least > 0.0 && whole.distance < at_least) {
                worst = worst.or(Some((point, near, plain, at_least)));
            }
        });
        prop_assert!(worst.is_none(), "{worst:?}");
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn patches_do_not_change_queries_of_star_shaped_meshes(seed in 1u64.., step in 1e-4..0.1f64) {
        check(&star(seed), step, seed)?;
    }

    #[test]
    fn patches_do_not_change_queries_of_primitives(
        name in prop::sample::select(&Primitive::NAMES[..]),
        seed in 1u64..1 << 40,
        exponent in -5i32..0,
    ) {
        let size = libm::exp10(f64::from(exponent));
        check(&primitive(name), size, seed)?;
        check(&moved(&primitive(name), |v| turn() * v + DVec3::new(1.0, -0.7, 0.3)), size, seed)?;
    }

    #[test]
    fn patches_do_not_change_queries_of_tiny_and_huge_meshes(seed in 1u64.., exponent in -59i32..59) {
        let mesh = moved(&star(seed), |v| v * libm::exp10(f64::from(exponent)));
        check(&mesh, 1e-3, seed)?;
    }
}

#[test]
fn patches_do_not_change_the_triangle_in_ties() {
    // along the edges and over the corners of a box, where many triangles are equally close
    let mesh = Primitive::Box { size: DVec3::ONE, divisions: 8 }.mesh().unwrap();
    let distance = SignedDistance::new(&mesh).unwrap();
    let mut patch = Patch::NONE;
    for i in 0..4000 {
        let x = f64::from(i) / 2048.0 - 1.0;
        for point in [DVec3::new(x, 0.5, 0.5), DVec3::new(x, 0.625, 0.0), DVec3::new(x, x, x)] {
            let near = distance.query_cached(point, &mut patch, 1.0);
            assert_eq!(near, distance.query(point, NO_HINT, 1.0), "{point}");
        }
    }
}

#[test]
fn a_patch_saves_most_searches_for_a_slow_point() {
    let distance = SignedDistance::new(&primitive("knot")).unwrap();
    let (low, high) = distance.bounds();
    let step = 1e-3 * (high - low).max_element();
    let (mut queries, mut searches) = (0, 0);
    for (i, start) in points(&primitive("knot"), 90, 1).into_iter().enumerate() {
        let mut patch = Patch::NONE;
        let mut state = i as u64 * 2 + 1;
        let mut point = start;
        for _ in 0..40 {
            let before = format!("{patch:?}");
            if distance.query_cached(point, &mut patch, f64::INFINITY).is_some() {
                queries += 1;
                searches += i32::from(format!("{patch:?}") != before);
            }
            point += DVec3::from_array([(); 3].map(|()| random(&mut state) - 0.5)) * step;
        }
    }
    assert!(searches * 4 < queries, "{searches} of {queries}");
}
