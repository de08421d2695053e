//! `tabletop learn` and `tabletop imitate --policy`.

use std::fs;

use tabletop::{
    StillScene,
    camera::Camera,
    core::HeadCamera,
    recorder::RecordingReader,
    scene::{IdAllocator, assemble},
    scene_at_beginning,
};

use crate::support::{place, record_shipped, stderr, stdout, tabletop};

#[test]
fn a_policy_is_learned_goes_on_where_it_was_cut_off_and_moves_the_robot() {
    let demo = record_shipped("red_on_blue", "policy");
    let file = place("policy.safetensors");
    place("policy.svg");
    let file = file.to_str().unwrap();
    let learn = |samples: &str| {
        let options = ["--count", "8", "--trials", "2", "--samples", samples];
        let output = tabletop(&[&["learn", &demo, "--out", file], &options[..]].concat());
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        stdout(&output)
    };
    let said = learn("16");
    assert!(said.contains(" of 2 unseen scenes done"), "{said}");
    assert!(
        fs::read_to_string(file.replace(".safetensors", ".svg"))
            .unwrap()
            .starts_with("<svg")
    );
    let first = fs::read(file).unwrap();
    // It is there already.
    learn("16");
    assert_eq!(fs::read(file).unwrap(), first);

    // A policy that has hardly learned decides something, and the robot says how that ended.
    let output = tabletop(&["imitate", &demo, "--policy", file]);
    let said = stdout(&output);
    assert!(
        said.starts_with("Done: ") || said.starts_with("Step "),
        "{said}{}",
        stderr(&output)
    );
    assert_eq!(
        output.status.code(),
        Some(i32::from(!said.starts_with("Done: ")))
    );

    // Without the policy, this seed puts the red block before the right corner of the picture.
    let trial = place("policy_trial");
    let trial = trial.to_str().unwrap();
    let seed = ["--seed", "9", "--record", trial];
    tabletop(&[&["imitate", &demo, "--policy", file], &seed[..]].concat());
    let recording = RecordingReader::open(trial).unwrap();
    let scene = scene_at_beginning(recording.session()).unwrap();
    let objects = assemble(&scene, &mut IdAllocator::default()).objects;
    let camera = Camera::of_head(&HeadCamera::default(), &scene.table);
    let still = StillScene::new(camera, &scene.table, objects);
    let red = still.pose("One").unwrap();
    assert!(still.has_in_view("One", red), "{red:?}");

    fs::write(file, &first[..100]).unwrap();
    for command in [
        &["imitate", &demo, "--policy", file][..],
        &["learn", &demo, "--out", file],
    ] {
        let output = tabletop(command);
        assert_eq!(output.status.code(), Some(2), "{command:?}");
        assert!(stderr(&output).contains(file), "{}", stderr(&output));
    }
}
