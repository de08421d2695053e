//! Plugins that need other plugins.

use std::any::type_name;

use bevy::prelude::*;

/// Logs an error if a plugin lacks another one, without which its systems are skipped. To be called once, in [`Plugin::finish`].
///
/// Returns whether it is there.
pub fn require<P: Plugin>(app: &App, plugin: &impl Plugin) -> bool {
    let is_there = app.is_plugin_added::<P>();
    if !is_there {
        error!(
            "{} needs {}: add that plugin, or nothing comes of this one",
            plugin.name(),
            type_name::<P>()
        );
    }
    is_there
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{CorePlugin, IdlePlugin};

    #[test]
    fn a_plugin_that_is_there_is_not_missed() {
        let mut app = App::new();
        app.add_plugins((MinimalPlugins, CorePlugin::default()));
        assert!(require::<CorePlugin>(&app, &IdlePlugin));
        assert!(!require::<IdlePlugin>(&app, &IdlePlugin));
    }
}
