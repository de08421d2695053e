//! `tabletop benchmark --policy`: a judge of policies.

use std::{
    fs,
    path::Path,
    sync::{
        Arc,
        atomic::{AtomicU64, Ordering},
    },
    thread,
    time::Duration,
};

use tabletop::wire::{NumpyArray, PolicyServer, Served, WireMap, WireValue};

use crate::{
    served::Serving,
    support::{
        command, place, record_shipped, replays_to_the_same_bytes, stderr, stdout, tabletop,
    },
};

/// A served policy whose decisions hang on the bytes of the picture: it takes what is where nothing is, or says that all is done.
#[derive(Clone)]
struct Dicing {
    /// Number of answers until it breaks down.
    left: Arc<AtomicU64>,
}

impl Served for Dicing {
    fn metadata(&self) -> WireMap {
        let shape = [WireValue::Nil, WireValue::Nil, WireValue::Integer(3)];
        let array = |shape: &[WireValue], dtype: &str| {
            let shape = ("shape".to_owned(), WireValue::List(shape.to_vec()));
            WireValue::from(WireMap::from([shape, ("dtype".to_owned(), dtype.into())]))
        };
        let wanted = [
            ("image".to_owned(), array(&shape, "|u1")),
            ("camera".to_owned(), array(&[WireValue::Integer(9)], "<f4")),
        ];
        WireMap::from([("observation".to_owned(), WireMap::from(wanted).into())])
    }

    fn answer(&self, observation: &WireMap) -> Result<WireMap, String> {
        if self.left.fetch_sub(1, Ordering::Relaxed) == 0 {
            return Err("out of memory".into());
        }
        let bytes = observation["image"].array().unwrap().bytes();
        let sum = bytes.iter().map(|byte| u64::from(*byte)).sum::<u64>();
        let mut numbers = [0.0; 11];
        numbers[0] = 50.0;
        numbers[10] = f32::from(u8::from(sum.is_multiple_of(2)));
        let actions = NumpyArray::of_floats(&[1, 11], &numbers);
        Ok(WireMap::from([("actions".to_owned(), actions.into())]))
    }
}

/// The address of a policy that answers so often.
fn dicing(answers: u64) -> (Arc<AtomicU64>, String) {
    let left = Arc::new(AtomicU64::new(answers));
    let policy = Dicing { left: left.clone() };
    let server = PolicyServer::bind("127.0.0.1", 0).unwrap();
    let address = format!("ws://{}", server.address().unwrap());
    thread::spawn(move || server.serve(&policy));
    (left, address)
}

/// The words that judge a policy in three tasks, of three episodes each, and write them into a file.
fn words<'a>(address: &'a str, file: &'a Path) -> Vec<&'a str> {
    let file = file.to_str().unwrap();
    let tasks = ["benchmark", "stack", "box", "--policy", address];
    let options = ["--robot", "assets/panda/robot.ron", "--episodes", "3"];
    [&tasks[..], &options[..], &["--json", file]].concat()
}

/// Judges so; the table, without the seconds that it took.
fn judge(address: &str, file: &Path, more: &[&str]) -> String {
    let output = tabletop(&[&words(address, file)[..], more].concat());
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let text = stdout(&output);
    let lines = text.lines().filter(|line| !line.contains("s simulated"));
    lines.collect::<Vec<_>>().join("\n")
}

#[test]
fn results_are_the_same_bytes_however_they_came_about() {
    let (_, address) = dicing(u64::MAX);
    let [one, two, again] = ["judged_1", "judged_2", "judged_again"].map(place);
    let table = judge(&address, &one, &["--jobs", "1"]);
    let bytes = fs::read(&one).unwrap();
    assert_eq!(bytes.iter().filter(|byte| **byte == b'\n').count(), 1 + 9);
    assert_eq!(judge(&address, &two, &["--jobs", "2"]), table);
    assert!(fs::read(&two).unwrap() == bytes);

    // What a kill has left is gone on with.
    for length in [bytes.len() * 2 / 3, 40, 0] {
        fs::write(&again, &bytes[..length]).unwrap();
        assert_eq!(judge(&address, &again, &[]), table);
        assert!(fs::read(&again).unwrap() == bytes, "{length}");
    }

    // Shards, in files of their own and in the same one.
    let [first, second, merged, same] =
        ["judged_s0", "judged_s1", "judged_s", "judged_same"].map(place);
    judge(&address, &first, &["--shard", "0/2"]);
    judge(&address, &second, &["--shard", "1/2"]);
    judge(&address, &same, &["--shard", "1/2"]);
    judge(&address, &same, &["--shard", "0/2"]);
    assert!(fs::read(&same).unwrap() == bytes);
    let [first, second, all] = [&first, &second, &merged].map(|path| path.to_str().unwrap());
    let output = tabletop(&["benchmark", "--merge", second, first, "--json", all]);
    assert_eq!(stdout(&output).trim_end(), table, "{}", stderr(&output));
    assert!(fs::read(&merged).unwrap() == bytes);
    let output = tabletop(&["benchmark", "--merge", second]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("stack, episode 0: it is in none of these files"));
}

