//! Datasets and pictures of a stranger: their names stay in their folder, what they say of themselves is counted, and nothing in them is
//! obeyed by a terminal.

use std::{
    fs,
    path::{Path, PathBuf},
};

use serde_json::{Value, json};

use crate::support::{files, place, record_shipped, stderr, stdout, tabletop};

/// The largest file that a stranger may have: a whole PNG of 65,535 × 65,535 pixels.
const BOMB: [u8; 66] = [
    0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48, 0x44, 0x52,
    0x00, 0x00, 0xff, 0xff, 0x00, 0x00, 0xff, 0xff, 0x08, 0x06, 0x00, 0x00, 0x00, 0xb6, 0x05, 0xd9,
    0x50, 0x00, 0x00, 0x00, 0x09, 0x49, 0x44, 0x41, 0x54, 0x78, 0x9c, 0x63, 0x00, 0x00, 0x00, 0x01,
    0x00, 0x01, 0x5e, 0xff, 0x7d, 0xf9, 0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42,
    0x60, 0x82,
];

/// A recording, and a dataset of two episodes of it. Both are in a folder of the test.
struct Sets {
    root: PathBuf,
    demo: String,
}

impl Sets {
    fn new(name: &str) -> Self {
        let root = place(name);
        fs::create_dir_all(&root).unwrap();
        let demo = record_shipped("red_on_blue", &format!("{name}/demo"));
        Self { root, demo }
    }

    fn path(&self, name: &str) -> String {
        self.root.join(name).to_str().unwrap().to_owned()
    }

    /// A dataset of two episodes, in this format.
    fn exported(&self, format: &str) -> String {
        let out = self.path(format);
        for _ in 0..2 {
            assert_eq!(self.export(format, &out), (0, String::new()));
        }
        out
    }

    /// Exports the recording. Returns the exit code and what was said.
    fn export(&self, format: &str, out: &str) -> (i32, String) {
        run(&["export", &self.demo, "--to", format, out])
    }
}

fn run(arguments: &[&str]) -> (i32, String) {
    let output = tabletop(arguments);
    let code = output.status.code();
    let said = stderr(&output);
    assert!(code.is_some(), "{arguments:?}: {said}");
    (code.unwrap_or_default(), said)
}

/// Runs a command that must refuse its input with these words, and change nothing in a folder.
fn is_refused(arguments: &[&str], words: &str, folder: &Path) {
    let before = files(folder);
    let (code, said) = run(arguments);
    assert_eq!(code, 2, "{arguments:?}: {said}");
    assert!(said.contains(words), "{arguments:?}: {words}: {said}");
    assert!(!said.contains("panicked"), "{arguments:?}: {said}");
    assert!(before == files(folder), "{arguments:?} changes something");
}

fn change_json(path: &str, change: impl FnOnce(&mut Value)) {
    let mut value: Value = serde_json::from_slice(&fs::read(path).unwrap()).unwrap();
    change(&mut value);
    fs::write(path, value.to_string()).unwrap();
}

#[test]
fn a_name_of_an_rlds_dataset_leads_nowhere_else() {
    let sets = Sets::new("strange_rlds_names");
    let rlds = sets.exported("rlds");
    let info = format!("{rlds}/dataset_info.json");
    let elsewhere = sets.path("canary");
    fs::create_dir(&elsewhere).unwrap();
    for name in [
        "../canary/pwn",
        &format!("{elsewhere}/pwn"),
        "..",
        "a/b",
        "",
        "Ä",
        "a\u{1b}[2J",
    ] {
        change_json(&info, |info| info["name"] = json!(name));
        is_refused(
            &["export", &sets.demo, "--to", "rlds", &rlds],
            "its name is",
            &sets.root,
        );
    }
}

#[test]
fn what_an_rlds_dataset_says_of_its_files_is_counted() {
    let sets = Sets::new("strange_rlds_numbers");
    let rlds = sets.exported("rlds");
    let info = format!("{rlds}/dataset_info.json");
    let whole = fs::read(&info).unwrap();
    for lengths in [json!(["1", "2"]), json!(["1", "1", "1"]), json!([1])] {
        change_json(&info, |info| info["splits"][0]["shardLengths"] = lengths);
        let (code, said) = sets.export("rlds", &rlds);
        assert_ne!(code, 0, "{said}");
        fs::write(&info, &whole).unwrap();
    }
    // It is not believed, so it cannot wrap.
    change_json(&info, |info| {
        info["splits"][0]["numBytes"] = json!(u64::MAX.to_string());
    });
    assert_eq!(sets.export("rlds", &rlds), (0, String::new()));
    let said: Value = serde_json::from_slice(&fs::read(&info).unwrap()).unwrap();
    let bytes = files(Path::new(&rlds))
        .iter()
        .filter(|(name, _)| name.contains("tfrecord"))
        .map(|(_, bytes)| bytes.len())
        .sum::<usize>();
    assert_eq!(said["splits"][0]["numBytes"], json!(bytes.to_string()));
}

