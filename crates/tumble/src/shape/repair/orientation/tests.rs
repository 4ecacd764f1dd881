use super::super::test_meshes::{cube, cuboid, inside_out, joined, moebius};
use super::*;
use crate::Primitive;

fn volume(mesh: &Mesh) -> f64 {
    mesh.solid_integrals().unwrap().measure
}

fn ball(radius: f64) -> Mesh {
    Primitive::Sphere { radius, subdivisions: 2 }.mesh().unwrap()
}

#[test]
fn each_component_is_turned_outwards() {
    let far = cuboid(DVec3::X * 3.0, DVec3::splat(0.9));
    let right = joined(&cube(DVec3::ZERO), &far);
    for (mesh, turned) in [
        (right.clone(), 0),
        (joined(&cube(DVec3::ZERO), &inside_out(&far)), 1),
        (joined(&inside_out(&cube(DVec3::ZERO)), &inside_out(&far)), 2),
    ] {
        let found = mesh.oriented();
        assert_eq!((found.shells, found.turned, found.rewound), (2, turned, 0));
        assert_eq!((found.cavities, found.crossing), (0, 0));
        assert!((volume(&found.mesh) - 1.729).abs() < 1e-12);
        assert_eq!(found.mesh.oriented().turned, 0);
    }
    assert_eq!(right.oriented().mesh, right);
}

#[test]
fn without_that_a_part_with_negative_volume_is_an_error() {
    let far = inside_out(&cuboid(DVec3::X * 3.0, DVec3::splat(0.9)));
    let mesh = joined(&cube(DVec3::ZERO), &far);
    let error = mesh.solid_integrals().unwrap_err();
    assert!(matches!(error, crate::SolidError::Impossible { .. }));
    let text = error.to_string();
    assert!(
        text.contains("2.7100e-1 m³ with its centre at (-8.07") && text.contains("inwards"),
        "{text}"
    );
}

#[test]
fn faces_with_different_diagonals_between_two_boxes_do_no_harm() {
    // the second box shares a face with the first, cut along the other diagonal
    let mut second = cube(DVec3::X);
    second.triangles.retain(|t| *t != [0, 4, 6] && *t != [0, 6, 2]);
    second.triangles.extend([[0, 4, 2], [4, 6, 2]]);
    for second in [second.clone(), inside_out(&second)] {
        let found = joined(&cube(DVec3::ZERO), &second).oriented();
        assert_eq!(found.shells, 2);
        assert!((volume(&found.mesh) - 2.0).abs() < 1e-12);
    }
    let mesh = joined(&cube(DVec3::ZERO), &second);
    assert!(mesh.watertightness().is_closed() && mesh.watertightness().non_manifold > 0);
    let found = mesh.without_duplicates();
    assert_eq!((found.copies, found.opposite), (0, 0));
    assert!((volume(&found.mesh.oriented().mesh) - 2.0).abs() < 1e-12);
}

#[test]
fn surfaces_inside_others_bound_cavities_by_turns() {
    let radii = [1.0, 0.7, 0.4];
    let [a, b, c] = radii.map(|r| volume(&ball(r)));
    for turned in 0..8 {
        let shells: Vec<Mesh> =
            (0..3)
                .map(|i| {
                    if turned >> i & 1 == 1 { inside_out(&ball(radii[i])) } else { ball(radii[i]) }
                })
                .collect();
        let mesh = joined(&joined(&shells[0], &shells[1]), &shells[2]);
        let found = mesh.oriented();
        assert_eq!((found.shells, found.cavities, found.crossing), (3, 1, 0));
        assert!((volume(&found.mesh) - (a - b + c)).abs() < 1e-12);
        // the middle one must be wound inwards
        assert_eq!(found.turned, (turned ^ 2u32).count_ones() as usize);
    }
}

