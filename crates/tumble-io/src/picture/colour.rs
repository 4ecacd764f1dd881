//! Colours of bodies.

use super::input::PictureInput;
use crate::appearance::KINEMATIC_COLOUR;

/// Palette that is safe for colour-blind readers (Okabe and Ito 2008), without black.
const PALETTE: [[f32; 3]; 7] = [
    [0.0, 114.0, 178.0],
    [230.0, 159.0, 0.0],
    [0.0, 158.0, 115.0],
    [204.0, 121.0, 167.0],
    [86.0, 180.0, 233.0],
    [213.0, 94.0, 0.0],
    [240.0, 228.0, 66.0],
];

/// Background colour that faded bodies blend into: red, green, blue from 0 to 255.
pub(super) const BACKGROUND: [f32; 3] = [247.0, 248.0, 250.0];

/// Colour of the body with this index: red, green, blue from 0 to 255.
pub(crate) fn body_colour(body: usize) -> [f32; 3] {
    let cycle = (body / PALETTE.len()) % 3;
    // repeated hues are a little darker
    PALETTE[body % PALETTE.len()].map(|c| c * (1.0 - 0.16 * cycle as f32))
}

/// Colour of a body in a picture: grey if it is kinematic.
pub(super) fn picture_colour(input: &PictureInput, body: usize) -> [f32; 3] {
    let is_kinematic = input.bodies.get(body).is_some_and(|body| body.is_kinematic);
    if is_kinematic { KINEMATIC_COLOUR } else { body_colour(body) }
}
