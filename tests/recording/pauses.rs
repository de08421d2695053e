//! Commands in pauses.

use tabletop::prelude::*;

use crate::demonstration::{Demonstration, assert_replays};

fn make(preset: Preset, seed: u64) -> SimCommand {
    SceneCommand::Make { preset, seed }.into()
}

#[test]
fn scenes_of_one_moment_of_a_pause_are_one_moment_of_its_replay() {
    let pause = |pause| SimCommand::from(ClockCommand::SetPaused(pause));
    let start = || SimCommand::from(RecordingCommand::Start);
    let block = |seed| make(Preset::BigBlock, seed);
    let boxes = |seed| make(Preset::BoxContainer, seed);
    let clear = || SimCommand::from(SceneCommand::Clear);
    let empty = || SimCommand::from(SceneCommand::Set(Box::default()));
    // Commands of a tick each.
    let cases: [&[&[SimCommand]]; 5] = [
        &[&[start()], &[pause(true)], &[block(1), clear(), boxes(2)]],
        &[&[start()], &[pause(true), block(1), clear()], &[boxes(2)]],
        &[&[start()], &[pause(true), boxes(1)], &[clear(), block(2)]],
        &[
            &[pause(true), block(1)],
            &[start(), clear(), boxes(2), clear(), block(3)],
            &[empty(), boxes(4)],
        ],
        &[
            &[pause(true)],
            &[block(1), clear(), boxes(2)],
            &[empty(), block(3), clear()],
            &[start()],
            &[boxes(5), block(6)],
        ],
    ];
    for (number, case) in cases.into_iter().enumerate() {
        let mut demonstration = Demonstration::new(&format!("pauses_{number}"));
        demonstration.tick(&[SceneCommand::Load("tablesetup/default.xml".into()).into()]);
        for commands in case {
            demonstration.tick(commands);
        }
        demonstration.tick(&[pause(false)]);
        demonstration.act(&[(Vec::new(), 20), (vec![RecordingCommand::Finish.into()], 1)]);
        assert_replays(&demonstration.folder);
    }
}
