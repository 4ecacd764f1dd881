//! Chooses the contact points of a shape.

use std::collections::BTreeMap;

use glam::DVec3;

use super::ContactPoints;
use super::vertex_normals::{VertexNormals, vertex_normals};
use crate::distance::{Face, OrientedSurface};
use crate::{Particles, Shape};

/// How deep an edge may enter another between two particles before it needs a contact point, in units of the size of the
/// surface.
const EDGE_TOLERANCE: f64 = 0.01;
/// The longest edge of a face without points of its own, in units of the size of the surface.
const LONGEST_FACE_EDGE: f64 = 0.15;
/// The largest number of parts into which the edges of a face are divided to place its points.
const MOST_PARTS: f64 = 3.0;

/// Cosine of the angle between normals up to which a plane can touch the points of both at once.
const SAME_SIDE: f64 = 0.9;

/// A contact point that is no particle.
struct Point {
    place: DVec3,
    half_segment: DVec3,
    normals: Vec<DVec3>,
    weight: f64,
    fade: f64,
}

/// The contact points of a shape. Without a valid surface, its particles, which leave other bodies by the nearest way.
pub(crate) fn contact_points(shape: &Shape) -> ContactPoints {
    let count = shape.particles().len();
    let none = ContactPoints { particle_count: count, ..ContactPoints::default() };
    let Ok(surface) = OrientedSurface::new(shape.surface()) else { return none };
    let vertices = &shape.surface().vertices;
    let around = vertex_normals(&surface, vertices);
    let (low, high) = surface.box_corners();
    let size = (high - low).length();

    let mut points = Vec::new();
    let at_particles = match_particles(shape, vertices, &around);
    add_vertices(vertices, &around, &at_particles, &mut points);
    add_edges(&surface, vertices, size, &mut points);
    add_faces(&surface, vertices, &around, size, count as f64, &mut points);

    let mut made = none;
    made.normal_starts.push(0);
    for vertex in &at_particles {
        let around = vertex.map(|vertex| &around[vertex as usize]);
        let normals = around.map_or(&[][..], |around| &around.normals);
        made.add_normals(normals);
        made.fade.push(around.map_or(0.0, fade));
    }
    for point in &points {
        made.add_normals(&point.normals);
        made.fade.push(point.fade);
        made.half_segments.push(point.half_segment);
        made.longest_half = made.longest_half.max(point.half_segment.length());
    }
    if !points.is_empty() {
        made.refined = Some(refined(shape.particles(), &points));
    }
    made.load = made.largest_load(shape);
    made
}

/// The particles with further points.
fn refined(particles: &Particles, points: &[Point]) -> Particles {
    let weights = (0..particles.len()).map(|index| particles.weight(index));
    let weights: Vec<f64> = weights.chain(points.iter().map(|point| point.weight)).collect();
    let places = particles.iter().chain(points.iter().map(|point| point.place));
    Particles::new(places).with_weights(&weights)
}

/// The fade of a particle at a vertex: the spacing on a flat surface, so that a row of particles passes the rim of a face
/// smoothly, and zero at an edge.
fn fade(around: &VertexNormals) -> f64 {
    if around.is_flat() { around.spacing } else { 0.0 }
}

/// For each particle, the vertex at which it is.
fn match_particles(
    shape: &Shape,
    vertices: &[DVec3],
    around: &[VertexNormals],
) -> Vec<Option<u32>> {
    // adding zero turns −0 into 0
    let key = |place: DVec3| place.to_array().map(|x| (x + 0.0).to_bits());
    let used = (0..).zip(vertices).filter(|(i, _)| !around[*i as usize].normals.is_empty());
    let by_place: BTreeMap<[u64; 3], u32> = used.map(|(i, place)| (key(*place), i)).collect();
    shape.particles().iter().map(|place| by_place.get(&key(place)).copied()).collect()
}

/// Adds the sharp vertices that are no particles.
fn add_vertices(
    vertices: &[DVec3],
    around: &[VertexNormals],
    at_particles: &[Option<u32>],
    points: &mut Vec<Point>,
) {
    let mut is_particle = vec![false; vertices.len()];
    for vertex in at_particles.iter().flatten() {
        is_particle[*vertex as usize] = true;
    }
    for (index, around) in around.iter().enumerate() {
        if around.normals.len() > 1 && !is_particle[index] {
            points.push(Point {
                place: vertices[index],
                half_segment: DVec3::ZERO,
                normals: around.normals.clone(),
                weight: 1.0,
                fade: 0.0,
            });
        }
    }
}

/// Adds the sharp convex edges.
fn add_edges(surface: &OrientedSurface, vertices: &[DVec3], size: f64, points: &mut Vec<Point>) {
    for edge in surface.edges() {
        let [one, other] = edge else { continue };
        let (face, opposite) = (&surface.faces[one.face], &surface.faces[other.face]);
        let [a, b] = one.ends.map(|end| vertices[end as usize]);
        let apex = vertices[opposite.corners[(other.corner + 2) % 3] as usize];
        let is_convex = (apex - a).dot(face.normal()) < 0.0;
        // the depth at which another edge, at a right angle, meets the ends: half the length times the slope of the faces
        let normals = [face.normal(), opposite.normal()];
        let half_angle = 0.5 * normals[0].angle_between(normals[1]);
        let depth = 0.5 * a.distance(b) * half_angle.min(std::f64::consts::FRAC_PI_4).tan();
        if !is_convex || depth < EDGE_TOLERANCE * size {
            continue;
        }
        points.push(Point {
            place: a.midpoint(b),
            half_segment: 0.5 * (b - a),
            normals: normals.to_vec(),
            weight: 1.0,
            fade: 0.0,
        });
    }
}

