//! stub
use glam::DVec3;
#[derive(Clone, Debug, Default)]
pub(super) struct Grid;
impl Grid {
    pub fn find(
        &mut self,
        n: usize,
        ball: &impl Fn(usize) -> (DVec3, f64),
        free: &impl Fn(usize) -> bool,
        out: &mut Vec<(u32, u32)>,
    ) {
        out.clear();
        for a in 0..n {
            for b in a + 1..n {
                let ((x, r), (y, s)) = (ball(a), ball(b));
                if (free(a) || free(b)) && x.distance(y) <= r + s {
                    out.push((a as u32, b as u32));
                }
            }
        }
    }
}
