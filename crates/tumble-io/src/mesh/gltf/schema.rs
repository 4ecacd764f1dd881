//! The geometry part of the glTF 2 schema, for `serde`.
//!
//! Rare fields are boxed to keep nodes small: a node may take only two bytes of JSON (`{}`).

use std::borrow::Cow;

use serde::Deserialize;

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Document<'a> {
    pub(super) asset: Asset,
    #[serde(default)]
    pub(super) extensions_used: Vec<String>,
    #[serde(default)]
    pub(super) extensions_required: Vec<String>,
    pub(super) scene: Option<usize>,
    #[serde(default)]
    pub(super) scenes: Vec<Scene>,
    #[serde(default)]
    pub(super) nodes: Vec<Node>,
    #[serde(default)]
    pub(super) meshes: Vec<MeshEntry>,
    #[serde(default)]
    pub(super) skins: Vec<SkinEntry>,
    #[serde(default)]
    pub(super) accessors: Vec<Accessor>,
    #[serde(default)]
    pub(super) buffer_views: Vec<BufferView>,
    #[serde(borrow, default)]
    pub(super) buffers: Vec<Buffer<'a>>,
}

#[derive(Deserialize)]
pub(super) struct Asset {
    pub(super) version: String,
}

#[derive(Deserialize)]
pub(super) struct Scene {
    #[serde(default)]
    pub(super) nodes: Vec<usize>,
}

#[derive(Deserialize)]
pub(super) struct Node {
    #[serde(default)]
    pub(super) children: Box<[usize]>,
    pub(super) mesh: Option<u32>,
    pub(super) skin: Option<u32>,
    /// Column by column.
    pub(super) matrix: Option<Box<[f64; 16]>>,
    pub(super) translation: Option<Box<[f64; 3]>>,
    /// A quaternion x, y, z, w.
    pub(super) rotation: Option<Box<[f64; 4]>>,
    pub(super) scale: Option<Box<[f64; 3]>>,
    /// Weights of morph targets, in place of those of the mesh.
    pub(super) weights: Option<Box<[f64]>>,
}

#[derive(Deserialize)]
pub(super) struct MeshEntry {
    #[serde(default)]
    pub(super) primitives: Vec<Primitive>,
    /// Weights of the morph targets.
    #[serde(default)]
    pub(super) weights: Vec<f64>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct SkinEntry {
    pub(super) inverse_bind_matrices: Option<usize>,
    /// The nodes that are joints.
    #[serde(default)]
    pub(super) joints: Vec<usize>,
}

#[derive(Deserialize)]
pub(super) struct Primitive {
    pub(super) attributes: Attributes,
    pub(super) indices: Option<usize>,
    #[serde(default = "triangles")]
    pub(super) mode: u32,
    /// Morph targets: displacements of the attributes.
    #[serde(default)]
    pub(super) targets: Vec<Attributes>,
}

fn triangles() -> u32 {
    4
}

#[derive(Deserialize)]
pub(super) struct Attributes {
    #[serde(rename = "POSITION")]
    pub(super) position: Option<usize>,
    #[serde(rename = "JOINTS_0")]
    joints_0: Option<usize>,
    #[serde(rename = "WEIGHTS_0")]
    weights_0: Option<usize>,
    #[serde(rename = "JOINTS_1")]
    joints_1: Option<usize>,
    #[serde(rename = "WEIGHTS_1")]
    weights_1: Option<usize>,
}

impl Attributes {
    /// Accessors of joints and their weights, four for each vertex.
    pub(super) fn joint_sets(&self) -> Vec<(usize, usize)> {
        let sets = [(self.joints_0, self.weights_0), (self.joints_1, self.weights_1)];
        sets.into_iter().filter_map(|(joints, weights)| joints.zip(weights)).collect()
    }
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Accessor {
    pub(super) buffer_view: Option<usize>,
    #[serde(default)]
    pub(super) byte_offset: usize,
    pub(super) component_type: u32,
    #[serde(default)]
    pub(super) normalized: bool,
    pub(super) count: usize,
    #[serde(rename = "type")]
    pub(super) kind: Kind,
    pub(super) sparse: Option<Box<Sparse>>,
}

#[derive(Deserialize, Clone, Copy, PartialEq, Debug)]
pub(super) enum Kind {
    #[serde(rename = "SCALAR")]
    Scalar,
    #[serde(rename = "VEC3")]
    Vec3,
    #[serde(rename = "VEC4")]
    Vec4,
    #[serde(rename = "MAT4")]
    Mat4,
    #[serde(other)]
    Other,
}

#[derive(Deserialize)]
pub(super) struct Sparse {
    pub(super) count: usize,
    pub(super) indices: SparsePart,
    pub(super) values: SparsePart,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct SparsePart {
    pub(super) buffer_view: usize,
    #[serde(default)]
    pub(super) byte_offset: usize,
    /// Of the indices only.
    #[serde(default)]
    pub(super) component_type: u32,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct BufferView {
    pub(super) buffer: usize,
    #[serde(default)]
    pub(super) byte_offset: usize,
    pub(super) byte_length: usize,
    pub(super) byte_stride: Option<usize>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Buffer<'a> {
    #[serde(borrow)]
    pub(super) uri: Option<Cow<'a, str>>,
    pub(super) byte_length: usize,
}
