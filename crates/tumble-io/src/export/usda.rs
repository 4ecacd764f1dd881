//! `.usda`: USD as text, an Xform a body, moved by time samples.
//!
//! Pixar, *Universal Scene Description*, <https://openusd.org>. Shapes are classes that bodies refer
//! to as instances. +z is up where gravity points along −z, else +y, and where it points another way,
//! the topmost Xform turns the scene.

use std::collections::HashSet;
use std::io::{self, Write};

use glam::Vec3;
use tumble::{DQuat, DVec3};

use super::draft::Draft;
use super::stage::{Form, Stage, steady, upright};
use super::{ExportError, Exported, Job, Watch, tell};

pub(super) fn write(job: &Job, watch: &mut Watch) -> Result<Exported, ExportError> {
    let stage = Stage::new(job)?;
    let mut out = job.draft()?;
    let failed = |error| job.failed(error);
    let scene = &job.replay.scene;
    let up = if upright(scene.gravity, DVec3::Z) == DQuat::IDENTITY && scene.gravity != DVec3::ZERO
    {
        DVec3::Z
    } else {
        DVec3::Y
    };
    // whole time codes for an even rate, and never so few that a player stands still
    let rate = job.chosen.rate.round().max(1.0);
    header(&mut out, job, up, rate).map_err(failed)?;
    shapes(&mut out, &stage).map_err(failed)?;
    let bodies = job.replay.world.bodies();
    let colours = materials(&mut out, &stage).map_err(failed)?;
    let mut names = HashSet::from(["Shapes".to_owned(), "Materials".to_owned()]);
    let count = bodies.len();
    for (index, body) in bodies.enumerate() {
        tell(watch, index, count)?;
        let name = (identifier(body.name(), &mut names), body.name());
        let looks = (stage.form_of[index], colours[index], stage.colours[index]);
        write_body(&mut out, job, (index, looks), name, rate).map_err(failed)?;
    }
    if !stage.walls.is_empty() {
        walls(&mut out, &stage.walls, &identifier("walls", &mut names)).map_err(failed)?;
    }
    writeln!(out, "}}").map_err(failed)?;
    Ok(Exported { frames: job.chosen.indices.len(), bytes: out.finish()? })
}

fn header(out: &mut Draft, job: &Job, up: DVec3, rate: f64) -> io::Result<()> {
    let scene = &job.replay.scene;
    let span = job.chosen.frames().map(|frame| frame.time * rate);
    let (start, end) = (span.clone().next().unwrap_or(0.0), span.last().unwrap_or(0.0));
    let axis = if up == DVec3::Z { "Z" } else { "Y" };
    writeln!(
        out,
        "#usda 1.0\n(\n    defaultPrim = \"World\"\n    doc = \"{}, written by tumble {}\"\n    \
         endTimeCode = {end}\n    framesPerSecond = {rate}\n    metersPerUnit = 1\n    \
         startTimeCode = {start}\n    timeCodesPerSecond = {rate}\n    upAxis = \"{axis}\"\n)\n\n\
         def Xform \"World\" (\n    kind = \"component\"\n)\n{{",
        quoted(&scene.name),
        env!("CARGO_PKG_VERSION"),
    )?;
    let q = upright(scene.gravity, up);
    if q != DQuat::IDENTITY {
        writeln!(out, "    quatf xformOp:orient = {}", quaternion(q))?;
        writeln!(out, "    uniform token[] xformOpOrder = [\"xformOp:orient\"]\n")?;
    }
    Ok(())
}

/// The shapes, in a scope of classes, which are drawn only where a body refers to them.
fn shapes(out: &mut Draft, stage: &Stage) -> io::Result<()> {
    writeln!(out, "    def Scope \"Shapes\"\n    {{")?;
    for (index, form) in stage.forms.iter().enumerate() {
        writeln!(out, "        class Xform \"Shape_{index}\"\n        {{")?;
        if form.triangles.is_empty() {
            particles(out, form)?
        } else {
            mesh(out, form)?
        }
        writeln!(out, "        }}\n")?;
    }
    writeln!(out, "    }}\n")
}

