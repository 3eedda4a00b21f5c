//! What a process that meets hostile files asks of the system, where the system has it.

/// What a task may take beyond what it said: estimates are not exact, and memory of the last one may linger.
#[cfg(target_os = "linux")]
const SLACK: u64 = 256 << 20;

/// The worker ends with its parent, however that ends, and is the first to go when memory runs out.
pub fn prepare() {
    #[cfg(target_os = "linux")]
    {
        // Without these the worker still ends when its stdin does.
        let _ = rustix::process::set_parent_process_death_signal(Some(rustix::process::Signal::KILL));
        let _ = std::fs::write("/proc/self/oom_score_adj", "800");
    }
}

/// No more memory than twice what was said: a decoder that is led astray fails here, not the machine.
pub fn limit_memory(bytes: u64) {
    #[cfg(target_os = "linux")]
    set(Some(2 * bytes + SLACK));
    #[cfg(not(target_os = "linux"))]
    let _ = bytes;
}

pub(crate) fn unlimit_memory() {
    #[cfg(target_os = "linux")]
    set(None);
}

#[cfg(target_os = "linux")]
fn set(bytes: Option<u64>) {
    use rustix::process::{Resource, Rlimit, getrlimit, setrlimit};
    let maximum = getrlimit(Resource::Data).maximum;
    let current = bytes.or(maximum);
    let _ = setrlimit(Resource::Data, Rlimit { current, maximum });
}

/// Most memory that this process held, in bytes; 0 where the system does not tell.
pub(crate) fn peak() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|l| l.strip_prefix("VmHWM:"));
    let kilobytes = line.and_then(|l| l.trim().strip_suffix("kB")?.trim().parse::<u64>().ok());
    kilobytes.unwrap_or(0) * 1024
}
