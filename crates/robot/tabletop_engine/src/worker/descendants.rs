//! The processes that an engine has started, also those that have left its process group.
//!
//! A process says by its environment, which it has from its parent, whose it is. On Linux this program takes in the orphans among
//! its descendants (as a child subreaper), so that those without that environment are found as well.

use std::path::Path;

/// The variable by which the processes of an engine are known: its value is the engine's folder.
pub(crate) const FOLDER_VARIABLE: &str = "TABLETOP_ENGINE_FOLDER";

/// The processes that come of one engine.
#[derive(Debug)]
pub(crate) struct Descendants {
    #[cfg(target_os = "linux")]
    entry: Vec<u8>,
    /// The engine's process, which is also the number of its group.
    #[cfg(target_os = "linux")]
    engine: i32,
}

#[cfg(not(target_os = "linux"))]
impl Descendants {
    pub(crate) fn of(_engine: u32, _folder: &Path) -> Self {
        Self {}
    }

    pub(crate) fn reap(&self) {}

    pub(crate) fn kill(&self) {}
}

#[cfg(target_os = "linux")]
mod linux {
    use std::{
        fs, process,
        sync::{Mutex, PoisonError},
        thread,
        time::Duration,
    };

    use nix::{
        sys::{
            prctl::set_child_subreaper,
            signal::{Signal, kill},
            wait::{WaitPidFlag, waitpid},
        },
        unistd::Pid,
    };

    use super::{Descendants, FOLDER_VARIABLE, Path};

    /// The number of searches for processes: killed ones may just have started others.
    const ROUNDS: usize = 50;
    const PAUSE: Duration = Duration::from_millis(2);

    /// The engines of this program that have not ended.
    static ENGINES: Mutex<Vec<i32>> = Mutex::new(Vec::new());

    impl Descendants {
        /// Those of an engine that has just been started with this folder in its environment.
        pub(crate) fn of(engine: u32, folder: &Path) -> Self {
            // Without this, orphans are found by their environment alone.
            let _ = set_child_subreaper(true);
            let engine = engine.cast_signed();
            with_engines(|engines| engines.push(engine));
            let entry = format!("{FOLDER_VARIABLE}={}", folder.display()).into_bytes();
            Self { entry, engine }
        }

        /// Takes leave of orphans that have ended.
        pub(crate) fn reap(&self) {
            let own = Status::of(process::id().cast_signed());
            for status in own.iter().flat_map(|own| adopted(own, self.engine)) {
                if status.is_zombie {
                    let _ = waitpid(Pid::from_raw(status.pid), Some(WaitPidFlag::WNOHANG));
                }
            }
        }

        /// Ends them all.
        pub(crate) fn kill(&self) {
            for _ in 0..ROUNDS {
                let mut is_done = true;
                for pid in self.living() {
                    is_done = false;
                    // It may have ended since.
                    let _ = kill(Pid::from_raw(pid), Signal::SIGKILL);
                }
                if is_done {
                    break;
                }
                thread::sleep(PAUSE);
            }
            self.reap();
        }

        fn living(&self) -> Vec<i32> {
            let Some(own) = Status::of(process::id().cast_signed()) else {
                return Vec::new();
            };
            // The engine of an orphan without that environment is known only if there is one engine.
            let is_only = with_engines(|engines| engines.iter().all(|other| *other == self.engine));
            let adopted: Vec<_> = match is_only {
                true => adopted(&own, self.engine).map(|it| it.pid).collect(),
                false => Vec::new(),
            };
            let statuses = processes().filter_map(Status::of);
            statuses
                .filter(|status| !status.is_zombie && status.pid != own.pid)
                .map(|status| status.pid)
                .filter(|pid| adopted.contains(pid) || self.is_marked(*pid))
                .collect()
        }

        fn is_marked(&self, pid: i32) -> bool {
            let environment = fs::read(format!("/proc/{pid}/environ")).unwrap_or_default();
            environment
                .split(|byte| *byte == 0)
                .any(|entry| entry == self.entry)
        }
    }

    impl Drop for Descendants {
        fn drop(&mut self) {
            with_engines(|engines| engines.retain(|engine| *engine != self.engine));
        }
    }

    fn with_engines<T>(act: impl FnOnce(&mut Vec<i32>) -> T) -> T {
        act(&mut ENGINES.lock().unwrap_or_else(PoisonError::into_inner))
    }

    /// The children of this program that it has not started itself: those in the engine's group, and those in sessions of their
    /// own, as this program starts none.
    fn adopted(own: &Status, engine: i32) -> impl Iterator<Item = Status> {
        let (pid, session) = (own.pid, own.session);
        children()
            .into_iter()
            .filter_map(Status::of)
            .filter(move |status| status.parent == pid && status.pid != engine)
            .filter(move |status| status.group == engine || status.session != session)
    }

    /// The children of this program; of a system that does not list them, all processes.
    fn children() -> Vec<i32> {
        let threads = fs::read_dir("/proc/self/task")
            .into_iter()
            .flatten()
            .flatten();
        let lists = threads.map(|thread| fs::read_to_string(thread.path().join("children")));
        let lists: Vec<_> = lists.flatten().collect();
        match lists.is_empty() {
            true => processes().collect(),
            false => {
                let words = lists.iter().flat_map(|list| list.split_whitespace());
                words.filter_map(|word| word.parse().ok()).collect()
            }
        }
    }

    fn processes() -> impl Iterator<Item = i32> {
        let entries = fs::read_dir("/proc").into_iter().flatten().flatten();
        entries.filter_map(|entry| entry.file_name().to_str()?.parse().ok())
    }

    /// The system's entry of a process.
    struct Status {
        pid: i32,
        is_zombie: bool,
        parent: i32,
        group: i32,
        session: i32,
    }

    impl Status {
        fn of(pid: i32) -> Option<Self> {
            let text = fs::read(format!("/proc/{pid}/stat")).ok()?;
            let text = String::from_utf8_lossy(&text);
            // The program's name, in parentheses, may hold anything.
            let mut fields = text.rsplit_once(')')?.1.split_whitespace();
            let is_zombie = matches!(fields.next()?, "Z" | "X");
            let mut number = || fields.next()?.parse().ok();
            Some(Self {
                pid,
                is_zombie,
                parent: number()?,
                group: number()?,
                session: number()?,
            })
        }
    }
}
