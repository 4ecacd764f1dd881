//! A hash of the state, for comparing runs.

use sha2::{Digest, Sha256};

use crate::{ContactImpulse, PairSpring, State};

impl State {
    /// The first 16 bytes of the SHA-256 of the state, in hexadecimal.
    ///
    /// The state is hashed as little-endian numbers: step, time, then for each body position, `position_compensation`, velocity,
    /// orientation (w, x, y, z), `orientation_compensation`, angular momentum, `energy_excess` and friction springs, then
    /// the friction springs between bodies and their impulses, then the totals (with its work unless that is zero, and with those of
    /// the implicit solver if it ran), then coordinate and forces of each joint, and the totals of joints if there are any. Two states with
    /// equal hashes are equal bit for bit.
    pub fn hash(&self) -> String {
        let mut hasher = Sha256::new();
        let mut put = |value: f64| hasher.update(value.to_le_bytes());
        put(f64::from_bits(self.step));
        put(self.time);
        for (body, springs) in self.bodies.iter().zip(&self.springs) {
            body.position.to_array().into_iter().for_each(&mut put);
            body.position_compensation.to_array().into_iter().for_each(&mut put);
            body.velocity.to_array().into_iter().for_each(&mut put);
            for q in [body.orientation, body.orientation_compensation] {
                [q.w, q.x, q.y, q.z].into_iter().for_each(&mut put);
            }
            body.angular_momentum.to_array().into_iter().for_each(&mut put);
            put(body.energy_excess);
            put(f64::from_bits(springs.len() as u64));
            for spring in springs {
                put(f64::from(spring.wall));
                put(f64::from(spring.particle));
                spring.anchor.to_array().into_iter().for_each(&mut put);
                spring.stretch.to_array().into_iter().for_each(&mut put);
            }
        }
        for spring in &self.pair_springs {
            let PairSpring { first, second, kind, particle, other, stretch } = *spring;
            for number in [first, second, kind as u32, particle, other] {
                put(f64::from(number));
            }
            stretch.to_array().into_iter().for_each(&mut put);
        }
        for ContactImpulse { normal, tangential } in &self.pair_impulses {
            put(*normal);
            tangential.to_array().into_iter().for_each(&mut put);
        }
        let totals = &self.totals;
        if totals.work != 0.0 {
            put(totals.work);
        }
        [totals.drag, totals.dashpot, totals.slip, totals.max_depth].into_iter().for_each(&mut put);
        put(f64::from_bits(totals.evaluations));
        if totals.iterations != 0 {
            put(self.since_kick);
            put(f64::from(self.step_divisions));
            put(totals.numerical);
            put(f64::from_bits(totals.iterations));
            put(f64::from_bits(totals.not_converged));
        }
        for joint in &self.joints {
            put(joint.coordinate);
            joint.force.into_iter().for_each(&mut put);
        }
        if !self.joints.is_empty() {
            [totals.motor, totals.joint_friction].into_iter().for_each(&mut put);
        }
        hasher.finalize().iter().take(16).map(|byte| format!("{byte:02x}")).collect()
    }
}
