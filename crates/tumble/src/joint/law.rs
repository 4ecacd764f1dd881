//! The law of a coordinate: the impulse of its spring, damper, motor, friction and limit in a kick.
//!
//! All of them resist, so the impulse p falls as the rate u⁺ after the kick rises. Let u₀ be the rate at the beginning of the step and
//! e = u⁺ + (u⁻ − u₀) that at its end, if both flights change it alike. The law is linear in parts: between the rates at which friction,
//! a motor or a limit jumps it is sloped, p = b − a e, and at these e is given and p is within the jump: what friction holds is at rest at
//! the end of the step, and does not creep, since the flights cancel. Springs and dampers act at the mean rate ū = (u⁻ + u⁺)/2 = (u₀ + e)/2: an
//! undamped spring conserves energy at any step. What an impulse takes is exactly −p ū.

use super::definition::Motor;
use super::model::JointModel;

/// The largest number of velocities at which the law jumps or bends.
const MAX_BREAKS: usize = 4;

/// A limit that the coordinate is at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum AtLimit {
    None,
    Lower,
    Upper,
}

/// Terms that jump: their impulses (N·s or N·m·s) below and above a velocity.
#[derive(Clone, Copy, Debug)]
struct Jump {
    velocity: f64,
    below: f64,
    above: f64,
}

impl Jump {
    const NONE: Self = Self { velocity: 0.0, below: 0.0, above: 0.0 };

    fn at(&self, side: Side) -> f64 {
        if side.is_below(self.velocity) { self.below } else { self.above }
    }
}

/// b − a e, within ± `most`.
#[derive(Clone, Copy, Debug)]
struct Ramp {
    a: f64,
    b: f64,
    most: f64,
}

impl Ramp {
    const NONE: Self = Self { a: 0.0, b: 0.0, most: f64::INFINITY };

    /// The velocities at which it reaches its limits.
    fn ends(&self) -> Option<[f64; 2]> {
        (self.a > 0.0 && self.most < f64::INFINITY)
            .then(|| [(self.b - self.most) / self.a, (self.b + self.most) / self.a])
    }

    /// Slope and intercept on one side of a velocity.
    fn at(&self, side: Side) -> [f64; 2] {
        match self.ends() {
            None => [self.a, self.b.clamp(-self.most, self.most)],
            Some([low, _]) if side.is_below(low) => [0.0, self.most],
            Some([_, high]) if !side.is_below(high) => [0.0, -self.most],
            Some(_) => [self.a, self.b],
        }
    }
}

/// Just below or just above a velocity.
#[derive(Clone, Copy, Debug)]
enum Side {
    Below(f64),
    Above(f64),
}

impl Side {
    /// Whether it is below another velocity.
    fn is_below(self, velocity: f64) -> bool {
        match self {
            Self::Below(at) => at <= velocity,
            Self::Above(at) => at < velocity,
        }
    }
}

/// A piece of the law.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Piece {
    /// p = b − a e, for e within `between`.
    Sloped { a: f64, b: f64, between: [f64; 2] },
    /// e = `velocity`, for p within `impulses`.
    Vertical { velocity: f64, impulses: [f64; 2] },
}

/// What the parts of the law do in a kick.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Parts {
    /// Impulse of the motor, and of all that dissipates.
    pub motor: f64,
    pub losses: f64,
}

/// The law of one coordinate in one kick.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CoordinateLaw {
    spring: Ramp,
    damper: f64,
    servo: Ramp,
    drive: Jump,
    friction: Jump,
    limit: Jump,
    breaks: [f64; MAX_BREAKS],
    count: usize,
}

