//! A recording as an episode: frames, actions and sentences.

use crate::demonstration::episode;

#[test]
fn an_episode_has_a_frame_every_quarter_of_a_second() {
    let episode = episode();
    assert_eq!(episode.fps, 4);
    let steps: Vec<_> = episode
        .ticks
        .windows(2)
        .map(|two| two[1].0 - two[0].0)
        .collect();
    let (last, others) = steps.split_last().unwrap();
    assert!(others.iter().all(|step| *step == 15), "{steps:?}");
    assert!(*last <= 15);
    assert_eq!(episode.cameras.len(), 1);
    assert_eq!(episode.cameras[0].images.len(), episode.len());
    assert_eq!(episode.state.frames().len(), episode.len());
    assert_eq!(episode.action.frames().len(), episode.len());
}

#[test]
fn the_actions_of_a_hand_lead_from_place_to_place() {
    let episode = episode();
    let column = |names: &[String], name: &str| names.iter().position(|it| it == name).unwrap();
    let x = column(&episode.state.names, "right_hand.x");
    let dx = column(&episode.action.names, "right_hand.dx");
    let grip = column(&episode.action.names, "right_hand.grip");
    let states: Vec<_> = episode.state.frames().map(|frame| frame[x]).collect();
    let actions: Vec<_> = episode.action.frames().collect();
    for (two, action) in states.windows(2).zip(&actions) {
        assert!((two[0] + action[dx] - two[1]).abs() < 1e-5);
    }
    assert!(actions.iter().any(|action| action[grip] == 1.0));
    assert_eq!(actions.last().unwrap()[grip], 0.0);
}

#[test]
fn the_task_is_told_as_a_whole_and_in_parts() {
    let episode = episode();
    assert_eq!(episode.task, "Put the red block on the green block.");
    let parts: Vec<_> = episode
        .subtasks
        .iter()
        .map(|part| part.sentence.as_str())
        .collect();
    assert_eq!(
        parts,
        ["pick up the red block", "put it on the green block"]
    );
    assert_eq!(episode.subtasks[0].frame, 0);
    assert!(episode.subtasks[1].frame > 0);
    assert!(!episode.paraphrases.is_empty());
    assert!(!episode.paraphrases.contains(&episode.task));
}
