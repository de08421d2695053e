//! `tabletop keys`.

use std::fs;

use crate::support::{command, place, stderr, stdout};

#[test]
fn the_list_that_is_printed_as_a_file_is_read_without_a_fault() {
    let folder = place("keys");
    fs::create_dir_all(&folder).unwrap();
    let keys = |arguments: &[&str]| {
        let mut command = command(&[&["keys"], arguments].concat());
        command.env("TABLETOP_CONFIG", &folder).output().unwrap()
    };
    let shipped = keys(&[]);
    assert_eq!(shipped.status.code(), Some(0), "{}", stderr(&shipped));
    assert!(stdout(&shipped).contains("Space"), "{}", stdout(&shipped));

    let file = stdout(&keys(&["--ron"])).replace("\"Space\"", "\"F5\"");
    fs::write(folder.join("keys.ron"), file).unwrap();
    let bound = keys(&[]);
    assert_eq!(
        (bound.status.code(), stderr(&bound).as_str()),
        (Some(0), "")
    );
    let [shipped, bound] = [shipped, bound].map(|output| stdout(&output));
    let expected = shipped.replace("Space  ", "F5     ");
    // The last line says which file binds the keys.
    let all_but_last = |list: &str| {
        list.trim_end()
            .rsplit_once('\n')
            .map(|(keys, _)| keys.to_owned())
    };
    assert_eq!(all_but_last(&bound), all_but_last(&expected));
    assert!(bound.contains("keys.ron"), "{bound}");
}

#[test]
fn faults_of_a_file_are_reported_with_their_places() {
    let path = place("faulty_keys.ron");
    fs::write(&path, "{\n  \"jump\": [\"Space\"],\n}").unwrap();
    let path = path.to_str().unwrap();
    let output = command(&["keys", "--keys", path]).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    let reported =
        format!("{path}:2:3: there is no action `jump`; `tabletop keys` lists them all\n");
    assert_eq!(stderr(&output), reported);
    assert!(stdout(&output).contains("Space"));
}
