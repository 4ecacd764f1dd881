//! `.usda`: USD as text, with one Xform per body and time samples.
//!
//! Reference: Pixar, *Universal Scene Description*, <https://openusd.org>. Each shape is a class, and
//! bodies refer to it as instances. The up axis is +z if gravity points along −z, otherwise +y. If
//! gravity points along neither −z nor −y, the root Xform rotates the scene.

use std::collections::HashSet;
use std::io::{self, Write};

use glam::Vec3;
use tumble::{DQuat, DVec3};

use super::error::ExportError;
use super::geometry::{SceneGeometry, ShapeGeometry, continuous_orientations, upright_rotation};
use super::job::{Exported, Job, Progress, report};
use super::partial_file::PartialFile;

pub(super) fn write(job: &Job, progress: &mut Progress) -> Result<Exported, ExportError> {
    let geometry = SceneGeometry::new(job)?;
    let mut out = job.create_file()?;
    let write_error = |error| job.write_error(error);
    let scene = &job.replay.scene;
    let up = if upright_rotation(scene.gravity, DVec3::Z) == DQuat::IDENTITY
        && scene.gravity != DVec3::ZERO
    {
        DVec3::Z
    } else {
        DVec3::Y
    };
    // an integer rate gives integer time codes; players need at least one per second
    let rate = job.selection.rate.round().max(1.0);
    write_header(&mut out, job, up, rate).map_err(write_error)?;
    write_shapes(&mut out, &geometry).map_err(write_error)?;
    let bodies = job.replay.world.bodies();
    let materials = write_materials(&mut out, &geometry).map_err(write_error)?;
    let mut names = HashSet::from(["Shapes".to_owned(), "Materials".to_owned()]);
    let count = bodies.len();
    for (index, body) in bodies.enumerate() {
        report(progress, index, count)?;
        let name = (identifier(body.name(), &mut names), body.name());
        let appearance = (geometry.shape_of_body[index], materials[index], geometry.colours[index]);
        write_body(&mut out, job, (index, appearance), name, rate).map_err(write_error)?;
    }
    if !geometry.walls.is_empty() {
        write_walls(&mut out, &geometry.walls, &identifier("walls", &mut names))
            .map_err(write_error)?;
    }
    writeln!(out, "}}").map_err(write_error)?;
    Ok(Exported { frames: job.selection.indices.len(), bytes: out.finish()? })
}

/// Writes the metadata and the start of the root Xform.
fn write_header(out: &mut PartialFile, job: &Job, up: DVec3, rate: f64) -> io::Result<()> {
    let scene = &job.replay.scene;
    let codes = job.selection.frames().map(|frame| frame.time * rate);
    let (start, end) = (codes.clone().next().unwrap_or(0.0), codes.last().unwrap_or(0.0));
    let axis = if up == DVec3::Z { "Z" } else { "Y" };
    writeln!(
        out,
        "#usda 1.0\n(\n    defaultPrim = \"World\"\n    doc = \"{}, written by tumble {}\"\n    \
         endTimeCode = {end}\n    framesPerSecond = {rate}\n    metersPerUnit = 1\n    \
         startTimeCode = {start}\n    timeCodesPerSecond = {rate}\n    upAxis = \"{axis}\"\n)\n\n\
         def Xform \"World\" (\n    kind = \"component\"\n)\n{{",
        escape(&scene.name),
        env!("CARGO_PKG_VERSION"),
    )?;
    let q = upright_rotation(scene.gravity, up);
    if q != DQuat::IDENTITY {
        writeln!(out, "    quatf xformOp:orient = {}", quaternion(q))?;
        writeln!(out, "    uniform token[] xformOpOrder = [\"xformOp:orient\"]\n")?;
    }
    Ok(())
}

/// Writes the shapes as classes, which are drawn only where a body refers to them.
fn write_shapes(out: &mut PartialFile, geometry: &SceneGeometry) -> io::Result<()> {
    writeln!(out, "    def Scope \"Shapes\"\n    {{")?;
    for (index, shape) in geometry.shapes.iter().enumerate() {
        writeln!(out, "        class Xform \"Shape_{index}\"\n        {{")?;
        if shape.triangles.is_empty() {
            write_particles(out, shape)?
        } else {
            write_mesh(out, shape)?
        }
        writeln!(out, "        }}\n")?;
    }
    writeln!(out, "    }}\n")
}

