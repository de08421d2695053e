//! Redrawing of the window, only when there is something new to see.
//!
//! After each frame of the main world, the visible state is summed up ([`Appearance`]). If it looks as in the last picture, that
//! picture stays: nothing is extracted, rendered or presented.

mod cause;
mod sight;

use std::time::{Duration, Instant};

use bevy::{
    gizmos::{GizmoMeshSystems, config::GizmoConfigStore},
    prelude::*,
    render::{pipelined_rendering::RenderExtractApp, view::screenshot::Screenshot},
    time::TimeReceiver,
    window::WindowEvent,
};
use tabletop_gui::PictureStatus;
use tabletop_view::Surface;

use self::{
    cause::RedrawCause,
    sight::{Appearance, DrawnQueries},
};
use super::{frame_rate::FrameRate, picture_times::PictureTimes};

/// Number of frames that are always drawn at the start.
const STARTING: u32 = 5;

/// Number of further frames after a change: some of it reaches the graphics card a frame late.
const SETTLING: u32 = 3;

/// Time after which an unchanged picture is drawn again: without a compositor, other windows wipe the parts that they cover.
const REFRESH: Duration = Duration::from_secs(5);

/// Time without motion after which a picture is still.
const STILL: Duration = Duration::from_millis(500);

/// True if the present frame is drawn.
#[derive(Resource, Debug, Default)]
pub(super) struct Redraw {
    cause: Option<RedrawCause>,
    sight: Appearance,
    /// Number of frames to be drawn in any case.
    left: u32,
    drawn_at: Duration,
    moved_at: Duration,
    news_at: Duration,
    frames: u32,
}

impl Redraw {
    /// True if the present frame is drawn.
    fn is_due(&self) -> bool {
        self.cause.is_some()
    }

    /// Time for which the user has seen nothing new.
    pub fn idle_for(&self, now: Duration) -> Duration {
        now.saturating_sub(self.news_at)
    }

    /// The time of the last motion in the picture.
    pub const fn moved_at(&self) -> Duration {
        self.moved_at
    }

    /// Decides about a frame by the visible state, by events that it does not show, and by the time since the start.
    fn decide(&mut self, sight: Appearance, events: [Option<RedrawCause>; 2], now: Duration) {
        self.frames = self.frames.saturating_add(1);
        let start = (self.frames <= STARTING).then_some(RedrawCause::Start);
        let difference = sight.difference(&self.sight);
        let settling = (self.left > 0).then_some(RedrawCause::Settling);
        let refresh = (now >= self.drawn_at + REFRESH).then_some(RedrawCause::Refresh);
        let [event, asset] = events;
        let causes = [start, event, difference, asset, settling, refresh];
        let mut causes = causes.into_iter().flatten().peekable();
        self.cause = causes.peek().copied();
        if self.cause.is_some() {
            self.sight = sight;
            self.drawn_at = now;
            self.left = self.left.saturating_sub(1);
        }
        for cause in causes {
            if cause.needs_settling() {
                self.left = SETTLING;
            }
            if cause.is_motion() {
                self.moved_at = now;
            }
            if cause.is_event() {
                self.news_at = now;
            }
        }
    }
}

/// The change of assets since the last frame.
#[derive(Resource, Default)]
struct AssetChange(Option<RedrawCause>);

/// Draws the frames that show something new, and only those. Needs pipelined rendering, which Bevy has wherever there are threads.
pub(super) fn plugin(app: &mut App) {
    app.init_resource::<Redraw>()
        .init_resource::<AssetChange>()
        .add_systems(Last, decide.after(GizmoMeshSystems));
    watch_assets::<Image>(app, RedrawCause::Texture);
    watch_assets::<Mesh>(app, RedrawCause::Asset);
    watch_assets::<Shader>(app, RedrawCause::Asset);
    watch_assets::<Surface>(app, RedrawCause::Asset);
    draw_when_due(app);
}

/// Changes of this kind of asset are seen.
fn watch_assets<A: Asset>(app: &mut App, cause: RedrawCause) {
    let note = move |mut change: ResMut<AssetChange>| {
        // A texture must not hide a change that needs settling.
        if change.0 != Some(RedrawCause::Asset) {
            change.0 = Some(cause);
        }
    };
    app.add_systems(
        Last,
        note.run_if(on_message::<AssetEvent<A>>).before(decide),
    );
}

fn decide(
    drawn: DrawnQueries,
    screenshots: Query<(), With<Screenshot>>,
    line_config: Res<GizmoConfigStore>,
    mut events: MessageReader<WindowEvent>,
    mut assets: ResMut<AssetChange>,
    time: Res<Time<Real>>,
    mut redraw: ResMut<Redraw>,
    mut picture: ResMut<PictureStatus>,
) {
    let is_uncovered = events.read().filter(|event| may_uncover(event)).count() > 0;
    let event = [
        (is_uncovered, RedrawCause::Window),
        (line_config.is_changed(), RedrawCause::Lines),
        (!screenshots.is_empty(), RedrawCause::Screenshot),
    ]
    .into_iter()
    .find_map(|(happened, cause)| happened.then_some(cause));
    let asset = assets.0.take();
    redraw.decide(drawn.sight(), [event, asset], time.elapsed());
    picture.is_still = time.elapsed() > redraw.moved_at + STILL;
    if let Some(cause) = redraw.cause {
        trace!("drawn because of {cause:?}");
    }
}

