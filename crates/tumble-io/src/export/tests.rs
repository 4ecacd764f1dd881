//! Reads exported files back and compares them with the run.

use std::fs;
use std::path::{Path, PathBuf};

use glam::{Quat, Vec3};
use proptest::prelude::*;
use serde_json::Value;
use tempfile::TempDir;
use tumble::{DVec3, World};

use super::*;
use crate::picture::View;
use crate::plot::EnergyRow;
use crate::replay::{Pose, Replay, ReplayFrame};
use crate::scene::{LoadOptions, Loaded, Source, load_text};

/// Two boxes with the same shape, a pair of particles without a surface, and a floor.
const SCENE: &str = "dt = 1e-3\ncollision = { collision_stiffness = 500 }\n\
    wall = [{ normal = [0, 1, 0] }]\n\
    [[body]]\nname = \"box \\\\ & <ä>\"\nshape = \"box\"\nposition = [0, 0.1, 0]\n\
    copies = { count = [2, 1, 1], spacing = [1, 1, 1] }\n\
    initial_velocity = [0, -1, 0]\ninitial_angular_velocity = [40, 2, 3]\n\
    [[body]]\nname = \"pair\"\nparticles = [[0, 0, 0], [1, 0, 0]]\nposition = [0, 2, 0]\n";

fn scene(text: &str) -> Loaded {
    let source = Source { name: "s.toml".to_owned(), text: text.to_owned() };
    load_text("s", source, Path::new("."), &LoadOptions::default()).unwrap()
}

fn frame(world: &World) -> ReplayFrame {
    let poses = world.bodies().map(|body| Pose {
        position: body.position(),
        velocity: body.velocity(),
        orientation: body.orientation(),
        angular_velocity: body.angular_velocity(),
        angular_momentum: body.angular_momentum(),
    });
    ReplayFrame { time: world.time(), poses: poses.collect() }
}

/// `count` frames, one every 20 ms.
fn replay(text: &str, count: usize) -> Replay {
    let Loaded { scene, world } = scene(text);
    let mut moving = world.clone();
    let mut frames = vec![frame(&moving)];
    while frames.len() < count {
        (0..20).for_each(|_| moving.step().unwrap());
        frames.push(frame(&moving));
    }
    let ledger =
        frames.iter().map(|frame| EnergyRow { time: frame.time, ..EnergyRow::default() }).collect();
    Replay { scene, world, frames, ledger }
}

/// A temporary folder for exports.
struct OutputFolder(TempDir);

impl OutputFolder {
    fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn export(
        &self,
        replay: &Replay,
        name: &str,
        options: ExportOptions,
    ) -> Result<Exported, ExportError> {
        Export::new(&self.path(name), options)?.write(replay, &mut |_, _| true)
    }

    fn bytes(&self, replay: &Replay, name: &str, options: ExportOptions) -> Vec<u8> {
        let exported = self.export(replay, name, options).unwrap();
        let bytes = fs::read(self.path(name)).unwrap();
        assert!(exported.bytes >= bytes.len() as u64);
        bytes
    }

    fn names(&self) -> Vec<String> {
        let entries = fs::read_dir(self.0.path()).unwrap();
        entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect()
    }
}

fn small() -> ExportOptions {
    ExportOptions { size: Some((64, 48)), ..ExportOptions::default() }
}

fn word(bytes: &[u8], at: usize) -> usize {
    u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()) as usize
}

/// The two chunks of a `.glb`: JSON and binary.
fn glb(bytes: &[u8]) -> (Value, Vec<u8>) {
    assert_eq!((&bytes[..4], word(bytes, 4), word(bytes, 8)), (&b"glTF"[..], 2, bytes.len()));
    let length = word(bytes, 12);
    assert_eq!((&bytes[16..20], length % 4), (&b"JSON"[..], 0));
    let binary = 20 + length;
    assert_eq!(&bytes[binary + 4..binary + 8], b"BIN\0");
    assert_eq!(word(bytes, binary) + binary + 8, bytes.len());
    (serde_json::from_slice(&bytes[20..binary]).unwrap(), bytes[binary + 8..].to_vec())
}

