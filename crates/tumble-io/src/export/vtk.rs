//! `.pvd` and a folder of `.vtp` files, one per frame with all bodies, for ParaView and PyVista.
//!
//! Reference: Kitware, *VTK XML file formats*. The arrays are raw appended data: little-endian numbers,
//! each array preceded by its length in bytes. The `.pvd` file, which lists the frames, gets its final
//! name last.

use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use tumble::{BodyModel, DMat3, DVec3, Mesh, World};

use super::error::ExportError;
use super::job::{Exported, Job, Progress, report};
use super::partial_file::{parent_folder, temporary_path};
use crate::appearance::surface_of;
use crate::replay::{Pose, ReplayFrame};

pub(super) fn write(job: &Job, progress: &mut Progress) -> Result<Exported, ExportError> {
    let mut out = job.create_file()?;
    let folder = FrameFolder::create(job)?;
    let frames = job.selection.frames();
    let topology = Topology::new(&job.replay.world)?;
    let mut bytes = 0;
    let mut datasets = String::new();
    for (index, frame) in frames.clone().enumerate() {
        report(progress, index, frames.len())?;
        let name = format!("frame_{index:06}.vtp");
        let path = folder.temporary.join(&name);
        let written = write_frame(&path, &job.replay.world, &topology, frame);
        bytes += written.map_err(|error| job.write_error(error))?;
        datasets += &format!(
            "    <DataSet timestep=\"{:?}\" part=\"0\" file=\"{}/{name}\"/>\n",
            frame.time, folder.escaped_name,
        );
    }
    write!(
        out,
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" \
         byte_order=\"LittleEndian\">\n  <Collection>\n{datasets}  </Collection>\n</VTKFile>\n",
    )
    .map_err(|error| job.write_error(error))?;
    folder.finish(job)?;
    Ok(Exported { frames: frames.len(), bytes: bytes + out.finish()? })
}

/// The folder of the `.vtp` files. It has a temporary name until it is complete.
struct FrameFolder {
    /// Its final name, as an attribute value of XML.
    escaped_name: String,
    path: PathBuf,
    temporary: PathBuf,
}

impl FrameFolder {
    fn create(job: &Job) -> Result<Self, ExportError> {
        let stem = job.path.file_stem().and_then(|stem| stem.to_str());
        let stem = stem.ok_or_else(|| {
            ExportError::Unsupported("the name of a .pvd file must be valid UTF-8".to_owned())
        })?;
        // with a suffix, because out/cat.pvd is often written beside the run out/cat
        let name = format!("{stem}_frames");
        let path = parent_folder(job.path).join(&name);
        let escaped_name = escape(&name).ok_or_else(|| {
            let problem = "the name of a .pvd file must not contain control characters: it is written in XML, \
                           which has none";
            ExportError::Unsupported(problem.to_owned())
        })?;
        let folder = Self { escaped_name, temporary: temporary_path(&path), path };
        if folder.path.symlink_metadata().is_ok() {
            if !job.options.force {
                return Err(ExportError::Exists(folder.path.clone()));
            }
            folder.check_replaceable()?;
        }
        fs::create_dir(&folder.temporary).map_err(|error| job.write_error(error))?;
        Ok(folder)
    }

    /// Refuses to replace a folder that contains anything but frames.
    fn check_replaceable(&self) -> Result<(), ExportError> {
        let write_error = |error| ExportError::Write(self.path.clone(), error);
        for entry in fs::read_dir(&self.path).map_err(write_error)? {
            let name = entry.map_err(write_error)?.file_name();
            let name = name.to_string_lossy();
            if !(name.starts_with("frame_") && name.ends_with(".vtp")) {
                let problem =
                    format!("the folder of the previous export also contains {name}; move it away");
                return Err(write_error(io::Error::other(problem)));
            }
        }
        Ok(())
    }

    /// Renames the folder to its final name. Replaces the folder of a previous export.
    fn finish(&self, job: &Job) -> Result<(), ExportError> {
        let write_error = |error| ExportError::Write(self.path.clone(), error);
        if self.path.symlink_metadata().is_ok() {
            self.check_replaceable()?;
            // remove the list first, so that a half-replaced export does not look complete
            let _ = fs::remove_file(job.path);
            fs::remove_dir_all(&self.path).map_err(write_error)?;
        }
        fs::rename(&self.temporary, &self.path).map_err(write_error)
    }
}

