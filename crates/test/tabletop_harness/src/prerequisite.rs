//! The tools that tests need.

use std::{
    env,
    ffi::OsStr,
    fmt, fs,
    path::Path,
    process::{self, Command, Stdio},
};

/// Something that tests need and not every machine has.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Prerequisite {
    /// GNU Octave, as `octave-cli`.
    Octave,
    /// Python 3, as `python3`.
    Python,
    /// The client of openpi's policies, for `python3`: `openpi-client` of PyPI, and `typing-extensions`, which it does not name.
    OpenpiClient,
    /// The client library and the master of ROS 1, for the system's own Python: Debian's `python3-rospy` and `python3-rosmaster`.
    Rospy,
    /// Perl, as `perl`.
    Perl,
    /// The validator `xmllint` of libxml2.
    Xmllint,
    /// strace, and the right to trace, which Linux has.
    Strace,
    /// The right to mount a disk in memory, which the root user of Linux has.
    Mounting,
}

impl Prerequisite {
    /// True if this machine has it.
    pub fn is_met(self) -> bool {
        match self {
            Self::Octave => succeeds("octave-cli", ["--version"]),
            Self::Python => succeeds("python3", ["--version"]),
            Self::OpenpiClient => succeeds(
                "python3",
                ["-c", "import openpi_client.websocket_client_policy"],
            ),
            Self::Rospy => succeeds(
                "/usr/bin/python3",
                [
                    "-c",
                    "import genpy.dynamic, rosmaster.master, rospy, sensor_msgs.msg",
                ],
            ),
            Self::Perl => succeeds("perl", ["-v"]),
            Self::Xmllint => succeeds("xmllint", ["--version"]),
            Self::Strace => succeeds("strace", ["-f", "-qq", "--seccomp-bpf", "true"]),
            Self::Mounting => mounts(),
        }
    }

    /// True if it does not wait for a test that others hold up: a robot's watchdog takes silence for a fault.
    pub fn is_in_real_time(self) -> bool {
        match self {
            Self::Rospy => true,
            Self::Octave
            | Self::Python
            | Self::OpenpiClient
            | Self::Perl
            | Self::Xmllint
            | Self::Strace
            | Self::Mounting => false,
        }
    }
}

impl fmt::Display for Prerequisite {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Octave => "GNU Octave (octave-cli)",
            Self::Python => "Python 3 (python3)",
            Self::OpenpiClient => "openpi's client (pip install openpi-client typing-extensions)",
            Self::Rospy => "ROS 1 (python3-rospy, python3-rosmaster, python3-sensor-msgs)",
            Self::Perl => "Perl (perl)",
            Self::Xmllint => "xmllint",
            Self::Strace => "strace",
            Self::Mounting => "the right to mount a disk",
        })
    }
}

fn succeeds(program: &str, arguments: impl IntoIterator<Item: AsRef<OsStr>>) -> bool {
    let mut command = Command::new(program);
    command.args(arguments).stdin(Stdio::null());
    command.output().is_ok_and(|output| output.status.success())
}

fn mounts() -> bool {
    let disk = env::temp_dir().join(format!("tabletop-disk-{}", process::id()));
    let is_mounted = fs::create_dir(&disk).is_ok() && mount(&disk);
    if is_mounted {
        succeeds("umount", [&disk]);
    }
    drop(fs::remove_dir(&disk));
    is_mounted
}

fn mount(disk: &Path) -> bool {
    let arguments = ["-t", "tmpfs", "-o", "size=64k", "tmpfs"].map(OsStr::new);
    succeeds("mount", arguments.into_iter().chain([disk.as_os_str()]))
}
