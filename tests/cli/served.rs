//! `tabletop serve-policy`, and `tabletop imitate --policy` with a served one.

use std::{
    io::{BufRead as _, BufReader},
    process::{Child, Stdio},
    sync::{Arc, Mutex},
    thread,
};

use tabletop::wire::{
    Dtype, NumpyArray, PolicyAddress, PolicyClient, PolicyServer, Served, WireMap, WireValue,
};

use crate::support::{command, files, place, record_shipped, stderr, stdout, tabletop};

/// A `tabletop serve-policy` that ends with its test.
pub struct Serving {
    child: Child,
    pub address: String,
}

impl Serving {
    fn begin(policy: &str) -> Self {
        Self::of(policy, policy)
    }

    pub fn oracle() -> Self {
        Self::of("--oracle", "The oracle")
    }

    /// The server of what this word says, which it calls by a name.
    fn of(word: &str, name: &str) -> Self {
        let mut command = command(&["serve-policy", word, "--port", "0"]);
        let mut child = command.stdout(Stdio::piped()).spawn().unwrap();
        let mut line = String::new();
        let said = child.stdout.take().unwrap();
        BufReader::new(said).read_line(&mut line).unwrap();
        let (file, address) = line.trim().split_once(" is served at ").unwrap();
        assert_eq!(file, name);
        let address = address.to_owned();
        Self { child, address }
    }
}

impl Drop for Serving {
    fn drop(&mut self) {
        self.child.kill().unwrap();
        self.child.wait().unwrap();
    }
}

/// A policy that has hardly learned, in a file of this name.
fn learned(demo: &str, name: &str) -> String {
    let file = place(name);
    place(&name.replace(".safetensors", ".svg"));
    let file = file.to_str().unwrap().to_owned();
    let options = ["--count", "8", "--trials", "0", "--samples", "16"];
    let output = tabletop(&[&["learn", demo, "--out", &file], &options[..]].concat());
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    file
}

#[test]
fn a_served_policy_does_what_its_file_does() {
    let demo = record_shipped("red_on_blue", "served");
    let file = learned(&demo, "served.safetensors");
    let serving = Serving::begin(&file);
    let imitate = |policy: &str, name: &str| {
        let record = place(name);
        let folder = record.to_str().unwrap();
        let trials = ["--trials", "3", "--record", folder];
        let output = tabletop(&[&["imitate", &demo, "--policy", policy], &trials[..]].concat());
        assert!(
            matches!(output.status.code(), Some(0 | 1)),
            "{}",
            stderr(&output)
        );
        let result = stdout(&output);
        // The last line has the seconds that it took.
        let result = result.lines().filter(|line| !line.contains("s simulated"));
        let result: Vec<_> = result.map(str::to_owned).collect();
        (result, stderr(&output), files(&record))
    };
    let by_file = imitate(&file, "by_file");
    let by_wire = imitate(&serving.address, "by_wire");
    assert_eq!((&by_file.0, &by_file.1), (&by_wire.0, &by_wire.1));
    let names = |files: &std::collections::BTreeMap<String, Vec<u8>>| {
        files.keys().cloned().collect::<Vec<_>>()
    };
    assert!(by_file.2.len() > 3);
    assert_eq!(names(&by_file.2), names(&by_wire.2));
    for (name, bytes) in &by_file.2 {
        assert!(bytes == &by_wire.2[name], "{name}");
    }
}

