//! A process that lets another one try inputs, so that no effect of an input ends the search.

use std::{
    env, fs,
    fs::{File, OpenOptions},
    path::PathBuf,
    process::{Child, Command, ExitCode, Stdio},
    thread::sleep,
    time::{Duration, Instant},
};

use crate::{WORK, input::Inputs, number, target::Target};

/// Longest time of an input on the processor: on a busy machine others have it meanwhile.
const LONGEST: Duration = Duration::from_secs(5);

/// Largest memory of a process, in bytes.
const MOST_MEMORY: u64 = 1 << 30;

/// Number of inputs after which a process is ended, so that memory that inputs leave behind is seen as that of one.
const INPUTS_PER_PROCESS: u64 = 1 << 40;

pub struct Supervisor {
    target: &'static Target,
    seed: u64,
    inputs: Inputs,
    /// The file in which the process writes the number of its input.
    progress: PathBuf,
    /// The folder of harmful inputs.
    found: PathBuf,
}

impl Supervisor {
    pub fn new(target: &'static Target, seed: u64) -> Result<Self, String> {
        let name = format!("tabletop_fuzz_{}_{}", target.name, std::process::id());
        let found = PathBuf::from("fuzz/found");
        fs::create_dir_all(&found).map_err(|error| format!("fuzz/found: {error}"))?;
        Ok(Self {
            target,
            seed,
            inputs: Inputs::of(target, seed)?,
            progress: env::temp_dir().join(name),
            found,
        })
    }

    /// Tries inputs until the time is over, and prints their number. Returns the number of harmful ones.
    pub fn run(&self, limit: Duration) -> Result<usize, String> {
        let end = Instant::now() + limit;
        let (mut first, mut found) = (0, 0);
        loop {
            let mut child = self.start(first)?;
            let harm = self.watch(&mut child, first, end);
            let now = self.tried(first);
            let Some(harm) = harm else {
                println!(
                    "{}: seed {}: {now} inputs, {found} found",
                    self.target.name, self.seed
                );
                let _gone = fs::remove_file(&self.progress);
                return Ok(found);
            };
            found += 1;
            self.keep(now, &harm)?;
            first = now + 1;
        }
    }

    fn start(&self, first: u64) -> Result<Child, String> {
        fs::write(&self.progress, first.to_le_bytes()).map_err(|error| error.to_string())?;
        let program = env::current_exe().map_err(|error| error.to_string())?;
        let errors = File::create(self.progress.with_extension("err"));
        Command::new(program)
            .args([WORK, self.target.name])
            .args([self.seed, first, INPUTS_PER_PROCESS].map(|number| number.to_string()))
            .arg(&self.progress)
            .stderr(errors.map_err(|error| error.to_string())?)
            .stdout(Stdio::null())
            .spawn()
            .map_err(|error| error.to_string())
    }

    /// Waits until an input does harm, and returns how, or until the time is over.
    fn watch(&self, child: &mut Child, first: u64, end: Instant) -> Option<String> {
        let mut at = (first, processor_time(child.id()));
        let harm = loop {
            sleep(Duration::from_millis(200));
            match child.try_wait() {
                Ok(Some(status)) => break Some(format!("the process ended: {status}")),
                Ok(None) => {}
                Err(error) => break Some(error.to_string()),
            }
            let now = self.tried(first);
            let spent = processor_time(child.id());
            if now != at.0 {
                at = (now, spent);
            }
            if spent.saturating_sub(at.1) > LONGEST {
                break Some(format!("it takes more than {} s", LONGEST.as_secs()));
            }
            if memory(child.id()) > MOST_MEMORY {
                break Some(format!("it takes more than {MOST_MEMORY} bytes"));
            }
            if Instant::now() > end {
                break None;
            }
        };
        let _ended = child.kill().and_then(|()| child.wait());
        harm
    }

    /// The number of the input that is being tried.
    fn tried(&self, first: u64) -> u64 {
        let bytes = fs::read(&self.progress).ok();
        bytes
            .and_then(|bytes| bytes.try_into().ok())
            .map_or(first, u64::from_le_bytes)
    }

    fn keep(&self, input: u64, harm: &str) -> Result<(), String> {
        let name = format!("{}-{}-{input}", self.target.name, self.seed);
        let path = self.found.join(&name);
        fs::write(&path, self.inputs.input(input)).map_err(|error| error.to_string())?;
        let said = fs::read_to_string(self.progress.with_extension("err")).unwrap_or_default();
        let said: Vec<_> = said.lines().take(3).collect();
        println!("{}: {harm}: {}", path.display(), said.join(" | "));
        Ok(())
    }
}

/// Tries inputs, and writes the number of each before it.
pub fn work(target: &str, numbers: [&str; 3], progress: &str) -> Result<ExitCode, String> {
    let target = Target::named(target)?;
    let [seed, first, count] = numbers;
    let (seed, first, count): (u64, u64, u64) = (number(seed)?, number(first)?, number(count)?);
    let inputs = Inputs::of(target, seed)?;
    let progress = OpenOptions::new().write(true).open(progress);
    let progress = progress.map_err(|error| error.to_string())?;
    let mut attempt = (target.start)();
    for input in first..first.saturating_add(count) {
        write_at_start(&progress, input).map_err(|error| error.to_string())?;
        attempt(&inputs.input(input));
    }
    Ok(ExitCode::SUCCESS)
}

#[cfg(unix)]
fn write_at_start(file: &File, number: u64) -> std::io::Result<()> {
    use std::os::unix::fs::FileExt as _;
    file.write_all_at(&number.to_le_bytes(), 0)
}

#[cfg(not(unix))]
fn write_at_start(mut file: &File, number: u64) -> std::io::Result<()> {
    use std::io::{Seek as _, Write as _};
    file.rewind()?;
    file.write_all(&number.to_le_bytes())
}

/// The time that a process has had the processor, where it can be measured.
fn processor_time(process: u32) -> Duration {
    const TICKS_PER_SECOND: f64 = 100.0;
    let text = fs::read_to_string(format!("/proc/{process}/stat")).unwrap_or_default();
    // The name of the program, which comes before, may have blanks.
    let fields = text.rsplit(')').next().unwrap_or_default();
    let ticks = fields.split_whitespace().skip(11).take(2);
    let ticks: f64 = ticks.filter_map(|ticks| ticks.parse::<f64>().ok()).sum();
    Duration::from_secs_f64(ticks / TICKS_PER_SECOND)
}

/// The memory of a process, in bytes, where it can be measured.
fn memory(process: u32) -> u64 {
    let text = fs::read_to_string(format!("/proc/{process}/statm")).unwrap_or_default();
    let pages = text.split(' ').nth(1).and_then(|pages| pages.parse().ok());
    pages.unwrap_or(0_u64) * 4096
}
