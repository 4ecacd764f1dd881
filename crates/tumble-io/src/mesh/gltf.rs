//! glTF 2, as text with side files or data URIs (`.gltf`) and as one binary file (`.glb`).
//!
//! Read with `serde_json`. The crate `gltf` (1.4) is not used: its validation panics if POSITION refers to a missing accessor, its accessors
//! do unchecked arithmetic, and it keeps node transforms in single precision.
//!
//! Read: the triangles, strips and fans of all nodes of the scene (or of the first scene; without
//! scenes of all nodes; without nodes all meshes as they stand), moved by the nodes' transforms in f64.
//! Each instance of a mesh has its own vertices. Points, lines, materials and animations are ignored. Morph targets displace
//! the vertices by the weights of the node, or else of the mesh. A skinned mesh is in the pose of
//! its joints.

mod data;
mod glb;
mod schema;
mod skin;
mod support;

use std::collections::BTreeMap;
use std::path::Path;

use glam::{DAffine3, DMat3, DQuat, DVec3};

use super::error::{Place, ReadError};
use super::parsed::Parsed;
use super::polygon::Faces;
use super::text::check_text;
use crate::counted::counted;
use data::{Buffers, error, get};
use schema::{Document, Node, Primitive};
use skin::Skin;

/// The largest JSON part (bytes): parsed entries take much more memory than their text.
const MAX_JSON: usize = 128 << 20;
/// Reads the bytes of a glTF file; `folder` holds its side files.
pub(super) fn parse(bytes: &[u8], folder: Option<&Path>) -> Result<Parsed, ReadError> {
    let (json, binary_chunk) = split(bytes)?;
    if json.len() > MAX_JSON {
        return Err(error("the JSON part has more than 128 MiB; keep the data in a .bin or .glb"));
    }
    let document: Document<'_> = serde_json::from_slice(json)
        .map_err(|e| support::other_version(json).unwrap_or_else(|| json_error(&e, bytes)))?;
    support::check(&document)?;

    let buffers = Buffers::new(&document, binary_chunk, folder);
    let mut scene = Scene::new(&document, buffers, bytes.len());
    scene.walk().and_then(|()| scene.finish()).map_err(|mut error| {
        error.message += &support::compression_note(&document);
        error
    })
}

/// The JSON part and the binary part of a file.
fn split(bytes: &[u8]) -> Result<(&[u8], Option<&[u8]>), ReadError> {
    if bytes.starts_with(b"glTF") {
        return glb::split(bytes);
    }
    check_text(bytes, "a glTF that does not begin with `glTF`")?;
    // skip a byte order mark
    Ok((bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes), None))
}

fn json_error(e: &serde_json::Error, bytes: &[u8]) -> ReadError {
    let message = format!("this is no glTF: {e}");
    match bytes.starts_with(b"glTF") {
        true => ReadError::new(Some(Place::Byte(20)), message),
        false => {
            ReadError::new(Some(Place::Line { line: e.line(), column: Some(e.column()) }), message)
        }
    }
}

/// Collects the meshes of the nodes.
struct Scene<'a> {
    document: &'a Document<'a>,
    buffers: Buffers<'a>,
    file_length: usize,
    vertices: Vec<DVec3>,
    faces: Faces,
    object_count: usize,
    /// The parent of each node, once a skin needs them.
    parents: Option<Vec<Option<usize>>>,
    /// Vertices, indices and primitives so far, all instances counted.
    work: usize,
}

/// What moves the vertices of an instance of a mesh.
enum Motion {
    Node(DAffine3),
    Skin(Skin),
}

impl Motion {
    /// Whether the surface is turned inside out.
    fn is_mirrored(&self) -> bool {
        match self {
            Self::Node(transform) => transform.matrix3.determinant() < 0.0,
            Self::Skin(skin) => skin.is_mirrored(),
        }
    }
}

impl<'a> Scene<'a> {
    fn new(document: &'a Document<'a>, buffers: Buffers<'a>, file_length: usize) -> Self {
        Self {
            document,
            buffers,
            file_length,
            vertices: Vec::new(),
            faces: Faces::default(),
            object_count: 0,
            parents: None,
            work: 0,
        }
    }