#[test]
fn a_server_says_what_it_wants_and_what_is_wrong() {
    let demo = record_shipped("red_on_blue", "served_wants");
    let file = learned(&demo, "served_wants.safetensors");
    let serving = Serving::begin(&file);
    let address: PolicyAddress = serving.address.parse().unwrap();
    let mut client = PolicyClient::connect(&address).unwrap();
    let metadata = client.metadata().clone();
    let wanted = metadata["observation"].map().unwrap();
    assert_eq!(wanted.keys().collect::<Vec<_>>(), ["camera", "image"]);
    let shape = &metadata["action"].map().unwrap()["shape"];
    let whole = WireValue::Integer;
    assert_eq!(shape, &WireValue::List(vec![whole(1), whole(11)]));
    assert_eq!(metadata["horizon"], whole(1));
    let refusal = client.ask(&WireMap::new()).unwrap_err().to_string();
    assert!(refusal.ends_with("refuses: \"image\" is missing; there are only []"));
    let mut client = PolicyClient::connect(&address).unwrap();
    let gray = NumpyArray::of_bytes(&[150, 200], Vec::new());
    let observation = WireMap::from([("image".to_owned(), gray.into())]);
    let refusal = client.ask(&observation).unwrap_err().to_string();
    assert!(
        refusal.contains("\"image\": its shape is [150, 200] of |u1"),
        "{refusal}"
    );

    // It is no policy of DROID's.
    let droid = ["--mapping", "droid", "--robot", "assets/panda/robot.ron"];
    let served = ["imitate", &demo, "--policy", &serving.address];
    let output = tabletop(&[&served, &droid[..]].concat());
    assert_eq!(output.status.code(), Some(2));
    let said = stderr(&output);
    assert!(
        said.contains("\"camera\": the server wants it, and the mapping has no such key"),
        "{said}"
    );
}

/// A served policy that says nothing of itself, answers with the same actions for ever, and remembers what it was asked.
#[derive(Clone)]
struct Scripted {
    actions: NumpyArray,
    /// The number of the answer from which on the actions are no numbers.
    gives_up: usize,
    seen: Arc<Mutex<Vec<WireMap>>>,
}

impl Served for Scripted {
    fn metadata(&self) -> WireMap {
        WireMap::new()
    }

    fn answer(&self, observation: &WireMap) -> Result<WireMap, String> {
        let mut seen = self.seen.lock().unwrap();
        seen.push(observation.clone());
        let actions = match seen.len() < self.gives_up {
            true => self.actions.clone(),
            false => NumpyArray::of_floats(self.actions.shape(), &[f32::NAN]),
        };
        Ok(WireMap::from([("actions".to_owned(), actions.into())]))
    }
}

impl Scripted {
    /// A policy whose actions are these numbers, in chunks of as many as given.
    fn serve(numbers: &[f32], rows: usize, gives_up: usize) -> (Self, String) {
        let all = numbers.repeat(rows);
        let policy = Self {
            actions: NumpyArray::of_floats(&[rows, numbers.len()], &all),
            gives_up,
            seen: Arc::default(),
        };
        let server = PolicyServer::bind("127.0.0.1", 0).unwrap();
        let address = format!("ws://{}", server.address().unwrap());
        let served = policy.clone();
        thread::spawn(move || server.serve(&served));
        (policy, address)
    }

    /// The number of a state in each observation.
    fn states(&self, key: &str, place: usize) -> Vec<f64> {
        let seen = self.seen.lock().unwrap();
        let states = seen.iter().map(|observation| {
            let array = observation[key].array().unwrap();
            array.numbers().nth(place).unwrap()
        });
        states.collect()
    }
}

/// Imitates with Panda; the exit code and what it says.
fn imitate_with(demo: &str, address: &str, mapping: &str, more: &[&str]) -> (Option<i32>, String) {
    let options = ["--mapping", mapping, "--robot", "assets/panda/robot.ron"];
    let served = ["imitate", demo, "--policy", address];
    let output = tabletop(&[&served, &options[..], more].concat());
    (
        output.status.code(),
        format!("{}{}", stdout(&output), stderr(&output)),
    )
}

