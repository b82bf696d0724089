//! Where a run was made: without this, a speed means nothing to who reads it later.

use crate::lanes::Isa;
use serde::Serialize;
use std::fmt::Write;
use std::fs;
use std::thread::available_parallelism;
use std::time::SystemTime;

/// The machine, the build and the time of a run. What a system does not say is none; Linux says all of it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Machine {
    /// The model of the processor.
    pub processor: Option<String>,
    /// Logical processors that this process may use.
    pub logical_processors: Option<usize>,
    /// Caches that the first logical processor sees.
    pub cache_bytes: CacheBytes,
    /// Main memory.
    pub memory_bytes: Option<u64>,
    /// Such as `linux`.
    pub operating_system: &'static str,
    /// The release of its kernel.
    pub kernel: Option<String>,
    /// Such as `x86_64`.
    pub architecture: &'static str,
    /// The instruction set that the program was built for.
    pub isa: Isa,
    /// What `rustc --version` said at the build.
    pub compiler: Option<&'static str>,
    /// Cargo's `opt-level` at the build.
    pub opt_level: Option<&'static str>,
    /// Whether the build checks itself as it runs, which takes time.
    pub debug_assertions: bool,
    /// The program's version.
    pub version: &'static str,
    /// When this was written down, in RFC 3339.
    pub utc: Option<String>,
}

/// Sizes of caches, bytes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct CacheBytes {
    /// Level 1, data.
    pub l1_data: Option<u64>,
    /// Level 2.
    pub l2: Option<u64>,
    /// Level 3, which several processors share as a rule.
    pub l3: Option<u64>,
}

impl Machine {
    /// This machine, this build and this moment.
    #[must_use]
    pub fn here_and_now() -> Self {
        Self {
            processor: field_of_file("/proc/cpuinfo", "model name"),
            logical_processors: available_parallelism().ok().map(usize::from),
            cache_bytes: CacheBytes::of_this_machine(),
            memory_bytes: bytes_of_file("/proc/meminfo", "MemTotal"),
            operating_system: std::env::consts::OS,
            kernel: trimmed_file("/proc/sys/kernel/osrelease"),
            architecture: std::env::consts::ARCH,
            isa: Isa::BUILT_FOR,
            compiler: option_env!("WAVELANE_RUSTC"),
            opt_level: option_env!("WAVELANE_OPT_LEVEL"),
            debug_assertions: cfg!(debug_assertions),
            version: env!("CARGO_PKG_VERSION"),
            utc: rfc_3339(SystemTime::now()),
        }
    }
}

impl CacheBytes {
    fn of_this_machine() -> Self {
        let mut caches = Self::default();
        // Linux numbers the caches of a processor, levels 1 to 3 and the kinds of level 1, from 0 on without a gap.
        for index in 0.. {
            let file =
                |name: &str| trimmed_file(&format!("/sys/devices/system/cpu/cpu0/cache/index{index}/{name}"));
            let Some(level) = file("level") else { break };
            let size = file("size").and_then(|size| kibibytes(size.strip_suffix('K')?));
            match (level.as_str(), file("type").as_deref()) {
                ("1", Some("Data" | "Unified")) => caches.l1_data = size,
                ("2", _) => caches.l2 = size,
                ("3", _) => caches.l3 = size,
                _ => {}
            }
        }
        caches
    }
}

/// The most memory that this process has had at one time, as Linux says it.
#[must_use]
pub fn peak_resident_bytes() -> Option<u64> {
    bytes_of_file("/proc/self/status", "VmHWM")
}

/// None where a clock is wrong by more than the library can write: before 1970 or after 9999.
fn rfc_3339(time: SystemTime) -> Option<String> {
    time.duration_since(SystemTime::UNIX_EPOCH).ok()?;
    let mut text = String::new();
    write!(text, "{}", humantime::format_rfc3339_seconds(time)).ok()?;
    Some(text)
}

fn bytes_of_file(path: &str, name: &str) -> Option<u64> {
    kibibytes(field_of_file(path, name)?.strip_suffix("kB")?)
}

