//! The measurements behind `cargo bench`: tumble compared with a plain loop over particles, heaps of clumps, and complete runs.

mod full_run;
mod heaps;
mod machine;
mod plain_loop;
mod single_body;
mod timing;

pub use full_run::{RunTime, time_run};
pub use heaps::{HeapCost, measure_heaps};
pub use machine::describe_machine;
pub use plain_loop::{LoopStyle, PlainLoop};
pub use single_body::{Motion, SingleBodyBenchmark, sphere_mesh};
pub use timing::time_in_turns;