/// True if the window may afterwards show something other than its own picture.
fn may_uncover(event: &WindowEvent) -> bool {
    matches!(
        event,
        WindowEvent::AppLifecycle(_)
            | WindowEvent::CursorEntered(_)
            | WindowEvent::WindowCreated(_)
            | WindowEvent::WindowFocused(_)
            | WindowEvent::WindowMoved(_)
            | WindowEvent::WindowOccluded(_)
            | WindowEvent::WindowResized(_)
    )
}

fn draw_when_due(app: &mut App) {
    let Some(renderer) = app.get_sub_app_mut(RenderExtractApp) else {
        return;
    };
    let Some(mut draw) = renderer.take_extract() else {
        return;
    };
    renderer.set_extract(move |main, renderer| {
        if main.resource::<Redraw>().is_due() {
            let waiting_since = Instant::now();
            draw(main, renderer);
            main.resource_mut::<PictureTimes>()
                .note(waiting_since, Instant::now());
            main.resource_mut::<PictureStatus>().drawn += 1;
        }
        // Here, and not at the end of a frame: the picture is being drawn meanwhile, and the user's next act is still read in time.
        main.resource_mut::<FrameRate>().wait();
    });
    // The renderer reports the time of each frame it has drawn; without frames, Bevy's clock would complain in every frame.
    app.world_mut().remove_resource::<TimeReceiver>();
}

#[cfg(test)]
mod tests {
    use super::*;
    use bevy::{
        gizmos::{GizmoAsset, GizmoHandles},
        time::TimeUpdateStrategy,
        window::{CursorMoved, PrimaryWindow, WindowFocused},
    };
    use bevy_egui::{
        EguiRenderOutput,
        egui::{ClippedPrimitive, Mesh as PanelMesh, Rect, epaint::Primitive},
    };

    const FRAME: Duration = Duration::from_millis(10);

    fn app() -> App {
        let mut app = App::new();
        app.add_plugins(MinimalPlugins)
            .insert_resource(TimeUpdateStrategy::ManualDuration(FRAME))
            .init_resource::<GizmoHandles>()
            .init_resource::<GizmoConfigStore>()
            .init_resource::<Assets<GizmoAsset>>()
            .init_resource::<PictureStatus>()
            .add_message::<WindowEvent>()
            .add_message::<AssetEvent<Mesh>>()
            .add_message::<AssetEvent<Image>>()
            .add_message::<AssetEvent<Shader>>()
            .add_message::<AssetEvent<Surface>>()
            .add_plugins(plugin);
        app.world_mut().spawn((Window::default(), PrimaryWindow));
        app.world_mut().spawn((Camera3d::default(), Msaa::Off));
        app.world_mut()
            .spawn((Mesh3d::default(), ViewVisibility::VISIBLE));
        app.world_mut().spawn(EguiRenderOutput::default());
        app
    }

    /// An app whose first frames are over.
    fn still_app() -> App {
        let mut app = app();
        causes(&mut app, 20);
        assert_eq!(causes(&mut app, 3), [None; 3]);
        app
    }

    fn causes(app: &mut App, frames: usize) -> Vec<Option<RedrawCause>> {
        let mut frame = || {
            app.update();
            app.world().resource::<Redraw>().cause
        };
        (0..frames).map(|_| frame()).collect()
    }

    /// Frames after a change of the drawn shapes.
    const MOTION: [Option<RedrawCause>; 4] = [
        Some(RedrawCause::Settling),
        Some(RedrawCause::Settling),
        Some(RedrawCause::Settling),
        None,
    ];

    #[test]
    fn the_first_frames_are_drawn_and_then_those_that_show_something_new() {
        let drawn = causes(&mut app(), 12);
        assert!(
            drawn[..5]
                .iter()
                .all(|cause| *cause == Some(RedrawCause::Start))
        );
        assert_eq!(drawn[5..9], MOTION);
        assert_eq!(drawn[9..], [None; 3]);
    }

