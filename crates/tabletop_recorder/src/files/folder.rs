//! Where the files of a recording are.

use std::{
    fs, io,
    path::{Path, PathBuf},
};

use crate::{error::RecorderError, files::log_file::is_locked};

/// The folder of a recording.
#[derive(Clone, Debug)]
pub(crate) struct Folder(PathBuf);

impl Folder {
    /// Makes the folder, and has it filled. One that is there already is moved aside to the same name with the first free number
    /// appended, unless a program is recording into it. If anything fails, all is as before.
    pub(crate) fn create<T>(
        path: &Path,
        fill: impl FnOnce(Self) -> Result<T, RecorderError>,
    ) -> Result<T, RecorderError> {
        let folder = Self(path.to_owned());
        let aside = match is_taken(path) {
            true => Some(folder.clear_the_way()?),
            false => None,
        };
        let made = folder.make();
        let is_made = made.is_ok();
        let filled = made.and_then(|()| fill(folder.clone()));
        if filled.is_err() {
            // What has failed is told; more cannot be done.
            if is_made {
                let _ = folder.remove();
            }
            if let Some(aside) = aside {
                let _ = fs::rename(aside, path);
            }
        }
        filled
    }

    /// Moves what is there aside. Its new place is returned.
    fn clear_the_way(&self) -> Result<PathBuf, RecorderError> {
        let folder = self.0.clone();
        if !self.0.is_dir() {
            return Err(RecorderError::NoFolder { path: folder });
        }
        match is_locked(&self.session()) {
            true => Err(RecorderError::InUse { folder }),
            false => move_aside(&self.0),
        }
    }

    /// Makes the folder, unless somebody else has just done that.
    fn make(&self) -> Result<(), RecorderError> {
        let parent = self.0.parent().filter(|parent| *parent != Path::new(""));
        let made = parent.map_or(Ok(()), fs::create_dir_all);
        made.and_then(|()| fs::create_dir(&self.0))
            .map_err(RecorderError::create(&self.0))
    }

    pub(crate) fn existing(path: &Path) -> Self {
        Self(path.to_owned())
    }

    pub(crate) fn path(&self) -> &Path {
        &self.0
    }

    pub(crate) fn session(&self) -> PathBuf {
        self.0.join("session.jsonl")
    }

    pub(crate) fn states(&self) -> PathBuf {
        self.0.join("states.csv")
    }

    pub(crate) fn joints(&self) -> PathBuf {
        self.0.join("joints.csv")
    }

    pub(crate) fn text(&self, segment: u32) -> PathBuf {
        self.0.join(format!("{segment}.txt"))
    }

    pub(crate) fn pictures(&self, segment: u32) -> PathBuf {
        self.0.join(segment.to_string())
    }

    pub(crate) fn picture(&self, segment: u32, frame: u64) -> PathBuf {
        self.pictures(segment).join(format!("{frame}.png"))
    }

    /// A picture's channel, `depth` or `ids`.
    pub(crate) fn channel(&self, segment: u32, frame: u64, name: &str) -> PathBuf {
        self.pictures(segment).join(format!("{frame}.{name}.png"))
    }

    /// What was undone and can be redone.
    pub(crate) fn undone(&self) -> Self {
        Self(self.0.join(".undone"))
    }

    /// What was undone with a segment.
    pub(crate) fn undone_segment(&self, segment: u32) -> Self {
        Self(self.undone().pictures(segment))
    }

    /// Moves text and pictures of a segment to another folder.
    pub(crate) fn move_segment(&self, segment: u32, to: &Self) -> Result<(), RecorderError> {
        for (from, to) in [
            (self.text(segment), to.text(segment)),
            (self.pictures(segment), to.pictures(segment)),
        ] {
            fs::rename(&from, &to).map_err(RecorderError::write(&from))?;
        }
        Ok(())
    }

    /// Removes the pictures of a segment, and their channels, from this frame on.
    pub(crate) fn remove_pictures(&self, segment: u32, first: u64) -> Result<(), RecorderError> {
        for (frame, path) in self.pictured_frames(segment)? {
            if frame >= first {
                fs::remove_file(&path).map_err(RecorderError::write(&path))?;
            }
        }
        Ok(())
    }