impl Drop for FrameFolder {
    fn drop(&mut self) {
        // after a rename the folder does not exist; after an error, that error is reported instead
        let _ = fs::remove_dir_all(&self.temporary);
    }
}

/// Points and cells, which are the same in every frame.
struct Topology {
    point_count: usize,
    /// Points drawn as vertex cells.
    vertices: Vec<i32>,
    /// Points of the triangles, three per triangle.
    triangles: Vec<i32>,
    /// Index of the body of each point.
    body: Vec<i32>,
    /// 1 for a particle, 0 for a vertex of the surface only.
    is_particle: Vec<u8>,
}

/// Whether the vertices of the surface are the particles, in the same order.
fn are_vertices_particles(body: &BodyModel, surface: &Mesh) -> bool {
    let particles = body.shape.particles();
    surface.vertices.len() == particles.len()
        && surface
            .vertices
            .iter()
            .zip(particles.iter())
            .all(|(vertex, particle)| *vertex == particle)
}

/// The points of a body in the body frame (m), and whether each is a particle: first the particles, then
/// the vertices of the surface unless they are the particles.
fn points<'a>(body: &'a BodyModel, surface: &'a Mesh) -> impl Iterator<Item = (DVec3, bool)> + 'a {
    let vertices: &[DVec3] =
        if are_vertices_particles(body, surface) { &[] } else { &surface.vertices };
    let particles = body.shape.particles().iter().map(|point| (point, true));
    particles.chain(vertices.iter().map(|&point| (point, false)))
}

impl Topology {
    fn new(world: &World) -> Result<Self, ExportError> {
        let too_many = || {
            ExportError::Unsupported(
                "the bodies have more than 2147483647 points, the maximum of a .vtp".to_owned(),
            )
        };
        let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
        let (mut body, mut is_particle) = (Vec::new(), Vec::new());
        for (index, model) in world.bodies().map(|body| body.model()).enumerate() {
            let first = is_particle.len();
            let surface = surface_of(model);
            is_particle.extend(points(model, &surface).map(|(_, particle)| u8::from(particle)));
            body.resize(is_particle.len(), index as i32);
            i32::try_from(is_particle.len()).map_err(|_| too_many())?;
            let particles = model.shape.particles().len();
            let are_shared = are_vertices_particles(model, &surface);
            let base = if are_shared { first } else { first + particles } as i32;
            triangles
                .extend(surface.triangles.iter().flatten().map(|&corner| base + corner as i32));
            // particles that are not vertices of triangles are drawn as points
            if !are_shared || surface.triangles.is_empty() {
                vertices.extend((first..first + particles).map(|point| point as i32));
            }
        }
        Ok(Self { point_count: is_particle.len(), vertices, triangles, body, is_particle })
    }
}