#[test]
fn what_a_lerobot_dataset_says_of_itself_is_counted() {
    let sets = Sets::new("strange_totals");
    let lerobot = sets.exported("lerobot");
    let info = format!("{lerobot}/meta/info.json");
    let whole = fs::read(&info).unwrap();
    let [merged, rest, trimmed, parts] =
        ["merged", "rest", "trimmed", "parts"].map(|it| sets.path(it));
    let is_refused_everywhere = |words: &str| {
        for arguments in [
            &["dataset", "merge", &lerobot, &lerobot, "--out", &merged][..],
            &["dataset", "drop", &lerobot, &rest, "--episodes", "0"],
            &["dataset", "trim", &lerobot, &trimmed],
            &["dataset", "split", &lerobot, &parts, "--into", "a=1,b=1"],
            &["export", &sets.demo, "--to", "lerobot", &lerobot],
        ] {
            is_refused(arguments, words, &sets.root);
        }
    };
    for (key, numbers) in [
        (
            "total_episodes",
            vec![0, 1, 3, 1_000_000_000_000, 1 << 63, u64::MAX],
        ),
        ("total_frames", vec![0, u64::MAX]),
        ("total_tasks", vec![0, u64::MAX]),
    ] {
        for number in numbers {
            change_json(&info, |info| info[key] = json!(number));
            is_refused_everywhere("meta/info.json says");
            let output = tabletop(&["dataset", "check", &lerobot]);
            assert_eq!(output.status.code(), Some(1));
            assert!(stdout(&output).contains("meta/info.json says"));
            // What it is said to have is not what it has.
            let output = tabletop(&["dataset", "info", &lerobot]);
            let said = stdout(&output);
            assert!(said.contains("episodes  2\n"), "{said}");
            assert!(said.contains("wrong     meta/info.json says"), "{said}");
            fs::write(&info, &whole).unwrap();
        }
    }
    for fps in [
        json!(0),
        json!(61),
        json!(1_u64 << 32),
        json!(-1),
        json!("4"),
    ] {
        change_json(&info, |info| info["fps"] = fps);
        is_refused_everywhere("fps");
        fs::write(&info, &whole).unwrap();
    }
    fs::remove_file(&info).unwrap();
    is_refused(
        &["export", &sets.demo, "--to", "lerobot", &lerobot],
        "no meta/info.json",
        &sets.root,
    );
    fs::write(&info, &whole).unwrap();
    let stats = format!("{lerobot}/meta/stats.json");
    change_json(&stats, |stats| {
        stats["action"]["min"].as_array_mut().unwrap().pop();
    });
    is_refused(
        &["export", &sets.demo, "--to", "lerobot", &lerobot],
        "the statistics of action",
        &sets.root,
    );
}

#[test]
fn a_table_without_rows_is_no_episode() {
    let sets = Sets::new("strange_tables");
    let lerobot = sets.exported("lerobot");
    // Nobody has written a table, and the totals stay.
    fs::remove_file(format!("{lerobot}/data/chunk-000/file-001.parquet")).unwrap();
    let out = sets.path("merged");
    is_refused(
        &["dataset", "merge", &lerobot, &lerobot, "--out", &out],
        "meta/info.json says 2 episodes",
        &sets.root,
    );
}

#[cfg(unix)]
#[test]
fn no_link_in_a_dataset_is_followed() {
    use std::os::unix::fs::symlink;

    let sets = Sets::new("strange_links");
    let out = sets.path("lerobot");
    let video = [
        "export", &sets.demo, "--to", "lerobot", &out, "--video", "--size", "64x48",
    ];
    assert_eq!(run(&video).0, 0);
    for inner in ["videos", "data", "meta/episodes", "data/chunk-000"] {
        let (inside, outside) = (format!("{out}/{inner}"), sets.path("outside"));
        fs::rename(&inside, &outside).unwrap();
        symlink(&outside, &inside).unwrap();
        fs::write(format!("{outside}/.canary.part"), "mine").unwrap();
        for arguments in [
            &video[..],
            &["dataset", "repair", &out],
            &["dataset", "trim", &out, &sets.path("trimmed")],
        ] {
            let before = files(Path::new(&outside));
            let (code, said) = run(arguments);
            assert_ne!(code, 0, "{inner}: {arguments:?}: {said}");
            assert!(said.contains("a link"), "{inner}: {arguments:?}: {said}");
            assert!(
                before == files(Path::new(&outside)),
                "{inner}: {arguments:?}"
            );
        }
        fs::remove_file(format!("{outside}/.canary.part")).unwrap();
        fs::remove_file(&inside).unwrap();
        fs::rename(&outside, &inside).unwrap();
    }
    assert_eq!(run(&video).0, 0);
}