/// The numbers of an accessor of `f32` type.
fn floats(root: &Value, binary: &[u8], accessor: &Value) -> Vec<f32> {
    let accessor = &root["accessors"][accessor.as_u64().unwrap() as usize];
    let view = &root["bufferViews"][accessor["bufferView"].as_u64().unwrap() as usize];
    let start = view["byteOffset"].as_u64().unwrap() as usize;
    let length = view["byteLength"].as_u64().unwrap() as usize;
    let width = match accessor["type"].as_str().unwrap() {
        "SCALAR" => 1,
        "VEC3" => 3,
        _ => 4,
    };
    assert_eq!(accessor["count"].as_u64().unwrap() as usize * width * 4, length);
    let numbers = binary[start..start + length].chunks_exact(4);
    numbers.map(|four| f32::from_le_bytes(four.try_into().unwrap())).collect()
}

#[test]
fn the_animation_of_a_glb_is_the_motion_of_the_bodies() {
    let replay = replay(SCENE, 30);
    let (root, binary) =
        glb(&OutputFolder::new().bytes(&replay, "a.glb", ExportOptions::default()));
    let animation = &root["animations"][0];
    assert_eq!(animation["channels"].as_array().unwrap().len(), 6);
    for channel in animation["channels"].as_array().unwrap() {
        let sampler = &animation["samplers"][channel["sampler"].as_u64().unwrap() as usize];
        let times = floats(&root, &binary, &sampler["input"]);
        assert!(times.windows(2).all(|pair| pair[0] < pair[1]));
        let body = channel["target"]["node"].as_u64().unwrap() as usize - 1;
        let node = &root["nodes"][body + 1];
        assert_eq!(node["name"], replay.world.body(body).name());
        let numbers = floats(&root, &binary, &sampler["output"]);
        if channel["target"]["path"] == "translation" {
            for (frame, place) in replay.frames.iter().zip(numbers.chunks_exact(3)) {
                assert_eq!(Vec3::from_slice(place), frame.poses[body].position.as_vec3());
            }
            continue;
        }
        let turns: Vec<Quat> = numbers.chunks_exact(4).map(Quat::from_slice).collect();
        assert!(turns.iter().all(|q| (q.length() - 1.0).abs() < 1e-6));
        assert!(turns.windows(2).all(|pair| pair[0].dot(pair[1]) >= 0.0));
        for (frame, q) in replay.frames.iter().zip(turns) {
            let own = frame.poses[body].orientation.as_quat();
            assert!(q.dot(own).abs() > 1.0 - 1e-6);
        }
    }
}

#[test]
fn bodies_of_one_shape_share_accessors_and_accessor_bounds_are_correct() {
    let replay = replay(SCENE, 2);
    let (root, binary) =
        glb(&OutputFolder::new().bytes(&replay, "a.glb", ExportOptions::default()));
    let primitive = |node: usize| {
        let mesh = root["nodes"][node]["mesh"].as_u64().unwrap() as usize;
        root["meshes"][mesh]["primitives"][0].clone()
    };
    // two bodies with the same shape and different colours
    assert_eq!(primitive(1)["attributes"], primitive(2)["attributes"]);
    assert_ne!(primitive(1)["material"], primitive(2)["material"]);
    assert_eq!((&primitive(3)["mode"], &primitive(3)["indices"]), (&Value::from(0), &Value::Null));
    assert_eq!(root["nodes"][4]["name"], "walls");
    for node in 1..=4 {
        let position = &primitive(node)["attributes"]["POSITION"];
        let accessor = &root["accessors"][position.as_u64().unwrap() as usize];
        for point in floats(&root, &binary, position).chunks_exact(3) {
            for (i, number) in point.iter().enumerate() {
                let bound = |name: &str| accessor[name][i].as_f64().unwrap();
                assert!((bound("min")..=bound("max")).contains(&f64::from(*number)));
            }
        }
        if let Value::Number(_) = primitive(node)["attributes"]["NORMAL"] {
            let normals = floats(&root, &binary, &primitive(node)["attributes"]["NORMAL"]);
            let mut normals = normals.chunks_exact(3).map(Vec3::from_slice);
            assert!(normals.all(|n| (n.length() - 1.0).abs() < 1e-5));
        }
    }
}

