//! Judgements in files of lines of JSON: the header, then an episode a line as soon as it is over, so that a killed run goes on where it ended.

use std::{
    io,
    path::{Path, PathBuf},
};

use tabletop_storage::{Storage, StoredFile, Symlinks, WriterLock, is_taken, read_regular_text};

use super::{
    JudgedEpisode,
    judgement::{JudgementHeader, PolicyJudgement, episode_line, header_line},
};

/// The most bytes of a file that are read.
const MOST_BYTES: u64 = 1 << 28;

/// Why a judgement cannot be read or written.
#[derive(Debug, thiserror::Error)]
pub enum JudgementError {
    /// The file makes no sense, or belongs to something else.
    #[error("{}: {fault}", .path.display())]
    Fault {
        /// The file.
        path: PathBuf,
        /// Where and what.
        fault: String,
    },
    /// The system refuses.
    #[error("{}: {source}", .path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
}

impl JudgementError {
    fn io(path: &Path) -> impl FnOnce(io::Error) -> Self {
        |source| Self::Io {
            path: path.to_owned(),
            source,
        }
    }

    fn fault(path: &Path) -> impl FnOnce(String) -> Self {
        |fault| Self::Fault {
            path: path.to_owned(),
            fault,
        }
    }
}

impl PolicyJudgement {
    /// Reads the judgement in a file. A last line without an end, which a killed run may have left, is left out.
    ///
    /// # Errors
    /// It cannot be read, or is none of this version of the benchmark.
    pub fn read(path: &Path) -> Result<Self, JudgementError> {
        let (judgement, _) = read(path)?;
        judgement.ok_or_else(|| JudgementError::fault(path)("it is empty".into()))
    }

    /// The episodes of several, such as shares of a judgement, together.
    ///
    /// # Errors
    /// One cannot be read, or is of something else.
    pub fn merged(paths: &[PathBuf]) -> Result<Option<Self>, JudgementError> {
        let mut merged: Option<Self> = None;
        for path in paths {
            let next = Self::read(path)?;
            let Some(merged) = &mut merged else {
                merged = Some(next);
                continue;
            };
            let fault = JudgementError::fault(path);
            if let Some(field) = first_difference(&merged.header, &next.header) {
                let first = paths.first().map_or(Path::new(""), PathBuf::as_path);
                let fault_text = format!(
                    "its {field} is another one than that of {}",
                    first.display()
                );
                return Err(fault(fault_text));
            }
            for episode in next.episodes().values() {
                merged
                    .add(episode.clone())
                    .map_err(JudgementError::fault(path))?;
            }
        }
        Ok(merged)
    }
}

/// The judgement in a file, if that is not empty, and the length of its whole lines in bytes.
fn read(path: &Path) -> Result<(Option<PolicyJudgement>, u64), JudgementError> {
    let text = read_regular_text(path, MOST_BYTES, Symlinks::Followed);
    let text = text.map_err(JudgementError::io(path))?;
    let at = |line: usize, fault: String| {
        let path = path.to_owned();
        let fault = format!("line {line}: {fault}");
        JudgementError::Fault { path, fault }
    };
    let mut whole = 0;
    let mut judgement: Option<PolicyJudgement> = None;
    let lines = text
        .split_inclusive('\n')
        .filter(|line| line.ends_with('\n'));
    for (number, line) in (1..).zip(lines) {
        whole += line.len() as u64;
        match &mut judgement {
            None => {
                let header: JudgementHeader = serde_json::from_str(line)
                    .map_err(|error| at(number, format!("it begins no judgement: {error}")))?;
                let begun = PolicyJudgement::new(header);
                begun.check_version().map_err(|fault| at(number, fault))?;
                judgement = Some(begun);
            }
            Some(judgement) => {
                let episode: JudgedEpisode =
                    serde_json::from_str(line).map_err(|error| at(number, error.to_string()))?;
                judgement.add(episode).map_err(|fault| at(number, fault))?;
            }
        }
    }
    Ok((judgement, whole))
}

/// The field in which two headers differ.
fn first_difference(one: &JudgementHeader, other: &JudgementHeader) -> Option<&'static str> {
    let JudgementHeader {
        benchmark,
        program,
        robot,
        dynamic,
        policy,
        about,
        mapping,
        delay,
        tasks,
        perturbations,
    } = one;
    let fields = [
        ("benchmark", *benchmark == other.benchmark),
        ("program", *program == other.program),
        ("robot", *robot == other.robot),
        ("robot's mode", *dynamic == other.dynamic),
        ("policy", *policy == other.policy),
        ("server", *about == other.about),
        ("mapping", *mapping == other.mapping),
        ("delay", *delay == other.delay),
        ("list of tasks", *tasks == other.tasks),
        (
            "list of perturbations",
            *perturbations == other.perturbations,
        ),
    ];
    let differing = fields.into_iter().find(|(_, is_same)| !is_same);
    differing.map(|(field, _)| field)
}

