//! Rendering of pictures: drawing order, compositing and antialiasing.

use super::body_mesh::{self, BodyMesh};
use super::camera::Camera;
use super::colour::picture_colour;
use super::framing;
use super::image::Image;
use super::input::{PictureInput, Pose, View, is_drawable};
use super::layer::Layer;
use super::legend::{self, LabelObstacles};
use super::shading::{Lighting, Material};
use super::snapshots::{self, Snapshot};
use super::surface::{self, Edge, Surface};
use glam::DVec3;

/// Colour of the edges of boxes.
const EDGE_COLOUR: [u8; 3] = [158, 34, 34];
/// Sample positions within a pixel, relative to its centre. No two share a row or a column.
const SAMPLES: [(f64, f64); 8] = [
    (-0.4375, -0.0625),
    (-0.3125, 0.3125),
    (-0.1875, -0.3125),
    (-0.0625, 0.1875),
    (0.0625, -0.4375),
    (0.1875, 0.0625),
    (0.3125, -0.1875),
    (0.4375, 0.4375),
];
/// Sample positions for frames of an animation, which need less antialiasing.
const ANIMATION_SAMPLES: [(f64, f64); 4] =
    [(-0.375, -0.125), (-0.125, 0.375), (0.125, -0.375), (0.375, 0.125)];
/// Largest number of path segments in a picture of one frame. Only the latest are drawn, which
/// bounds the time to render late frames of an animation.
const MAX_PATH_SEGMENTS: usize = 8192;

/// Opacity of kinematic bodies, out of 255.
const KINEMATIC_ALPHA: u8 = 96;

/// Path of a centre of mass: frame index and position (m) of each point.
type Path = Vec<(usize, DVec3)>;

/// Renders pictures of one run with a common view.
pub struct Renderer<'a> {
    input: PictureInput<'a>,
    up: DVec3,
    width: u32,
    height: u32,
    camera: Camera,
    bodies: Vec<BodyMesh>,
    /// Floors and walls, in groups whose members do not occlude each other.
    surfaces: Vec<Vec<Surface>>,
    edges: Vec<Edge>,
    paths: Vec<Path>,
    /// Frames shown in the picture of the size motion.
    selected_frames: Vec<usize>,
}

impl<'a> Renderer<'a> {
    /// A renderer with an automatically chosen view of the walls and the size motion.
    #[must_use]
    pub fn new(input: &PictureInput<'a>) -> Self {
        Self::with_view(input, None)
    }

    /// A renderer with the given view, or an automatically chosen one for `None`.
    #[must_use]
    pub fn with_view(input: &PictureInput<'a>, view: Option<View>) -> Self {
        let (width, height) = (input.size.0.clamp(1, 16384), input.size.1.clamp(1, 16384));
        let up = if is_drawable(input.up) { input.up } else { DVec3::Y };
        let up = up.try_normalize().unwrap_or(DVec3::Y);
        let radii: Vec<f64> = input.bodies.iter().map(body_mesh::bounding_radius).collect();
        let viewport = legend::viewport(width, height);
        let camera = framing::fit_camera(input, &radii, up, view, viewport);
        let pixel_size = camera.pixel_size();
        let bodies = input.bodies.iter().zip(&radii);
        let bodies: Vec<BodyMesh> =
            bodies.map(|(body, &radius)| BodyMesh::new(body, radius, pixel_size)).collect();
        let (surfaces, edges) = surface::from_boundary(input.boundary, &camera, up);
        let paths = (0..radii.len()).map(|body| path(input, body, &camera)).collect();
        let selected_frames = snapshots::select_frames(input.frames, &bodies, &camera);
        let input = *input;
        Self { input, up, width, height, camera, bodies, surfaces, edges, paths, selected_frames }
    }

    /// Renders the size motion as snapshots at several times, earlier ones paler.
    #[must_use]
    pub fn render_motion(&self) -> Image {
        let count = self.selected_frames.len();
        let snapshot = |(i, &frame): (usize, &usize)| {
            let age = if count > 1 { 1.0 - i as f32 / (count - 1) as f32 } else { 0.0 };
            let (fade, alpha) = if i + 1 == count { (0.0, 255) } else { (0.14 + 0.46 * age, 215) };
            Snapshot { frame, fade, alpha }
        };
        let snapshots: Vec<Snapshot> =
            self.selected_frames.iter().enumerate().map(snapshot).collect();
        let mut image = self.draw(&snapshots, &SAMPLES);
        let obstacles = self.label_obstacles(&snapshots);
        legend::draw_motion_labels(
            &mut image,
            &self.input,
            &snapshots,
            &obstacles,
            &self.camera,
            self.grid(),
        );
        image
    }

    /// Renders one frame with the paths up to its time. If there is no such frame, the picture
    /// shows no bodies.
    #[must_use]
    pub fn render_frame(&self, frame: usize) -> Image {
        self.render_with_samples(frame, &SAMPLES)
    }

