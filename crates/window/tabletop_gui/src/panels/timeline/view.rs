//! What the user looks at in the Timeline, and has selected.

use std::path::PathBuf;

use bevy::prelude::*;
use tabletop_core::SimTick;

use super::{selected_segments::SelectedSegments, zoom::Zoom};
use crate::pictures::Pictures;

/// The state of the panel.
#[derive(Resource, Default)]
pub(super) struct View {
    /// The moment that the user looks at, though the world is not there.
    pub looked_at: Option<SimTick>,
    /// The moment under the mouse while it drags.
    pub dragged_to: Option<SimTick>,
    pub pictures: Pictures,
    pub selection: SelectedSegments,
    pub zoom: Zoom,
    /// The recording of which a part is shown.
    pub zoomed: PathBuf,
}
