//! Contact of coarse meshes: flush faces, crossing edges, sliding over seams and over a fine mesh.

use std::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_4};

use tumble::{Body, DQuat, DVec3, Motion, Prescribed, Primitive, World, WorldBuilder};

use crate::check::{Case, Check, Error, Outcome};
use crate::setup::{FLOOR, G, material, mesh_body, step_until};

pub(crate) const RESTING: Case = Case {
    name: "coarse meshes at rest",
    description: "Boxes, sticks and plates of twelve triangles lie on each other for 2 s: flush, nearly flush, turned, overhanging, crossed. They \
            stay where they are but for the depth of springs: at most the weight over the stiffness k of one particle for each body.",
    run: resting,
    slow: true,
};

pub(crate) const CROSSING_EDGES: Case = Case {
    name: "crossing edges",
    description: "A stick falls edge first across the edge of another, without losses. Each edge is in the other one, with k and the normal \
            of its face at 45°, so that both together are one spring of stiffness k: the depth is that of the static and the falling weight on it.",
    run: crossing_edges,
    slow: false,
};

pub(crate) const SLIDING: Case = Case {
    name: "coarse mesh on a mesh",
    description: "A block without friction slides over the seams of flush tiles, and over a fine mesh. It keeps its speed and its height.",
    run: sliding,
    slow: true,
};

/// Stiffness of the springs (N/m).
const K: f64 = 1e5;

fn cuboid(x: f64, y: f64, z: f64, divisions: u32) -> Result<Body, Error> {
    let body = mesh_body(Primitive::Box { size: DVec3::new(x, y, z), divisions })?;
    Ok(body.mass(1.0))
}

fn fixed(body: Body) -> Body {
    body.motion(Motion::Prescribed(Prescribed::default()))
}

fn world(friction: f64) -> WorldBuilder {
    World::builder().material(material(K, 0.3, friction)).dt(1e-4)
}

/// Two bodies on the floor, one on the other.
struct Pile {
    name: &'static str,
    lower: [f64; 3],
    upper: [f64; 3],
    /// Angle of the upper one about the vertical.
    turn: f64,
    /// Horizontal offset of the upper one (m).
    offset: [f64; 2],
}

const BOX: [f64; 3] = [0.4, 0.2, 0.4];
const STICK: [f64; 3] = [1.0, 0.04, 0.04];
const PLATE: [f64; 3] = [0.6, 0.01, 0.1];

const PILES: &[Pile] = &[
    Pile { name: "flush boxes", lower: BOX, upper: BOX, turn: 0.0, offset: [0.0; 2] },
    Pile {
        name: "a footprint 0.1 mm smaller",
        lower: BOX,
        upper: [0.3999, 0.2, 0.3999],
        turn: 0.0,
        offset: [0.0; 2],
    },
    Pile { name: "turned by 45°", lower: BOX, upper: BOX, turn: FRAC_PI_4, offset: [0.0; 2] },
    Pile { name: "overhanging", lower: BOX, upper: BOX, turn: 0.0, offset: [0.12, 0.0] },
    Pile {
        name: "flush with the edges of a larger one",
        lower: [1.0, 0.2, 1.0],
        upper: BOX,
        turn: 0.0,
        offset: [0.3; 2],
    },
    Pile {
        name: "a stick across a stick",
        lower: STICK,
        upper: STICK,
        turn: 2.0 * FRAC_PI_4,
        offset: [0.0; 2],
    },
    Pile {
        name: "a plate across a plate",
        lower: PLATE,
        upper: PLATE,
        turn: 2.0 * FRAC_PI_4,
        offset: [0.0; 2],
    },
];

