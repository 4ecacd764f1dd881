//! What `cargo bench` measures: tumble beside a plain loop over particles, in turns.

mod heaps;
mod plain_loop;
mod rounds;
mod runs;
mod trial;

pub use heaps::{HeapCost, heaps};
pub use plain_loop::{PlainLoop, Style};
pub use rounds::side_by_side;
pub use runs::{Run, machine, wall_seconds};
pub use trial::{Motion, Trial, fibonacci_sphere, sphere_mesh};
