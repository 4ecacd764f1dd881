use super::super::test_meshes::{cube, cuboid, soup};
use super::*;

#[test]
fn rounding_noise_closes_at_any_size_and_place() {
    for scale in [1e-9, 1.0, 1e9] {
        for noise in [0.0, 1e-17, 1e-12, 1e-7] {
            let mesh = soup(&cuboid(DVec3::ONE * scale, DVec3::ONE * scale), noise * scale);
            let found = mesh.welded(None);
            assert!(found.mesh.watertightness().is_manifold(), "scale {scale}, noise {noise}");
            assert_eq!((found.mesh.vertices.len(), found.mesh.triangles.len()), (8, 12));
            assert_eq!((found.equal + found.near, found.collapsed), (28, 0));
            assert!(found.tolerance > 1e-6 * scale && found.tolerance < 2e-6 * scale);
        }
    }
}

#[test]
fn a_closed_mesh_stays_as_it_is_however_fine_it_is() {
    // a closed speck beside a large cube: far below the tolerance
    let speck = cuboid(DVec3::splat(3.0), DVec3::splat(1e-9));
    let mesh = super::super::test_meshes::joined(&cube(DVec3::ZERO), &speck);
    let found = mesh.welded(None);
    assert_eq!((found.mesh, found.near, found.collapsed), (mesh, 0, 0));
}

#[test]
fn the_default_never_collapses_a_triangle_that_is_no_sliver() {
    // open at the top, and as small as the tolerance of the large cube
    let mut speck = cuboid(DVec3::splat(3.0), DVec3::splat(1e-7));
    speck.triangles.truncate(10);
    let mesh = super::super::test_meshes::joined(&soup(&cube(DVec3::ZERO), 1e-12), &speck);
    let found = mesh.welded(None);
    assert_eq!((found.collapsed, found.mesh.triangles.len()), (0, 22));
    assert!(found.tolerance < 1e-7, "{}", found.tolerance);
    assert_eq!(found.near + found.equal, 28, "the noise of the cube is still closed");
}

#[test]
fn a_sliver_of_rounding_collapses() {
    // a facet whose first two corners differ by rounding only, as CAD kernels write them
    let mut mesh = soup(&cube(DVec3::ZERO), 0.0);
    let [p, q] = [mesh.vertices[0], mesh.vertices[1]];
    let n = mesh.vertices.len() as u32;
    mesh.vertices.extend([p, p + 1e-12, q]);
    mesh.triangles.push([n, n + 1, n + 2]);
    let found = mesh.welded(None);
    assert_eq!((found.collapsed, found.mesh.triangles.len()), (1, 12));
    assert!(found.mesh.watertightness().is_manifold());
}

#[test]
fn a_tolerance_is_a_length() {
    let mesh = soup(&cube(DVec3::ZERO), 1e-4);
    assert!(!mesh.welded(None).mesh.watertightness().is_closed());
    let found = mesh.welded(Some(1e-3));
    assert!(found.mesh.watertightness().is_manifold());
    assert_eq!((found.tolerance, found.near), (1e-3, 28));
    assert_eq!(mesh.welded(Some(0.0)).near, 0);
    let all = mesh.welded(Some(1e300));
    assert_eq!((all.mesh.vertices.len(), all.mesh.triangles.len(), all.collapsed), (1, 0, 12));
    // merging twice changes nothing
    assert_eq!(found.mesh.welded(Some(1e-3)).mesh, found.mesh);
}

#[test]
fn impossible_meshes_do_not_panic() {
    let broken = Mesh { vertices: vec![DVec3::NAN; 3], triangles: vec![[0, 1, 2], [7, 8, 9]] };
    assert!(broken.welded(None).mesh.triangles.is_empty());
    assert_eq!(Mesh::default().welded(None), Welded::default());
    let equal = Mesh { vertices: vec![DVec3::ONE; 3], triangles: vec![[0, 1, 2]] };
    let found = equal.welded(None);
    assert_eq!((found.mesh.vertices.len(), found.equal, found.collapsed), (1, 2, 1));
    for size in [1e308, 1e-308] {
        let huge = soup(&cuboid(DVec3::ZERO, DVec3::splat(size)), 0.0);
        assert!(huge.welded(None).mesh.watertightness().is_closed(), "size {size}");
        assert!(huge.welded(Some(1.0)).mesh.vertices.len() <= 8);
    }
    // all within the tolerance of others in one cell
    let line = (0..30_000).map(|i| DVec3::X * f64::from(i) * 1e-12).collect();
    let triangles = (0..10_000).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    let found = Mesh { vertices: line, triangles }.welded(Some(1e-3));
    assert_eq!(found.mesh.vertices.len(), 1);
}
