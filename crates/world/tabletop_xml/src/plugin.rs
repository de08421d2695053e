//! Task files in the simulation.

use std::path::PathBuf;

use bevy::prelude::*;
use tabletop_core::{
    IssuedCommand, RestingSystems, SceneCommand, SceneFact, SceneSpec, ShippedFile, ShippedFiles,
    SimCommand, SimFact, SimSystems,
};

use crate::{ParsedTask, ReadError, TaskReader};

/// Carries out [`SceneCommand::Load`]: in [`SimSystems::Load`] the command becomes a [`SceneCommand::Set`] with
/// the content of the file, at the same place of the order, and a [`SceneFact::TaskLoaded`] reports its faults, which are
/// also logged. A file that cannot be read gives an empty table; a missing one may be among the [`ShippedFiles`].
#[derive(Clone, Copy, Debug, Default)]
pub struct XmlPlugin;

/// Folders in which, including their subfolders, task files may include files, besides their own.
#[derive(Resource, Clone, Debug, Default)]
pub struct AllowedFolders(pub Vec<PathBuf>);

impl Plugin for XmlPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<ShippedFiles>()
            .init_resource::<AllowedFolders>()
            .add_systems(
                FixedUpdate,
                load_tasks.in_set(SimSystems::Load).in_set(RestingSystems),
            );
    }
}

fn load_tasks(
    mut commands: MessageMutator<IssuedCommand>,
    mut facts: MessageWriter<SimFact>,
    shipped: Res<ShippedFiles>,
    allowed: Res<AllowedFolders>,
) {
    for IssuedCommand { id, command, .. } in commands.read() {
        if let SimCommand::Scene(SceneCommand::Load(path)) = command {
            let path = std::mem::take(path);
            let task = TaskReader::with_shipped(&shipped)
                .allowing(&allowed.0)
                .read(&path);
            let path = shipped.find(&path).map_or(path, ShippedFile::name);
            let (scene, faults) = scene_and_faults(task);
            *command = SimCommand::Scene(SceneCommand::Set(Box::new(scene)));
            let cause = *id;
            facts.write(SimFact::Scene(SceneFact::TaskLoaded {
                cause,
                path,
                faults,
            }));
        }
    }
}

fn scene_and_faults(task: Result<ParsedTask, ReadError>) -> (SceneSpec, Vec<String>) {
    match task {
        Ok(task) => {
            let faults: Vec<String> = task.faults.iter().map(ToString::to_string).collect();
            for fault in &faults {
                warn!("{fault}");
            }
            (task.scene, faults)
        }
        Err(error) => {
            error!("{error}");
            (SceneSpec::default(), vec![error.to_string()])
        }
    }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use tabletop_core::{
        ClockCommand, CommandId, CorePlugin, Paused, StepApp as _, WriteCommand as _,
    };

    use super::*;

    #[derive(Resource, Default)]
    struct SeenMessages {
        commands: Vec<SimCommand>,
        facts: Vec<SimFact>,
    }

    fn see(
        mut seen: ResMut<SeenMessages>,
        mut commands: MessageReader<IssuedCommand>,
        mut facts: MessageReader<SimFact>,
    ) {
        let issued = commands.read().cloned();
        seen.commands.extend(issued.map(|issued| issued.command));
        seen.facts.extend(facts.read().cloned());
    }

    fn app() -> App {
        let mut app = App::new();
        app.add_plugins((MinimalPlugins, CorePlugin::default(), XmlPlugin))
            .init_resource::<SeenMessages>()
            .add_systems(FixedUpdate, see.in_set(SimSystems::Ingest))
            .start();
        app
    }

    fn temporary_file(name: &str, text: &str) -> PathBuf {
        let path = std::env::temp_dir().join(format!("{}_{name}", std::process::id()));
        fs::write(&path, text).unwrap();
        path
    }

    #[test]
    fn a_file_becomes_a_scene_in_the_same_tick_also_while_paused() {
        let path = temporary_file(
            "plugin.xml",
            "<tabletop xmlns='http://synapse.cs.umd.edu/tabletop-xml' xspan='8'>\n<cube/>\
             <sphere location='(0,0,1)'/></tabletop>",
        );
        let mut app = app();
        app.insert_resource(Paused(true));
        app.world_mut().write_command(SceneCommand::Clear);
        app.world_mut()
            .write_command(SceneCommand::Load(path.clone()));
        app.world_mut().write_command(ClockCommand::SetPaused(true));
        app.step(1);
        let seen = app.world().resource::<SeenMessages>();
        let [
            SimCommand::Scene(SceneCommand::Clear),
            SimCommand::Scene(SceneCommand::Set(scene)),
            SimCommand::Clock(ClockCommand::SetPaused(true)),
        ] = seen.commands.as_slice()
        else {
            panic!("{:?}", seen.commands);
        };
        assert_eq!((scene.table.xspan, scene.items.len()), (8.0, 1));
        let [
            SimFact::Scene(SceneFact::TaskLoaded {
                cause: CommandId(1),
                path: loaded,
                faults,
            }),
        ] = seen.facts.as_slice()
        else {
            panic!("{:?}", seen.facts);
        };
        assert_eq!(*loaded, path);
        assert_eq!(faults.len(), 1);
        assert!(
            faults[0].starts_with(&format!("{}:2:1: cube: ", path.display())),
            "{faults:?}"
        );
        fs::remove_file(path).unwrap();
    }

    #[test]
    fn a_file_that_is_not_there_is_taken_from_the_program() {
        const CUBE: ShippedFile = ShippedFile {
            path: "tablesetup/plugin-cube.xml",
            text: "<tabletop xmlns='http://synapse.cs.umd.edu/tabletop-xml' xspan='8'/>",
        };
        let mut app = app();
        app.insert_resource(ShippedFiles::new([CUBE]));
        app.world_mut()
            .write_command(SceneCommand::Load(CUBE.path.into()));
        app.step(1);
        let seen = app.world().resource::<SeenMessages>();
        assert_eq!(
            seen.facts,
            [SimFact::Scene(SceneFact::TaskLoaded {
                cause: CommandId(0),
                path: CUBE.name(),
                faults: Vec::new(),
            })]
        );
        assert!(
            matches!(&seen.commands[..], [SimCommand::Scene(SceneCommand::Set(scene))] if scene.table.xspan == 8.0)
        );
    }

    #[test]
    fn a_file_is_loaded_once() {
        let mut app = app();
        app.world_mut()
            .write_command(SceneCommand::Load("missing.xml".into()));
        app.step(5);
        let seen = app.world().resource::<SeenMessages>();
        assert_eq!((seen.commands.len(), seen.facts.len()), (1, 1));
    }

    #[test]
    fn without_a_file_there_is_still_a_table() {
        let mut app = app();
        app.world_mut()
            .write_command(SceneCommand::Load("missing.xml".into()));
        app.step(1);
        let seen = app.world().resource::<SeenMessages>();
        assert_eq!(
            seen.commands,
            [SimCommand::Scene(SceneCommand::Set(Box::default()))]
        );
        let [SimFact::Scene(SceneFact::TaskLoaded { faults, .. })] = seen.facts.as_slice() else {
            panic!("{:?}", seen.facts);
        };
        assert!(
            faults[0].starts_with("missing.xml: it cannot be read: "),
            "{faults:?}"
        );
    }
}
