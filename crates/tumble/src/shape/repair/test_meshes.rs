//! Meshes for the tests.

use glam::DVec3;

use crate::Mesh;

/// A box of twelve triangles, wound outwards.
pub fn cuboid(centre: DVec3, size: DVec3) -> Mesh {
    let vertices = (0..8u32)
        .map(|i| DVec3::new((i & 1).into(), (i >> 1 & 1).into(), (i >> 2).into()) - 0.5)
        .map(|p| centre + p * size)
        .collect();
    let triangles = [
        [0, 2, 3],
        [0, 3, 1],
        [4, 5, 7],
        [4, 7, 6],
        [0, 1, 5],
        [0, 5, 4],
        [2, 6, 7],
        [2, 7, 3],
        [0, 4, 6],
        [0, 6, 2],
        [1, 3, 7],
        [1, 7, 5],
    ];
    Mesh { vertices, triangles: triangles.to_vec() }
}

/// The unit cube about a point.
pub fn cube(centre: DVec3) -> Mesh {
    cuboid(centre, DVec3::ONE)
}

/// Both meshes as one.
pub fn joined(a: &Mesh, b: &Mesh) -> Mesh {
    let mut all = a.clone();
    let first = a.vertices.len() as u32;
    all.vertices.extend(&b.vertices);
    all.triangles.extend(b.triangles.iter().map(|t| t.map(|i| i + first)));
    all
}

/// The mesh wound the other way.
pub fn inside_out(mesh: &Mesh) -> Mesh {
    let mut turned = mesh.clone();
    turned.triangles.iter_mut().for_each(|t| t.swap(1, 2));
    turned
}

/// The mesh with three vertices of its own for each triangle, each coordinate moved by up to `noise`.
pub fn soup(mesh: &Mesh, noise: f64) -> Mesh {
    let mut seed = 1u64;
    let mut random = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    };
    let mut all = Mesh::default();
    for t in &mesh.triangles {
        let first = all.vertices.len() as u32;
        all.triangles.push([first, first + 1, first + 2]);
        for &i in t {
            let offset = DVec3::new(random(), random(), random()) * noise;
            all.vertices.push(mesh.vertices[i as usize] + offset);
        }
    }
    all
}

/// A Möbius strip.
pub fn moebius() -> Mesh {
    let count = 12u32;
    let mut mesh = Mesh::default();
    for i in 0..count {
        let angle = f64::from(i) / f64::from(count) * std::f64::consts::TAU;
        let (half, out) = (0.5 * angle, DVec3::new(angle.cos(), angle.sin(), 0.0));
        let across = (out * half.cos() + DVec3::Z * half.sin()) * 0.3;
        mesh.vertices.extend([out - across, out + across]);
    }
    for i in 0..count {
        let [a, b] = [2 * i, 2 * i + 1];
        // the ends are joined after half a turn
        let [c, d] = if i + 1 < count { [a + 2, b + 2] } else { [1, 0] };
        mesh.triangles.extend([[a, b, c], [b, d, c]]);
    }
    mesh
}