/// Adds points in the large faces: the centroids of equal parts. The points of a flat side weigh as much as the vertices of that
/// side, which carry it on a wall.
fn add_faces(
    surface: &OrientedSurface,
    vertices: &[DVec3],
    around: &[VertexNormals],
    size: f64,
    particle_count: f64,
    points: &mut Vec<Point>,
) {
    let used = around.iter().filter(|vertex| !vertex.normals.is_empty()).count();
    for face in &surface.faces {
        let [a, b, c] = face.corners.map(|corner| vertices[corner as usize]);
        let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
        if longest < LONGEST_FACE_EDGE * size {
            continue;
        }
        let parts = (longest / (LONGEST_FACE_EDGE * size)).ceil().min(MOST_PARTS);
        let corners: f64 = (0..3).map(|corner| around_corner(face, corner, vertices, around)).sum();
        let weight = corners * particle_count / (used as f64 * parts * parts);
        for (u, v) in centroids(parts as usize) {
            points.push(Point {
                place: a + (b - a) * u + (c - a) * v,
                half_segment: DVec3::ZERO,
                normals: vec![face.normal()],
                weight,
                fade: (face.area() / (parts * parts)).sqrt(),
            });
        }
    }
}

/// The share that a face has of one of its corners, as part of a flat side.
fn around_corner(face: &Face, corner: usize, vertices: &[DVec3], around: &[VertexNormals]) -> f64 {
    let [vertex, next, last] = [0, 1, 2].map(|k| face.corners[(corner + k) % 3] as usize);
    let [to_next, to_last] = [next, last].map(|other| vertices[other] - vertices[vertex]);
    to_next.angle_between(to_last) / around[vertex].angle_facing(face.normal())
}

/// Coordinates along two edges of the centroids of the equal triangles into which a triangle with `parts` parts per edge is
/// divided.
fn centroids(parts: usize) -> impl Iterator<Item = (f64, f64)> {
    let n = parts as f64;
    (0..parts).flat_map(move |row| {
        (0..2 * (parts - row) - 1).map(move |column| {
            let is_upright = column % 2 == 0;
            let inner = if is_upright { 1.0 / 3.0 } else { 2.0 / 3.0 };
            (((column / 2) as f64 + inner) / n, (row as f64 + inner) / n)
        })
    })
}

impl ContactPoints {
    fn add_normals(&mut self, normals: &[DVec3]) {
        self.normals.extend_from_slice(normals);
        self.normal_starts.push(self.normals.len() as u32);
    }

    /// The largest sum of weights of points with a normal close to one of the directions of a face, an axis or a diagonal, in
    /// units of the number of particles.
    fn largest_load(&self, shape: &Shape) -> f64 {
        let points = self.points(shape);
        if self.refined.is_none() {
            return 1.0;
        }
        let on_side = |direction: DVec3| {
            let faces = |index: usize| {
                self.normals(index as u32).iter().any(|normal| normal.dot(direction) > SAME_SIDE)
            };
            (0..points.len()).filter(|&i| faces(i)).map(|i| points.weight(i)).sum::<f64>()
        };
        let directions = (0..27u32).filter(|i| *i != 13).map(|i| {
            let part = |place: u32| f64::from(i / place % 3) - 1.0;
            DVec3::new(part(1), part(3), part(9)).normalize()
        });
        let largest = directions.map(on_side).fold(0.0, f64::max);
        largest / shape.particles().len() as f64
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;
    use crate::{MassModel, Primitive, Sampling};

    fn points(primitive: Primitive) -> (Shape, ContactPoints) {
        let mesh = primitive.mesh().unwrap();
        let shape = Shape::from_mesh(&mesh, Sampling::Vertices, MassModel::Solid).unwrap();
        let points = contact_points(&shape);
        (shape, points)
    }

    #[test]
    fn a_box_of_twelve_triangles_has_points_on_its_edges_and_in_its_faces() {
        let size = DVec3::new(0.4, 0.2, 0.4);
        let (shape, points) = points(Primitive::Box { size, divisions: 1 });
        let segments = points.half_segments.iter().filter(|half| half.length() > 0.0);
        assert_eq!(segments.count(), 12);
        let all = points.points(&shape);
        // on each side as much as the four particles there
        let weight = |index: usize| all.weight(index);
        let faces: f64 = (8 + 12..all.len()).map(weight).sum();
        assert!((faces - 24.0).abs() < 1e-12, "{faces}");
        assert!((0..20).all(|index| weight(index) == 1.0));
        assert_eq!(points.normals(0).len(), 3);
    }

    #[test]
    fn a_fine_ball_has_no_further_points_and_one_normal_per_particle() {
        let (shape, points) = points(Primitive::Sphere { radius: 1.0, subdivisions: 3 });
        assert_eq!(points.added(), 0);
        for (index, place) in (0..).zip(shape.particles().iter()) {
            let [normal] = points.normals(index) else { panic!("{index}") };
            assert!(normal.dot(place.normalize()) > 0.999);
        }
    }

    #[test]
    fn the_centroids_of_the_parts_of_a_triangle_average_to_its_own() {
        for parts in 1..5 {
            let all: Vec<_> = centroids(parts).collect();
            assert_eq!(all.len(), parts * parts);
            let mean =
                |f: fn(&(f64, f64)) -> f64| all.iter().map(f).sum::<f64>() / all.len() as f64;
            assert!((mean(|p| p.0) - 1.0 / 3.0).abs() < 1e-12);
            assert!((mean(|p| p.1) - 1.0 / 3.0).abs() < 1e-12);
        }
    }
}
