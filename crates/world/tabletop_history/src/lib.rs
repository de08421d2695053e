//! Undo and redo: the world as it was at the beginning of a recording's segment, bit for bit.
//!
//! Each plugin registers its own part, as in `bevy_ggrs`: components of the entities marked [`Rollback`](tabletop_core::Rollback),
//! resources, and any other state on which later ticks depend ([`RollbackState`]). While a recording runs, or [always](HistoryPlugin::keeps_always), [`begin_segment`]
//! keeps a [`WorldSnapshot`]; [`HistoryCommand`](tabletop_core::HistoryCommand)s
//! go back and forth between these. Snapshots share unchanged parts.
//!
//! ```
//! use bevy::prelude::*;
//! use tabletop_core::{CommandId, Recording, Rollback, prelude::*};
//! use tabletop_history::{HistoryPlugin, RollbackApp, begin_segment};
//!
//! #[derive(Component, Clone, Copy, Debug, PartialEq)]
//! struct Switch(bool);
//!
//! let mut app = App::new();
//! app.add_plugins((MinimalPlugins, CorePlugin::default(), HistoryPlugin::default()))
//!     .rollback_component::<Switch>()
//!     .start();
//! app.insert_resource(Recording(true));
//! let switch = app.world_mut().spawn((Rollback, Switch(false))).id();
//!
//! begin_segment(app.world_mut(), CommandId(0));
//! app.world_mut().entity_mut(switch).insert(Switch(true));
//! app.world_mut().write_command(HistoryCommand::Undo);
//! app.step(1);
//! assert_eq!(app.world().get(switch), Some(&Switch(false)));
//! ```

#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

mod removal;
mod rollback;
mod segments;
mod snapshot;

pub use removal::{KeepRemoved, Parked, despawn_or_park, drop_removed};
pub use rollback::{
    RollbackApp, RollbackRegistry, RollbackState, RollingBack, Since, is_rolling_back,
};
pub use segments::{begin_change, begin_segment};
pub use snapshot::WorldSnapshot;

/// The names that most users of this crate need.
pub mod prelude {
    #[doc(hidden)]
    pub use crate::{HistoryPlugin, RollbackApp, begin_segment, despawn_or_park, is_rolling_back};
}

use bevy::{prelude::*, transform::components::TransformTreeChanged};
use tabletop_core::{CommandSystems, Hands, Held, Markers, ObjectIndex, RestingSystems, SimTick};

use crate::segments::{Segments, undo_and_redo};

/// Adds undo and redo. Needs [`CorePlugin`](tabletop_core::CorePlugin), whose types it registers for rollback.
#[derive(Clone, Copy, Debug)]
pub struct HistoryPlugin {
    /// Limit on the memory of snapshots, in bytes. Beyond it, the oldest segment can no longer be undone.
    pub most_bytes: usize,
    /// True if changes outside recordings can be undone, too. A recording that begins or ends forgets what was before.
    pub keeps_always: bool,
}

impl HistoryPlugin {
    /// 512 MB.
    pub const DEFAULT: Self = Self {
        most_bytes: 512 * 1024 * 1024,
        keeps_always: false,
    };
}

impl Default for HistoryPlugin {
    fn default() -> Self {
        Self::DEFAULT
    }
}

impl Plugin for HistoryPlugin {
    fn build(&self, app: &mut App) {
        app.register_type::<KeepRemoved>()
            .register_type::<Parked>()
            .insert_resource(Segments::new(self.most_bytes, self.keeps_always))
            .init_resource::<KeepRemoved>()
            .rollback_component::<Transform>()
            .rollback_component::<GlobalTransform>()
            .rollback_component::<Held>()
            .derived_component::<Children>()
            .derived_component::<TransformTreeChanged>()
            .rollback_resource::<Hands>()
            .rollback_resource::<Markers>()
            .rollback_resource::<ObjectIndex>()
            .rollback_resource::<SimTick>()
            .add_systems(
                FixedUpdate,
                undo_and_redo
                    .in_set(CommandSystems::History)
                    .in_set(RestingSystems),
            );
    }
}
