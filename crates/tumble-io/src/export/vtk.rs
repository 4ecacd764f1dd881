//! `.pvd` and a folder of `.vtp`: a surface with all bodies in each file, for ParaView and PyVista.
//!
//! Kitware, *VTK XML file formats*. Arrays are appended as raw little-endian numbers, each after its
//! length in bytes. The `.pvd` that lists the files is written last.

use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use tumble::{BodyModel, DMat3, DVec3, Mesh, World};

use super::draft::{beside, folder_of};
use super::{ExportError, Exported, Job, Watch, tell};
use crate::appearance::surface_of;
use crate::replay::{Pose, ReplayFrame};

pub(super) fn write(job: &Job, watch: &mut Watch) -> Result<Exported, ExportError> {
    let mut out = job.draft()?;
    let folder = Folder::create(job)?;
    let frames = job.chosen.frames();
    let cells = Cells::of(&job.replay.world)?;
    let mut bytes = 0;
    let mut list = String::new();
    for (index, frame) in frames.clone().enumerate() {
        tell(watch, index, frames.len())?;
        let name = format!("frame_{index:06}.vtp");
        let path = folder.temporary.join(&name);
        let written = write_frame(&path, &job.replay.world, &cells, frame);
        bytes += written.map_err(|error| job.failed(error))?;
        list += &format!(
            "    <DataSet timestep=\"{:?}\" part=\"0\" file=\"{}/{name}\"/>\n",
            frame.time,
            escaped(&folder.name),
        );
    }
    write!(
        out,
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" \
         byte_order=\"LittleEndian\">\n  <Collection>\n{list}  </Collection>\n</VTKFile>\n",
    )
    .map_err(|error| job.failed(error))?;
    folder.finish(job)?;
    Ok(Exported { frames: frames.len(), bytes: bytes + out.finish()? })
}

/// The folder of the frames, under another name until all of them are there.
struct Folder {
    name: String,
    path: PathBuf,
    temporary: PathBuf,
}

impl Folder {
    fn create(job: &Job) -> Result<Self, ExportError> {
        let stem = job.export.path.file_stem().and_then(|stem| stem.to_str());
        let stem = stem.ok_or_else(|| {
            ExportError::Unfit("the name of a .pvd file must be text in UTF-8".to_owned())
        })?;
        // not the bare stem: out/cat.pvd is to stand beside the run out/cat
        let name = format!("{stem}_frames");
        let path = folder_of(&job.export.path).join(&name);
        let folder = Self { name, temporary: beside(&path), path };
        if folder.path.symlink_metadata().is_ok() {
            if !job.export.options.force {
                return Err(ExportError::Taken(folder.path.clone()));
            }
            folder.check_old()?;
        }
        fs::create_dir(&folder.temporary).map_err(|error| job.failed(error))?;
        Ok(folder)
    }

    /// Only a folder that holds nothing but frames is ours to replace.
    fn check_old(&self) -> Result<(), ExportError> {
        let failed = |error| ExportError::Write(self.path.clone(), error);
        for entry in fs::read_dir(&self.path).map_err(failed)? {
            let name = entry.map_err(failed)?.file_name();
            let name = name.to_string_lossy();
            if !(name.starts_with("frame_") && name.ends_with(".vtp")) {
                let other =
                    format!("the folder of an old export also holds {name}; move that away");
                return Err(failed(io::Error::other(other)));
            }
        }
        Ok(())
    }

    /// Takes the place of an old folder.
    fn finish(&self, job: &Job) -> Result<(), ExportError> {
        let failed = |error| ExportError::Write(self.path.clone(), error);
        if self.path.symlink_metadata().is_ok() {
            self.check_old()?;
            // without its list, an old export does not look whole
            let _ = fs::remove_file(&job.export.path);
            fs::remove_dir_all(&self.path).map_err(failed)?;
        }
        fs::rename(&self.temporary, &self.path).map_err(failed)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        // after a rename it is gone; otherwise the first error is the one to tell
        let _ = fs::remove_dir_all(&self.temporary);
    }
}

/// What is the same in every frame: which points make a cell.
struct Cells {
    points: usize,
    vertices: Vec<i32>,
    triangles: Vec<i32>,
    body: Vec<i32>,
    /// 1 for a particle, 0 for what is only drawn.
    is_particle: Vec<u8>,
}

/// Whether the vertices of the surface are the particles.
fn is_drawn_by_particles(body: &BodyModel, surface: &Mesh) -> bool {
    let particles = body.shape.particles();
    surface.vertices.len() == particles.len()
        && surface
            .vertices
            .iter()
            .zip(particles.iter())
            .all(|(vertex, particle)| *vertex == particle)
}

/// The points of a body in its own frame: its particles, then vertices that are none.
fn points<'a>(body: &'a BodyModel, surface: &'a Mesh) -> impl Iterator<Item = (DVec3, bool)> + 'a {
    let only_drawn: &[DVec3] =
        if is_drawn_by_particles(body, surface) { &[] } else { &surface.vertices };
    let particles = body.shape.particles().iter().map(|place| (place, true));
    particles.chain(only_drawn.iter().map(|&place| (place, false)))
}