#[test]
fn speeds_of_droid_turn_joints_and_the_same_answers_are_the_same_bytes() {
    let demo = record_shipped("red_on_blue", "served_droid");
    let mut numbers = [0.0; 8];
    numbers[0] = 0.1;
    numbers[7] = 1.0;
    let (policy, address) = Scripted::serve(&numbers, 10, 5);
    let recorded = |name: &str| {
        policy.seen.lock().unwrap().clear();
        let record = place(name);
        let folder = record.to_str().unwrap();
        let (code, said) = imitate_with(&demo, &address, "droid", &["--record", folder]);
        assert_eq!(code, Some(1), "{said}");
        assert!(
            said.contains("sends nonsense: actions: row 1, column 1 is NaN"),
            "{said}"
        );
        files(&record)
    };
    let first = recorded("served_droid_1");
    let seen = policy.seen.lock().unwrap().clone();
    let observation = &seen[0];
    for key in [
        "observation/exterior_image_1_left",
        "observation/wrist_image_left",
    ] {
        let image = observation[key].array().unwrap();
        assert_eq!(
            (image.dtype(), image.shape()),
            (Dtype::U8, &[224, 224, 3][..])
        );
        // The aspect leaves 49 rows black above and below.
        let rows: Vec<_> = image.bytes().chunks(224 * 3).collect();
        let is_black = |row: &&[u8]| row.iter().all(|byte| *byte == 0);
        assert!(rows[..49].iter().all(is_black), "{key}");
        assert!(rows[49..175].iter().any(|row| !is_black(row)), "{key}");
        assert!(rows[175..].iter().all(is_black), "{key}");
    }
    let prompt = WireValue::from("Put the red block on the blue block.");
    assert_eq!(observation["prompt"], prompt);
    // 8 actions of 1/15 s at 0.3 rad/s.
    let turned = policy.states("observation/joint_position", 0);
    for pair in turned.windows(2) {
        assert!((pair[1] - pair[0] - 0.16).abs() < 1e-3, "{turned:?}");
    }
    let closed = policy.states("observation/gripper_position", 0);
    assert!(closed.last().unwrap() > &0.99, "{closed:?}");
    assert!(first == recorded("served_droid_2"));
}

#[test]
fn in_real_time_joints_stand_still_until_the_answer() {
    let demo = record_shipped("red_on_blue", "served_delay");
    let mut numbers = [0.0; 8];
    numbers[0] = 0.1;
    let (policy, address) = Scripted::serve(&numbers, 10, 5);
    let simulated = |more: &[&str]| {
        policy.seen.lock().unwrap().clear();
        let (code, said) = imitate_with(&demo, &address, "droid", more);
        assert_eq!(code, Some(1), "{said}");
        let seconds = said.split_once(" s simulated").unwrap().0;
        let seconds: f64 = seconds.rsplit(' ').next().unwrap().parse().unwrap();
        (seconds, policy.states("observation/joint_position", 0))
    };
    let (waited, turned) = simulated(&[]);
    let (delayed, turned_delayed) = simulated(&["--realtime", "--delay", "500"]);
    // Four answers of 0.5 s each; the fifth is none.
    assert!((delayed - waited - 2.0).abs() < 0.11, "{waited}, {delayed}");
    assert_eq!(turned, turned_delayed);
}

#[test]
fn standing_cameras_light_and_words_are_perturbed() {
    let (policy, address) = Scripted::serve(&[0.0; 8], 10, 1);
    let judged = ["benchmark", "beside", "--policy", &address];
    let options = ["--mapping", "droid", "--robot", "assets/panda/robot.ron"];
    let perturb = ["--perturb", "light,camera,words", "--jobs", "1"];
    let words = [&judged[..], &options, &perturb, &["--episodes", "1"]].concat();
    let output = tabletop(&words);
    let said = stdout(&output) + &stderr(&output);
    assert!(said.contains("| words | 0 of 1 | 0 % |"), "{said}");
    let seen = policy.seen.lock().unwrap();
    let differ = |key: &str| {
        let others = seen.iter().skip(1);
        others.map(|it| it[key] != seen[0][key]).collect::<Vec<_>>()
    };
    let standing = "observation/exterior_image_1_left";
    assert_eq!(differ(standing), [true, true, false]);
    // The camera on the hand stays where it is.
    let wrist = "observation/wrist_image_left";
    assert_eq!(differ(wrist), [true, false, false]);
    assert_eq!(differ("prompt"), [false, false, true]);
}

