//! Files are replaced whole or stay, and only leftovers of the program's own are removed.
#![expect(clippy::unwrap_used, reason = "a test may panic")]

use std::{
    fs::{self, File},
    path::{Path, PathBuf},
    process,
};

use tabletop_storage::{
    LockedFolder, Patience, Storage, StorageFault, TemporaryFolder, WriterLock,
};

struct Place(PathBuf);

impl Place {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("tabletop_storage_{name}_{}", process::id()));
        fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    fn join(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }

    fn names(&self) -> Vec<String> {
        let entries = fs::read_dir(&self.0).unwrap();
        let mut names: Vec<_> = entries
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        names
    }
}

impl Drop for Place {
    fn drop(&mut self) {
        let _already_gone = fs::remove_dir_all(&self.0);
    }
}

/// Writes with every call failing in every way in turn, and checks that the old text or the new one is there.
fn survives_every_fault(name: &str, old: Option<&str>, write: fn(&Storage, &Path) -> bool) {
    let mut calls = 0;
    let counted = Storage::default();
    let place = Place::new(&format!("{name}_counted"));
    prepare(&place, old);
    assert!(write(&counted, &place.join("file")));
    assert!(counted.calls() > 3);
    for call in 0..counted.calls() {
        for fault in StorageFault::ALL {
            let place = Place::new(&format!("{name}_{call}_{fault:?}"));
            prepare(&place, old);
            let file = place.join("file");
            let is_written = write(&Storage::with_fault(fault, call), &file);
            let there = fs::read_to_string(&file).ok();
            let expected = if is_written { Some("new") } else { old };
            assert_eq!(there.as_deref(), expected, "{fault:?} at call {call}");
            // A hidden file that stays beside a new one is no failure.
            let is_last = old.is_none() && call + 1 == counted.calls();
            assert!(
                !is_written || is_last,
                "{fault:?} at call {call} was silent"
            );
            calls += 1;
        }
    }
    assert!(calls >= 20);
}

fn prepare(place: &Place, old: Option<&str>) {
    if let Some(old) = old {
        fs::write(place.join("file"), old).unwrap();
    }
    fs::write(place.join("file.part"), "another file").unwrap();
}

#[test]
fn a_file_is_replaced_whole_or_stays() {
    survives_every_fault("replaced", Some("old"), |storage, path| {
        storage.replace(path, b"new").is_ok()
    });
    survives_every_fault("made", None, |storage, path| {
        storage.write_new(path, b"new").is_ok()
    });
}

#[test]
fn nothing_else_is_touched_and_nothing_is_left() {
    let place = Place::new("beside");
    prepare(&place, Some("old"));
    let storage = Storage::default();
    storage.check_replaceable(&place.join("file")).unwrap();
    storage.check_replaceable(&place.join("new")).unwrap();
    storage.replace(&place.join("file"), b"new").unwrap();
    let error = storage
        .write_new(&place.join("file"), b"newer")
        .unwrap_err();
    assert_eq!(error.kind(), std::io::ErrorKind::AlreadyExists);
    assert!(storage.replace(&place.0, b"new").is_err(), "a folder");
    assert_eq!(place.names(), ["file", "file.part"]);
    let text = |name| fs::read_to_string(place.join(name)).unwrap();
    assert_eq!([text("file"), text("file.part")], ["new", "another file"]);
}