fn resting() -> Outcome {
    let mut checks = Vec::new();
    for pile in PILES {
        let Pile { name, lower, upper, turn, offset } = pile;
        let height = lower[1] + 0.5 * upper[1];
        let place = DVec3::new(offset[0], height, offset[1]);
        let below = cuboid(lower[0], lower[1], lower[2], 1)?.position(DVec3::Y * 0.5 * lower[1]);
        let above = cuboid(upper[0], upper[1], upper[2], 1)?
            .position(place)
            .orientation(DQuat::from_rotation_y(*turn));
        let mut world = world(0.5).wall(FLOOR).body(below).body(above).build()?;
        step_until(&mut world, 2.0)?;
        let moved = world.body(1).position() - place;
        // twice the weight on the lower body, once on the upper one; one particle would carry either
        let bound = 3.0 * G / K;
        checks.push(Check::error(format!("{name}: sinking"), moved.y, bound, "m"));
        let drift = moved.x.hypot(moved.z);
        checks.push(Check::error(format!("{name}: drift"), drift, bound, "m"));
        let speed = world.body(1).velocity().length();
        checks.push(Check::error(format!("{name}: speed at the end"), speed, 1e-5, "m/s"));
    }
    Ok(checks)
}

fn crossing_edges() -> Outcome {
    let (thickness, drop) = (0.04, 1e-3);
    let roll = DQuat::from_rotation_x(FRAC_PI_4);
    let across = DQuat::from_rotation_y(2.0 * FRAC_PI_4) * roll;
    let touch = thickness * 2.0 * FRAC_1_SQRT_2;
    let below = fixed(cuboid(1.0, thickness, thickness, 1)?.orientation(roll));
    let height = touch + drop;
    let above = cuboid(1.0, thickness, thickness, 1)?.position(DVec3::Y * height);
    let undamped = material(K, 1.0, 0.0);
    let world = World::builder().material(undamped).dt(2e-5);
    let mut world = world.body(below).body(above.orientation(across)).build()?;
    let mut lowest = height;
    while world.time() < 0.04 {
        world.step()?;
        lowest = lowest.min(world.body(1).position().y);
    }
    // energy: ½ k d² = m g (drop + d)
    let sag = G / K;
    let depth = sag + (sag * sag + 2.0 * sag * drop).sqrt();
    let measured = touch - lowest;
    Ok(vec![Check::new("greatest depth", depth, measured, 0.01 * depth, "m")])
}

fn sliding() -> Outcome {
    let mut checks = Vec::new();
    let tiles = (0..9).map(|i| {
        let at = DVec3::new(f64::from(i / 3) * 0.4 - 0.4, -0.05, f64::from(i % 3) * 0.4 - 0.4);
        Ok(fixed(cuboid(0.4, 0.1, 0.4, 1)?.position(at)))
    });
    let tiles: Vec<Body> = tiles.collect::<Result<_, Error>>()?;
    let fine = vec![fixed(cuboid(1.2, 0.1, 0.6, 60)?.position(DVec3::Y * -0.05))];
    for (name, floor, divisions) in [("nine tiles", tiles, 1), ("a fine mesh", fine, 2)] {
        let block = cuboid(0.2, 0.1, 0.2, divisions)?;
        let start = DVec3::new(-0.413, 0.05, 0.0071);
        let block = block.position(start).velocity(DVec3::X);
        let mut world =
            floor.into_iter().fold(world(0.0), WorldBuilder::body).body(block).build()?;
        let index = world.model().bodies.len() - 1;
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        while world.time() < 0.8 {
            world.step()?;
            if world.time() > 0.2 {
                let height = world.body(index).position().y;
                (low, high) = (low.min(height), high.max(height));
            }
        }
        let loss = 1.0 - world.body(index).velocity().x;
        checks.push(Check::error(format!("{name}: speed lost in 0.8 s"), loss, 1e-3, "m/s"));
        // one particle alone would carry the block at this depth
        let bound = G / K;
        checks.push(Check::error(format!("{name}: change of height"), high - low, bound, "m"));
        let turned = world.body(index).orientation().to_axis_angle().1;
        checks.push(Check::error(format!("{name}: rotation"), turned, 1e-3, "rad"));
    }
    Ok(checks)
}
