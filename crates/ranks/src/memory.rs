//! Memory that there is, as far as the system says.
//!
//! A program that takes more is killed without a word, or ends where a vector grows. What is known to be large is therefore asked for before it is
//! taken.

use std::fmt;
use std::fs::read_to_string;

/// Bytes below which nobody is asked: 64 MiB.
pub const LITTLE: u64 = 64 << 20;

/// Something needs more memory than there is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Short {
    /// What needs it.
    pub what: String,
    /// Bytes that it needs at least.
    pub needed: u64,
    /// Bytes that there are.
    pub there: u64,
}

impl fmt::Display for Short {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let gigabytes = |bytes: u64| bytes as f64 / 1e9;
        write!(
            f,
            "out of memory: {} needs {:.3} GB, and there are {:.3} GB",
            self.what,
            gigabytes(self.needed),
            gigabytes(self.there)
        )
    }
}

impl std::error::Error for Short {}

/// Whether there is room for so many bytes; there is where the system does not tell.
///
/// # Errors
/// There is none.
pub fn room_for(what: impl fmt::Display, needed: u64) -> Result<(), Short> {
    match (needed > LITTLE).then(available).flatten() {
        Some(there) if there < needed => Err(Short {
            what: what.to_string(),
            needed,
            there,
        }),
        _ => Ok(()),
    }
}

/// Bytes that this process can still take: the least of what the machine has, what the group of processes may have that this one is in, and what the
/// limit of the process leaves; `None` where the system tells none of them.
pub fn available() -> Option<u64> {
    let read = |path: &str| read_to_string(path).unwrap_or_default();
    let status = read("/proc/self/status");
    let of_process = limit(&read("/proc/self/limits"))
        .zip(kilobytes(&status, "VmSize:"))
        .map(|(most, taken)| most.saturating_sub(taken));
    let all = [of_machine(&read("/proc/meminfo")), of_process, of_group()];
    all.into_iter().flatten().min()
}

/// What the machine has without pushing out what others use, swap included.
fn of_machine(text: &str) -> Option<u64> {
    let memory = kilobytes(text, "MemAvailable:")?;
    Some(memory + kilobytes(text, "SwapFree:").unwrap_or(0))
}

/// What a container or a batch system leaves to its processes, by the control groups of either version.
fn of_group() -> Option<u64> {
    let groups = read_to_string("/proc/self/cgroup").ok()?;
    let of_line = |line: &str| {
        let mut words = line.splitn(3, ':').skip(1);
        let (kind, path) = words.next().zip(words.next())?;
        let (root, most, used) = match kind {
            "" => ("/sys/fs/cgroup", "memory.max", "anon "),
            "memory" => (
                "/sys/fs/cgroup/memory",
                "memory.limit_in_bytes",
                "total_rss ",
            ),
            _ => return None,
        };
        // in a container the group of the file is the root of what it sees
        let folders = [format!("{root}{path}"), root.to_owned()];
        folders.iter().find_map(|folder| {
            let most = read_to_string(format!("{folder}/{most}")).ok()?;
            let most: u64 = most.trim().parse().ok()?;
            let used_now = read_to_string(format!("{folder}/memory.stat")).ok()?;
            let mut lines = used_now.lines();
            let used_now = lines.find_map(|line| line.strip_prefix(used))?;
            Some(most.saturating_sub(used_now.trim().parse().ok()?))
        })
    };
    groups.lines().filter_map(of_line).min()
}

/// The limit of the address space in the table of limits; none where there is no limit.
fn limit(table: &str) -> Option<u64> {
    let mut lines = table.lines();
    let line = lines.find_map(|line| line.strip_prefix("Max address space"))?;
    line.split_whitespace().next()?.parse().ok()
}

/// A value of a table of kilobytes, in bytes.
fn kilobytes(table: &str, key: &str) -> Option<u64> {
    let mut lines = table.lines();
    let value = lines.find_map(|line| line.strip_prefix(key))?;
    let number: u64 = value.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(1024 * number)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_of_the_system_are_read() {
        let meminfo = "MemTotal:  24683652 kB\nMemAvailable:   1000 kB\nSwapFree:        24 kB\n";
        assert_eq!(of_machine(meminfo), Some(1024 * 1024));
        assert_eq!(of_machine("nothing"), None);
        let limits = "Limit    Soft Limit  Hard Limit Units\nMax address space     4096000000    unlimited bytes\n";
        assert_eq!(limit(limits), Some(4_096_000_000));
        assert_eq!(limit("Max address space  unlimited unlimited bytes"), None);
    }

    #[test]
    fn what_no_machine_has_is_refused_with_what_there_is() {
        assert_eq!(room_for("little", LITTLE), Ok(()));
        match (available(), room_for("a matrix", u64::MAX)) {
            (None, answer) => assert_eq!(answer, Ok(())),
            (Some(_), answer) => {
                let told = answer.unwrap_err().to_string();
                assert!(
                    told.starts_with("out of memory: a matrix needs 18446744073.710 GB"),
                    "{told}"
                );
            }
        }
    }
}