#[test]
fn windings_within_a_component_are_made_alike() {
    let right = ball(1.0);
    let mut mesh = right.clone();
    mesh.triangles.iter_mut().step_by(3).for_each(|t| t.swap(1, 2));
    assert!(!mesh.watertightness().is_closed());
    let found = mesh.oriented();
    assert_eq!(found.rewound, right.triangles.len().div_ceil(3));
    assert!((volume(&found.mesh) - volume(&right)).abs() < 1e-12);
}

#[test]
fn surfaces_that_cross_are_not_cavities() {
    let a = cube(DVec3::ZERO);
    for b in [
        cube(DVec3::splat(0.5)),
        cube(DVec3::X * 0.25),
        cuboid(DVec3::ZERO, DVec3::new(0.5, 0.5, 2.0)),
    ] {
        let mesh = joined(&a, &b);
        let found = mesh.oriented();
        assert_eq!((found.cavities, found.turned), (0, 0));
        assert!((volume(&found.mesh) - volume(&a) - volume(&b)).abs() < 1e-12);
    }
    assert_eq!(joined(&a, &cuboid(DVec3::ZERO, DVec3::new(0.5, 0.5, 2.0))).oriented().crossing, 2);
}

#[test]
fn surfaces_that_touch_stay_two_solids() {
    let a = cube(DVec3::ZERO);
    // at a face, at an edge, at a vertex, and in the middle of a face
    let places = [DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::ONE, DVec3::new(1.0, 0.3, 0.2)];
    for at in places {
        let mesh = joined(&a, &inside_out(&cube(at)));
        let found = mesh.without_duplicates().mesh.oriented();
        if at != DVec3::X {
            assert_eq!((found.shells, found.turned), (2, 1), "{at}");
            assert_eq!((found.cavities, found.crossing), (0, 0), "{at}");
            assert!((volume(&found.mesh) - 2.0).abs() < 1e-12);
        }
        let alike = joined(&a, &cube(at)).without_duplicates().mesh.oriented();
        assert!((volume(&alike.mesh) - 2.0).abs() < 1e-12, "{at}");
    }
}

#[test]
fn one_sided_surfaces_stay_as_they_are() {
    let strip = moebius();
    let found = strip.oriented();
    assert_eq!((found.mesh, found.one_sided, found.shells), (strip.clone(), 1, 0));
    // where it is has no effect on others
    let both = joined(&strip, &inside_out(&cube(DVec3::X * 9.0))).oriented();
    assert_eq!((both.shells, both.turned, both.one_sided), (1, 1, 1));
}

#[test]
fn open_and_impossible_meshes_do_not_panic() {
    assert_eq!(Mesh::default().oriented(), Oriented::default());
    let broken = Mesh { vertices: vec![DVec3::NAN; 3], triangles: vec![[0, 1, 2], [7, 8, 9]] };
    assert_eq!(broken.oriented().shells, 0);
    let mut open = cube(DVec3::ZERO);
    open.triangles.truncate(10);
    assert_eq!((open.oriented().mesh, open.oriented().shells), (open, 0));
    for size in [1e-300, 1e300] {
        let two = joined(
            &cuboid(DVec3::ZERO, DVec3::splat(size)),
            &cuboid(DVec3::X * 2.0 * size, DVec3::splat(size)),
        );
        assert_eq!(two.oriented().shells, 2);
    }
}

#[test]
fn many_components_take_no_time() {
    let mut mesh = ball(1.0);
    let speck = inside_out(&cuboid(DVec3::ZERO, DVec3::splat(1e-3)));
    for i in 0..20_000u32 {
        let at = DVec3::new((i % 30).into(), (i / 30 % 30).into(), (i / 900).into());
        let first = mesh.vertices.len() as u32;
        mesh.vertices.extend(speck.vertices.iter().map(|&v| v + (at - 12.0) * 0.02));
        mesh.triangles.extend(speck.triangles.iter().map(|t| t.map(|k| k + first)));
    }
    let start = std::time::Instant::now();
    let found = mesh.oriented();
    assert_eq!((found.shells, found.cavities, found.turned), (20_001, 20_000, 0));
    assert!(start.elapsed() < std::time::Duration::from_secs(20));
}