#[cfg(unix)]
#[test]
fn a_link_leads_to_the_file_that_is_replaced_and_a_pipe_is_written_to() {
    use std::{io::Read as _, os::unix::fs::PermissionsExt as _, process::Command, thread};
    let place = Place::new("links");
    let storage = Storage::default();
    let [file, link, pipe] = ["file", "link", "pipe"].map(|name| place.join(name));
    fs::write(&file, "old").unwrap();
    fs::set_permissions(&file, fs::Permissions::from_mode(0o640)).unwrap();
    std::os::unix::fs::symlink(&file, &link).unwrap();
    storage.replace(&link, b"new").unwrap();
    assert!(link.is_symlink());
    assert_eq!(fs::read_to_string(&file).unwrap(), "new");
    let mode = fs::metadata(&file).unwrap().permissions().mode();
    assert_eq!(mode & 0o777, 0o640);
    storage.replace_name(&link, b"newer").unwrap();
    assert!(!link.is_symlink());
    assert_eq!(fs::read_to_string(&file).unwrap(), "new");

    assert!(
        Command::new("mkfifo")
            .arg(&pipe)
            .status()
            .unwrap()
            .success()
    );
    let reading = thread::spawn({
        let pipe = pipe.clone();
        move || {
            let mut text = String::new();
            File::open(pipe).unwrap().read_to_string(&mut text).unwrap();
            text
        }
    });
    storage.check_replaceable(&pipe).unwrap();
    storage.replace(&pipe, b"through").unwrap();
    assert_eq!(reading.join().unwrap(), "through");
}

#[cfg(unix)]
#[test]
fn a_file_knows_whether_it_is_still_in_its_place() {
    let place = Place::new("in_place");
    let storage = Storage::default();
    let path = place.join("file");
    let file = storage.create(&path).unwrap();
    assert!(file.is_at(&path).unwrap());
    fs::rename(&path, place.join("moved")).unwrap();
    assert!(!file.is_at(&path).unwrap());
    fs::write(&path, "another").unwrap();
    assert!(!file.is_at(&path).unwrap());
    assert!(file.is_at(&place.join("moved")).unwrap());
}

#[test]
fn only_abandoned_folders_of_the_program_are_removed() {
    let place = Place::new("locked");
    let storage = Storage::default();
    let left = LockedFolder::create(&place.0, "kind-", &storage).unwrap();
    let left_at = left.path().to_owned();
    fs::write(left_at.join("file"), "content").unwrap();
    drop(left);
    for name in ["kind-1", "kind-x", "other-1"] {
        fs::create_dir(place.join(name)).unwrap();
        fs::write(place.join(name).join("file"), "mine").unwrap();
    }
    let first = LockedFolder::create(&place.0, "kind-", &storage).unwrap();
    let second = LockedFolder::create(&place.0, "kind-", &storage).unwrap();
    assert_ne!(first.path(), second.path());
    assert!(first.path().exists(), "its program runs");
    assert!(!left_at.join("file").exists(), "its program does not run");
    assert!(
        place.join("kind-1/file").exists(),
        "no lock says whose it is"
    );
    assert_eq!(place.names().len(), 5);
    let path = first.unlock().unwrap();
    assert_eq!(fs::read_dir(path).unwrap().count(), 0);
    second.remove().unwrap();
    assert_eq!(place.names().len(), 4);
}

#[test]
fn folders_that_begin_at_the_same_time_keep_their_contents() {
    let place = Place::new("locked_at_once");
    let fill = || {
        for _ in 0..300 {
            let storage = Storage::default();
            let folder = LockedFolder::create(&place.0, "new-", &storage).unwrap();
            let content = folder.path().join("content");
            fs::write(&content, "").unwrap();
            std::thread::yield_now();
            assert!(content.exists());
            folder.remove().unwrap();
        }
    };
    std::thread::scope(|scope| {
        for _ in 0..4 {
            scope.spawn(fill);
        }
    });
}

#[test]
fn a_folder_is_copied_without_what_is_hidden_and_links_are_refused() {
    let place = Place::new("copied");
    let (from, to) = (place.join("from"), place.join("to"));
    fs::create_dir_all(from.join("inner")).unwrap();
    fs::write(from.join("inner/file"), "content").unwrap();
    fs::write(from.join(".hidden"), "").unwrap();
    let storage = Storage::default();
    storage.copy_folder(&from, &to).unwrap();
    assert_eq!(fs::read(to.join("inner/file")).unwrap(), b"content");
    assert!(!to.join(".hidden").exists());
    assert!(
        storage.copy_folder(&from, &to).is_err(),
        "something is there"
    );
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink("/etc", from.join("link")).unwrap();
        let error = storage.copy_folder(&from, &place.join("other"));
        let error = error.unwrap_err().to_string();
        assert!(error.contains("link"), "{error}");
    }
}

