//! `.glb`: binary glTF 2.0 with one node per body and one animation.
//!
//! Reference: The Khronos Group, *glTF 2.0 Specification* (ISO/IEC 12113:2022). In glTF +y is up. If
//! gravity does not point along −y, the root node rotates the scene.

use std::collections::HashMap;
use std::io::Write;

use serde_json::{Value, json};
use tumble::{DQuat, DVec3};

use super::error::ExportError;
use super::geometry::{
    SceneGeometry, ShapeGeometry, continuous_orientations, range_error, upright_rotation,
};
use super::glb_buffer::{ARRAY_BUFFER, BufferBuilder};
use super::job::{Exported, Job, Progress, report};
use crate::replay::ReplayFrame;

/// Primitive mode for points.
const POINTS: u32 = 0;

pub(super) fn write(job: &Job, progress: &mut Progress) -> Result<Exported, ExportError> {
    let (frames, times) = frames_in_single_precision(job);
    let (scene, count) = (&job.replay.scene, job.replay.world.body_count());
    let mut buffer = BufferBuilder::default();
    let geometry = SceneGeometry::new(job)?;
    let mut meshes = Meshes::new(&geometry, &mut buffer)?;
    let mut animation = Animation::new(&mut buffer, &times)?;
    let mut nodes = vec![json!({ "name": scene.name })];
    for (index, body) in job.replay.world.bodies().enumerate() {
        report(progress, index, count)?;
        let translations: Vec<[f32; 3]> =
            frames.iter().map(|frame| to_f32(frame.poses[index].position)).collect();
        let rotations: Vec<[f32; 4]> =
            continuous_orientations(frames.iter().copied(), index).map(rotation).collect();
        animation.add_node(&mut buffer, nodes.len(), &translations, &rotations)?;
        nodes.push(json!({
            "name": body.name(), "mesh": meshes.body_mesh(&geometry, index),
            "translation": translations[0], "rotation": rotations[0],
        }));
    }
    if !geometry.walls.is_empty() {
        nodes.push(json!({ "name": "walls", "mesh": meshes.wall_mesh(&geometry, &mut buffer)? }));
    }
    nodes[0]["children"] = (1..nodes.len()).collect();
    let upright = upright_rotation(scene.gravity, DVec3::Y);
    if upright != DQuat::IDENTITY {
        nodes[0]["rotation"] = json!(rotation(upright));
    }
    let mut root = json!({
        "asset": { "version": "2.0", "generator": concat!("tumble ", env!("CARGO_PKG_VERSION")) },
        "scene": 0, "scenes": [{ "nodes": [0] }], "nodes": nodes,
        "meshes": meshes.meshes, "materials": meshes.materials,
        "accessors": buffer.accessors, "bufferViews": buffer.views,
        "buffers": [{ "byteLength": buffer.bytes.len() }],
    });
    if let Some(animation) = animation.into_json(&scene.name) {
        root["animations"] = json!([animation]);
    }
    let bytes = write_chunks(job, root.to_string().into_bytes(), buffer.bytes)?;
    Ok(Exported { frames: frames.len(), bytes })
}

/// The animation of all nodes.
struct Animation {
    /// Accessor of the times; `None` for a single frame, which needs no animation.
    times: Option<usize>,
    samplers: Vec<Value>,
    channels: Vec<Value>,
}

impl Animation {
    fn new(buffer: &mut BufferBuilder, times: &[[f32; 1]]) -> Result<Self, ExportError> {
        let times = if times.len() > 1 {
            Some(buffer.add_vectors(times, None, true).ok_or_else(range_error)?)
        } else {
            None
        };
        Ok(Self { times, samplers: Vec::new(), channels: Vec::new() })
    }