    #[test]
    fn a_change_of_anything_that_is_seen_is_drawn() {
        let changes: [(RedrawCause, fn(&mut World)); 11] = [
            (RedrawCause::Scene, |world| {
                let mut things = world.query_filtered::<&mut GlobalTransform, With<Mesh3d>>();
                *things.single_mut(world).unwrap() = Transform::from_xyz(0.0, 0.0, 1e-3).into();
            }),
            (RedrawCause::Scene, |world| {
                world.spawn((Mesh3d::default(), ViewVisibility::VISIBLE));
            }),
            (RedrawCause::Scene, |world| {
                let mut things = world.query_filtered::<Entity, With<Mesh3d>>();
                let thing = things.single(world).unwrap();
                world.despawn(thing);
            }),
            (RedrawCause::Scene, |world| {
                let mut things = world.query_filtered::<&mut ViewVisibility, With<Mesh3d>>();
                *things.single_mut(world).unwrap() = ViewVisibility::HIDDEN;
            }),
            (RedrawCause::Camera, |world| {
                let mut cameras = world.query_filtered::<&mut GlobalTransform, With<Camera>>();
                *cameras.single_mut(world).unwrap() = Transform::from_xyz(1.0, 0.0, 0.0).into();
            }),
            (RedrawCause::Camera, |world| {
                let mut cameras = world.query::<&mut Msaa>();
                *cameras.single_mut(world).unwrap() = Msaa::Sample4;
            }),
            (RedrawCause::Window, |world| {
                let mut windows = world.query::<&mut Window>();
                let mut window = windows.single_mut(world).unwrap();
                window.resolution.set_physical_resolution(300, 200);
            }),
            (RedrawCause::Window, |world| {
                let window = Entity::PLACEHOLDER;
                world.write_message(WindowEvent::WindowFocused(WindowFocused {
                    window,
                    focused: true,
                }));
            }),
            (RedrawCause::Asset, |world| {
                let id = AssetId::<Mesh>::default();
                world.write_message(AssetEvent::Modified { id });
            }),
            (RedrawCause::Texture, |world| {
                let id = AssetId::<Image>::default();
                world.write_message(AssetEvent::Modified { id });
            }),
            (RedrawCause::Lines, |world| {
                world.resource_mut::<GizmoConfigStore>().set_changed();
            }),
        ];
        for (cause, change) in changes {
            let mut app = still_app();
            change(app.world_mut());
            let drawn = causes(&mut app, 5);
            assert_eq!(drawn[0], Some(cause));
            assert_eq!(drawn[4], None, "{cause:?}");
        }
    }

    #[test]
    fn trembling_is_not_drawn_and_creeping_is() {
        let mut app = still_app();
        let mut put = |z: f32| {
            let world = app.world_mut();
            let mut things = world.query_filtered::<&mut GlobalTransform, With<Mesh3d>>();
            *things.single_mut(world).unwrap() = Transform::from_xyz(0.0, 0.0, z).into();
            causes(&mut app, 1)[0]
        };
        for number in 0..20 {
            assert_eq!(put(5e-5 * (number % 2) as f32), None);
        }
        let crept = (0..20).filter_map(|number| put(2e-5 * number as f32));
        assert!(crept.count() > 0);
    }

    #[test]
    fn panels_are_drawn_once_when_they_look_different() {
        let mut app = still_app();
        let mut draw = |x: f32| {
            let world = app.world_mut();
            let mut outputs = world.query::<&mut EguiRenderOutput>();
            let mut mesh = PanelMesh::default();
            mesh.colored_vertex([x, 0.0].into(), default());
            outputs.single_mut(world).unwrap().paint_jobs = vec![ClippedPrimitive {
                clip_rect: Rect::EVERYTHING,
                primitive: Primitive::Mesh(mesh),
            }];
            causes(&mut app, 2)
        };
        assert_eq!(draw(1.0), [Some(RedrawCause::Panels), None]);
        assert_eq!(draw(1.0), [None, None]);
        assert_eq!(draw(2.0), [Some(RedrawCause::Panels), None]);
    }

    #[test]
    fn a_mouse_over_an_unchanged_picture_draws_nothing() {
        let mut app = still_app();
        app.world_mut()
            .write_message(WindowEvent::CursorMoved(CursorMoved {
                window: Entity::PLACEHOLDER,
                position: Vec2::ONE,
                delta: None,
            }));
        assert_eq!(causes(&mut app, 2), [None, None]);
    }

    #[test]
    fn a_waiting_screenshot_gets_a_picture() {
        let mut app = still_app();
        let screenshot = app.world_mut().spawn(Screenshot::primary_window()).id();
        assert_eq!(causes(&mut app, 3), [Some(RedrawCause::Screenshot); 3]);
        app.world_mut().despawn(screenshot);
        assert_eq!(causes(&mut app, 4), MOTION);
    }

    #[test]
    fn an_old_picture_is_drawn_again() {
        let mut app = still_app();
        let frames = (REFRESH.as_millis() / FRAME.as_millis()) as usize;
        let drawn = causes(&mut app, 2 * frames);
        let refreshed: Vec<_> = drawn.iter().flatten().collect();
        assert_eq!(refreshed, [&RedrawCause::Refresh; 2]);
    }

    #[test]
    fn a_picture_is_still_when_only_panels_have_changed_for_a_while() {
        let mut app = still_app();
        causes(&mut app, 60);
        let id = AssetId::<Image>::default();
        app.world_mut().write_message(AssetEvent::Modified { id });
        causes(&mut app, 1);
        assert!(app.world().resource::<PictureStatus>().is_still);
        app.world_mut()
            .spawn((Mesh3d::default(), ViewVisibility::VISIBLE));
        causes(&mut app, 1);
        assert!(!app.world().resource::<PictureStatus>().is_still);
    }
}