/// Writes one frame. Returns the size of the file in bytes.
fn write_frame(
    path: &Path,
    world: &World,
    topology: &Topology,
    frame: &ReplayFrame,
) -> io::Result<u64> {
    let mut data = AppendedData::default();
    let (mut positions, mut velocities, mut forces) = (Vec::new(), Vec::new(), Vec::new());
    for (body, pose) in world.bodies().zip(&frame.poses) {
        let rotation = DMat3::from_quat(pose.orientation);
        for (point, is_particle) in points(body.model(), &surface_of(body.model())) {
            let (arm, model) = (rotation * point, body.model());
            let force = if is_particle {
                spring_force(world, model, pose.position + arm)
            } else {
                DVec3::ZERO
            };
            positions.extend((pose.position + arm).as_vec3().to_array());
            velocities.extend(velocity(pose, arm).as_vec3().to_array());
            forces.extend(force.as_vec3().to_array());
        }
    }
    let offsets = |size: usize, count: usize| (1..=count).map(move |i| (i * size) as i32);
    let (vertex_count, triangle_count) = (topology.vertices.len(), topology.triangles.len() / 3);
    let time = data.add("Float64", "TimeValue\" NumberOfTuples=\"1", 1, frame.time.to_le_bytes());
    let velocities = data.add_vectors("velocity", &velocities);
    let forces = data.add_vectors("force", &forces);
    let bodies = data.add_integers("body", topology.body.iter().copied());
    let particle = data.add("UInt8", "particle", 1, topology.is_particle.iter().copied());
    let positions = data.add_vectors("Points", &positions);
    let cells = |data: &mut AppendedData, points: &[i32], size: usize, count: usize| {
        data.add_integers("connectivity", points.iter().copied())
            + &data.add_integers("offsets", offsets(size, count))
    };
    let vertex_cells = cells(&mut data, &topology.vertices, 1, vertex_count);
    let triangle_cells = cells(&mut data, &topology.triangles, 3, triangle_count);
    let mut out = BufWriter::with_capacity(1 << 16, File::create_new(path)?);
    write!(
        out,
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" \
         byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<PolyData>\n<FieldData>\n{time}\
         </FieldData>\n<Piece NumberOfPoints=\"{}\" NumberOfVerts=\"{vertex_count}\" NumberOfLines=\"0\" \
         NumberOfStrips=\"0\" NumberOfPolys=\"{triangle_count}\">\n<PointData Vectors=\"velocity\" \
         Scalars=\"body\">\n{velocities}{forces}{bodies}{particle}</PointData>\n<Points>\n{positions}\
         </Points>\n<Verts>\n{vertex_cells}</Verts>\n<Polys>\n{triangle_cells}</Polys>\n</Piece>\n</PolyData>\n\
         <AppendedData encoding=\"raw\">\n_",
        topology.point_count,
    )?;
    out.write_all(&data.bytes)?;
    write!(out, "\n</AppendedData>\n</VTKFile>\n")?;
    let file = out.into_inner().map_err(io::IntoInnerError::into_error)?;
    Ok(file.metadata()?.len())
}

/// Velocity of a point at `arm` = R r from the centre of mass (m): v + ω × R r (m/s).
fn velocity(pose: &Pose, arm: DVec3) -> DVec3 {
    pose.velocity + pose.angular_velocity.cross(arm)
}

/// Spring force of all walls on a particle at `position` (m): Σ k δ n (N), without dashpots and friction.
fn spring_force(world: &World, body: &BodyModel, position: DVec3) -> DVec3 {
    let walls = world.model().walls.iter().zip(&body.contacts);
    walls
        .filter(|(wall, _)| wall.depth(position) > 0.0)
        .map(|(wall, law)| wall.normal * (law.stiffness * wall.depth(position)))
        .sum()
}

/// The appended data of a file: arrays, each preceded by its length in bytes (`UInt64`).
#[derive(Default)]
struct AppendedData {
    bytes: Vec<u8>,
}

impl AppendedData {
    /// Appends an array. Returns the `DataArray` element that refers to it.
    fn add(
        &mut self,
        data_type: &str,
        name: &str,
        components: usize,
        bytes: impl IntoIterator<Item = u8>,
    ) -> String {
        let offset = self.bytes.len();
        self.bytes.extend([0; 8]);
        self.bytes.extend(bytes);
        let length = (self.bytes.len() - offset - 8) as u64;
        self.bytes[offset..offset + 8].copy_from_slice(&length.to_le_bytes());
        let components = if components > 1 {
            format!(" NumberOfComponents=\"{components}\"")
        } else {
            String::new()
        };
        format!(
            "<DataArray type=\"{data_type}\" Name=\"{name}\"{components} format=\"appended\" \
             offset=\"{offset}\"/>\n"
        )
    }

    fn add_vectors(&mut self, name: &str, vectors: &[f32]) -> String {
        self.add("Float32", name, 3, vectors.iter().flat_map(|number| number.to_le_bytes()))
    }

    fn add_integers(&mut self, name: &str, numbers: impl Iterator<Item = i32>) -> String {
        self.add("Int32", name, 1, numbers.flat_map(i32::to_le_bytes))
    }
}

/// `text` as an attribute value of XML; `None` if it has a character that XML cannot express.
fn escape(text: &str) -> Option<String> {
    let mut escaped = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '"' => escaped.push_str("&quot;"),
            // a reader would turn them into spaces
            '\t' | '\n' | '\r' => escaped.push_str(&format!("&#{};", u32::from(letter))),
            '\0'..='\u{1f}' | '\u{fffe}' | '\u{ffff}' => return None,
            other => escaped.push(other),
        }
    }
    Some(escaped)
}