#[test]
fn recorded_exchanges_do_the_same_without_the_server() {
    let demo = record_shipped("red_on_blue", "served_exchanges");
    let exchanges = place("served_exchanges.wire");
    let exchanges = exchanges.to_str().unwrap();
    let (policy, address) = Scripted::serve(&[0.1, 0.0, 0.0, 0.1, 0.0, 0.0, 0.0, 1.0], 10, 4);
    let recorded = |policy: &str, more: &[&str], name: &str| {
        let record = place(name);
        let record_in = ["--record", record.to_str().unwrap()];
        let (code, said) = imitate_with(&demo, policy, "droid", &[&record_in, more].concat());
        assert_eq!(code, Some(1), "{said}");
        (said, files(&record))
    };
    let note = ["--exchanges", exchanges];
    let (said, by_wire) = recorded(&address, &note, "served_exchanges_1");
    assert!(said.contains("row 1, column 1 is NaN"), "{said}");
    assert_eq!(policy.seen.lock().unwrap().len(), 4);
    let (said, by_file) = recorded(exchanges, &[], "served_exchanges_2");
    assert!(
        said.contains("served_exchanges.wire: actions: row 1, column 1 is NaN"),
        "{said}"
    );
    assert_eq!(policy.seen.lock().unwrap().len(), 4);
    assert!(by_wire == by_file);

    // It cannot know what it was never asked.
    let (code, said) = imitate_with(&demo, exchanges, "droid", &["--seed", "1"]);
    assert_eq!(code, Some(1), "{said}");
    assert!(said.contains("the policy was never asked this"), "{said}");
    for (policy, fault) in [
        (address.as_str(), "File exists"),
        (exchanges, "is for a policy that is served"),
    ] {
        let (_, said) = imitate_with(&demo, policy, "droid", &note);
        assert!(said.contains(fault), "{said}");
    }
}

#[test]
fn displacements_of_libero_move_the_end_effector() {
    let demo = record_shipped("red_on_blue", "served_libero");
    let numbers = [-0.1, 0.05, 0.1, 0.0, 0.0, 0.04, -1.0];
    let (policy, address) = Scripted::serve(&numbers, 5, 4);
    let (code, said) = imitate_with(&demo, &address, "libero", &[]);
    assert_eq!(code, Some(1), "{said}");
    // Five actions a chunk, of which 1 is 5 cm.
    for (place, way) in [(0, -0.025), (1, 0.0125), (2, 0.025)] {
        let places = policy.states("observation/state", place);
        assert!(places.len() == 4, "{places:?}");
        for pair in places.windows(2) {
            assert!(
                (pair[1] - pair[0] - way).abs() < 2e-3,
                "{place}: {places:?}"
            );
        }
    }
    // The fingers are half of 8 cm from each other's middle.
    assert!((policy.states("observation/state", 6)[3] - 0.04).abs() < 1e-6);
    assert!((policy.states("observation/state", 7)[3] + 0.04).abs() < 1e-6);
}

#[test]
fn what_does_not_fit_is_refused_before_anything_moves() {
    let demo = record_shipped("red_on_blue", "served_unfit");
    let (policy, address) = Scripted::serve(&[0.0; 8], 10, usize::MAX);
    let refused = |policy: &str, more: &[&str], code: i32, fault: &str| {
        let output = tabletop(&[&["imitate", &demo, "--policy", policy], more].concat());
        let said = stderr(&output);
        assert_eq!(output.status.code(), Some(code), "{said}");
        assert!(said.contains(fault), "{said}");
    };
    refused(&address, &[], 2, "does not say what it wants to see");
    let droid = ["--mapping", "droid"];
    refused(&address, &droid, 2, "the robot is \"Baxter\"");
    let droidd = ["--mapping", "droidd"];
    refused(&address, &droidd, 2, "it is neither a file nor one of");
    refused("http://gpu", &[], 2, "it must begin with ws://");
    refused(
        "a.safetensors",
        &droid,
        2,
        "--mapping is for a policy that is served",
    );
    let nobody = PolicyServer::bind("127.0.0.1", 0).unwrap();
    let gone = format!("ws://{}", nobody.address().unwrap());
    drop(nobody);
    refused(&gone, &droid, 1, "cannot be reached");
    assert!(policy.seen.lock().unwrap().is_empty());
    let output = tabletop(&["serve-policy", "none.safetensors"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("none.safetensors"));
}