    /// The frames of a segment that are in pictures or their channels, each with the file.
    pub(crate) fn pictured_frames(
        &self,
        segment: u32,
    ) -> Result<Vec<(u64, PathBuf)>, RecorderError> {
        let folder = self.pictures(segment);
        let mut frames = Vec::new();
        if !folder.exists() {
            return Ok(frames);
        }
        for entry in fs::read_dir(&folder).map_err(RecorderError::read(&folder))? {
            let path = entry.map_err(RecorderError::read(&folder))?.path();
            let name = path.file_name().and_then(|name| name.to_str());
            let frame = name.and_then(|name| name.split('.').next()?.parse().ok());
            frames.extend(frame.map(|frame| (frame, path)));
        }
        Ok(frames)
    }

    /// Removes the folder, if there is one.
    pub(crate) fn remove(&self) -> Result<(), RecorderError> {
        match fs::remove_dir_all(&self.0) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => {
                Err(RecorderError::write(&self.0)(error))
            }
            _ => Ok(()),
        }
    }
}

pub(crate) fn create_folder(path: &Path) -> Result<(), RecorderError> {
    fs::create_dir_all(path).map_err(RecorderError::create(path))
}

/// Moves a folder to a name that is free, which is returned.
fn move_aside(path: &Path) -> Result<PathBuf, RecorderError> {
    let aside = first_free_name(path);
    match fs::rename(path, &aside) {
        Ok(()) => Ok(aside),
        Err(source) => Err(RecorderError::MoveAside {
            folder: path.to_owned(),
            aside,
            source,
        }),
    }
}

fn first_free_name(path: &Path) -> PathBuf {
    let numbered = |number: u32| {
        let mut name = path.components().as_path().as_os_str().to_owned();
        name.push(format!("-{number}"));
        PathBuf::from(name)
    };
    let mut number = 1;
    while is_taken(&numbered(number)) {
        number += 1;
    }
    numbered(number)
}

fn is_taken(path: &Path) -> bool {
    path.symlink_metadata().is_ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    #[cfg(unix)]
    use crate::files::log_file::LogFile;

    #[test]
    fn earlier_recordings_are_moved_aside_to_the_first_free_number() {
        let parent = std::env::temp_dir().join(format!("tabletop_folder_{}", std::process::id()));
        let demo = parent.join("demo/");
        for content in ["first", "second", "third"] {
            Folder::create(&demo, |folder| {
                fs::write(folder.path().join("content"), content).unwrap();
                Ok(())
            })
            .unwrap();
        }
        let failed = |_| Err::<(), _>(RecorderError::write(&demo)(io::Error::other("full")));
        Folder::create(&demo, failed).unwrap_err();
        for (folder, content) in [("demo", "third"), ("demo-1", "first"), ("demo-2", "second")] {
            let path = parent.join(folder).join("content");
            assert_eq!(fs::read_to_string(path).unwrap(), content);
        }
        fs::remove_dir_all(parent).unwrap();
    }

    #[cfg(unix)]
    #[test]
    fn what_is_being_recorded_and_what_is_no_recording_stays_where_it_is() {
        let demo = std::env::temp_dir().join(format!("tabletop_locked_{}", std::process::id()));
        let begin = || {
            Folder::create(&demo, |folder| {
                let session = LogFile::create(folder.session())?;
                session.lock();
                Ok(session)
            })
        };
        let session = begin().unwrap();
        let error = begin().unwrap_err().to_string();
        assert!(error.starts_with("a recording is being made in"), "{error}");
        drop(session);
        drop(begin().unwrap());
        let file = demo.join("session.jsonl");
        let error = Folder::create(&file, Ok).unwrap_err().to_string();
        assert!(
            error.ends_with("is a file; record into a folder"),
            "{error}"
        );
        assert!(file.exists());
        for folder in [demo.clone(), PathBuf::from(format!("{}-1", demo.display()))] {
            fs::remove_dir_all(folder).unwrap();
        }
    }

    #[test]
    fn a_folder_that_cannot_be_made_is_named() {
        let error = Folder::create(Path::new("/dev/null/demo"), Ok).unwrap_err();
        assert!(error.to_string().contains("/dev/null/demo"), "{error}");
    }
}