#[test]
fn a_glb_of_one_frame_has_no_animation_and_is_upright() {
    let text = format!("gravity = [0, 0, -9.8]\n{SCENE}");
    let (root, _) =
        glb(&OutputFolder::new().bytes(&replay(&text, 1), "a.glb", ExportOptions::default()));
    assert_eq!(root["animations"], Value::Null);
    let q: Vec<f32> = serde_json::from_value(root["nodes"][0]["rotation"].clone()).unwrap();
    assert!((Quat::from_slice(&q) * Vec3::Z - Vec3::Y).length() < 1e-6);
}

#[test]
fn positions_beyond_single_precision_are_rejected() {
    let mut far = replay(SCENE, 2);
    let folder = OutputFolder::new();
    for (file, x) in [("a.glb", 1e39), ("a.usda", 1e39), ("a.glb", 1e300), ("a.usda", 1e300)] {
        far.frames[1].poses[0].position = DVec3::X * x;
        let error = folder.export(&far, file, ExportOptions::default()).unwrap_err();
        assert!(matches!(error, ExportError::Unsupported(_)), "{error}");
    }
    assert!(folder.names().is_empty());
    // times that are equal in single precision
    let mut dense = replay(SCENE, 3);
    dense.frames[1].time = dense.frames[2].time - 1e-12;
    let exported = folder.export(&dense, "a.glb", ExportOptions::default()).unwrap();
    assert_eq!(exported.frames, 2);
}

#[test]
fn a_usda_has_valid_names_and_time_samples() {
    let replay = replay(SCENE, 4);
    let text = OutputFolder::new().bytes(&replay, "a.usda", ExportOptions::default());
    let text = String::from_utf8(text).unwrap();
    let metadata =
        "endTimeCode = 3\n    framesPerSecond = 50\n    metersPerUnit = 1\n    startTimeCode = 0";
    assert!(text.starts_with("#usda 1.0\n"), "{text}");
    for part in [
        metadata,
        "upAxis = \"Y\"",
        "def Xform \"box_________0\" (",
        "displayName = \"box \\\\ & <ä> 0\"",
        "def Xform \"pair\" (",
        "prepend references = </World/Shapes/Shape_0>",
        "prepend references = </World/Shapes/Shape_1>",
        "def Points \"particles\"",
        "def Mesh \"walls\"",
    ] {
        assert!(text.contains(part), "{part} is missing in:\n{text}");
    }
    assert_eq!(text.matches("class Xform").count(), 2);
    assert_eq!(text.matches('{').count(), text.matches('}').count());
    let z = OutputFolder::new().bytes(
        &self::replay(&format!("gravity = [0, 0, -9.8]\n{SCENE}"), 2),
        "a.usda",
        ExportOptions::default(),
    );
    let z = String::from_utf8(z).unwrap();
    assert!(z.contains("upAxis = \"Z\"") && !z.contains("    quatf xformOp:orient = "));
}

/// The bytes of the array `name` of a `.vtp`.
fn array<'a>(bytes: &'a [u8], name: &str) -> &'a [u8] {
    let find = |text: &[u8], from: usize| {
        let at = bytes[from..].windows(text.len()).position(|window| window == text);
        from + at.unwrap() + text.len()
    };
    let named = find(format!("Name=\"{name}\"").as_bytes(), 0);
    let offset = find(b"offset=\"", named);
    let digits = bytes[offset..].iter().take_while(|byte| byte.is_ascii_digit()).count();
    let offset: usize =
        std::str::from_utf8(&bytes[offset..offset + digits]).unwrap().parse().unwrap();
    let start = find(b"encoding=\"raw\">\n_", 0) + offset;
    let length = u64::from_le_bytes(bytes[start..start + 8].try_into().unwrap()) as usize;
    &bytes[start + 8..start + 8 + length]
}

fn vectors(bytes: &[u8]) -> Vec<Vec3> {
    let number = |four: &[u8]| f32::from_le_bytes(four[..4].try_into().unwrap());
    bytes.chunks_exact(12).map(|v| Vec3::new(number(v), number(&v[4..]), number(&v[8..]))).collect()
}

