//! Moments of meshes against closed formulas.

use super::*;
use crate::shape::Primitive;
use crate::shape::watertight::EdgeFault;
use glam::DQuat;

fn cuboid(size: DVec3) -> Mesh {
    Primitive::Box { size, divisions: 1 }.mesh().unwrap()
}

fn moved(mut mesh: Mesh, rotation: DQuat, shift: DVec3) -> Mesh {
    for v in &mut mesh.vertices {
        *v = rotation * *v + shift;
    }
    mesh
}

/// ∫ r rᵀ of a box about its centre: V/12 times the squares of its edges.
fn cuboid_moment(size: DVec3) -> DMat3 {
    DMat3::from_diagonal(size.x * size.y * size.z / 12.0 * size * size)
}

fn difference(a: DMat3, b: DMat3) -> f64 {
    let largest = b.to_cols_array().iter().fold(0.0f64, |m, x| m.max(x.abs()));
    (a - b).to_cols_array().iter().fold(0.0f64, |m, x| m.max(x.abs())) / largest
}

#[test]
fn a_solid_cube_has_the_textbook_moments() {
    let solid = cuboid(DVec3::ONE).solid_integrals().unwrap();
    assert_eq!(solid.measure, 1.0);
    assert_eq!(solid.centre, DVec3::ZERO);
    assert!(difference(solid.second_moment, cuboid_moment(DVec3::ONE)) < 1e-15);
    assert!(difference(solid.inertia(), DMat3::from_diagonal(DVec3::splat(1.0 / 6.0))) < 1e-15);
}

#[test]
fn a_solid_tetrahedron_has_the_textbook_moments() {
    // with corners 0, x, y, z: V = 1/6, centre 1/4, ∫x² = 1/60, ∫xy = 1/120
    let vertices = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
    let mesh = Mesh::new(vertices, vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]]).unwrap();
    let solid = mesh.solid_integrals().unwrap();
    assert!((solid.measure - 1.0 / 6.0).abs() < 1e-16);
    assert!((solid.centre - DVec3::splat(0.25)).length() < 1e-15);
    let shift = 1.0 / 6.0 / 16.0;
    let (own, mixed) = (1.0 / 60.0 - shift, 1.0 / 120.0 - shift);
    let expected =
        DMat3::from_cols_array(&[own, mixed, mixed, mixed, own, mixed, mixed, mixed, own]);
    assert!(difference(solid.second_moment, expected) < 1e-14);
}

#[test]
fn a_cubic_shell_has_the_textbook_moments() {
    // ∫x²: two faces at 1/4, four with 1/12
    let shell = cuboid(DVec3::ONE).shell_integrals().unwrap();
    assert!((shell.measure - 6.0).abs() < 1e-14);
    assert!(shell.centre.length() < 1e-16);
    let expected = DMat3::from_diagonal(DVec3::splat(0.5 + 4.0 / 12.0));
    assert!(difference(shell.second_moment, expected) < 1e-14);
}

#[test]
fn a_shell_may_be_open_and_its_winding_does_not_matter() {
    let mut mesh = cuboid(DVec3::new(1.0, 2.0, 3.0));
    let whole = mesh.shell_integrals().unwrap();
    mesh.triangles[3].swap(0, 1);
    let turned = mesh.shell_integrals().unwrap();
    assert!((whole.measure - turned.measure).abs() < 1e-13);
    mesh.triangles.truncate(2);
    assert!(mesh.shell_integrals().is_ok());
}

#[test]
fn far_from_the_origin_moments_are_as_accurate_as_the_coordinates() {
    // shifted by powers of two: the coordinates are exact, and so is the result
    let shift = DVec3::new(1.0, -2.0, 0.5) * 2f64.powi(20);
    let solid = moved(cuboid(DVec3::ONE), DQuat::IDENTITY, shift).solid_integrals().unwrap();
    assert_eq!(solid.centre, shift);
    assert!(difference(solid.second_moment, cuboid_moment(DVec3::ONE)) < 1e-15);

    // rotated and 1e6 m away: coordinates accurate to 1e-10 m, moments similarly
    let turn = DQuat::from_axis_angle(DVec3::new(1.0, 2.0, 3.0).normalize(), 0.7);
    let size = DVec3::new(0.3, 0.2, 0.1);
    let mesh = moved(cuboid(size), turn, DVec3::splat(1e6));
    let solid = mesh.solid_integrals().unwrap();
    let r = DMat3::from_quat(turn);
    assert!(difference(solid.second_moment, r * cuboid_moment(size) * r.transpose()) < 2e-9);
}

