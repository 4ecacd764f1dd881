//! Tests of rendered pixels.

use super::{
    Boundary, Frame, Image, PictureBody, PictureInput, Pose, Renderer, encode_png, render,
};
use glam::{DQuat, DVec3};
use proptest::prelude::*;

fn cube(half: f64) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let sign = |bit: u32| if bit == 0 { -half } else { half };
    let corners = (0..8).map(|i| DVec3::new(sign(i & 1), sign(i & 2), sign(i & 4))).collect();
    let quads =
        [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    let halves = |q: [u32; 4]| [[q[0], q[1], q[2]], [q[0], q[2], q[3]]];
    (corners, quads.into_iter().flat_map(halves).collect())
}

fn pose(x: f64, y: f64, z: f64) -> Pose {
    Pose { position: DVec3::new(x, y, z), orientation: DQuat::IDENTITY }
}

fn closed_box(half: f64) -> Boundary {
    Boundary::Box {
        min: DVec3::splat(-half),
        max: DVec3::splat(half),
        orientation: DQuat::IDENTITY,
        open: [false; 6],
    }
}

struct Case {
    bodies: Vec<(Vec<DVec3>, Vec<[u32; 3]>)>,
    boundary: Vec<Boundary>,
    frames: Vec<Frame>,
    size: (u32, u32),
    title: &'static str,
}

impl Case {
    fn with<T>(&self, test: impl FnOnce(&PictureInput) -> T) -> T {
        let bodies: Vec<PictureBody> = self
            .bodies
            .iter()
            .map(|(vertices, triangles)| PictureBody {
                name: "body",
                vertices,
                triangles,
                is_kinematic: false,
            })
            .collect();
        test(&PictureInput {
            title: self.title,
            up: DVec3::Y,
            bodies: &bodies,
            boundary: &self.boundary,
            frames: &self.frames,
            size: self.size,
        })
    }
}

fn one_cube(poses: &[Pose]) -> Case {
    let frame = |(i, pose): (usize, &Pose)| Frame { time: i as f64, poses: vec![*pose] };
    Case {
        bodies: vec![cube(0.2)],
        boundary: vec![closed_box(1.0)],
        frames: poses.iter().enumerate().map(frame).collect(),
        size: (400, 250),
        title: "",
    }
}

/// Whether a pixel has the blue hue of the first body, unlike walls and background.
fn is_blue([r, _, b]: [u8; 3]) -> bool {
    i32::from(b) > i32::from(r) + 60
}

fn is_orange([r, _, b]: [u8; 3]) -> bool {
    i32::from(r) > i32::from(b) + 60
}

fn at(renderer: &Renderer, image: &Image, point: DVec3) -> [u8; 3] {
    let (x, y) = renderer.project(point).unwrap();
    image.pixel(x as u32, y as u32).unwrap()
}

#[test]
fn body_is_drawn_at_its_projected_position() {
    one_cube(&[pose(0.5, 0.1, -0.3)]).with(|picture| {
        let renderer = Renderer::new(picture);
        let image = renderer.render_motion();
        assert!(is_blue(at(&renderer, &image, DVec3::new(0.5, 0.1, -0.3))));
        assert!(!is_blue(at(&renderer, &image, DVec3::new(-0.5, 0.1, 0.3))));
    });
}

#[test]
fn picture_has_the_requested_size_and_shows_the_body() {
    let image = one_cube(&[pose(0.0, 0.0, 0.0), pose(0.5, 0.5, 0.5)]).with(render);
    assert_eq!((image.width, image.height, image.pixels.len()), (400, 250, 300_000));
    assert!(image.pixels.chunks(3).filter(|p| is_blue([p[0], p[1], p[2]])).count() > 500);
}

