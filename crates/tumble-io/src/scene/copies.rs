//! A lattice of bodies, and random orientations that are the same on every machine.

use tumble::{DQuat, DVec3};

use super::description::Copies;

impl Copies {
    /// Number of bodies.
    pub fn total(&self) -> u64 {
        self.count.iter().map(|&n| u64::from(n)).product()
    }

    /// Position (m) and orientation of every copy relative to those of the body.
    pub fn poses(&self) -> Vec<(DVec3, DQuat)> {
        let centre = DVec3::from_array(self.count.map(|n| 0.5 * (f64::from(n) - 1.0)));
        let mut random = self.seed.map(SplitMix64);
        let mut poses = Vec::new();
        for k in 0..self.count[2] {
            for j in 0..self.count[1] {
                for i in 0..self.count[0] {
                    let offset = DVec3::new(f64::from(i), f64::from(j), f64::from(k)) - centre;
                    let rotation = random.as_mut().map_or(DQuat::IDENTITY, SplitMix64::rotation);
                    poses.push((offset * self.spacing, rotation));
                }
            }
        }
        poses
    }
}

/// Steele, Lea & Flood, *Fast splittable pseudorandom number generators*, OOPSLA 2014.
struct SplitMix64(u64);

impl SplitMix64 {
    /// A uniform number in [0, 1).
    fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    /// A uniformly distributed rotation: Shoemake, *Uniform random rotations*, Graphics Gems III, 1992.
    fn rotation(&mut self) -> DQuat {
        let (u, a, b) = (self.unit(), self.unit(), self.unit());
        let (sin_a, cos_a) = libm::sincos(std::f64::consts::TAU * a);
        let (sin_b, cos_b) = libm::sincos(std::f64::consts::TAU * b);
        let (p, q) = ((1.0 - u).sqrt(), u.sqrt());
        DQuat::from_xyzw(p * sin_a, p * cos_a, q * sin_b, q * cos_b).normalize()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_lattice_is_centred() {
        let copies = Copies { count: [3, 2, 4], spacing: DVec3::new(0.5, 1.0, 2.0), seed: Some(1) };
        let poses = copies.poses();
        assert_eq!(poses.len() as u64, copies.total());
        assert!(poses.iter().map(|(at, _)| *at).sum::<DVec3>().length() < 1e-12);
        assert_eq!(poses[0].0, DVec3::new(-0.5, -0.5, -3.0));
        assert!(poses.iter().all(|(_, q)| q.is_normalized()));
        assert_ne!(poses[0].1, poses[1].1);
        assert_eq!(poses, copies.poses());
    }
}
