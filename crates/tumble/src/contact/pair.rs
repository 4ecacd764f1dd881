//! Pairs of bodies that may touch, and what is constant about their contacts.

use crate::state::{PairOrder, pair_order};
use crate::{BodyModel, ContactKind, ContactLaw, Particles, Surface};

/// Two bodies, or a body and a wall, in a neighbour list.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pair {
    pub first: u32,
    /// The second body, or the wall.
    pub second: u32,
    pub kind: ContactKind,
    /// Its points, as a range of those of the chunk.
    pub start: u32,
    pub end: u32,
    /// Index of its cache, where it is a point–mesh pair.
    pub cache: u32,
    /// There is no contact until the path lengths of both bodies add up to this (m).
    pub clear_until: f64,
    /// Distance at which two particles touch, or a particle and a mesh or wall (m).
    pub contact_distance: f64,
    /// How far beyond that distance the narrow phase searches meshes (m).
    pub search_margin: f64,
    /// How far the bodies may move relative to each other in a step without risk of passing through (m).
    pub tunnelling_limit: f64,
    /// Radii of the spheres of both bodies; 0 where it is not a sphere that touches (m).
    pub radii: [f64; 2],
    pub law: ContactLaw,
    /// Whether one of the bodies has a surface velocity.
    pub has_surface_velocity: bool,
}

/// Stands for a wall where the index of a second body is expected.
pub(super) const WALL_BODY: u32 = u32::MAX;

impl Pair {
    /// Its place in the order of pairs.
    pub fn order(&self) -> PairOrder {
        pair_order(self.first, self.second, self.kind)
    }

    /// Whether particles of the one body touch the mesh of the other.
    pub fn is_point_mesh(&self) -> bool {
        matches!(self.kind, ContactKind::PointMesh | ContactKind::MeshPoint)
    }

    /// Index of the second body, or [`WALL_BODY`].
    #[inline(always)]
    pub fn second_body(&self) -> u32 {
        if self.kind == ContactKind::SphereWall { WALL_BODY } else { self.second }
    }
}

/// Two particles, or a particle and a mesh or wall, in a neighbour list.
#[derive(Clone, Copy, Debug)]
pub(super) struct ListedContact {
    /// Slot of the particle: its place in the order of the particle tree.
    pub particle: u32,
    /// Slot of the particle of the other body; of a mesh, the index of the cached patch.
    pub other: u32,
    /// There is no contact until the path lengths of both bodies add up to this (m); of a mesh, until the relative path of the
    /// pair does.
    pub clear_until: f64,
}

/// Feature size of a body without spheres, as a fraction of its extent.
const FEATURE_FRACTION: f64 = 0.1;

/// Size of the smallest features of a body that matter for contact (m).
pub(super) fn feature_size(body: &BodyModel) -> f64 {
    match body.surface {
        Surface::Spheres { radius } => radius,
        _ => FEATURE_FRACTION * body.extent,
    }
}

/// Radius of the spheres of a body; 0 where it has none (m).
pub(crate) fn sphere_radius(body: &BodyModel) -> f64 {
    if let Surface::Spheres { radius } = body.surface { radius } else { 0.0 }
}

/// Thickness of a body (m): of its mesh, or the diameter of its spheres.
pub(super) fn thickness(body: &BodyModel) -> f64 {
    body.signed_distance.as_ref().map_or(2.0 * sphere_radius(body), |distance| distance.thickness())
}

/// Whether two bodies can have contacts of this kind.
pub(crate) fn can_touch(first: &BodyModel, second: &BodyModel, kind: ContactKind) -> bool {
    (first.is_free() || second.is_free()) && contact_kinds(first, second).contains(&kind)
}

/// The points of a body that can have contacts of this kind: only its particles touch walls.
#[inline(always)]
pub(crate) fn contact_particles(body: &BodyModel, kind: ContactKind) -> &Particles {
    if kind == ContactKind::SphereWall { body.shape.particles() } else { body.points() }
}

/// The weight of a particle in contact with a wall: that of its area; spheres have none.
#[inline(always)]
pub(super) fn wall_weight(body: &BodyModel, particle: u32) -> f64 {
    if body.has_spheres() { 1.0 } else { body.shape.particles().weight(particle as usize) }
}

/// The kinds of contact that two bodies can have.
pub(crate) fn contact_kinds(first: &BodyModel, second: &BodyModel) -> &'static [ContactKind] {
    use ContactKind::{MeshPoint, PointMesh, SphereSphere};
    match (first.surface, second.surface) {
        (Surface::None, Surface::None) => &[],
        (Surface::Mesh, Surface::Mesh) => &[PointMesh, MeshPoint],
        (Surface::Mesh, _) => &[MeshPoint],
        (_, Surface::Mesh) => &[PointMesh],
        _ => &[SphereSphere],
    }
}

/// The law of one kind of contact between two bodies.
pub(crate) fn contact_law(first: &BodyModel, second: &BodyModel, kind: ContactKind) -> ContactLaw {
    let law = first.pair_material.law(&second.pair_material);
    if is_single_point(first, second, kind) {
        // the patch is this point, and its effective mass is that of the bodies
        let mass = 1.0 / (first.pair_material.inverse_mass + second.pair_material.inverse_mass);
        law.of_single_particle(mass)
    } else {
        law
    }
}

/// Whether two bodies touch at one point at most, whose force turns neither of them, or only one that is not free.
fn is_single_point(first: &BodyModel, second: &BodyModel, kind: ContactKind) -> bool {
    let is_point = |body: &BodyModel| {
        body.shape.is_single_particle() && !matches!(body.surface, Surface::Mesh)
    };
    match kind {
        ContactKind::SphereSphere => is_point(first) && is_point(second),
        ContactKind::PointMesh => is_point(first) && !second.is_free(),
        ContactKind::MeshPoint => is_point(second) && !first.is_free(),
        ContactKind::SphereWall => is_point(first),
    }
}

/// Distance at which particles of these bodies touch, or a particle and a mesh (m).
pub(super) fn contact_distance(first: &BodyModel, second: &BodyModel, kind: ContactKind) -> f64 {
    match kind {
        ContactKind::SphereWall | ContactKind::PointMesh => sphere_radius(first),
        ContactKind::MeshPoint => sphere_radius(second),
        ContactKind::SphereSphere => sphere_radius(first) + sphere_radius(second),
    }
}

/// How far one body may move relative to the other in a step (m): half of what it would have to pass through.
pub(crate) fn tunnelling_limit(first: &BodyModel, second: &BodyModel, kind: ContactKind) -> f64 {
    let mesh_thickness = |body: &BodyModel| {
        body.signed_distance.as_ref().map_or(0.0, |distance| distance.thickness())
    };
    match kind {
        ContactKind::SphereWall => f64::INFINITY,
        ContactKind::SphereSphere => sphere_radius(first) + sphere_radius(second),
        ContactKind::PointMesh => sphere_radius(first) + 0.5 * mesh_thickness(second),
        ContactKind::MeshPoint => sphere_radius(second) + 0.5 * mesh_thickness(first),
    }
}