#[test]
fn a_vtp_has_position_velocity_and_force_of_every_particle() {
    let mut replay = replay(SCENE, 6);
    // one body deep below the floor
    replay.frames[5].poses[0].position.y = 0.05;
    let folder = OutputFolder::new();
    let list = folder.bytes(&replay, "a & b.pvd", ExportOptions::default());
    let list = String::from_utf8(list).unwrap();
    assert_eq!(list.matches("<DataSet timestep=").count(), 6);
    assert!(list.contains("file=\"a &amp; b_frames/frame_000005.vtp\""), "{list}");
    let bytes = fs::read(folder.path("a & b_frames/frame_000005.vtp")).unwrap();
    let (places, velocities) =
        (vectors(array(&bytes, "Points")), vectors(array(&bytes, "velocity")));
    let (forces, bodies) = (vectors(array(&bytes, "force")), array(&bytes, "body"));
    assert_eq!(array(&bytes, "TimeValue"), replay.frames[5].time.to_le_bytes());
    let mut index = 0;
    for (number, (body, pose)) in replay.world.bodies().zip(&replay.frames[5].poses).enumerate() {
        for r in body.model().shape.particles().iter() {
            let arm = pose.orientation * r;
            let place = pose.position + arm;
            assert!((places[index] - place.as_vec3()).length() < 1e-6);
            let velocity = pose.velocity + pose.angular_velocity.cross(arm);
            assert!((velocities[index] - velocity.as_vec3()).length() < 1e-4);
            let force = Vec3::Y * (500.0 * (-place.y).max(0.0)) as f32;
            assert!((forces[index] - force).length() < 1e-3, "{} {force}", forces[index]);
            assert_eq!(word(bodies, 4 * index), number);
            index += 1;
        }
    }
    assert_eq!((places.len(), array(&bytes, "particle")), (index, vec![1; index].as_slice()));
    assert!(forces.iter().any(|force| force.y > 1.0));
}

#[test]
fn a_pvd_replaces_a_previous_export_but_no_other_files() {
    let folder = OutputFolder::new();
    let force = ExportOptions { force: true, ..ExportOptions::default() };
    folder.export(&replay(SCENE, 9), "a.pvd", ExportOptions::default()).unwrap();
    let again = folder.export(&replay(SCENE, 2), "a.pvd", ExportOptions::default());
    assert!(matches!(again, Err(ExportError::Exists(_))));
    folder.export(&replay(SCENE, 2), "a.pvd", force.clone()).unwrap();
    assert_eq!(fs::read_dir(folder.path("a_frames")).unwrap().count(), 2);
    fs::write(folder.path("a_frames/mine.txt"), "mine").unwrap();
    let error = folder.export(&replay(SCENE, 3), "a.pvd", force).unwrap_err().to_string();
    assert!(error.contains("mine.txt"), "{error}");
    assert_eq!(
        (folder.names().len(), fs::read_dir(folder.path("a_frames")).unwrap().count()),
        (2, 3)
    );
}

#[test]
fn a_gif_plays_in_real_time() {
    let replay = replay(SCENE, 26);
    let bytes = OutputFolder::new().bytes(&replay, "a.gif", small());
    let mut options = ::gif::DecodeOptions::new();
    options.set_color_output(::gif::ColorOutput::RGBA);
    let mut decoder = options.read_info(bytes.as_slice()).unwrap();
    assert_eq!((decoder.width(), decoder.height()), (64, 48));
    let mut canvas = vec![0u8; 64 * 48 * 4];
    let (mut delays, mut first) = (Vec::new(), Vec::new());
    while let Some(frame) = decoder.read_next_frame().unwrap() {
        delays.push(frame.delay);
        let width = usize::from(frame.width);
        for (at, pixel) in frame.buffer.chunks_exact(4).enumerate().filter(|(_, p)| p[3] > 0) {
            let (x, y) =
                (at % width + usize::from(frame.left), at / width + usize::from(frame.top));
            canvas[4 * (64 * y + x)..][..4].copy_from_slice(pixel);
        }
        if first.is_empty() {
            first = canvas.clone();
        }
    }
    // every second of 50 frames per second, and a longer delay after the last one
    assert_eq!((delays.len(), &delays[..3], delays[12]), (13, &[4, 4, 4][..], 100));
    assert!(first != canvas && first.chunks_exact(4).all(|pixel| pixel[3] == 255));
    let last =
        OutputFolder::new().bytes(&replay, "a.png", ExportOptions { at: Some(0.48), ..small() });
    let mut reader = ::png::Decoder::new(std::io::Cursor::new(last)).read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    reader.next_frame(&mut pixels).unwrap();
    let off = pixels
        .chunks_exact(3)
        .zip(canvas.chunks_exact(4))
        .map(|(a, b)| (0..3).map(|i| f64::from(a[i].abs_diff(b[i]))).sum::<f64>());
    assert!(off.sum::<f64>() / (64.0 * 48.0 * 3.0) < 3.0, "the last frame is another picture");
}