    /// Visits all nodes, parents first, in the file's order.
    fn walk(&mut self) -> Result<(), ReadError> {
        let document = self.document;
        if document.nodes.is_empty() {
            return (0..document.meshes.len())
                .try_for_each(|mesh| self.add_mesh(mesh, None, &Motion::Node(DAffine3::IDENTITY)));
        }
        let mut seen = vec![false; document.nodes.len()];
        let roots = self.roots()?;
        // remaining children and transform of each parent on the path
        let mut levels = vec![(roots.iter(), DAffine3::IDENTITY)];
        while let Some((siblings, parent)) = levels.last_mut() {
            let Some(&index) = siblings.next() else {
                levels.pop();
                continue;
            };
            let node = get(&document.nodes, index, "node")?;
            if std::mem::replace(&mut seen[index], true) {
                return Err(error(format!(
                    "node {index} is reached twice; the nodes of a scene must form trees, without cycles"
                )));
            }
            let transform = *parent * local_transform(node, index)?;
            if let Some(mesh) = node.mesh {
                let motion = match node.skin {
                    Some(skin) => Motion::Skin(self.skin(skin as usize)?),
                    None => Motion::Node(transform),
                };
                self.add_mesh(mesh as usize, node.weights.as_deref(), &motion)?;
            }
            levels.push((node.children.iter(), transform));
        }
        Ok(())
    }

    fn roots(&self) -> Result<Vec<usize>, ReadError> {
        let document = self.document;
        if !document.scenes.is_empty() {
            let scene = document.scene.unwrap_or(0);
            return Ok(get(&document.scenes, scene, "scene")?.nodes.clone());
        }
        let mut is_child = vec![false; document.nodes.len()];
        for &child in document.nodes.iter().flat_map(|node| &node.children) {
            get(&document.nodes, child, "node")?;
            is_child[child] = true;
        }
        Ok((0..is_child.len()).filter(|&node| !is_child[node]).collect())
    }

    /// Adds an instance of a mesh. `weights` of its morph targets replace its own.
    fn add_mesh(
        &mut self,
        mesh: usize,
        weights: Option<&[f64]>,
        motion: &Motion,
    ) -> Result<(), ReadError> {
        let mesh = get(&self.document.meshes, mesh, "mesh")?;
        self.object_count += 1;
        let weights = weights.unwrap_or(&mesh.weights);
        // primitives may share their vertices
        let mut first_of = BTreeMap::new();
        for primitive in &mesh.primitives {
            self.charge(1 + primitive.targets.len())?;
            let Some(position) = primitive.attributes.position else { continue };
            if !(4..=6).contains(&primitive.mode) {
                continue;
            }
            let morph = morph(primitive, weights);
            let shifts: Vec<_> = morph.iter().map(|(at, weight)| (*at, weight.to_bits())).collect();
            let key = (position, shifts, primitive.attributes.joint_sets());
            let first = match first_of.get(&key) {
                Some(&first) => first,
                None => self.add_vertices(primitive, position, &morph, motion)?,
            };
            first_of.insert(key, first);
            self.add_faces(primitive, position, first, motion.is_mirrored())?;
        }
        Ok(())
    }

    fn add_vertices(
        &mut self,
        primitive: &Primitive,
        position: usize,
        morph: &[(usize, f64)],
        motion: &Motion,
    ) -> Result<usize, ReadError> {
        let mut positions = self.positions(position)?;
        for &(target, weight) in morph {
            let shifts = self.positions(target)?;
            if shifts.len() != positions.len() {
                return Err(error(format!(
                    "a morph target displaces {}, but its primitive has {}",
                    counted(shifts.len(), "vertex", "vertices"),
                    positions.len()
                )));
            }
            positions.iter_mut().zip(shifts).for_each(|(point, shift)| *point += weight * shift);
        }
        match motion {
            Motion::Node(transform) => {
                positions.iter_mut().for_each(|point| *point = transform.transform_point3(*point));
            }
            Motion::Skin(skin) => {
                let sets = primitive.attributes.joint_sets();
                for accessor in sets.iter().flat_map(|(joints, weights)| [*joints, *weights]) {
                    self.charge(self.buffers.count(accessor)?)?;
                }
                skin.apply(&mut self.buffers, &primitive.attributes, &mut positions)?;
            }
        }
        let first = self.vertices.len();
        for vertex in positions {
            if !vertex.is_finite() {
                return Err(error("a vertex becomes infinite by the transforms of its nodes"));
            }
            self.vertices.push(vertex);
        }
        if u32::try_from(self.vertices.len()).is_err() {
            return Err(error("the scene has more than 4,294,967,295 vertices"));
        }
        Ok(first)
    }

    /// A skin, in the pose of its joints.
    fn skin(&mut self, index: usize) -> Result<Skin, ReadError> {
        let parents = match self.parents.take() {
            Some(parents) => parents,
            None => skin::parents(self.document)?,
        };
        let mut work = self.work;
        let limit = self.limit();
        let skin = Skin::new(self.document, &mut self.buffers, &parents, index, |more| {
            work = work.saturating_add(more);
            if work > limit { Err(too_much(limit)) } else { Ok(()) }
        });
        (self.work, self.parents) = (work, Some(parents));
        skin
    }

