//! What was measured of a real robot comes into the simulation on one way, and nothing of the simulated robot gets to the real one.

use crate::source::program;

#[test]
fn only_the_mirror_speaks_for_a_real_robot() {
    let speaks = |path: &Vec<String>| path.ends_with(&["Actor", "RealRobot"].map(String::from));
    let files = program().into_iter();
    let speakers = files.filter(|(_, source)| source.paths.iter().any(speaks));
    let speakers: Vec<_> = speakers.map(|(path, _)| path).collect();
    assert_eq!(
        speakers,
        ["crates/robot/tabletop_real/src/mirror.rs"].map(std::path::PathBuf::from)
    );
}

#[test]
fn whoever_drives_a_real_robot_knows_nothing_of_the_simulated_one() {
    /// The state of the simulated robot, and everything.
    const STATE: [&str; 5] = ["*", "JointState", "LimbState", "Robot", "RobotContact"];
    let mut files = 0;
    for (path, source) in program() {
        let crates = ["crates/robot/tabletop_bridge", "crates/robot/tabletop_real"];
        if !crates.iter().any(|it| path.starts_with(it)) {
            continue;
        }
        files += 1;
        let used = source.uses.iter();
        let known = used.filter(|it| it.path.first().is_some_and(|it| it == "tabletop_core"));
        for name in known.filter_map(|it| it.path.last()) {
            assert!(
                !STATE.contains(&name.as_str()),
                "{}: {name}",
                path.display()
            );
        }
    }
    assert!(files > 10, "{files}");
}
