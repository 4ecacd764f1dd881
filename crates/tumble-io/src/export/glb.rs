//! `.glb`: binary glTF 2.0, a node a body, moved by one animation.
//!
//! The Khronos Group, *glTF 2.0 Specification* (ISO/IEC 12113:2022). +y is up there, so where gravity
//! points another way, a root node turns the scene.

use std::collections::HashMap;
use std::io::Write;

use serde_json::{Value, json};
use tumble::{DQuat, DVec3};

use super::glb_buffer::{Arrays, VERTICES};
use super::stage::{Form, Stage, steady, too_far, upright};
use super::{ExportError, Exported, Job, Watch, tell};
use crate::replay::ReplayFrame;

/// Number of the primitive mode that draws points.
const POINTS: u32 = 0;

pub(super) fn write(job: &Job, watch: &mut Watch) -> Result<Exported, ExportError> {
    let (frames, times) = in_single_precision(job);
    let (scene, count) = (&job.replay.scene, job.replay.world.body_count());
    let mut arrays = Arrays::default();
    let stage = Stage::new(job)?;
    let mut meshes = Meshes::new(&stage, &mut arrays)?;
    let mut motion = Motion::new(&mut arrays, &times)?;
    let mut nodes = vec![json!({ "name": scene.name })];
    for (index, body) in job.replay.world.bodies().enumerate() {
        tell(watch, index, count)?;
        let places: Vec<[f32; 3]> =
            frames.iter().map(|frame| single(frame.poses[index].position)).collect();
        let turns: Vec<[f32; 4]> = steady(frames.iter().copied(), index).map(turn).collect();
        motion.add(&mut arrays, nodes.len(), &places, &turns)?;
        nodes.push(json!({
            "name": body.name(), "mesh": meshes.of_body(&stage, index),
            "translation": places[0], "rotation": turns[0],
        }));
    }
    if !stage.walls.is_empty() {
        nodes.push(json!({ "name": "walls", "mesh": meshes.walls(&stage, &mut arrays)? }));
    }
    nodes[0]["children"] = (1..nodes.len()).collect();
    let upright = upright(scene.gravity, DVec3::Y);
    if upright != DQuat::IDENTITY {
        nodes[0]["rotation"] = json!(turn(upright));
    }
    let mut root = json!({
        "asset": { "version": "2.0", "generator": concat!("tumble ", env!("CARGO_PKG_VERSION")) },
        "scene": 0, "scenes": [{ "nodes": [0] }], "nodes": nodes,
        "meshes": meshes.meshes, "materials": meshes.materials,
        "accessors": arrays.accessors, "bufferViews": arrays.views,
        "buffers": [{ "byteLength": arrays.bytes.len() }],
    });
    if let Some(animation) = motion.animation(&scene.name) {
        root["animations"] = json!([animation]);
    }
    let bytes = put_together(job, root.to_string().into_bytes(), arrays.bytes)?;
    Ok(Exported { frames: frames.len(), bytes })
}

/// How the nodes move.
struct Motion {
    /// The accessor of the times; none for a single frame, which is a pose and no motion.
    clock: Option<usize>,
    samplers: Vec<Value>,
    channels: Vec<Value>,
}

impl Motion {
    fn new(arrays: &mut Arrays, times: &[[f32; 1]]) -> Result<Self, ExportError> {
        let clock = if times.len() > 1 {
            Some(arrays.vectors(times, None, true).ok_or_else(too_far)?)
        } else {
            None
        };
        Ok(Self { clock, samplers: Vec::new(), channels: Vec::new() })
    }

    fn add(
        &mut self,
        arrays: &mut Arrays,
        node: usize,
        places: &[[f32; 3]],
        turns: &[[f32; 4]],
    ) -> Result<(), ExportError> {
        let Some(clock) = self.clock else {
            let is_finite = places[0].iter().all(|number| number.is_finite());
            return if is_finite { Ok(()) } else { Err(too_far()) };
        };
        let outputs = [
            ("translation", arrays.vectors(places, None, false)),
            ("rotation", arrays.vectors(turns, None, false)),
        ];
        for (path, output) in outputs {
            let output = output.ok_or_else(too_far)?;
            let target = json!({ "node": node, "path": path });
            self.channels.push(json!({ "sampler": self.samplers.len(), "target": target }));
            let sampler = json!({ "input": clock, "output": output, "interpolation": "LINEAR" });
            self.samplers.push(sampler);
        }
        Ok(())
    }

    fn animation(self, name: &str) -> Option<Value> {
        self.clock?;
        Some(json!({ "name": name, "samplers": self.samplers, "channels": self.channels }))
    }
}

/// The two chunks and their header, each padded to four bytes.
fn put_together(job: &Job, mut text: Vec<u8>, mut binary: Vec<u8>) -> Result<u64, ExportError> {
    text.resize(text.len().next_multiple_of(4), b' ');
    binary.resize(binary.len().next_multiple_of(4), 0);
    let word = |length: usize| {
        let too_long = "the motion is longer than the 4 GiB that a .glb can hold; lower --fps, or \
                        export a part of it with --from and --to-time";
        u32::try_from(length).map_err(|_| ExportError::Unfit(too_long.to_owned()))
    };
    let whole = word(12 + 8 + text.len() + 8 + binary.len())?;
    let mut out = job.draft()?;
    let mut put = |bytes: &[u8]| out.write_all(bytes).map_err(|error| job.failed(error));
    put(b"glTF")?;
    put(&2u32.to_le_bytes())?;
    put(&whole.to_le_bytes())?;
    for (kind, chunk) in [(b"JSON", &text), (b"BIN\0", &binary)] {
        put(&word(chunk.len())?.to_le_bytes())?;
        put(kind)?;
        put(chunk)?;
    }
    out.finish()
}

