//! Description of the machine that the benchmarks run on.

/// Describes the processor and the operating system in one sentence.
pub fn describe_machine() -> String {
    let cpu = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model = cpu.lines().find_map(|line| line.strip_prefix("model name")?.split_once(": "));
    let model = model.map_or("unknown processor", |(_, model)| model);
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    format!("Machine: {model}, {cores} cores, {} {}.", std::env::consts::OS, std::env::consts::ARCH)
}