#[test]
fn near_body_occludes_far_body_in_either_order() {
    for order in [[0.8, -0.8], [-0.8, 0.8]] {
        let mut case = one_cube(&[]);
        case.bodies.push(cube(0.2));
        case.with(|picture| {
            // both bodies lie on the line of sight through the centre
            let toward = Renderer::new(picture).direction_to_viewer();
            let frames = [Frame {
                time: 0.0,
                poses: order
                    .iter()
                    .map(|&d| Pose { position: toward * d, orientation: DQuat::IDENTITY })
                    .collect(),
            }];
            let picture = PictureInput { frames: &frames, ..*picture };
            let renderer = Renderer::new(&picture);
            let image = renderer.render_motion();
            let seen = at(&renderer, &image, toward * 0.8);
            assert_eq!(is_blue(seen), order[0] > 0.0, "{seen:?}");
            assert_eq!(is_orange(seen), order[1] > 0.0, "{seen:?}");
        });
    }
}

#[test]
fn body_occludes_the_edge_behind_it() {
    let mut case = one_cube(&[pose(0.0, 0.0, 0.0)]);
    case.with(|picture| {
        let renderer = Renderer::new(picture);
        let image = renderer.render_motion();
        let corner = farthest_corner(&renderer);
        let [r, g, b] = at(&renderer, &image, corner).map(i32::from);
        assert!(r > g + 30 && r > b + 30, "the edge is visible: {r} {g} {b}");
    });
    let corner = case.with(|picture| farthest_corner(&Renderer::new(picture)));
    case.frames[0].poses[0].position = corner * 0.75;
    case.with(|picture| {
        let renderer = Renderer::new(picture);
        let image = renderer.render_motion();
        assert!(is_blue(at(&renderer, &image, corner)), "the edge is hidden");
    });
}

fn farthest_corner(renderer: &Renderer) -> DVec3 {
    let toward = renderer.direction_to_viewer();
    DVec3::new(-toward.x.signum(), -toward.y.signum(), -toward.z.signum())
}

#[test]
fn png_round_trip_preserves_pixels() {
    let image = one_cube(&[pose(0.0, 0.0, 0.0)]).with(render);
    let bytes = encode_png(&image).unwrap();
    let mut reader = png::Decoder::new(std::io::Cursor::new(bytes)).read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut pixels).unwrap();
    assert_eq!((info.width, info.height), (400, 250));
    assert_eq!(pixels, image.pixels);
}

#[test]
fn encoding_too_few_pixels_is_an_error() {
    let image = Image { width: 4, height: 4, pixels: vec![0; 5] };
    assert!(encode_png(&image).is_err());
}

#[test]
fn rendering_is_deterministic() {
    let case = one_cube(&[pose(-0.6, 0.0, 0.0), pose(0.0, 0.4, 0.0), pose(0.6, -0.7, 0.2)]);
    assert_eq!(case.with(render), case.with(render));
}

#[test]
fn scale_of_the_scene_does_not_change_the_picture() {
    let at = |x: f64, scale: f64| {
        let mut case = one_cube(&[pose(-0.5 * scale, 0.0, 0.0), pose(x * scale, 0.0, 0.0)]);
        case.bodies = vec![cube(0.2 * scale)];
        case.boundary = vec![closed_box(scale)];
        case.with(render)
    };
    let usual = at(0.5, 1.0);
    for scale in [1e-6, 1e6] {
        let other = at(0.5, scale);
        let differ = |(a, b): &(&u8, &u8)| a.abs_diff(**b) > 40;
        let count = usual.pixels.iter().zip(&other.pixels).filter(differ).count();
        // only labels may differ
        assert!(count < usual.pixels.len() / 50, "{count} at {scale}");
    }
}

#[test]
fn poses_that_are_not_finite_are_not_drawn() {
    let nan = pose(f64::NAN, 0.0, 0.0);
    let far = pose(1e300, -1e300, f64::INFINITY);
    let flat = Pose { position: DVec3::ZERO, orientation: DQuat::from_xyzw(0.0, 0.0, 0.0, 0.0) };
    let case = one_cube(&[pose(0.0, 0.0, 0.0), nan, far, flat, pose(0.5, 0.0, 0.0), nan]);
    case.with(|picture| {
        let renderer = Renderer::new(picture);
        assert!(is_blue(at(&renderer, &renderer.render_motion(), DVec3::new(0.5, 0.0, 0.0))));
        for frame in 0..8 {
            let _ = renderer.render_frame(frame);
        }
    });
}