    /// The vectors of an accessor.
    fn positions(&mut self, accessor: usize) -> Result<Vec<DVec3>, ReadError> {
        self.buffers.load(accessor)?;
        self.charge(self.buffers.count(accessor)?)?;
        self.buffers.positions(accessor)
    }

    fn add_faces(
        &mut self,
        primitive: &Primitive,
        position: usize,
        first: usize,
        mirrored: bool,
    ) -> Result<(), ReadError> {
        let vertex_count = self.buffers.count(position)?;
        let count = primitive.indices.map_or(Ok(vertex_count), |i| self.buffers.count(i))?;
        self.charge(count)?;
        let mut corners = match primitive.indices {
            Some(indices) => {
                self.buffers.load(indices)?;
                self.buffers.indices(indices)?
            }
            None => (0..vertex_count as u32).collect(),
        };
        for corner in &mut corners {
            if *corner as usize >= vertex_count {
                return Err(error(format!(
                    "an index is {corner}, but its primitive has only {}",
                    counted(vertex_count, "vertex", "vertices")
                )));
            }
            *corner += first as u32;
        }
        let start = self.faces.triangle_count();
        match primitive.mode {
            4 if !corners.len().is_multiple_of(3) => {
                return Err(error(format!(
                    "a primitive of triangles has {}, which is no multiple of 3",
                    counted(corners.len(), "corner", "corners")
                )));
            }
            4 => corners.chunks_exact(3).for_each(|triangle| self.faces.push(triangle)),
            5 => self.faces.push_strip(&corners),
            _ => corners.windows(2).skip(1).for_each(|pair| {
                self.faces.push(&[corners[0], pair[0], pair[1]]);
            }),
        }
        if mirrored {
            self.faces.reverse_from(start);
        }
        Ok(())
    }

    /// Counts work against a limit in proportion to the file size, since instances multiply the data.
    fn charge(&mut self, work: usize) -> Result<(), ReadError> {
        self.work = self.work.saturating_add(work);
        if self.work > self.limit() { Err(too_much(self.limit())) } else { Ok(()) }
    }

    fn limit(&self) -> usize {
        (2 * (self.file_length + self.buffers.side_bytes())).max(1_000_000)
    }

    fn finish(self) -> Result<Parsed, ReadError> {
        if self.vertices.is_empty() {
            return Err(error(
                "the scene has no triangles (only triangles, strips and fans are read, of nodes in the scene)",
            ));
        }
        let face_count = self.faces.count;
        let triangles = self.faces.finish(&self.vertices);
        Ok(Parsed {
            vertices: self.vertices,
            triangles,
            face_count,
            object_count: self.object_count,
            side_files: self.buffers.into_side_names(),
        })
    }
}

fn too_much(limit: usize) -> ReadError {
    error(format!(
        "with all instances, the file has more than {limit} vertices and indices, out of proportion to its size: its counts are wrong, or it has too many instances"
    ))
}

/// The accessors of the displacements of a primitive and their weights, without those that are zero.
fn morph(primitive: &Primitive, weights: &[f64]) -> Vec<(usize, f64)> {
    let targets = primitive.targets.iter().zip(weights);
    targets
        .filter(|(_, weight)| **weight != 0.0)
        .filter_map(|(target, weight)| Some((target.position?, *weight)))
        .collect()
}

/// The transform of a node relative to its parent.
fn local_transform(node: &Node, index: usize) -> Result<DAffine3, ReadError> {
    if let Some(matrix) = &node.matrix {
        let column = |i: usize| DVec3::new(matrix[4 * i], matrix[4 * i + 1], matrix[4 * i + 2]);
        return Ok(DAffine3 {
            matrix3: DMat3::from_cols(column(0), column(1), column(2)),
            translation: column(3),
        });
    }
    let rotation = match &node.rotation {
        Some(rotation) => DQuat::from_array(**rotation),
        None => DQuat::IDENTITY,
    };
    let length = rotation.length();
    if !(length.is_finite() && length > 0.0) {
        return Err(error(format!(
            "the rotation of node {index} must be a quaternion of length 1"
        )));
    }
    let scale = node.scale.as_ref().map_or(DVec3::ONE, |scale| DVec3::from_array(**scale));
    let translation = node.translation.as_ref().map_or(DVec3::ZERO, |t| DVec3::from_array(**t));
    Ok(DAffine3::from_scale_rotation_translation(scale, rotation / length, translation))
}