    /// As [`Renderer::render_frame`], with fewer antialiasing samples and about twice as fast.
    #[must_use]
    pub fn render_animation_frame(&self, frame: usize) -> Image {
        self.render_with_samples(frame, &ANIMATION_SAMPLES)
    }

    fn render_with_samples(&self, frame: usize, samples: &[(f64, f64)]) -> Image {
        let snapshots = [Snapshot { frame, fade: 0.0, alpha: 255 }];
        let mut image = self.draw(&snapshots, samples);
        legend::draw_frame_labels(&mut image, &self.input, frame, &self.camera, self.grid());
        image
    }

    /// Projects a point (m) into the picture: pixels from the upper left corner. `None` if it
    /// lies behind the viewer or far outside the picture.
    #[must_use]
    pub fn project(&self, point: DVec3) -> Option<(f64, f64)> {
        self.camera.project(point).map(|at| (f64::from(at.x), f64::from(at.y)))
    }

    /// Unit vector from the centre of the scene towards the viewer.
    #[must_use]
    pub fn direction_to_viewer(&self) -> DVec3 {
        (self.camera.eye() - self.camera.centre()).normalize_or(DVec3::Z)
    }

    /// Spacing of the grid lines on the floor (m), if there are any.
    fn grid(&self) -> Option<f64> {
        self.surfaces.iter().flatten().map(|surface| surface.grid).find(|&grid| grid > 0.0)
    }

    fn draw(&self, snapshots: &[Snapshot], samples: &[(f64, f64)]) -> Image {
        let surfaces = self.shaded_surfaces(snapshots);
        let threads = std::thread::available_parallelism().map_or(1, usize::from).min(4);
        let part = |thread| {
            let samples: Vec<_> = samples.iter().copied().skip(thread).step_by(threads).collect();
            self.sum_samples(&samples, snapshots, &surfaces)
        };
        let mut sums = vec![[0u16; 3]; self.width as usize * self.height as usize];
        std::thread::scope(|scope| {
            let part = &part;
            let workers: Vec<_> =
                (1..threads).map(|thread| scope.spawn(move || part(thread))).collect();
            // integer sums do not depend on the number of threads
            add(&mut sums, &part(0));
            for (index, worker) in workers.into_iter().enumerate() {
                add(&mut sums, &worker.join().unwrap_or_else(|_| part(index + 1)));
            }
        });
        let mean = |sum: u16| ((usize::from(sum) + samples.len() / 2) / samples.len()) as u8;
        let pixels = sums.iter().flat_map(|rgb| rgb.map(mean)).collect();
        Image { width: self.width, height: self.height, pixels }
    }

    /// The sum over some of the samples: red, green, blue of each pixel.
    fn sum_samples(
        &self,
        samples: &[(f64, f64)],
        snapshots: &[Snapshot],
        surfaces: &[Vec<Surface>],
    ) -> Vec<[u16; 3]> {
        let mut layers = self.layers(snapshots);
        let mut sums = vec![[0u16; 3]; self.width as usize * self.height as usize];
        for &(x, y) in samples {
            let camera = self.camera.with_offset(x, y);
            layers.iter_mut().for_each(Layer::clear);
            self.draw_sample(&camera, snapshots, surfaces, &mut layers);
            self.composite(&layers, &mut sums);
        }
        sums
    }

    /// The extents and the path of the body in a picture of a single body; empty otherwise.
    fn label_obstacles(&self, snapshots: &[Snapshot]) -> LabelObstacles {
        let ([body], [path]) = (self.bodies.as_slice(), self.paths.as_slice()) else {
            return LabelObstacles::default();
        };
        let extent = |snapshot: &Snapshot| {
            let pose = self.input.frames.get(snapshot.frame)?.drawable_pose(0)?;
            body.approximate_extent(&pose, &self.camera)
        };
        let bodies = snapshots.iter().map(|s| extent(s).unwrap_or([i32::MIN / 4; 4])).collect();
        let points = path.iter().filter_map(|(_, point)| self.camera.project(*point));
        LabelObstacles { bodies, path: points.map(|at| (at.x as i32, at.y as i32)).collect() }
    }

    /// The surfaces with the shadows of the bodies in the snapshots.
    fn shaded_surfaces(&self, snapshots: &[Snapshot]) -> Vec<Vec<Surface>> {
        let mut groups = self.surfaces.clone();
        for surface in groups.iter_mut().flatten() {
            let Some(mut shadow) = surface.shadow.take() else { continue };
            for snapshot in snapshots {
                let weight = 0.5 * (1.0 - snapshot.fade) * (1.0 - snapshot.fade);
                let Some(frame) = self.input.frames.get(snapshot.frame) else { continue };
                for (index, body) in self.bodies.iter().enumerate() {
                    // translucent bodies cast no shadow
                    if let Some(pose) = frame
                        .drawable_pose(index)
                        .filter(|_| !self.input.bodies[index].is_kinematic)
                    {
                        shadow.cast(&surface.rectangle, self.up, &self.camera, body, &pose, weight);
                    }
                }
            }
            surface.shadow = Some(shadow);
        }
        groups
    }