#[test]
fn small_and_empty_sizes_are_rendered() {
    for size in [(0, 0), (1, 1), (1, 300), (300, 1), (7, 3), (320, 200), (321, 201)] {
        let mut case = one_cube(&[pose(0.0, 0.0, 0.0), pose(0.5, 0.5, 0.5)]);
        (case.size, case.title) = (size, "a title that is longer than the picture is wide, 世界");
        let image = case.with(render);
        assert_eq!((image.width, image.height), (size.0.max(1), size.1.max(1)));
    }
}

#[test]
fn empty_input_shows_the_title() {
    let empty = Case {
        bodies: vec![],
        boundary: vec![],
        frames: vec![],
        size: (320, 200),
        title: "nothing",
    };
    assert!(empty.with(render).pixels.iter().any(|&p| p < 200), "the title is drawn");
}

#[test]
fn single_particle_is_visible() {
    let mut case = one_cube(&[pose(0.3, 0.0, 0.0)]);
    case.bodies = vec![(vec![DVec3::ZERO], vec![])];
    for boundary in [vec![closed_box(1.0)], vec![]] {
        case.boundary = boundary;
        case.with(|picture| {
            let renderer = Renderer::new(picture);
            assert!(is_blue(at(&renderer, &renderer.render_motion(), DVec3::new(0.3, 0.0, 0.0))));
        });
    }
}

#[test]
fn triangles_with_invalid_vertices_are_skipped() {
    let mut case = one_cube(&[pose(0.0, 0.0, 0.0)]);
    case.bodies[0].1.push([0, 1, 99]);
    case.bodies[0].0[3] = DVec3::splat(f64::NAN);
    assert!(case.with(render).pixels.chunks(3).any(|p| is_blue([p[0], p[1], p[2]])));
}

fn any_number() -> impl Strategy<Value = f64> {
    prop_oneof![3 => -2.0..2.0, 1 => any::<f64>()]
}

fn any_vector() -> impl Strategy<Value = DVec3> {
    (any_number(), any_number(), any_number()).prop_map(|(x, y, z)| DVec3::new(x, y, z))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn arbitrary_numbers_do_not_panic(
        vertices in prop::collection::vec(any_vector(), 0..6),
        triangles in prop::collection::vec([0u32..8, 0u32..8, 0u32..8], 0..4),
        places in prop::collection::vec((any_number(), any_vector(), any_vector()), 0..4),
        corners in [any_vector(), any_vector(), any_vector()],
        up in any_vector(),
        offset in any_number(),
        width in 1u32..400,
    ) {
        let frame = |&(time, position, turn): &(f64, DVec3, DVec3)| {
            let orientation = DQuat::from_xyzw(turn.x, turn.y, turn.z, offset);
            Frame { time, poses: vec![Pose { position, orientation }] }
        };
        let frames: Vec<Frame> = places.iter().map(frame).collect();
        let bodies = [PictureBody {
            name: "any",
            vertices: &vertices,
            triangles: &triangles,
            is_kinematic: false,
        }];
        let [min, max, normal] = corners;
        let open = [false, false, false, true, false, false];
        let orientation = DQuat::from_xyzw(up.x, up.y, up.z, offset);
        let boundary = [
            Boundary::Box { min, max, orientation, open },
            Boundary::Plane { normal, offset },
        ];
        let size = (width, 210);
        for boundary in [&boundary[..], &boundary[..0]] {
            let picture =
                PictureInput { title: "any", up, bodies: &bodies, boundary, frames: &frames, size };
            let _ = render(&picture);
        }
    }
}