    /// Adds the motion of a node.
    fn add_node(
        &mut self,
        buffer: &mut BufferBuilder,
        node: usize,
        translations: &[[f32; 3]],
        rotations: &[[f32; 4]],
    ) -> Result<(), ExportError> {
        let Some(times) = self.times else {
            let is_finite = translations[0].iter().all(|number| number.is_finite());
            return if is_finite { Ok(()) } else { Err(range_error()) };
        };
        let outputs = [
            ("translation", buffer.add_vectors(translations, None, false)),
            ("rotation", buffer.add_vectors(rotations, None, false)),
        ];
        for (path, output) in outputs {
            let output = output.ok_or_else(range_error)?;
            let target = json!({ "node": node, "path": path });
            self.channels.push(json!({ "sampler": self.samplers.len(), "target": target }));
            let sampler = json!({ "input": times, "output": output, "interpolation": "LINEAR" });
            self.samplers.push(sampler);
        }
        Ok(())
    }

    fn into_json(self, name: &str) -> Option<Value> {
        self.times?;
        Some(json!({ "name": name, "samplers": self.samplers, "channels": self.channels }))
    }
}

/// Writes the header and the two chunks, each padded to four bytes. Returns the size of the file.
fn write_chunks(job: &Job, mut text: Vec<u8>, mut binary: Vec<u8>) -> Result<u64, ExportError> {
    text.resize(text.len().next_multiple_of(4), b' ');
    binary.resize(binary.len().next_multiple_of(4), 0);
    let to_u32 = |length: usize| {
        let too_long = "the animation exceeds 4 GiB, the maximum size of a .glb; lower --fps, or export a \
                        part of it with --from and --to-time";
        u32::try_from(length).map_err(|_| ExportError::Unsupported(too_long.to_owned()))
    };
    let total = to_u32(12 + 8 + text.len() + 8 + binary.len())?;
    let mut out = job.create_file()?;
    let mut write = |bytes: &[u8]| out.write_all(bytes).map_err(|error| job.write_error(error));
    write(b"glTF")?;
    write(&2u32.to_le_bytes())?;
    write(&total.to_le_bytes())?;
    for (kind, chunk) in [(b"JSON", &text), (b"BIN\0", &binary)] {
        write(&to_u32(chunk.len())?.to_le_bytes())?;
        write(kind)?;
        write(chunk)?;
    }
    out.finish()
}

/// The selected frames with their times since the first frame (s) in single precision. Omits a frame
/// whose time equals that of the previous one, because glTF requires increasing times.
fn frames_in_single_precision<'a>(job: &Job<'a>) -> (Vec<&'a ReplayFrame>, Vec<[f32; 1]>) {
    let start = job.selection.span[0].time;
    let (mut frames, mut times) = (Vec::new(), Vec::<[f32; 1]>::new());
    for frame in job.selection.frames() {
        let time = (frame.time - start) as f32;
        if times.last().is_none_or(|last| last[0] < time) {
            frames.push(frame);
            times.push([time]);
        }
    }
    (frames, times)
}

fn to_f32(v: DVec3) -> [f32; 3] {
    v.as_vec3().to_array()
}

/// A unit quaternion in the order of glTF: x, y, z, w.
fn rotation(q: DQuat) -> [f32; 4] {
    q.as_quat().normalize().to_array()
}

/// The meshes and materials of the file. Bodies with the same shape share its accessors.
struct Meshes {
    /// Primitive of each shape, without a material.
    primitives: Vec<Value>,
    /// Mesh of each shape and colour.
    mesh_of: HashMap<(usize, [u32; 4]), usize>,
    /// Material of each colour.
    material_of: HashMap<[u32; 4], usize>,
    meshes: Vec<Value>,
    materials: Vec<Value>,
}

impl Meshes {
    fn new(geometry: &SceneGeometry, buffer: &mut BufferBuilder) -> Result<Self, ExportError> {
        let primitives: Option<_> =
            geometry.shapes.iter().map(|shape| primitive(shape, buffer)).collect();
        let (mesh_of, material_of) = (HashMap::new(), HashMap::new());
        let primitives = primitives.ok_or_else(range_error)?;
        Ok(Self { primitives, mesh_of, material_of, meshes: Vec::new(), materials: Vec::new() })
    }