fn field_of_file(path: &str, name: &str) -> Option<String> {
    field(&fs::read_to_string(path).ok()?, name).map(str::to_owned)
}

/// What follows `name:` on the first line that has it.
fn field<'a>(text: &'a str, name: &str) -> Option<&'a str> {
    let values = text.lines().filter_map(|line| line.split_once(':'));
    let mut of_name = values.filter(|(key, _)| key.trim() == name).map(|(_, value)| value.trim());
    of_name.next().filter(|value| !value.is_empty())
}

fn kibibytes(number: &str) -> Option<u64> {
    number.trim().parse::<u64>().ok()?.checked_mul(1024)
}

fn trimmed_file(path: &str) -> Option<String> {
    Some(fs::read_to_string(path).ok()?.trim().to_owned()).filter(|text| !text.is_empty())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    #[test]
    fn a_field_is_found_by_its_whole_name() {
        let text = "model\t\t: 97\nmodel name\t: AMD EPYC: x\nmodel name\t: another\nMemTotal:       24684084 kB\nflags:\n";
        assert_eq!(field(text, "model name"), Some("AMD EPYC: x"));
        assert_eq!(field(text, "MemTotal"), Some("24684084 kB"));
        assert_eq!((field(text, "flags"), field(text, "model n")), (None, None));
    }

    #[test]
    fn what_is_not_there_is_none() {
        assert_eq!(field_of_file("/proc/there is no such file", "MemTotal"), None);
        assert_eq!(
            (kibibytes("32"), kibibytes("K"), kibibytes("18446744073709551615")),
            (Some(32768), None, None)
        );
    }

    #[test]
    #[cfg(all(target_os = "linux", target_arch = "x86_64"))]
    fn linux_says_all_of_the_machine() {
        let machine = Machine::here_and_now();
        for text in [&machine.processor, &machine.kernel] {
            assert!(text.as_ref().is_some_and(|text| !text.is_empty()), "{machine:?}");
        }
        assert_eq!((machine.operating_system, machine.architecture), ("linux", "x86_64"));
        assert!(machine.logical_processors.is_some_and(|count| count >= 1), "{machine:?}");
        // A process is smaller than the memory that it is in.
        let peak = peak_resident_bytes().unwrap();
        assert!(
            peak > 1 << 16 && machine.memory_bytes.is_some_and(|bytes| bytes > peak),
            "{peak}, {machine:?}"
        );
        // A guest need not be shown its caches; where it is, they grow.
        let CacheBytes { l1_data, l2, l3 } = machine.cache_bytes;
        let sizes: Vec<u64> = [l1_data, l2, l3].into_iter().flatten().collect();
        assert!(sizes.is_sorted() && sizes.first().is_none_or(|&least| least >= 4096), "{sizes:?}");
    }

    #[test]
    fn the_build_is_known() {
        let machine = Machine::here_and_now();
        assert!(machine.compiler.is_some_and(|compiler| compiler.starts_with("rustc 1.")), "{machine:?}");
        assert!(machine.opt_level.is_some_and(|level| ["0", "1", "2", "3", "s", "z"].contains(&level)));
    }

    #[test]
    fn the_time_is_utc() {
        let day = Duration::from_secs(86_400);
        let after = |days: u32| rfc_3339(SystemTime::UNIX_EPOCH + day * days + Duration::from_secs(3661));
        assert_eq!(after(0).as_deref(), Some("1970-01-01T01:01:01Z"));
        // 2000 was a leap year: 30 years of 365 days, and the leap days of 72, 76, 80, 84, 88, 92 and 96.
        assert_eq!(after(30 * 365 + 7 + 31 + 28).as_deref(), Some("2000-02-29T01:01:01Z"));
        assert_eq!((rfc_3339(SystemTime::UNIX_EPOCH - day), after(8100 * 366)), (None, None));
        let now = Machine::here_and_now().utc.unwrap();
        let apart = SystemTime::now().duration_since(humantime::parse_rfc3339(&now).unwrap());
        assert!(apart.is_ok_and(|apart| apart < day), "{now}");
    }
}