    /// Empty layers: one for opaque parts, one for each translucent snapshot, one for other
    /// translucent parts such as front edges, and one for each group of surfaces.
    fn layers(&self, snapshots: &[Snapshot]) -> Vec<Layer> {
        let size = (self.width as i32, self.height as i32);
        let mut layers = vec![Layer::new((0, 0), size)];
        for snapshot in snapshots.iter().filter(|snapshot| snapshot.alpha < 255) {
            let [x0, y0, x1, y1] = self.snapshot_extent(snapshot);
            let low = (x0.clamp(0, size.0), y0.clamp(0, size.1));
            layers.push(Layer::new(low, (x1.clamp(0, size.0), y1.clamp(0, size.1))));
        }
        layers.push(Layer::new((0, 0), size));
        layers.extend(self.surfaces.iter().map(|_| Layer::new((0, 0), size)));
        layers
    }

    /// The rectangle of pixels that contains the bodies of a snapshot: left, top, right, bottom.
    fn snapshot_extent(&self, snapshot: &Snapshot) -> [i32; 4] {
        let mut union = [i32::MAX, i32::MAX, i32::MIN, i32::MIN];
        for (index, body) in self.bodies.iter().enumerate() {
            let pose = self.input.frames[snapshot.frame].drawable_pose(index);
            let Some(square) = pose.and_then(|pose| body.bounding_square(&pose, &self.camera))
            else {
                continue;
            };
            let ([x0, y0, x1, y1], [left, top, right, bottom]) = (union, square);
            union = [x0.min(left), y0.min(top), x1.max(right), y1.max(bottom)];
        }
        union
    }

    /// Draws everything once, for one antialiasing sample.
    fn draw_sample(
        &self,
        camera: &Camera,
        snapshots: &[Snapshot],
        surfaces: &[Vec<Surface>],
        layers: &mut [Layer],
    ) {
        let lighting = Lighting::new(camera, self.up);
        let Some((opaque, translucent)) = layers.split_first_mut() else { return };
        let count = translucent.len().saturating_sub(surfaces.len() + 1);
        let (snapshot_layers, rest) = translucent.split_at_mut(count);
        let Some((overlay, surface_layers)) = rest.split_first_mut() else { return };
        for (group, layer) in surfaces.iter().zip(surface_layers) {
            group.iter().for_each(|surface| surface.draw(camera, layer));
        }
        self.draw_edges(camera, opaque, overlay);
        self.draw_paths(camera, snapshots, if self.bodies.len() > 8 { overlay } else { opaque });
        let mut snapshot_layers = snapshot_layers.iter_mut();
        for snapshot in snapshots {
            let layer =
                if snapshot.alpha < 255 { snapshot_layers.next() } else { Some(&mut *opaque) };
            let (Some(layer), Some(frame)) = (layer, self.input.frames.get(snapshot.frame)) else {
                continue;
            };
            for (index, body) in self.bodies.iter().enumerate() {
                let Some(pose) = frame.drawable_pose(index) else { continue };
                let Snapshot { fade, alpha, .. } = *snapshot;
                if alpha < 255 && self.is_at_final_pose(index, &pose) {
                    continue;
                }
                let colour = picture_colour(&self.input, index);
                if !self.input.bodies[index].is_kinematic {
                    body.draw(&pose, camera, &lighting, Material { colour, fade, alpha }, layer);
                } else if alpha == 255 {
                    // kinematic bodies are drawn only in the final snapshot
                    let material = Material { colour, fade, alpha: KINEMATIC_ALPHA };
                    body.draw(&pose, camera, &lighting, material, overlay);
                }
            }
        }
    }

    /// Whether a pose nearly equals the final pose of the body. Two translucent copies at nearly
    /// the same pose would show through each other in patches.
    fn is_at_final_pose(&self, body: usize, pose: &Pose) -> bool {
        let last = self
            .selected_frames
            .last()
            .and_then(|&frame| self.input.frames[frame].drawable_pose(body));
        last.is_some_and(|last| {
            let has_moved =
                last.position.distance(pose.position) > 0.1 * self.bodies[body].rms_radius;
            // cosine of half the rotation angle, for 0.1 rad
            let has_rotated = last.orientation.dot(pose.orientation).abs() < 0.99875;
            !has_moved && !has_rotated
        })
    }