/// A file that a judgement is written into, an episode at a time. Nobody else writes there meanwhile.
#[derive(Debug)]
pub struct JudgementFile {
    path: PathBuf,
    file: StoredFile,
    storage: Storage,
    _lock: WriterLock,
}

impl JudgementFile {
    /// Opens a file for a judgement with this header, and takes up what it holds of it.
    ///
    /// # Errors
    /// It holds something else, or cannot be written.
    pub fn open(
        path: &Path,
        header: &JudgementHeader,
        storage: &Storage,
    ) -> Result<(Self, PolicyJudgement), JudgementError> {
        let io = || JudgementError::io(path);
        let lock = WriterLock::of_place(path, storage).map_err(io())?;
        let (known, whole, file) = match is_taken(path) {
            true => {
                let (known, whole) = read(path)?;
                (known, whole, storage.open(path))
            }
            false => (None, 0, storage.create(path)),
        };
        let mut file = file.map_err(io())?;
        let is_new = known.is_none();
        let judgement = known.unwrap_or_else(|| PolicyJudgement::new(header.clone()));
        if let Some(field) = first_difference(header, &judgement.header) {
            let fault =
                format!("it holds results of which the {field} was another one; name another file");
            return Err(JudgementError::fault(path)(fault));
        }
        file.cut(whole).map_err(io())?;
        if is_new {
            file.append(header_line(header).as_bytes()).map_err(io())?;
        }
        let opened = Self {
            path: path.to_owned(),
            file,
            storage: storage.clone(),
            _lock: lock,
        };
        Ok((opened, judgement))
    }