impl CoordinateLaw {
    /// The law for a kick over the time `h` (s), in a step that begins at the coordinate `start` with the rate `rate`.
    pub fn new(joint: &JointModel, (start, rate): (f64, f64), h: f64, at_limit: AtLimit) -> Self {
        // the mean of the force at both ends of the step, which moves the coordinate by h ū
        let spring = |k: f64, c: f64, rest: f64, most: f64| {
            let a = 0.5 * (0.5 * h * h * k + h * c);
            Ramp { a, b: -h * k * (start - rest) - a * rate, most: h * most }
        };
        let (mut servo, mut drive) = (Ramp::NONE, Jump::NONE);
        match joint.motor {
            Some(Motor::Speed { speed, effort }) => {
                drive = Jump { velocity: speed, below: h * effort, above: -h * effort };
            }
            Some(Motor::Position { target, stiffness, damping, effort }) => {
                servo = spring(stiffness, damping, target, effort);
            }
            None => {}
        }
        let most = h * joint.friction;
        let mut law = Self {
            spring: spring(joint.stiffness, joint.damping, joint.natural, f64::INFINITY),
            damper: h * joint.damping,
            servo,
            drive,
            friction: Jump { velocity: 0.0, below: most, above: -most },
            limit: match at_limit {
                AtLimit::None => Jump::NONE,
                AtLimit::Lower => Jump { velocity: 0.0, below: f64::INFINITY, above: 0.0 },
                AtLimit::Upper => Jump { velocity: 0.0, below: 0.0, above: f64::NEG_INFINITY },
            },
            breaks: [0.0; MAX_BREAKS],
            count: 0,
        };
        law.find_breaks();
        law
    }

    fn find_breaks(&mut self) {
        let jumps = [self.drive, self.friction, self.limit];
        let jumps = jumps.iter().filter(|jump| jump.below != jump.above).map(|jump| jump.velocity);
        let mut breaks: Vec<f64> = jumps.chain(self.servo.ends().into_iter().flatten()).collect();
        breaks.sort_by(f64::total_cmp);
        breaks.dedup();
        self.count = breaks.len();
        self.breaks[..self.count].copy_from_slice(&breaks);
    }

    /// A piece, in the order of rising velocity: the odd ones are vertical.
    pub fn piece(&self, index: usize) -> Piece {
        let at = index / 2;
        if index % 2 == 1 {
            let velocity = self.breaks[at];
            let impulse = |side| {
                let [a, b] = self.sloped(side);
                b - a * velocity
            };
            let impulses = [impulse(Side::Above(velocity)), impulse(Side::Below(velocity))];
            return Piece::Vertical { velocity, impulses };
        }
        let low = if at > 0 { self.breaks[at - 1] } else { f64::NEG_INFINITY };
        let high = if at < self.count { self.breaks[at] } else { f64::INFINITY };
        let side = if at > 0 { Side::Above(low) } else { Side::Below(high) };
        let [a, b] = self.sloped(side);
        Piece::Sloped { a, b, between: [low, high] }
    }

    /// The piece that holds a velocity, or the nearest one whose impulses are finite.
    pub fn piece_at(&self, velocity: f64) -> usize {
        let breaks = &self.breaks[..self.count];
        let below = breaks.partition_point(|at| *at < velocity);
        let piece = 2 * below + usize::from(breaks.get(below) == Some(&velocity));
        match self.piece(piece) {
            Piece::Sloped { b: f64::NEG_INFINITY, .. } => piece - 1,
            Piece::Sloped { b: f64::INFINITY, .. } => piece + 1,
            _ => piece,
        }
    }

    fn sloped(&self, side: Side) -> [f64; 2] {
        let jumps =
            [self.drive, self.friction, self.limit].iter().map(|jump| jump.at(side)).sum::<f64>();
        let [a, b] = self.servo.at(side);
        [self.spring.a + a, self.spring.b + b + jumps]
    }

    /// The parts of an impulse on a piece, at the rate e `end` and the mean rate ū `mean`.
    pub fn parts(&self, index: usize, [end, mean]: [f64; 2], impulse: f64) -> Parts {
        let Piece::Vertical { velocity, .. } = self.piece(index) else {
            let side = Side::Above(end);
            let [a, b] = self.servo.at(side);
            let motor = self.drive.at(side) + (b - a * end);
            return Parts { motor, losses: self.friction.at(side) - self.damper * mean };
        };
        // what the others leave is that of the motor, then that of friction; a limit does no work
        let side = Side::Above(velocity);
        let [a, b] = self.servo.at(side);
        let servo = b - a * velocity;
        let rest = impulse - (self.spring.b - self.spring.a * velocity) - servo;
        let share = |jump: &Jump, rest: f64| {
            if jump.velocity == velocity && jump.below != jump.above {
                rest.clamp(jump.above, jump.below)
            } else {
                jump.at(side)
            }
        };
        let others = if self.drive.velocity == velocity { self.friction.at(side) } else { 0.0 };
        let drive = share(&self.drive, rest - others);
        let friction = share(&self.friction, rest - drive);
        Parts { motor: drive + servo, losses: friction - self.damper * mean }
    }
}