/// The frames whose times, counted from the first one, still differ in single precision.
fn in_single_precision<'a>(job: &Job<'a>) -> (Vec<&'a ReplayFrame>, Vec<[f32; 1]>) {
    let start = job.chosen.span[0].time;
    let (mut frames, mut times) = (Vec::new(), Vec::<[f32; 1]>::new());
    for frame in job.chosen.frames() {
        let time = (frame.time - start) as f32;
        if times.last().is_none_or(|last| last[0] < time) {
            frames.push(frame);
            times.push([time]);
        }
    }
    (frames, times)
}

fn single(v: DVec3) -> [f32; 3] {
    v.as_vec3().to_array()
}

/// In the order of glTF: x, y, z, w.
fn turn(q: DQuat) -> [f32; 4] {
    q.as_quat().normalize().to_array()
}

/// The meshes and materials of the file; bodies of one shape share its arrays.
struct Meshes {
    /// The primitive of each shape, without a material.
    primitives: Vec<Value>,
    /// The mesh of each shape and colour.
    made: HashMap<(usize, [u32; 4]), usize>,
    /// The material of each colour.
    colours: HashMap<[u32; 4], usize>,
    meshes: Vec<Value>,
    materials: Vec<Value>,
}

impl Meshes {
    fn new(stage: &Stage, arrays: &mut Arrays) -> Result<Self, ExportError> {
        let primitives: Option<_> =
            stage.forms.iter().map(|form| primitive(form, arrays)).collect();
        let (made, colours) = (HashMap::new(), HashMap::new());
        let primitives = primitives.ok_or_else(too_far)?;
        Ok(Self { primitives, made, colours, meshes: Vec::new(), materials: Vec::new() })
    }

    fn of_body(&mut self, stage: &Stage, body: usize) -> usize {
        let colour = stage.colours[body];
        let key = colour.map(f32::to_bits);
        let material = *self.colours.entry(key).or_insert_with(|| {
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
        let form = stage.form_of[body];
        *self.made.entry((form, key)).or_insert_with(|| {
            let mut primitive = self.primitives[form].clone();
            primitive["material"] = json!(material);
            self.meshes.push(json!({ "primitives": [primitive] }));
            self.meshes.len() - 1
        })
    }

    fn walls(&mut self, stage: &Stage, arrays: &mut Arrays) -> Result<usize, ExportError> {
        let points: Vec<[f32; 3]> = stage.walls.iter().flatten().map(|&v| single(v)).collect();
        let normal = |[a, b, c, _]: &[DVec3; 4]| (*b - *a).cross(*c - *a).normalize_or(DVec3::Y);
        let normals: Vec<[f32; 3]> =
            stage.walls.iter().flat_map(|wall| [single(normal(wall)); 4]).collect();
        let corners = (0..stage.walls.len() as u32).map(|wall| 4 * wall);
        let indices: Vec<u32> = corners.flat_map(|i| [i, i + 1, i + 2, i, i + 2, i + 3]).collect();
        let position = arrays.vectors(&points, Some(VERTICES), true).ok_or_else(too_far)?;
        let normal = arrays.vectors(&normals, Some(VERTICES), false).ok_or_else(too_far)?;
        self.meshes.push(json!({ "primitives": [{
            "attributes": { "POSITION": position, "NORMAL": normal },
            "indices": arrays.indices(&indices), "material": self.materials.len(),
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

/// The arrays of a shape; `None` if it is too large for single precision.
fn primitive(form: &Form, arrays: &mut Arrays) -> Option<Value> {
    if form.triangles.is_empty() {
        let points: Vec<[f32; 3]> = form.points.iter().map(|&point| single(point)).collect();
        let position = arrays.vectors(&points, Some(VERTICES), true)?;
        return Some(json!({ "attributes": { "POSITION": position }, "mode": POINTS }));
    }
    // a vertex of glTF has one normal: one on a crease becomes several
    let mut made: HashMap<(u32, [u32; 3]), u32> = HashMap::new();
    let (mut points, mut normals, mut indices) = (Vec::new(), Vec::new(), Vec::new());
    for (triangle, around) in form.triangles.iter().zip(&form.normals) {
        for (&corner, normal) in triangle.iter().zip(around) {
            let normal = normal.normalize().to_array();
            let index = made.entry((corner, normal.map(f32::to_bits))).or_insert_with(|| {
                points.push(single(form.points[corner as usize]));
                normals.push(normal);
                (points.len() - 1) as u32
            });
            indices.push(*index);
        }
    }
    Some(json!({
        "attributes": {
            "POSITION": arrays.vectors(&points, Some(VERTICES), true)?,
            "NORMAL": arrays.vectors(&normals, Some(VERTICES), false)?,
        },
        "indices": arrays.indices(&indices),
    }))
}