impl Cells {
    fn of(world: &World) -> Result<Self, ExportError> {
        let too_many = || ExportError::Unfit("more points than a .vtp can number".to_owned());
        let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
        let (mut body, mut is_particle) = (Vec::new(), Vec::new());
        for (index, model) in world.bodies().map(|body| body.model()).enumerate() {
            let first = is_particle.len();
            let surface = surface_of(model);
            is_particle.extend(points(model, &surface).map(|(_, particle)| u8::from(particle)));
            body.resize(is_particle.len(), index as i32);
            i32::try_from(is_particle.len()).map_err(|_| too_many())?;
            let particles = model.shape.particles().len();
            let is_same = is_drawn_by_particles(model, &surface);
            let base = if is_same { first } else { first + particles } as i32;
            triangles
                .extend(surface.triangles.iter().flatten().map(|&corner| base + corner as i32));
            // particles that no triangle shows are shown as points
            if !is_same || surface.triangles.is_empty() {
                vertices.extend((first..first + particles).map(|point| point as i32));
            }
        }
        Ok(Self { points: is_particle.len(), vertices, triangles, body, is_particle })
    }
}

/// Writes one frame; returns its size in bytes.
fn write_frame(path: &Path, world: &World, cells: &Cells, frame: &ReplayFrame) -> io::Result<u64> {
    let mut arrays = Arrays::default();
    let (mut places, mut velocities, mut forces) = (Vec::new(), Vec::new(), Vec::new());
    for (body, pose) in world.bodies().zip(&frame.poses) {
        let turn = DMat3::from_quat(pose.orientation);
        for (place, is_particle) in points(body.model(), &surface_of(body.model())) {
            let (arm, model) = (turn * place, body.model());
            let force = if is_particle {
                spring_force(world, model, pose.position + arm)
            } else {
                DVec3::ZERO
            };
            places.extend((pose.position + arm).as_vec3().to_array());
            velocities.extend(velocity(pose, arm).as_vec3().to_array());
            forces.extend(force.as_vec3().to_array());
        }
    }
    let ends = |each: usize, count: usize| (1..=count).map(move |i| (i * each) as i32);
    let (dots, faces) = (cells.vertices.len(), cells.triangles.len() / 3);
    let time = arrays.add("Float64", "TimeValue\" NumberOfTuples=\"1", 1, frame.time.to_le_bytes());
    let velocities = arrays.floats("velocity", &velocities);
    let forces = arrays.floats("force", &forces);
    let bodies = arrays.integers("body", cells.body.iter().copied());
    let particle = arrays.add("UInt8", "particle", 1, cells.is_particle.iter().copied());
    let places = arrays.floats("Points", &places);
    let cell = |arrays: &mut Arrays, corners: &[i32], each: usize, count: usize| {
        arrays.integers("connectivity", corners.iter().copied())
            + &arrays.integers("offsets", ends(each, count))
    };
    let dots_of = cell(&mut arrays, &cells.vertices, 1, dots);
    let faces_of = cell(&mut arrays, &cells.triangles, 3, faces);
    let mut out = BufWriter::with_capacity(1 << 16, File::create_new(path)?);
    write!(
        out,
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" \
         byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<PolyData>\n<FieldData>\n{time}\
         </FieldData>\n<Piece NumberOfPoints=\"{}\" NumberOfVerts=\"{dots}\" NumberOfLines=\"0\" \
         NumberOfStrips=\"0\" NumberOfPolys=\"{faces}\">\n<PointData Vectors=\"velocity\" \
         Scalars=\"body\">\n{velocities}{forces}{bodies}{particle}</PointData>\n<Points>\n{places}\
         </Points>\n<Verts>\n{dots_of}</Verts>\n<Polys>\n{faces_of}</Polys>\n</Piece>\n</PolyData>\n\
         <AppendedData encoding=\"raw\">\n_",
        cells.points,
    )?;
    out.write_all(&arrays.bytes)?;
    write!(out, "\n</AppendedData>\n</VTKFile>\n")?;
    let file = out.into_inner().map_err(io::IntoInnerError::into_error)?;
    Ok(file.metadata()?.len())
}

/// v + ω × R r (m/s).
fn velocity(pose: &Pose, arm: DVec3) -> DVec3 {
    pose.velocity + pose.angular_velocity.cross(arm)
}

/// What the springs of all walls do to a particle at `place` (m): Σ k δ n (N), without dashpots and
/// friction.
fn spring_force(world: &World, body: &BodyModel, place: DVec3) -> DVec3 {
    let walls = world.model().walls.iter().zip(&body.contacts);
    walls
        .filter(|(wall, _)| wall.depth(place) > 0.0)
        .map(|(wall, law)| wall.normal * (law.stiffness * wall.depth(place)))
        .sum()
}

/// Arrays appended to the file, each after its length.
#[derive(Default)]
struct Arrays {
    bytes: Vec<u8>,
}

impl Arrays {
    /// Appends numbers; returns what refers to them.
    fn add(
        &mut self,
        kind: &str,
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
            "<DataArray type=\"{kind}\" Name=\"{name}\"{components} format=\"appended\" \
             offset=\"{offset}\"/>\n"
        )
    }

    fn floats(&mut self, name: &str, vectors: &[f32]) -> String {
        self.add("Float32", name, 3, vectors.iter().flat_map(|number| number.to_le_bytes()))
    }

    fn integers(&mut self, name: &str, numbers: impl Iterator<Item = i32>) -> String {
        self.add("Int32", name, 1, numbers.flat_map(i32::to_le_bytes))
    }
}

/// What may stand between the quotes of XML.
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('"', "&quot;")
}