    /// Writes an episode.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn append(&mut self, episode: &JudgedEpisode) -> Result<(), JudgementError> {
        let appended = self.file.append(episode_line(episode).as_bytes());
        appended.map_err(JudgementError::io(&self.path))
    }

    /// Ends the writing. Episodes that came in another order, as with shares one after the other, are brought into theirs.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn finish(self, judgement: &PolicyJudgement) -> Result<(), JudgementError> {
        let io = || JudgementError::io(&self.path);
        self.file.sync().map_err(io())?;
        let lines = judgement.lines();
        let is_so =
            read_regular_text(&self.path, MOST_BYTES, Symlinks::Refused).map_err(io())? == lines;
        match is_so {
            true => Ok(()),
            false => self
                .storage
                .replace(&self.path, lines.as_bytes())
                .map_err(io()),
        }
    }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use serde_json::json;
    use tabletop_storage::TemporaryFolder;

    use super::*;
    use crate::judging::{BENCHMARK_VERSION, JUDGED_TASKS, Perturbation};

    fn header(policy: &str) -> JudgementHeader {
        JudgementHeader {
            benchmark: BENCHMARK_VERSION.into(),
            program: "1".into(),
            robot: "Panda".into(),
            dynamic: false,
            policy: policy.into(),
            about: json!({"name": "a"}),
            mapping: None,
            delay: None,
            tasks: JUDGED_TASKS[..2].iter().map(Into::into).collect(),
            perturbations: Vec::new(),
        }
    }

    fn episode(number: u64, done: bool) -> JudgedEpisode {
        JudgedEpisode {
            task: JUDGED_TASKS[(number % 2) as usize].name.into(),
            episode: number / 2,
            perturbation: None,
            words: None,
            seed: number,
            beginning: format!("{number:x}"),
            done,
            steps: 1,
            steps_done: usize::from(done),
            left: (!done).then(|| "Put it there.".into()),
            failure: None,
            reason: None,
            ticks: 60,
        }
    }

    fn judge(path: &Path, numbers: impl IntoIterator<Item = u64>) -> PolicyJudgement {
        let storage = Storage::default();
        let (mut file, mut judgement) = JudgementFile::open(path, &header("a"), &storage).unwrap();
        for number in numbers {
            if !judgement.holds(number) {
                let episode = episode(number, number % 3 == 0);
                file.append(&episode).unwrap();
                judgement.add(episode).unwrap();
            }
        }
        file.finish(&judgement).unwrap();
        judgement
    }

    #[test]
    fn a_file_that_was_cut_anywhere_becomes_the_same_again() {
        let folder = TemporaryFolder::new("judgement").unwrap();
        let path = folder.path().join("a.jsonl");
        let whole = judge(&path, 0..6);
        let bytes = fs::read(&path).unwrap();
        assert_eq!(PolicyJudgement::read(&path).unwrap(), whole);
        for length in 0..bytes.len() {
            fs::write(&path, &bytes[..length]).unwrap();
            assert_eq!(judge(&path, 0..6), whole);
            assert_eq!(fs::read(&path).unwrap(), bytes, "{length}");
        }
    }

    #[test]
    fn shares_are_merged_to_the_whole() {
        let folder = TemporaryFolder::new("judgement").unwrap();
        let place = |name: &str| folder.path().join(name);
        let whole = judge(&place("whole"), 0..6);
        let shares = [place("0"), place("1")];
        judge(&shares[0], [0, 2, 4]);
        judge(&shares[1], [1, 3, 5]);
        let merged = PolicyJudgement::merged(&shares).unwrap().unwrap();
        assert_eq!(merged, whole);
        assert_eq!(merged.missing(), None);
        let one = PolicyJudgement::merged(&shares[..1]).unwrap().unwrap();
        assert_eq!(one.missing(), Some(1));
        assert_eq!(judge(&place("few"), 0..3).missing(), Some(3));
        // One after the other into the same file.
        judge(&place("same"), [1, 3, 5]);
        judge(&place("same"), [0, 2, 4]);
        assert_eq!(
            fs::read(place("same")).unwrap(),
            fs::read(place("whole")).unwrap()
        );
    }

    #[test]
    fn each_perturbation_has_a_place_beside_the_beginning_of_its_twin() {
        let header = JudgementHeader {
            perturbations: vec![Perturbation::Light, Perturbation::Words],
            ..header("a")
        };
        let mut judgement = PolicyJudgement::new(header.clone());
        for number in (0..12).rev() {
            let (task, round, perturbation) = header.episode(number).unwrap();
            let one = JudgedEpisode {
                task: task.name.clone(),
                episode: round,
                perturbation,
                done: perturbation != Some(Perturbation::Words),
                ..episode(number, true)
            };
            judgement.add(one.clone()).unwrap();
            assert_eq!(judgement.episodes()[&number], one);
        }
        assert_eq!((header.round(), judgement.missing()), (6, None));
        let twins = judgement.twins(Perturbation::Words);
        let done = |[one, other]: &[&JudgedEpisode; 2]| {
            assert_eq!((&one.task, one.episode), (&other.task, other.episode));
            [one.done, other.done]
        };
        let done: Vec<_> = twins.iter().map(done).collect();
        assert_eq!(done, [[true, false]; 4]);
        let strange = JudgedEpisode {
            perturbation: Some(Perturbation::Sizes),
            ..episode(0, true)
        };
        let refusal = judgement.add(strange).unwrap_err();
        assert!(
            refusal.contains("no task \"stack\" with \"sizes\""),
            "{refusal}"
        );
    }

    #[test]
    fn what_does_not_fit_is_named() {
        let folder = TemporaryFolder::new("judgement").unwrap();
        let path = folder.path().join("a.jsonl");
        judge(&path, 0..2);
        let storage = Storage::default();
        let refusal = JudgementFile::open(&path, &header("b"), &storage).unwrap_err();
        assert!(
            refusal
                .to_string()
                .ends_with("the policy was another one; name another file")
        );
        let text = fs::read_to_string(&path).unwrap();
        for (old, new, fault) in [
            ("\"steps\":1", "\"steps\":-1", "line 2: invalid value"),
            ("\"seed\"", "\"sed\"", "line 2: unknown field `sed`"),
            (
                "benchmark@1",
                "benchmark@2",
                "line 1: it is of \"benchmark@2\"",
            ),
            (
                "{\"benchmark\"",
                "[\"benchmark\"",
                "line 1: it begins no judgement",
            ),
            (
                "{\"task\":\"stack\"",
                "{\"task\":\"pile\"",
                "line 2: the first line has no task \"pile\"",
            ),
            (
                "\"stack-among-others\",\"episode\"",
                "\"stack\",\"episode\"",
                "line 3: stack, episode 0: it is there already",
            ),
        ] {
            assert!(text.contains(old), "{old}");
            fs::write(&path, text.replacen(old, new, 1)).unwrap();
            let refusal = PolicyJudgement::read(&path).unwrap_err().to_string();
            assert!(refusal.contains(fault), "{refusal}");
        }
        fs::write(&path, "").unwrap();
        assert!(
            PolicyJudgement::read(&path)
                .unwrap_err()
                .to_string()
                .ends_with("it is empty")
        );
    }

    #[test]
    fn two_policies_are_paired_where_they_began_alike() {
        let [mut one, mut other] = [
            PolicyJudgement::new(header("a")),
            PolicyJudgement::new(header("b")),
        ];
        one.add(episode(0, true)).unwrap();
        one.add(episode(1, true)).unwrap();
        assert_eq!(
            one.beside(&other),
            Err("it has no episode of the same tasks".into())
        );
        other.add(episode(1, false)).unwrap();
        assert_eq!(
            one.beside(&other),
            Ok(vec![[&episode(1, true), &episode(1, false)]])
        );
        other
            .add(JudgedEpisode {
                beginning: "f".into(),
                ..episode(0, true)
            })
            .unwrap();
        assert_eq!(
            one.beside(&other),
            Err("stack, episode 0: it begins otherwise".into())
        );
    }
}