#[test]
fn a_killed_run_goes_on() {
    let (_, address) = dicing(u64::MAX);
    let [whole, killed] = ["judged_whole", "judged_killed"].map(place);
    let table = judge(&address, &whole, &[]);
    let mut child = command(&words(&address, &killed)).spawn().unwrap();
    let lines = || {
        fs::read_to_string(&killed)
            .unwrap_or_default()
            .lines()
            .count()
    };
    while lines() < 3 && child.try_wait().unwrap().is_none() {
        thread::sleep(Duration::from_millis(2));
    }
    child.kill().unwrap();
    child.wait().unwrap();
    assert_eq!(judge(&address, &killed, &[]), table);
    assert!(fs::read(&killed).unwrap() == fs::read(&whole).unwrap());
}

#[test]
fn a_server_that_breaks_down_costs_no_episode() {
    let [whole, broken] = ["judged_sound", "judged_broken"].map(place);
    let (left, address) = dicing(4);
    let words = words(&address, &broken);
    let output = tabletop(&[&words[..], &["--jobs", "1"]].concat());
    let said = stderr(&output);
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(
        said.contains("stack-among-others, episode 1: ") && said.contains("refuses: out of memory"),
        "{said}"
    );
    assert_eq!(fs::read_to_string(&broken).unwrap().lines().count(), 1 + 4);
    left.store(u64::MAX, Ordering::Relaxed);
    let table = judge(&address, &broken, &[]);
    assert_eq!(judge(&address, &whole, &[]), table);
    assert!(fs::read(&broken).unwrap() == fs::read(&whole).unwrap());
}

#[test]
fn episodes_are_recorded_and_compared() {
    let (_, address) = dicing(u64::MAX);
    let [file, unrecorded, folder] = ["judged_file", "judged_plain", "judged_recorded"].map(place);
    let record = ["--record", folder.to_str().unwrap()];
    let table = judge(&address, &file, &record);
    assert_eq!(judge(&address, &unrecorded, &[]), table);
    for number in 0..9 {
        replays_to_the_same_bytes(folder.join(format!("000{number}")));
    }
    // A line that a kill has cost is written again, and the recording stays.
    let bytes = fs::read(&file).unwrap();
    fs::write(&file, &bytes[..bytes.len() - 9]).unwrap();
    judge(&address, &file, &record);
    assert!(fs::read(&file).unwrap() == bytes);

    let beside = ["--beside", unrecorded.to_str().unwrap()];
    let compared = judge(&address, &file, &beside);
    assert!(
        compared.contains("| task | both | only this | only the other | neither | p |"),
        "{compared}"
    );
    assert!(
        compared.contains("| all | 0 | 0 | 0 | 9 | 1.000 |"),
        "{compared}"
    );
    assert!(
        compared.contains("| stack | 0 of 3 | 0 % | 0 to 56 % |"),
        "{compared}"
    );
    let text = fs::read_to_string(&file).unwrap();
    assert!(
        text.starts_with("{\"benchmark\":\"benchmark@1\",\"program\":\""),
        "{text}"
    );
    assert!(
        text.contains("\"left\":\"Put the red block on the blue block.\""),
        "{text}"
    );
    assert!(text.contains("\"failure\":\"nothing there\""), "{text}");
    assert!(text.contains("\"failure\":\"premature\""), "{text}");
}

#[test]
fn what_cannot_be_judged_is_refused() {
    let (_, address) = dicing(u64::MAX);
    let file = place("judged_refused");
    let refused = |words: &[&str], fault: &str| {
        let output = tabletop(&[&["benchmark"], words].concat());
        let said = stderr(&output);
        assert_eq!(output.status.code(), Some(2), "{said}");
        assert!(said.contains(fault), "{said}");
    };
    let path = file.to_str().unwrap();
    refused(
        &["pile", "--policy", &address],
        "pile: no task's name begins so; they are beside, box",
    );
    refused(&["--policy", &address, "--seed", "2"], "--seed");
    refused(&["--episodes", "3"], "--policy");
    refused(&["--shard", "0/2"], "--policy");
    refused(&["--json", path], "--policy");
    refused(&["--policy", "none.safetensors"], "none.safetensors");
    refused(&["--merge", "none.jsonl"], "none.jsonl");
    judge(&address, &file, &[]);
    let (_, other) = dicing(u64::MAX);
    let words = words(&other, &file);
    refused(&words[1..], "results of which the policy was another one");
    let baxter = [
        "stack",
        "--policy",
        &address,
        "--episodes",
        "1",
        "--beside",
        path,
    ];
    refused(
        &baxter,
        "stack, episode 0: it begins otherwise; the robot is Panda, and here Baxter",
    );
}

#[test]
fn the_oracle_does_every_task() {
    let oracle = Serving::oracle();
    let words = ["benchmark", "--policy", &oracle.address, "--episodes", "1"];
    let panda = ["--robot", "assets/panda/robot.ron"];
    let output = tabletop(&[&words[..], &panda].concat());
    let said = stdout(&output);
    assert!(
        said.contains("| all | 9 of 9 | 100 % | 70 to 100 % |"),
        "{said}"
    );
    let demo = record_shipped("red_on_blue", "judged_oracle");
    let output = tabletop(&["imitate", &demo, "--policy", &oracle.address, "--seed", "3"]);
    let said = stdout(&output) + &stderr(&output);
    assert!(said.contains("Done: 1 steps"), "{said}");
}
