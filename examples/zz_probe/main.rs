//! Temporary.
#![allow(missing_docs, clippy::print_stderr, clippy::allow_attributes_without_reason, clippy::allow_attributes)]
mod window;
use bevy::prelude::*;
use tabletop_core::*;

#[derive(Default)]
pub struct TabletopSimPlugins;
impl Plugin for TabletopSimPlugins {
    fn build(&self, app: &mut App) {
        app.add_plugins(CorePlugin::default())
            .add_systems(FixedUpdate, scene.in_set(SimSystems::Ingest))
            .add_systems(FixedUpdate, spin.in_set(SimSystems::Physics))
            .add_observer(|a: On<Add, UserCamera>, mut c: Commands| {
                let v = std::env::var("VAR").unwrap_or_default();
                if v.contains("nomsaa") { c.entity(a.entity).insert(Msaa::Off); }
                if v.contains("srgb") { c.entity(a.entity).insert(bevy::camera::CompositingSpace::Srgb); }
                if v.contains("frustum") { c.entity(a.entity).insert(bevy::camera::visibility::NoFrustumCulling); }
                if v.contains("nocpu") { c.entity(a.entity).insert(bevy::render::view::NoIndirectDrawing); }
            })
            .add_systems(Update, fps);
    }
}
#[derive(Component)]
struct Spin;
fn spin(mut q: Query<&mut Transform, With<Spin>>, tick: Res<SimTick>) {
    for mut t in &mut q {
        t.rotation = Quat::from_rotation_z(tick.0 as f32 / 60.0);
        t.translation.x = 4.0 + (tick.0 as f32 / 60.0).sin();
    }
}
fn fps(time: Res<Time<Real>>, mut n: Local<(u32, f32)>) {
    n.0 += 1;
    n.1 += time.delta_secs();
    if n.1 > 2.0 {
        eprintln!("fps {:.1}", n.0 as f32 / n.1);
        *n = (0, 0.0);
    }
}
fn scene(mut reader: MessageReader<SimCommand>, mut facts: MessageWriter<SimFact>, mut commands: Commands) {
    for c in reader.read() {
        let SimCommand::LoadTask(path) = c else { continue };
        commands.spawn(Table::default());
        let mut add = |loc: Vec3, yaw: f32, shape: Shape| {
            let pose = Pose::from_degrees(loc, Vec3::new(0.0, 0.0, yaw));
            commands
                .spawn((ObjectSpec { id: String::new(), pose, mass: 1.0, shape, descriptions: vec![] }, Transform::from(pose)))
                .id()
        };
        let red = Rgb::new(1.0, 0.0, 0.0);
        let green = Rgb::new(0.0, 1.0, 0.0);
        let blue = Rgb::new(0.0, 0.0, 1.0);
        let orange: Rgb = "orange".parse().unwrap();
        add(Vec3::new(2.0, 0.0, 1.0), -15.0, Shape::Block { span: Vec3::splat(2.0), color: red });
        add(Vec3::new(-2.0, 0.0, 1.0), 45.0, Shape::Block { span: Vec3::splat(2.0), color: green });
        add(Vec3::new(-6.0, 2.0, 1.0), 0.0, Shape::Sphere { radius: 1.0, color: blue });
        add(Vec3::new(-6.0, -3.0, 0.75), 30.0, Shape::Cylinder { radius: 0.75, yspan: 3.0, color: orange });
        add(Vec3::new(6.5, -3.0, 1.5), 10.0, Shape::Box { span: Vec3::new(4.0, 4.0, 3.0), thickness: 0.3, color: Rgb::GRAY });
        let hammer = Shape::Composite { parts: vec![
            Part { id: "handle".into(), pose: Pose::IDENTITY, shape: Shape::Cylinder { radius: 0.2, yspan: 4.0, color: "brown".parse().unwrap() } },
            Part { id: "head".into(), pose: Pose::from_degrees(Vec3::Y * 2.0, Vec3::new(0.0, 0.0, 90.0)), shape: Shape::Cylinder { radius: 0.5, yspan: 1.6, color: "darkgray".parse().unwrap() } },
        ]};
        let h = add(Vec3::new(4.0, 3.5, 0.6), 40.0, hammer);
        commands.entity(h).insert(Spin);
        if let Ok(n) = std::env::var("MANY") {
            for i in 0..n.parse::<u32>().unwrap() {
                commands.spawn((ObjectSpec { id: String::new(), pose: Pose::IDENTITY, mass: 1.0, descriptions: vec![],
                    shape: Shape::Block { span: Vec3::splat(0.3), color: if i % 2 == 0 { red } else { blue } } },
                    Transform::from_xyz((i % 25) as f32 * 0.7 - 9.0, (i / 25) as f32 * 0.5 - 5.0, 3.0)));
            }
        }
        let faults = if std::env::var("FAULTS").is_ok() {
            vec![format!("{}:12:5: <blok> is not an element; did you mean <block>?", path.display()), "default.xml:14:9: attribute `colour` is unknown; did you mean `color`?".into()]
        } else { vec![] };
        facts.write(SimFact::TaskLoaded { path: path.clone(), faults });
    }
}
fn main() -> AppExit {
    let args: Vec<String> = std::env::args().collect();
    let screenshot = args.get(1).map(|p| window::ScreenshotAt { path: p.into(), seconds: args[2].parse().unwrap() });
    match window::run(window::WindowOptions { setup: "tablesetup/default.xml".into(), screenshot }) {
        Ok(exit) => exit,
        Err(e) => { eprintln!("{e}"); AppExit::from_code(7) }
    }
}