    fn body_mesh(&mut self, geometry: &SceneGeometry, body: usize) -> usize {
        let colour = geometry.colours[body];
        let key = colour.map(f32::to_bits);
        let material = *self.material_of.entry(key).or_insert_with(|| {
            let mut material = json!({
                "pbrMetallicRoughness": {
                    "baseColorFactor": colour, "metallicFactor": 0.0, "roughnessFactor": 0.5,
                },
                "doubleSided": true,
            });
            if colour[3] < 1.0 {
                material["alphaMode"] = json!("BLEND");
            }
            self.materials.push(material);
            self.materials.len() - 1
        });
        let shape = geometry.shape_of_body[body];
        *self.mesh_of.entry((shape, key)).or_insert_with(|| {
            let mut primitive = self.primitives[shape].clone();
            primitive["material"] = json!(material);
            self.meshes.push(json!({ "primitives": [primitive] }));
            self.meshes.len() - 1
        })
    }

    fn wall_mesh(
        &mut self,
        geometry: &SceneGeometry,
        buffer: &mut BufferBuilder,
    ) -> Result<usize, ExportError> {
        let points: Vec<[f32; 3]> = geometry.walls.iter().flatten().map(|&v| to_f32(v)).collect();
        let normal = |[a, b, c, _]: &[DVec3; 4]| (*b - *a).cross(*c - *a).normalize_or(DVec3::Y);
        let normals: Vec<[f32; 3]> =
            geometry.walls.iter().flat_map(|wall| [to_f32(normal(wall)); 4]).collect();
        let first_vertices = (0..geometry.walls.len() as u32).map(|wall| 4 * wall);
        let indices: Vec<u32> =
            first_vertices.flat_map(|i| [i, i + 1, i + 2, i, i + 2, i + 3]).collect();
        let position =
            buffer.add_vectors(&points, Some(ARRAY_BUFFER), true).ok_or_else(range_error)?;
        let normal =
            buffer.add_vectors(&normals, Some(ARRAY_BUFFER), false).ok_or_else(range_error)?;
        self.meshes.push(json!({ "primitives": [{
            "attributes": { "POSITION": position, "NORMAL": normal },
            "indices": buffer.add_indices(&indices), "material": self.materials.len(),
        }]}));
        self.materials.push(json!({
            "name": "walls", "alphaMode": "BLEND", "doubleSided": true,
            "pbrMetallicRoughness": {
                "baseColorFactor": [0.8, 0.82, 0.86, 0.25], "metallicFactor": 0.0,
                "roughnessFactor": 0.9,
            },
        }));
        Ok(self.meshes.len() - 1)
    }
}

/// The primitive of a shape; `None` if a coordinate exceeds the range of single precision.
fn primitive(shape: &ShapeGeometry, buffer: &mut BufferBuilder) -> Option<Value> {
    if shape.triangles.is_empty() {
        let points: Vec<[f32; 3]> = shape.points.iter().map(|&point| to_f32(point)).collect();
        let position = buffer.add_vectors(&points, Some(ARRAY_BUFFER), true)?;
        return Some(json!({ "attributes": { "POSITION": position }, "mode": POINTS }));
    }
    // a vertex of glTF has one normal, so a vertex on a crease becomes several
    let mut vertex_of: HashMap<(u32, [u32; 3]), u32> = HashMap::new();
    let (mut points, mut normals, mut indices) = (Vec::new(), Vec::new(), Vec::new());
    for (triangle, triangle_normals) in shape.triangles.iter().zip(&shape.normals) {
        for (&corner, normal) in triangle.iter().zip(triangle_normals) {
            let normal = normal.normalize().to_array();
            let index = vertex_of.entry((corner, normal.map(f32::to_bits))).or_insert_with(|| {
                points.push(to_f32(shape.points[corner as usize]));
                normals.push(normal);
                (points.len() - 1) as u32
            });
            indices.push(*index);
        }
    }
    Some(json!({
        "attributes": {
            "POSITION": buffer.add_vectors(&points, Some(ARRAY_BUFFER), true)?,
            "NORMAL": buffer.add_vectors(&normals, Some(ARRAY_BUFFER), false)?,
        },
        "indices": buffer.add_indices(&indices),
    }))
}