/// A material for each colour of the bodies, for renderers that do not heed `displayColor`; returns
/// which one each body has.
fn materials(out: &mut Draft, stage: &Stage) -> io::Result<Vec<usize>> {
    let mut made: Vec<[f32; 4]> = Vec::new();
    let of_body = stage.colours.iter().map(|colour| {
        made.iter().position(|other| other == colour).unwrap_or_else(|| {
            made.push(*colour);
            made.len() - 1
        })
    });
    let of_body = of_body.collect();
    writeln!(out, "    def Scope \"Materials\"\n    {{")?;
    for (index, [r, g, b, opacity]) in made.iter().enumerate() {
        let material = format!("Colour_{index}");
        let opacity = match *opacity {
            1.0 => String::new(),
            part => format!("                float inputs:opacity = {part}\n"),
        };
        writeln!(
            out,
            "        def Material \"{material}\"\n        {{\n            token outputs:surface.connect = \
             </World/Materials/{material}/surface.outputs:surface>\n\n            def Shader \"surface\"\n            \
             {{\n                uniform token info:id = \"UsdPreviewSurface\"\n                \
             color3f inputs:diffuseColor = ({r}, {g}, {b})\n{opacity}                float inputs:roughness = 0.5\n                \
             token outputs:surface\n            }}\n        }}\n",
        )?;
    }
    writeln!(out, "    }}\n")?;
    Ok(of_body)
}

fn mesh(out: &mut Draft, form: &Form) -> io::Result<()> {
    let pad = "            ";
    writeln!(out, "{pad}def Mesh \"mesh\"\n{pad}{{")?;
    extent(out, &form.points, 0.0)?;
    list(out, "int[] faceVertexCounts", form.triangles.iter().map(|_| 3))?;
    list(out, "int[] faceVertexIndices", form.triangles.iter().flatten())?;
    list(
        out,
        "normal3f[] normals (faceVarying)",
        form.normals.iter().flatten().map(|n| triple(*n)),
    )?;
    list(out, "point3f[] points", form.points.iter().map(|p| triple(p.as_vec3())))?;
    writeln!(out, "{pad}    uniform bool doubleSided = 1")?;
    writeln!(out, "{pad}    uniform token subdivisionScheme = \"none\"\n{pad}}}")
}

fn particles(out: &mut Draft, form: &Form) -> io::Result<()> {
    let pad = "            ";
    let farthest = form.points.iter().fold(0.0f64, |far, v| far.max(v.length()));
    // balls that can be seen, and told apart
    let width = 2.2 * farthest / (form.points.len() as f64).sqrt();
    let width = if width > 0.0 { width.min(0.3 * farthest) } else { 0.02 };
    writeln!(out, "{pad}def Points \"particles\"\n{pad}{{")?;
    extent(out, &form.points, 0.5 * width)?;
    list(out, "point3f[] points", form.points.iter().map(|p| triple(p.as_vec3())))?;
    list(out, "float[] widths (constant)", [width as f32].iter())?;
    writeln!(out, "{pad}}}")
}

fn extent(out: &mut Draft, points: &[DVec3], margin: f64) -> io::Result<()> {
    let low = points.iter().fold(DVec3::MAX, |low, p| low.min(*p)) - margin;
    let high = points.iter().fold(DVec3::MIN, |high, p| high.max(*p)) + margin;
    list(out, "float3[] extent", [low, high].iter().map(|v| triple(v.as_vec3())))
}

/// An array; its name may be followed by what it is interpolated as.
fn list(
    out: &mut Draft,
    name: &str,
    items: impl Iterator<Item = impl std::fmt::Display>,
) -> io::Result<()> {
    let (name, interpolation) = name.split_once(" (").unwrap_or((name, ""));
    write!(out, "                {name} = [")?;
    for (index, item) in items.enumerate() {
        let comma = if index > 0 { ", " } else { "" };
        write!(out, "{comma}{item}")?;
    }
    match interpolation.strip_suffix(')') {
        Some(how) => {
            writeln!(out, "] (\n                    interpolation = \"{how}\"\n                )")
        }
        None => writeln!(out, "]"),
    }
}