    /// Scale of line widths: 1 for the default size, less for smaller pictures.
    fn line_scale(&self) -> f32 {
        (self.width as f32 / 1600.0).min(self.height as f32 / 1000.0).max(0.4)
    }

    fn draw_edges(&self, camera: &Camera, opaque: &mut Layer, overlay: &mut Layer) {
        let [r, g, b] = EDGE_COLOUR;
        for edge in &self.edges {
            let [start, end] = edge.ends.map(|end| camera.project(end));
            let (Some(mut start), Some(mut end)) = (start, end) else { continue };
            // draw edges slightly in front of the adjacent faces
            start.inverse_depth *= 1.001;
            end.inverse_depth *= 1.001;
            if edge.is_front {
                overlay.draw_line(start, end, 1.8 * self.line_scale(), [r, g, b, 90]);
            } else {
                opaque.draw_line(start, end, 2.2 * self.line_scale(), [r, g, b, 255]);
            }
        }
    }

    fn draw_paths(&self, camera: &Camera, snapshots: &[Snapshot], layer: &mut Layer) {
        let last_frame = snapshots.iter().map(|snapshot| snapshot.frame).max().unwrap_or(0);
        let max_segments = if snapshots.len() > 1 {
            usize::MAX
        } else {
            MAX_PATH_SEGMENTS / self.paths.len().max(1)
        };
        let (width, alpha) = match self.paths.len() {
            0..=3 => (3.0, 255),
            4..=8 => (2.0, 255),
            9..=40 => (1.5, 140),
            _ => (1.2, 50),
        };
        for (body, path) in self.paths.iter().enumerate() {
            let [r, g, b] = picture_colour(&self.input, body).map(|c| (0.88 * c) as u8);
            let count = path.partition_point(|(frame, _)| *frame <= last_frame);
            let mut last = None;
            for &(_, point) in &path[count.saturating_sub(max_segments.max(2))..count] {
                let at = camera.project(point);
                if let (Some(last), Some(at)) = (last, at) {
                    layer.draw_line(last, at, width * self.line_scale(), [r, g, b, alpha]);
                }
                last = at;
            }
        }
    }

    /// Blends the translucent layers over the opaque one from back to front, and adds the result to the sums.
    fn composite(&self, layers: &[Layer], sums: &mut [[u16; 3]]) {
        let Some((opaque, translucent)) = layers.split_first() else { return };
        let width = self.width as usize;
        let mut visible: Vec<(f32, [u8; 4])> = Vec::with_capacity(translucent.len());
        for (y, row) in (0..).zip(sums.chunks_exact_mut(width)) {
            let gradient = y as f32 / self.height as f32;
            let background = [252.0, 253.0, 254.0].map(|c| c - 11.0 * gradient);
            let in_row: Vec<&Layer> =
                translucent.iter().filter(|layer| layer.contains_row(y)).collect();
            for (x, sum) in (0..).zip(row) {
                let (inverse_depth, [r, g, b, _]) = opaque.pixel(x, y);
                let mut colour = background;
                if inverse_depth > 0.0 {
                    colour = [r, g, b].map(f32::from);
                }
                visible.clear();
                let samples =
                    in_row.iter().filter(|layer| layer.contains_column(x)).map(|l| l.pixel(x, y));
                visible.extend(samples.filter(|(d, _)| *d > inverse_depth));
                if visible.len() > 1 {
                    visible.sort_by(|a, b| a.0.total_cmp(&b.0));
                }
                for (_, [r, g, b, a]) in &visible {
                    let alpha = f32::from(*a) / 255.0;
                    for (below, above) in colour.iter_mut().zip([r, g, b]) {
                        *below += (f32::from(*above) - *below) * alpha;
                    }
                }
                for (sum, c) in sum.iter_mut().zip(colour) {
                    *sum += (c + 0.5) as u16;
                }
            }
        }
    }
}

fn add(sums: &mut [[u16; 3]], other: &[[u16; 3]]) {
    for (sum, value) in sums.iter_mut().flatten().zip(other.iter().flatten()) {
        *sum += value;
    }
}

/// The path of the centre of mass of a body, without points that nearly coincide in the picture.
fn path(input: &PictureInput, body: usize, camera: &Camera) -> Path {
    let mut path = Path::new();
    let mut last: Option<(f32, f32)> = None;
    for (index, frame) in input.frames.iter().enumerate() {
        let Some(pose) = frame.drawable_pose(body) else { continue };
        let Some(at) = camera.project(pose.position) else { continue };
        let is_near = last.is_some_and(|(x, y)| (x - at.x).hypot(y - at.y) < 0.8);
        if !is_near {
            path.push((index, pose.position));
            last = Some((at.x, at.y));
        }
    }
    path
}

/// Renders the whole motion in one picture.
#[must_use]
pub fn render(input: &PictureInput) -> Image {
    Renderer::new(input).render_motion()
}