#[test]
fn a_mesh_wound_inwards_has_the_same_moments() {
    let mesh = cuboid(DVec3::new(1.0, 2.0, 3.0));
    let mut inward = mesh.clone();
    for t in &mut inward.triangles {
        t.swap(1, 2);
    }
    let (a, b) = (mesh.solid_integrals().unwrap(), inward.solid_integrals().unwrap());
    assert!(b.measure > 0.0 && (a.measure - b.measure).abs() < 1e-14);
    assert!(difference(b.second_moment, a.second_moment) < 1e-14);
}

#[test]
fn a_cavity_is_subtracted() {
    let mut mesh = cuboid(DVec3::splat(2.0));
    let hole = cuboid(DVec3::ONE);
    mesh.vertices.extend(&hole.vertices);
    mesh.triangles.extend(hole.triangles.iter().map(|t| [t[0] + 8, t[2] + 8, t[1] + 8]));
    let solid = mesh.solid_integrals().unwrap();
    assert!((solid.measure - 7.0).abs() < 1e-14);
    let expected = cuboid_moment(DVec3::splat(2.0)) - cuboid_moment(DVec3::ONE);
    assert!(difference(solid.second_moment, expected) < 1e-14);
}

#[test]
fn an_open_mesh_is_refused_and_its_edges_are_listed() {
    let mut mesh = cuboid(DVec3::ONE);
    mesh.triangles.pop();
    let error = mesh.solid_integrals().unwrap_err();
    let SolidError::Edges(found) = &error else { panic!("{error}") };
    assert_eq!(found.open_edges, 3);
    assert!(found.first.iter().all(|e| e.fault == EdgeFault::Open));
    assert!(
        error.to_string().contains("3 open and 0 wrongly wound edges; open from vertex"),
        "{error}"
    );
}

#[test]
fn meshes_without_volume_or_area_are_refused() {
    let cloud = Mesh::new(vec![DVec3::ZERO], vec![]).unwrap();
    assert_eq!(cloud.solid_integrals(), Err(SolidError::NoTriangles));
    assert_eq!(cloud.shell_integrals(), Err(ShellError::NoTriangles));

    // a triangle and its reverse are closed but flat, in any orientation
    let corners =
        vec![DVec3::new(0.1, 0.2, 0.3), DVec3::new(1.3, 0.7, 0.1), DVec3::new(0.2, 0.9, 0.77)];
    let flat = Mesh::new(corners.clone(), vec![[0, 1, 2], [0, 2, 1]]).unwrap();
    assert_eq!(flat.solid_integrals(), Err(SolidError::NoVolume));
    assert!(flat.shell_integrals().is_ok());

    // the area of collinear corners is zero up to rounding
    let line = vec![corners[0], corners[1], corners[0].lerp(corners[1], 0.3)];
    let line = Mesh::new(line, vec![[0, 1, 2]]).unwrap();
    assert_eq!(line.shell_integrals(), Err(ShellError::NoArea));
    let point = Mesh::new(vec![corners[0]], vec![[0, 0, 0]]).unwrap();
    assert_eq!(point.shell_integrals(), Err(ShellError::NoArea));
    assert_eq!(point.solid_integrals(), Err(SolidError::NoTriangles));
}

#[test]
fn moments_scale_with_powers_of_the_size() {
    let mesh = Primitive::from_name("t-handle").unwrap().mesh().unwrap();
    let one = mesh.solid_integrals().unwrap();
    for scale in [1e-9, 1e-6, 1e6, 1e12] {
        let mut scaled = mesh.clone();
        scaled.vertices.iter_mut().for_each(|v| *v *= scale);
        let solid = scaled.solid_integrals().unwrap();
        assert!((solid.measure / one.measure / (scale * scale * scale) - 1.0).abs() < 1e-13);
        let back = solid.second_moment * (1.0 / (scale * scale) / (scale * scale) / scale);
        assert!(difference(back, one.second_moment) < 1e-12);
    }
}

#[test]
fn sizes_beyond_the_range_of_doubles_are_refused() {
    for scale in [1e-80, 1e80, 1e300] {
        let mut mesh = cuboid(DVec3::ONE);
        mesh.vertices.iter_mut().for_each(|v| *v *= scale);
        assert!(matches!(mesh.solid_integrals(), Err(SolidError::OutOfRange { .. })));
        assert!(matches!(mesh.shell_integrals(), Err(ShellError::OutOfRange { .. })));
    }
}
