//! In which order the commands of a tick are carried out.

use tabletop_core::SimCommand;

/// The commands of a tick that take effect before any that hands carry out, and before the clock is turned; and the others.
pub(crate) fn in_order(commands: &[SimCommand]) -> (Vec<SimCommand>, Vec<SimCommand>) {
    commands.iter().cloned().partition(is_carried_out_first)
}

fn is_carried_out_first(command: &SimCommand) -> bool {
    matches!(
        command,
        SimCommand::LoadTask(_)
            | SimCommand::SetScene(_)
            | SimCommand::ClearTable
            | SimCommand::Make { .. }
            | SimCommand::SetPaused(_)
    )
}

/// Whether a command sets the world back to another tick.
pub(crate) fn turns_the_clock(command: &SimCommand) -> bool {
    matches!(command, SimCommand::Undo | SimCommand::Redo)
}

/// Whether a command is about recordings, and none that a recording holds.
pub(crate) fn is_about_recordings(command: &SimCommand) -> bool {
    turns_the_clock(command)
        || matches!(
            command,
            SimCommand::StartRecording | SimCommand::FinishRecording
        )
}