/// Writes a material for each colour, for renderers that ignore `displayColor`. Returns the index of
/// the material of each body.
fn write_materials(out: &mut PartialFile, geometry: &SceneGeometry) -> io::Result<Vec<usize>> {
    let mut distinct: Vec<[f32; 4]> = Vec::new();
    let of_body = geometry.colours.iter().map(|colour| {
        distinct.iter().position(|other| other == colour).unwrap_or_else(|| {
            distinct.push(*colour);
            distinct.len() - 1
        })
    });
    let of_body = of_body.collect();
    writeln!(out, "    def Scope \"Materials\"\n    {{")?;
    for (index, [r, g, b, opacity]) in distinct.iter().enumerate() {
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

fn write_mesh(out: &mut PartialFile, shape: &ShapeGeometry) -> io::Result<()> {
    let pad = "            ";
    writeln!(out, "{pad}def Mesh \"mesh\"\n{pad}{{")?;
    write_extent(out, &shape.points, 0.0)?;
    write_array(out, "int[] faceVertexCounts", shape.triangles.iter().map(|_| 3))?;
    write_array(out, "int[] faceVertexIndices", shape.triangles.iter().flatten())?;
    write_array(
        out,
        "normal3f[] normals (faceVarying)",
        shape.normals.iter().flatten().map(|n| triple(*n)),
    )?;
    write_array(out, "point3f[] points", shape.points.iter().map(|p| triple(p.as_vec3())))?;
    writeln!(out, "{pad}    uniform bool doubleSided = 1")?;
    writeln!(out, "{pad}    uniform token subdivisionScheme = \"none\"\n{pad}}}")
}

fn write_particles(out: &mut PartialFile, shape: &ShapeGeometry) -> io::Result<()> {
    let pad = "            ";
    let radius = shape.points.iter().fold(0.0f64, |radius, v| radius.max(v.length()));
    // large enough to be visible, small enough to be separate
    let width = 2.2 * radius / (shape.points.len() as f64).sqrt();
    let width = if width > 0.0 { width.min(0.3 * radius) } else { 0.02 };
    writeln!(out, "{pad}def Points \"particles\"\n{pad}{{")?;
    write_extent(out, &shape.points, 0.5 * width)?;
    write_array(out, "point3f[] points", shape.points.iter().map(|p| triple(p.as_vec3())))?;
    write_array(out, "float[] widths (constant)", [width as f32].iter())?;
    writeln!(out, "{pad}}}")
}

fn write_extent(out: &mut PartialFile, points: &[DVec3], margin: f64) -> io::Result<()> {
    let low = points.iter().fold(DVec3::MAX, |low, p| low.min(*p)) - margin;
    let high = points.iter().fold(DVec3::MIN, |high, p| high.max(*p)) + margin;
    write_array(out, "float3[] extent", [low, high].iter().map(|v| triple(v.as_vec3())))
}

/// Writes an array. `name` may end with the interpolation in parentheses.
fn write_array(
    out: &mut PartialFile,
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
        Some(interpolation) => {
            writeln!(
                out,
                "] (\n                    interpolation = \"{interpolation}\"\n                )"
            )
        }
        None => writeln!(out, "]"),
    }
}

fn write_body(
    out: &mut PartialFile,
    job: &Job,
    (index, (shape, material, colour)): (usize, (usize, usize, [f32; 4])),
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
        escape(name),
    )?;
    for (frame, q) in
        job.selection.frames().zip(continuous_orientations(job.selection.frames(), index))
    {
        writeln!(out, "            {}: {},", frame.time * rate, quaternion(q))?;
    }
    writeln!(out, "        }}\n        double3 xformOp:translate.timeSamples = {{")?;
    for frame in job.selection.frames() {
        let p = frame.poses[index].position;
        writeln!(out, "            {}: ({}, {}, {}),", frame.time * rate, p.x, p.y, p.z)?;
    }
    writeln!(
        out,
        "        }}\n        uniform token[] xformOpOrder = [\"xformOp:translate\", \
         \"xformOp:orient\"]\n\n        def Xform \"shape\" (\n            instanceable = true\n            \
         prepend references = </World/Shapes/Shape_{shape}>\n        )\n        {{\n        }}\n    }}\n",
    )
}

fn write_walls(out: &mut PartialFile, walls: &[[DVec3; 4]], prim: &str) -> io::Result<()> {
    let corners: Vec<DVec3> = walls.iter().flatten().copied().collect();
    writeln!(out, "    def Mesh \"{prim}\"\n    {{")?;
    write_extent(out, &corners, 0.0)?;
    write_array(out, "int[] faceVertexCounts", walls.iter().map(|_| 4))?;
    write_array(out, "int[] faceVertexIndices", 0..corners.len())?;
    write_array(out, "point3f[] points", corners.iter().map(|p| triple(p.as_vec3())))?;
    writeln!(
        out,
        "        color3f[] primvars:displayColor = [(0.6, 0.64, 0.7)]\n        \
         float[] primvars:displayOpacity = [0.25]\n        uniform bool doubleSided = 1\n        \
         uniform token subdivisionScheme = \"none\"\n    }}",
    )
}

/// A quaternion in the order of USD: w, x, y, z.
fn quaternion(q: DQuat) -> String {
    let q = q.as_quat();
    format!("({}, {}, {}, {})", q.w, q.x, q.y, q.z)
}

fn triple(v: Vec3) -> String {
    format!("({}, {}, {})", v.x, v.y, v.z)
}

/// `text` as the contents of a string literal.
fn escape(text: &str) -> String {
    let printable = text.chars().filter(|c| !c.is_control());
    printable
        .flat_map(|c| ['\\'].into_iter().filter(move |_| c == '"' || c == '\\').chain([c]))
        .collect()
}

/// A valid and unique USD identifier made from `name`.
fn identifier(name: &str, used: &mut HashSet<String>) -> String {
    let replace = |c: char| if c.is_ascii_alphanumeric() { c } else { '_' };
    let mut identifier: String = name.chars().map(replace).collect();
    if identifier.chars().next().is_none_or(|first| first.is_ascii_digit()) {
        identifier.insert(0, '_');
    }
    let mut unique = identifier.clone();
    let mut number = 2;
    while !used.insert(unique.clone()) {
        unique = format!("{identifier}_{number}");
        number += 1;
    }
    unique
}