#[cfg(unix)]
#[test]
fn a_picture_that_is_a_link_is_not_shown() {
    use std::os::unix::fs::symlink;

    let sets = Sets::new("strange_picture_links");
    let picture = format!("{}/0/0.png", sets.demo);
    let mine = sets.path("mine.png");
    fs::rename(&picture, &mine).unwrap();
    symlink(&mine, &picture).unwrap();
    let [page, out] = ["page.html", "out"].map(|name| sets.path(name));
    for arguments in [
        &["report", &sets.demo, &page][..],
        &["export", &sets.demo, "--to", "mat", &out],
        &["dataset", "card", &sets.demo],
        &["watch", &sets.demo],
    ] {
        let (code, said) = run(arguments);
        assert_ne!(code, 0, "{arguments:?}: {said}");
        assert!(said.contains("a link"), "{arguments:?}: {said}");
    }
    let output = tabletop(&["dataset", "check", &sets.demo, "--quick"]);
    assert!(stdout(&output).contains("a link"), "{}", stdout(&output));
    // A folder of pictures alone.
    let pictures = sets.path("pictures");
    fs::create_dir(&pictures).unwrap();
    symlink(&mine, format!("{pictures}/0.png")).unwrap();
    is_refused(&["watch", &pictures], "a link", &sets.root);
}

#[cfg(unix)]
#[test]
fn a_recording_that_is_a_link_is_none_of_a_folder() {
    let sets = Sets::new("strange_recording_links");
    let [many, out] = ["many", "out"].map(|name| sets.path(name));
    fs::create_dir(&many).unwrap();
    std::os::unix::fs::symlink(&sets.demo, format!("{many}/0000")).unwrap();
    for arguments in [
        &["dataset", "info", &many][..],
        &["dataset", "merge", &many, &many, "--out", &out],
        &["export", &many, "--to", "mat", &out],
    ] {
        is_refused(arguments, "0000: it is a link", &sets.root);
    }
}

#[test]
fn a_picture_is_of_its_camera() {
    let sets = Sets::new("strange_pictures");
    let picture = format!("{}/0/0.png", sets.demo);
    let [page, out] = ["page.html", "out"].map(|name| sets.path(name));
    let small = small_png();
    for (bytes, words) in [(&BOMB[..], "65535x65535 pixels"), (&small, "1x1 pixels")] {
        fs::write(&picture, bytes).unwrap();
        for arguments in [
            &["report", &sets.demo, &page][..],
            &["export", &sets.demo, "--to", "mat", &out],
            &["dataset", "card", &sets.demo],
        ] {
            let (code, said) = run(arguments);
            assert_eq!(code, 2, "{arguments:?}: {said}");
            assert!(said.contains(words), "{arguments:?}: {said}");
        }
        let output = tabletop(&["dataset", "check", &sets.demo, "--quick"]);
        assert_eq!(output.status.code(), Some(1));
        assert!(stdout(&output).contains(words), "{}", stdout(&output));
    }
}

/// A picture of one pixel.
fn small_png() -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, 1, 1);
    encoder.set_color(png::ColorType::Rgb);
    let mut writer = encoder.write_header().unwrap();
    writer.write_image_data(&[1, 2, 3]).unwrap();
    writer.finish().unwrap();
    bytes
}

#[test]
fn names_neither_reach_the_terminal_nor_break_a_table() {
    let sets = Sets::new("strange_names");
    let session = format!("{}/session.jsonl", sets.demo);
    let log = fs::read_to_string(&session).unwrap();
    let long = "x".repeat(70_000);
    for name in ["\\u001b[2J\\u009b\\u202e", "a\\nepisodes  9", &long] {
        let demo = sets.path("named");
        let _earlier = fs::remove_dir_all(&demo);
        fs::create_dir(&demo).unwrap();
        for (file, bytes) in files(Path::new(&sets.demo)) {
            let file = Path::new(&demo).join(file);
            fs::create_dir_all(file.parent().unwrap()).unwrap();
            let is_text = file
                .extension()
                .is_some_and(|it| it == "csv" || it == "txt");
            let spoken: String = serde_json::from_str(&format!("\"{name}\"")).unwrap();
            let quoted = match spoken.contains('\n') {
                true => format!("\"{spoken}\""),
                false => spoken,
            };
            let bytes = match is_text {
                true => String::from_utf8(bytes)
                    .unwrap()
                    .replace("RedBlock", &quoted)
                    .into_bytes(),
                false => bytes,
            };
            fs::write(file, bytes).unwrap();
        }
        fs::write(
            format!("{demo}/session.jsonl"),
            log.replace("RedBlock", name),
        )
        .unwrap();
        for arguments in [
            &["dataset", "info", &demo][..],
            &["dataset", "stats", &demo],
            &["dataset", "check", &demo, "--quick"],
            &["explain", &demo],
        ] {
            let output = tabletop(arguments);
            let said = stdout(&output) + &stderr(&output);
            let obeyed = |letter: char| {
                letter.is_control() && letter != '\n' || matches!(letter, '\u{202a}'..='\u{202e}')
            };
            assert!(!said.contains(obeyed), "{arguments:?}: {said:?}");
            assert!(!said.contains("\nepisodes  9"), "{arguments:?}: {said}");
            assert!(!said.contains("panicked"), "{arguments:?}: {said}");
        }
    }
}