#[test]
fn the_view_changes_the_image() {
    let replay = replay(SCENE, 3);
    let seen = |yaw: f64, pitch: f64, zoom: f64| {
        let view = Some(View { yaw, pitch, zoom });
        OutputFolder::new().bytes(&replay, "a.png", ExportOptions { view, ..small() })
    };
    let pictures =
        [seen(0.0, 0.3, 1.0), seen(1.0, 0.3, 1.0), seen(0.0, 1.5, 1.0), seen(0.0, 0.3, 3.0)];
    for (i, picture) in pictures.iter().enumerate() {
        assert!(pictures[..i].iter().all(|other| other != picture), "{i}");
    }
}

#[test]
fn frames_are_selected_by_time_and_rate() {
    let replay = replay(SCENE, 51);
    let rows = |options: ExportOptions| {
        let text = String::from_utf8(OutputFolder::new().bytes(&replay, "a.csv", options)).unwrap();
        let times =
            text.lines().skip(1).step_by(3).map(|row| row.split(',').next().unwrap().parse());
        times.collect::<Result<Vec<f64>, _>>().unwrap()
    };
    let of =
        |fps, from, to_time| rows(ExportOptions { fps, from, to_time, ..ExportOptions::default() });
    let near = |a: &[f64], b: &[f64]| {
        a.len() == b.len() && a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-9)
    };
    assert_eq!(of(None, None, None).len(), 51);
    assert_eq!(of(Some(1000.0), None, None).len(), 51);
    assert!(near(&of(Some(2.0), None, None), &[0.0, 0.5, 1.0]));
    assert!(near(&of(Some(1e-6), None, None), &[0.0]));
    assert!(near(&of(None, Some(0.3), Some(0.34)), &[0.3, 0.32, 0.34]));
    let none = ExportOptions { from: Some(7.0), ..ExportOptions::default() };
    let error = OutputFolder::new().export(&replay, "a.csv", none).unwrap_err();
    assert!(
        error.is_invalid_request() && error.to_string().contains("51 frames, from 0 s to 1"),
        "{error}"
    );
}

#[test]
fn a_stopped_export_leaves_no_files() {
    let replay = replay(SCENE, 5);
    for (extension, _) in Format::ALL {
        let folder = OutputFolder::new();
        let options = if matches!(extension, "png" | "gif" | "mp4") {
            small()
        } else {
            ExportOptions::default()
        };
        let export = Export::new(&folder.path(&format!("a.{extension}")), options).unwrap();
        let result = export.write(&replay, &mut |_, _| false);
        match result {
            Err(ExportError::Stopped) => {}
            // if ffmpeg is not installed, the export fails first
            Err(ExportError::NoFfmpeg) if extension == "mp4" => {}
            other => panic!("{extension}: {other:?}"),
        }
        assert!(folder.names().is_empty(), "{extension}: {:?}", folder.names());
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn any_options_are_accepted_or_rejected(
        format in 0usize..4,
        fps in proptest::option::of(any::<f64>()),
        from in proptest::option::of(-1.0..1.0f64),
        to_time in proptest::option::of(-1.0..1.0f64),
        at in proptest::option::of(any::<f64>()),
    ) {
        static REPLAY: std::sync::OnceLock<Replay> = std::sync::OnceLock::new();
        let replay = REPLAY.get_or_init(|| replay(SCENE, 8));
        let folder = OutputFolder::new();
        let options = ExportOptions { fps, from, to_time, at, ..ExportOptions::default() };
        let name = format!("a.{}", Format::ALL[format].0);
        match folder.export(replay, &name, options) {
            Ok(exported) => prop_assert!(exported.frames > 0 && folder.path(&name).is_file()),
            Err(error) => {
                prop_assert!(error.is_invalid_request(), "{}", error);
                prop_assert!(folder.names().is_empty());
            }
        }
    }
}