fn write_body(
    out: &mut Draft,
    job: &Job,
    (index, (form, material, colour)): (usize, (usize, usize, [f32; 4])),
    (prim, name): (String, &str),
    rate: f64,
) -> io::Result<()> {
    let [r, g, b, _] = colour;
    writeln!(
        out,
        "    def Xform \"{prim}\" (\n        displayName = \"{}\"\n        prepend apiSchemas = \
         [\"MaterialBindingAPI\"]\n    )\n    {{\n        rel material:binding = \
         </World/Materials/Colour_{material}>\n        color3f[] primvars:displayColor = [({r}, {g}, {b})]\n        \
         quatf xformOp:orient.timeSamples = {{",
        quoted(name),
    )?;
    for (frame, q) in job.chosen.frames().zip(steady(job.chosen.frames(), index)) {
        writeln!(out, "            {}: {},", frame.time * rate, quaternion(q))?;
    }
    writeln!(out, "        }}\n        double3 xformOp:translate.timeSamples = {{")?;
    for frame in job.chosen.frames() {
        let p = frame.poses[index].position;
        writeln!(out, "            {}: ({}, {}, {}),", frame.time * rate, p.x, p.y, p.z)?;
    }
    writeln!(
        out,
        "        }}\n        uniform token[] xformOpOrder = [\"xformOp:translate\", \
         \"xformOp:orient\"]\n\n        def Xform \"shape\" (\n            instanceable = true\n            \
         prepend references = </World/Shapes/Shape_{form}>\n        )\n        {{\n        }}\n    }}\n",
    )
}

fn walls(out: &mut Draft, walls: &[[DVec3; 4]], prim: &str) -> io::Result<()> {
    let corners: Vec<DVec3> = walls.iter().flatten().copied().collect();
    writeln!(out, "    def Mesh \"{prim}\"\n    {{")?;
    extent(out, &corners, 0.0)?;
    list(out, "int[] faceVertexCounts", walls.iter().map(|_| 4))?;
    list(out, "int[] faceVertexIndices", 0..corners.len())?;
    list(out, "point3f[] points", corners.iter().map(|p| triple(p.as_vec3())))?;
    writeln!(
        out,
        "        color3f[] primvars:displayColor = [(0.6, 0.64, 0.7)]\n        \
         float[] primvars:displayOpacity = [0.25]\n        uniform bool doubleSided = 1\n        \
         uniform token subdivisionScheme = \"none\"\n    }}",
    )
}

/// In the order of USD: w, x, y, z.
fn quaternion(q: DQuat) -> String {
    let q = q.as_quat();
    format!("({}, {}, {}, {})", q.w, q.x, q.y, q.z)
}

fn triple(v: Vec3) -> String {
    format!("({}, {}, {})", v.x, v.y, v.z)
}

/// What may stand between quotes.
fn quoted(text: &str) -> String {
    let plain = text.chars().filter(|c| !c.is_control());
    plain
        .flat_map(|c| ['\\'].into_iter().filter(move |_| c == '"' || c == '\\').chain([c]))
        .collect()
}

/// A name that USD accepts and no other body has.
fn identifier(name: &str, taken: &mut HashSet<String>) -> String {
    let letter = |c: char| if c.is_ascii_alphanumeric() { c } else { '_' };
    let mut plain: String = name.chars().map(letter).collect();
    if plain.chars().next().is_none_or(|first| first.is_ascii_digit()) {
        plain.insert(0, '_');
    }
    let mut unique = plain.clone();
    let mut number = 2;
    while !taken.insert(unique.clone()) {
        unique = format!("{plain}_{number}");
        number += 1;
    }
    unique
}