#[test]
fn a_temporary_folder_goes_with_its_owner() {
    let folder = TemporaryFolder::new("tabletop-test-temporary").unwrap();
    let path = folder.path().to_owned();
    fs::write(path.join("file"), "content").unwrap();
    drop(folder);
    assert!(!path.exists());
}

#[test]
fn a_name_is_given_to_one_new_file_only() {
    let place = Place::new("raced");
    for round in 0..200 {
        let file = place.join(&format!("file-{round}"));
        let write = |text: &str| {
            let written = Storage::default().write_new(&file, text.repeat(1000).as_bytes());
            written.is_ok().then(|| text.repeat(1000))
        };
        let written: Vec<_> = std::thread::scope(|scope| {
            let writers = ["a", "b", "c"].map(|text| scope.spawn(move || write(text)));
            let written = writers.into_iter().filter_map(|it| it.join().unwrap());
            written.collect()
        });
        assert_eq!(written, [fs::read_to_string(&file).unwrap()]);
    }
    assert_eq!(place.names().len(), 200);
}

#[test]
fn one_writer_at_a_time_has_a_place() {
    let place = Place::new("writers");
    let storage = Storage::default().with_patience(Patience::None);
    let first = WriterLock::of_folder(&place.0, &storage).unwrap();
    let writer = WriterLock::writer_in(&place.0, &storage)
        .unwrap()
        .to_string();
    let reason = format!(": process {} writes there since 2", process::id());
    assert!(writer.contains(&reason), "{writer}");
    let error = WriterLock::of_folder(&place.0, &storage).unwrap_err();
    assert_eq!(error.kind(), std::io::ErrorKind::ResourceBusy);
    assert!(error.to_string().contains(&writer), "{error}");
    // Another place is another's.
    let file = place.join("file");
    drop(WriterLock::of_place(&file, &storage).unwrap());
    drop(first);
    assert!(place.names().is_empty());
    assert_eq!(WriterLock::writer_in(&place.0, &storage), None);

    // What a killed program has left is nobody's.
    fs::write(place.join(".tabletop-writer"), "1 1").unwrap();
    assert_eq!(WriterLock::writer_in(&place.0, &storage), None);
    drop(WriterLock::of_folder(&place.0, &storage).unwrap());
    assert!(place.names().is_empty());
}

#[test]
fn writers_wait_for_each_other() {
    let place = Place::new("waiting");
    let (folder, count) = (place.join("folder"), place.join("count"));
    fs::create_dir(&folder).unwrap();
    fs::write(&count, "0").unwrap();
    let add = || {
        for _ in 0..100 {
            let storage = Storage::default().with_patience(Patience::Wait(|_| {}));
            let _alone = WriterLock::of_folder(&folder, &storage).unwrap();
            let number: u32 = fs::read_to_string(&count).unwrap().parse().unwrap();
            std::thread::yield_now();
            fs::write(&count, (number + 1).to_string()).unwrap();
        }
    };
    std::thread::scope(|scope| {
        for _ in 0..4 {
            scope.spawn(add);
        }
    });
    assert_eq!(fs::read_to_string(&count).unwrap(), "400");
    assert_eq!(fs::read_dir(folder).unwrap().count(), 0);
}

#[cfg(unix)]
#[test]
fn links_lead_to_one_lock_and_are_none_themselves() {
    let place = Place::new("linked_locks");
    let (file, link) = (place.join("file"), place.join("link"));
    fs::write(&file, "").unwrap();
    std::os::unix::fs::symlink(&file, &link).unwrap();
    let storage = Storage::default().with_patience(Patience::None);
    let _first = WriterLock::of_place(&file, &storage).unwrap();
    WriterLock::of_place(&link, &storage).unwrap_err();

    let folder = place.join("folder");
    fs::create_dir(&folder).unwrap();
    fs::write(&file, "mine").unwrap();
    std::os::unix::fs::symlink(&file, folder.join(".tabletop-writer")).unwrap();
    WriterLock::of_folder(&folder, &storage).unwrap_err();
    assert_eq!(fs::read_to_string(&file).unwrap(), "mine");
}
