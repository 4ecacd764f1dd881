//! Skins: the vertices of a mesh follow the joints of a skeleton, in the pose that the file has.
//!
//! A joint has the matrix M = G B of its global transform G and its inverse bind matrix B. A vertex x with weights w goes to
//! Σ wⱼ Mⱼ x (glTF 2.0, 3.7.3). The transform of the mesh's own node does not apply.

use glam::{DAffine3, DMat3, DVec3};

use super::super::error::ReadError;
use super::data::{Buffers, error, get};
use super::local_transform;
use super::schema::{Attributes, Document};

/// The joints of a skin, for the vertices of a mesh.
pub(super) struct Skin {
    /// M of each joint.
    matrices: Vec<DAffine3>,
}

/// The parent of each node.
pub(super) fn parents(document: &Document<'_>) -> Result<Vec<Option<usize>>, ReadError> {
    let mut parents = vec![None; document.nodes.len()];
    for (parent, node) in document.nodes.iter().enumerate() {
        for &child in &node.children {
            get(&document.nodes, child, "node")?;
            parents[child] = Some(parent);
        }
    }
    Ok(parents)
}

impl Skin {
    /// Skin number `index`. `charge` counts the joints and their ancestors as work.
    pub(super) fn new(
        document: &Document<'_>,
        buffers: &mut Buffers<'_>,
        parents: &[Option<usize>],
        index: usize,
        mut charge: impl FnMut(usize) -> Result<(), ReadError>,
    ) -> Result<Self, ReadError> {
        let skin = get(&document.skins, index, "skin")?;
        charge(skin.joints.len())?;
        let binds = match skin.inverse_bind_matrices {
            None => vec![DAffine3::IDENTITY; skin.joints.len()],
            Some(accessor) => {
                charge(buffers.count(accessor)?)?;
                buffers.load(accessor)?;
                buffers.rows::<16>(accessor, "inverse bind matrices")?.iter().map(affine).collect()
            }
        };
        if binds.len() < skin.joints.len() {
            return Err(error(format!("skin {index} has fewer inverse bind matrices than joints")));
        }
        let mut matrices = Vec::with_capacity(skin.joints.len());
        for (&joint, bind) in skin.joints.iter().zip(binds) {
            let mut global = local_transform(get(&document.nodes, joint, "node")?, joint)?;
            let mut node = joint;
            // a cycle ends at the limit of work
            while let Some(parent) = parents[node] {
                charge(1)?;
                global = local_transform(&document.nodes[parent], parent)? * global;
                node = parent;
            }
            matrices.push(global * bind);
        }
        Ok(Self { matrices })
    }

    /// Moves the vertices of a primitive with these attributes. Without joints they stay.
    pub(super) fn apply(
        &self,
        buffers: &mut Buffers<'_>,
        attributes: &Attributes,
        positions: &mut [DVec3],
    ) -> Result<(), ReadError> {
        let mut sets = Vec::new();
        for (joints, weights) in attributes.joint_sets() {
            buffers.load(joints)?;
            buffers.load(weights)?;
            let joints = buffers.rows::<4>(joints, "joints")?;
            let weights = buffers.rows::<4>(weights, "weights")?;
            if joints.len() != positions.len() || weights.len() != positions.len() {
                return Err(error("joints or weights are not as many as the vertices"));
            }
            sets.push((joints, weights));
        }
        if sets.is_empty() {
            return Ok(());
        }
        for (i, position) in positions.iter_mut().enumerate() {
            let pairs =
                sets.iter().flat_map(|(joints, weights)| joints[i].into_iter().zip(weights[i]));
            *position = self.moved(*position, pairs)?;
        }
        Ok(())
    }

    /// A vertex that follows these joints with these weights.
    fn moved(
        &self,
        position: DVec3,
        pairs: impl Iterator<Item = (f64, f64)>,
    ) -> Result<DVec3, ReadError> {
        let (mut sum, mut total) = (DVec3::ZERO, 0.0);
        for (joint, weight) in pairs.filter(|(_, weight)| *weight != 0.0) {
            let matrix = get(&self.matrices, joint as usize, "joint")?;
            sum += weight * matrix.transform_point3(position);
            total += weight;
        }
        if total == 0.0 {
            return Err(error(
                "a vertex of a skinned mesh has no weights: weight all of them, or export without the skeleton",
            ));
        }
        // weights that are whole numbers in the file do not add up to 1 exactly
        Ok(sum / total)
    }

    /// Whether the joints turn the surface inside out, as a mirrored skeleton does.
    pub(super) fn is_mirrored(&self) -> bool {
        self.matrices.first().is_some_and(|matrix| matrix.matrix3.determinant() < 0.0)
    }
}

/// An affine transform from a matrix column by column.
fn affine(m: &[f64; 16]) -> DAffine3 {
    let column = |i: usize| DVec3::new(m[4 * i], m[4 * i + 1], m[4 * i + 2]);
    DAffine3 { matrix3: DMat3::from_cols(column(0), column(1), column(2)), translation: column(3) }
}
