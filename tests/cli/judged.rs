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
    let named = ["stack", "stack-among-others", "box"];
    let options = ["--robot", "assets/panda/robot.ron", "--episodes", "3"];
    let judge = ["benchmark", "--policy", address];
    [&judge[..], &named, &options, &["--json", file]].concat()
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
fn perturbed_episodes_begin_like_their_twins() {
    let (_, address) = dicing(u64::MAX);
    let [plain, one, two, folder, page] = [
        "judged_unperturbed",
        "judged_perturbed",
        "judged_perturbed_again",
        "judged_perturbed_recorded",
        "judged_perturbed.html",
    ]
    .map(place);
    let perturb = ["--perturb", "words,light,words", "--perturb", "distractors"];
    let table = judge(&address, &one, &[&perturb[..], &["--jobs", "1"]].concat());
    let unperturbed = judge(&address, &plain, &[]);
    let text = fs::read_to_string(&one).unwrap();
    let json = |line: &str| serde_json::from_str::<serde_json::Value>(line).unwrap();
    let lines: Vec<_> = text.lines().map(json).collect();
    let kinds = serde_json::json!(["light", "distractors", "words"]);
    assert_eq!(lines[0]["perturbations"], kinds);
    assert_eq!(lines.len(), 1 + 9 * 4);
    for twins in lines[1..].chunks(4) {
        let same = ["task", "episode", "beginning", "seed"];
        for key in same {
            assert!(twins.iter().all(|it| it[key] == twins[0][key]), "{twins:?}");
        }
        let own: Vec<_> = twins.iter().map(|it| it["perturbation"].as_str()).collect();
        assert_eq!(
            own,
            [None, Some("light"), Some("distractors"), Some("words")]
        );
        let told: Vec<_> = twins.iter().map(|it| it["words"].is_string()).collect();
        assert_eq!(told, [false, false, false, true]);
    }
    // The others are those of a judgement without perturbations, to the byte.
    let own = text.lines().skip(1).step_by(4);
    let without = fs::read_to_string(&plain).unwrap();
    assert!(own.eq(without.lines().skip(1)));
    let rates = unperturbed.lines().take_while(|line| line.starts_with('|'));
    assert!(rates.clone().count() > 4);
    assert!(rates.eq(table.lines().take_while(|line| line.starts_with('|'))));
    assert!(
        table.contains("| none | 0 of 9 | 0 % | 0 to 30 % | | | |"),
        "{table}"
    );
    assert!(
        table.contains("| distractors | 0 of 9 | 0 % | 0 to 30 % | 0 | 0 | 1.000 |"),
        "{table}"
    );

    // Recorded, with two jobs, and as a page with films.
    let [folder_text, page_text] = [&folder, &page].map(|path| path.to_str().unwrap());
    let more = ["--jobs", "2", "--record", folder_text, "--html", page_text];
    assert_eq!(
        judge(&address, &two, &[&perturb[..], &more].concat()),
        table
    );
    assert_eq!(fs::read_to_string(&two).unwrap(), text);
    for number in 0..4 {
        replays_to_the_same_bytes(folder.join(format!("000{number}")));
    }
    let first_picture =
        |number: u64| fs::read(folder.join(format!("000{number}/0/0.png"))).unwrap();
    let differ = [1, 2, 3].map(|number| first_picture(number) != first_picture(0));
    assert_eq!(differ, [true, true, false]);
    let html = fs::read_to_string(&page).unwrap();
    for part in [
        "<h2>Perturbations by task</h2>",
        "<td>none</td>",
        "<b>stack, episode 0</b>",
        "<img alt=\"Pictures of stack, episode 0\" src=\"data:image/png;base64,",
    ] {
        assert!(html.contains(part), "{part}");
    }
    // The same page comes from the file alone, without films.
    let output = tabletop(&[
        "benchmark",
        "--merge",
        two.to_str().unwrap(),
        "--html",
        page_text,
    ]);
    assert_eq!(stdout(&output).trim_end(), table, "{}", stderr(&output));
    let html = fs::read_to_string(&page).unwrap();
    assert!(html.contains("<h2>Failures</h2>") && !html.contains("<h2>Films</h2>"));
}

#[test]
fn in_real_time_the_simulation_runs_on_until_the_answer() {
    let (_, address) = dicing(u64::MAX);
    let [waiting, delayed, again] =
        ["judged_waiting", "judged_delayed", "judged_delayed_again"].map(place);
    let ticks = |file: &Path| {
        let text = fs::read_to_string(file).unwrap();
        let episodes = text.lines().skip(1);
        let ticks = episodes.map(|line| {
            let json: serde_json::Value = serde_json::from_str(line).unwrap();
            let premature = json["failure"] == "premature";
            (premature, json["ticks"].as_u64().unwrap())
        });
        ticks.collect::<Vec<_>>()
    };
    let delay = ["--realtime", "--delay", "490"];
    let table = judge(&address, &waiting, &[]);
    assert_eq!(judge(&address, &delayed, &delay), table);
    judge(&address, &again, &delay);
    assert!(fs::read(&delayed).unwrap() == fs::read(&again).unwrap());
    let text = fs::read_to_string(&delayed).unwrap();
    assert!(
        text.lines()
            .next()
            .unwrap()
            .contains("\"delay\":{\"ms\":490}"),
        "{text}"
    );
    // Who says that all is done is not waited for.
    for ((premature, before), (_, after)) in ticks(&waiting).into_iter().zip(ticks(&delayed)) {
        assert_eq!(after - before, if premature { 0 } else { 30 });
    }
    let measured = place("judged_measured");
    judge(&address, &measured, &["--realtime"]);
    let text = fs::read_to_string(&measured).unwrap();
    assert!(text.contains("\"delay\":\"measured\""), "{text}");
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
    refused(&["--html", path], "--policy");
    refused(
        &["--policy", &address, "--perturb", "dark"],
        "light, colors",
    );
    refused(&["--policy", &address, "--delay", "9"], "--realtime");
    let elsewhere = ["--policy", &address, "--html", "Cargo.toml"];
    refused(
        &elsewhere,
        "something else than a page of tabletop's is there",
    );
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
    assert!(said.contains("Done: 1 step"), "{said}");
}
