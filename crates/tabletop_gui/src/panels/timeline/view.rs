//! What the user looks at in the Timeline, and has selected.

use bevy::prelude::*;
use tabletop_core::SimTick;

use super::{pictures::Pictures, selected_segments::SelectedSegments};

/// The state of the panel.
#[derive(Resource, Default)]
pub(super) struct View {
    /// The moment that the user looks at, though the world is not there.
    pub looked_at: Option<SimTick>,
    /// The moment under the mouse while it drags.
    pub dragged_to: Option<SimTick>,
    pub pictures: Pictures,
    pub selection: SelectedSegments,
}
