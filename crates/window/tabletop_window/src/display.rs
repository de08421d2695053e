//! The display of the window: the choices that the display offers, and the user's choice on the command line, in the display settings
//! (report 2.3) or in an earlier run.

use std::num::NonZeroU32;

use bevy::{
    math::DVec2,
    prelude::*,
    render::{
        render_resource::TextureFormat,
        renderer::{RenderAdapter, RenderAdapterInfo, RenderDevice},
        settings::WgpuFeatures,
    },
    window::{
        Monitor, MonitorSelection, PresentMode, PrimaryMonitor, PrimaryWindow, VideoMode,
        VideoModeSelection, WindowMode,
    },
};
use tabletop_gui::{
    Renderer,
    display::{Antialiasing, DisplayOffer, DisplaySettings, Resolution, ScreenMode},
};
use tabletop_user::{Action, KeySystems, UserCamera, was_struck};
use wgpu_types::DeviceType;

use super::frame_rate::FrameRate;

/// Display options of the command line. Missing ones are as in the last run.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct DisplayOptions {
    /// The size of the window, or of the screen if the window fills it.
    pub resolution: Option<Resolution>,
    /// True if the window fills the screen.
    pub fullscreen: Option<bool>,
    /// True if pictures wait for the screen.
    pub vsync: Option<bool>,
    /// Largest number of pictures a second.
    pub refresh_rate: Option<NonZeroU32>,
    /// Bits of a pixel's colour.
    pub color_depth: Option<u16>,
    /// The smoothing of edges.
    pub antialiasing: Option<Antialiasing>,
    /// True if the user is asked for all of this. By default he is asked unless there is an option above or a choice from the last run.
    pub ask: Option<bool>,
}

impl DisplayOptions {
    /// These settings, replaced by those of the command line.
    pub(super) fn over(&self, settings: DisplaySettings) -> DisplaySettings {
        DisplaySettings {
            resolution: self.resolution.unwrap_or(settings.resolution),
            fullscreen: self.fullscreen.unwrap_or(settings.fullscreen),
            vsync: self.vsync.unwrap_or(settings.vsync),
            refresh_rate: self.refresh_rate.unwrap_or(settings.refresh_rate),
            color_depth: self.color_depth.unwrap_or(settings.color_depth),
            antialiasing: self.antialiasing.unwrap_or(settings.antialiasing),
            ask: settings.ask,
        }
    }

    /// True if the user is asked.
    pub(super) fn asks(&self, remembered: Option<DisplaySettings>) -> bool {
        let says_nothing = Self { ask: None, ..*self } == Self::default();
        self.ask
            .unwrap_or(says_nothing && remembered.unwrap_or_default().ask)
    }
}

/// Applies the settings to the window whenever they change.
pub(super) fn plugin(app: &mut App) {
    app.add_systems(
        Update,
        (
            shape_window.run_if(resource_exists_and_changed::<DisplaySettings>),
            smooth_edges.run_if(resource_exists::<DisplaySettings>),
        ),
    )
    .add_systems(
        RunFixedMainLoop,
        fill_screen
            .in_set(KeySystems)
            .run_if(was_struck(Action::FillScreen)),
    );
}

/// Makes the window fill the screen in its present mode, or no longer.
fn fill_screen(window: Single<&mut Window, With<PrimaryWindow>>) {
    let mut window = window.into_inner();
    window.mode = match window.mode {
        WindowMode::Windowed => WindowMode::BorderlessFullscreen(MonitorSelection::Current),
        WindowMode::BorderlessFullscreen(_) | WindowMode::Fullscreen(..) => WindowMode::Windowed,
    };
}

fn shape_window(
    mut shaped: Local<Option<(Resolution, Option<ScreenMode>)>>,
    settings: Res<DisplaySettings>,
    mut frame_rate: ResMut<FrameRate>,
    window: Single<&mut Window, With<PrimaryWindow>>,
    monitors: Query<(Entity, &Monitor, Has<PrimaryMonitor>)>,
) {
    let mut window = window.into_inner();
    *frame_rate = FrameRate::of(settings.refresh_rate);
    window.present_mode = match settings.vsync {
        true => PresentMode::AutoVsync,
        false => PresentMode::AutoNoVsync,
    };
    // The user's own size of the window stays until he chooses another in the settings.
    let shape = (
        settings.resolution,
        settings.fullscreen.then(|| settings.mode()),
    );
    if shaped.replace(shape) == Some(shape) {
        return;
    }
    window.mode = window_mode(&settings, present_monitor(&monitors));
    if window.mode == WindowMode::Windowed {
        let Resolution { width, height } = settings.resolution;
        window.resolution.set(width as f32, height as f32);
    }
}

/// The screen's own mode needs no switching, and other windows can be seen before this one.
fn window_mode(settings: &DisplaySettings, monitor: Option<(Entity, &Monitor)>) -> WindowMode {
    let Some((entity, monitor)) = monitor.filter(|_| settings.fullscreen) else {
        return WindowMode::Windowed;
    };
    let selection = MonitorSelection::Entity(entity);
    let asked = settings.mode();
    let found = monitor
        .video_modes
        .iter()
        .find(|mode| screen_mode(mode) == asked);
    match found {
        Some(mode) if asked != present_mode(monitor) => {
            WindowMode::Fullscreen(selection, VideoModeSelection::Specific(*mode))
        }
        _ => WindowMode::BorderlessFullscreen(selection),
    }
}

fn smooth_edges(settings: Res<DisplaySettings>, mut cameras: Query<&mut Msaa, With<UserCamera>>) {
    let msaa = match settings.antialiasing {
        Antialiasing::Off => Msaa::Off,
        Antialiasing::X2 => Msaa::Sample2,
        Antialiasing::X4 => Msaa::Sample4,
        Antialiasing::X8 => Msaa::Sample8,
    };
    for mut camera in &mut cameras {
        camera.set_if_neq(msaa);
    }
}

/// The choices that the screens and the graphics driver offer.
pub(super) fn offer(
    monitors: Query<(Entity, &Monitor, Has<PrimaryMonitor>)>,
    adapter: Res<RenderAdapter>,
    device: Res<RenderDevice>,
    renderer: Res<Renderer>,
) -> DisplayOffer {
    let monitor = present_monitor(&monitors).map(|(_, monitor)| monitor);
    DisplayOffer {
        desktop: monitor.map_or(UNKNOWN_SCREEN.resolution, desktop),
        screen: monitor.map_or(UNKNOWN_SCREEN, present_mode),
        modes: monitor.map_or_else(Vec::new, |monitor| {
            monitor.video_modes.iter().map(screen_mode).collect()
        }),
        antialiasing: Antialiasing::ALL
            .into_iter()
            .filter(|antialiasing| can_draw(antialiasing.samples(), &adapter, &device))
            .collect(),
        is_software: renderer.is_software,
    }
}

/// The renderer: a graphics card or the processor.
pub(super) fn renderer(info: Res<RenderAdapterInfo>) -> Renderer {
    Renderer {
        name: info.name.clone(),
        is_software: info.device_type == DeviceType::Cpu,
    }
}

/// A screen of unknown modes: nothing is too large for it.
const UNKNOWN_SCREEN: ScreenMode = ScreenMode {
    resolution: Resolution::new(u32::MAX, u32::MAX),
    refresh_rate: SIXTY,
    color_depth: 24,
};

const SIXTY: NonZeroU32 = NonZeroU32::new(60).expect("it is not zero");

/// The screen on which windows appear.
fn present_monitor<'a>(
    monitors: &'a Query<(Entity, &Monitor, Has<PrimaryMonitor>)>,
) -> Option<(Entity, &'a Monitor)> {
    let monitor = monitors.iter().max_by_key(|(.., is_primary)| *is_primary);
    monitor.map(|(entity, monitor, _)| (entity, monitor))
}

/// Upper left corner, in pixels, of a window in the middle of the screen.
pub(super) fn centered(
    window: In<Resolution>,
    monitors: Query<(Entity, &Monitor, Has<PrimaryMonitor>)>,
) -> Option<IVec2> {
    let (_, monitor) = present_monitor(&monitors)?;
    let desktop = desktop(monitor);
    let size = |Resolution { width, height }| DVec2::new(width.into(), height.into());
    let margin = (size(desktop) - size(*window)) / 2.0;
    let margin = margin.max(DVec2::ZERO) * scale(monitor);
    Some(monitor.physical_position + margin.as_ivec2())
}

fn desktop(monitor: &Monitor) -> Resolution {
    let size = monitor.physical_size().as_dvec2() / scale(monitor);
    Resolution::new(size.x as u32, size.y as u32)
}

/// Pixels of a point. A screen of unknown size says 0.
fn scale(monitor: &Monitor) -> f64 {
    match monitor.scale_factor {
        scale if scale > 0.0 => scale,
        _ => 1.0,
    }
}

/// The present mode of a screen.
fn present_mode(monitor: &Monitor) -> ScreenMode {
    let size = monitor.physical_size();
    let resolution = Resolution::new(size.x, size.y);
    let refresh_rate = monitor.refresh_rate_millihertz.map_or(SIXTY, hertz);
    let modes = monitor.video_modes.iter().map(screen_mode);
    let color_depth = modes
        .filter(|mode| (mode.resolution, mode.refresh_rate) == (resolution, refresh_rate))
        .map(|mode| mode.color_depth)
        .max();
    ScreenMode {
        resolution,
        refresh_rate,
        color_depth: color_depth.unwrap_or(UNKNOWN_SCREEN.color_depth),
    }
}

fn screen_mode(mode: &VideoMode) -> ScreenMode {
    ScreenMode {
        resolution: Resolution::new(mode.physical_size.x, mode.physical_size.y),
        refresh_rate: hertz(mode.refresh_rate_millihertz),
        color_depth: mode.bit_depth,
    }
}

fn hertz(millihertz: u32) -> NonZeroU32 {
    let hertz = (u64::from(millihertz) + 500) / 1000;
    u32::try_from(hertz)
        .ok()
        .and_then(NonZeroU32::new)
        .unwrap_or(SIXTY)
}

/// True if the graphics driver can draw the window and its depth with this many samples per pixel.
fn can_draw(samples: u32, adapter: &RenderAdapter, device: &RenderDevice) -> bool {
    // Numbers of samples that all drivers can. For more, the device has to be asked for the adapter's abilities.
    const ALWAYS: [u32; 2] = [1, 4];
    let drawn = [
        TextureFormat::Rgba8UnormSrgb,
        TextureFormat::Bgra8UnormSrgb,
        TextureFormat::Depth32Float,
    ];
    let asks_adapter = WgpuFeatures::TEXTURE_ADAPTER_SPECIFIC_FORMAT_FEATURES;
    ALWAYS.contains(&samples)
        || device.features().contains(asks_adapter)
            && drawn.into_iter().all(|format| {
                let offered = adapter.get_texture_format_features(format);
                offered.flags.sample_count_supported(samples)
            })
}

#[cfg(test)]
mod tests {
    use tabletop_core::CorePlugin;
    use tabletop_user::UserPlugin;

    use super::*;

    fn video_mode(width: u32, height: u32, millihertz: u32) -> VideoMode {
        VideoMode {
            physical_size: UVec2::new(width, height),
            bit_depth: 24,
            refresh_rate_millihertz: millihertz,
        }
    }

    fn monitor() -> Monitor {
        Monitor {
            name: None,
            physical_width: 1920,
            physical_height: 1080,
            physical_position: IVec2::ZERO,
            refresh_rate_millihertz: Some(59_940),
            scale_factor: 1.0,
            video_modes: vec![
                video_mode(1920, 1080, 59_940),
                video_mode(1280, 1024, 75_025),
            ],
        }
    }

    #[test]
    fn a_scaled_screen_has_fewer_points_than_pixels() {
        let mut world = World::new();
        world.spawn(Monitor {
            physical_position: IVec2::new(100, 0),
            scale_factor: 1.5,
            ..monitor()
        });
        let window = Resolution::new(1024, 600);
        let corner = world.run_system_cached_with(centered, window).unwrap();
        assert_eq!(corner, Some(IVec2::new(100 + (1920 - 1536) / 2, 90)));
        let unknown = Monitor {
            scale_factor: 0.0,
            ..monitor()
        };
        assert_eq!(desktop(&unknown), Resolution::new(1920, 1080));
    }

    #[test]
    fn the_command_line_overrides_chosen_settings() {
        let options = DisplayOptions {
            fullscreen: Some(true),
            antialiasing: Some(Antialiasing::X8),
            ..default()
        };
        let settings = DisplaySettings::default();
        let expected = DisplaySettings {
            fullscreen: true,
            antialiasing: Antialiasing::X8,
            ..settings
        };
        assert_eq!(options.over(settings), expected);
        assert_eq!(DisplayOptions::default().over(settings), settings);
    }

    #[test]
    fn the_user_is_asked_unless_there_is_an_answer() {
        let silent = DisplayOptions::default();
        let asked = DisplaySettings::default();
        let answered = DisplaySettings {
            ask: false,
            ..asked
        };
        assert!(silent.asks(None));
        assert!(silent.asks(Some(asked)));
        assert!(!silent.asks(Some(answered)));
        let with = |ask| DisplayOptions {
            ask: Some(ask),
            ..default()
        };
        assert!(with(true).asks(Some(answered)));
        assert!(!with(false).asks(None));
        let vsync = DisplayOptions {
            vsync: Some(true),
            ..default()
        };
        assert!(!vsync.asks(None));
    }

    #[test]
    fn a_mode_of_the_screen_is_switched_to_and_its_present_one_is_not() {
        let (entity, monitor) = (Entity::PLACEHOLDER, monitor());
        let selection = MonitorSelection::Entity(entity);
        let mode = |width, height, rate, fullscreen| {
            let settings = DisplaySettings {
                resolution: Resolution::new(width, height),
                refresh_rate: NonZeroU32::new(rate).unwrap(),
                fullscreen,
                ..default()
            };
            window_mode(&settings, Some((entity, &monitor)))
        };
        let specific = VideoModeSelection::Specific(monitor.video_modes[1]);
        assert_eq!(
            mode(1280, 1024, 75, true),
            WindowMode::Fullscreen(selection, specific)
        );
        let borderless = WindowMode::BorderlessFullscreen(selection);
        assert_eq!(mode(1920, 1080, 60, true), borderless);
        assert_eq!(mode(1280, 1024, 75, false), WindowMode::Windowed);
    }

    fn app() -> (App, Entity) {
        let mut app = App::new();
        app.add_plugins((MinimalPlugins, CorePlugin::default(), UserPlugin, plugin))
            .init_resource::<ButtonInput<KeyCode>>()
            .init_resource::<FrameRate>();
        let window = app.world_mut().spawn((Window::default(), PrimaryWindow));
        let window = window.id();
        app.update();
        (app, window)
    }

    #[test]
    fn the_window_takes_the_chosen_settings() {
        let (mut app, window) = app();
        let camera = app.world_mut().spawn((UserCamera, Msaa::Off)).id();
        app.insert_resource(DisplaySettings {
            resolution: Resolution::new(800, 600),
            vsync: false,
            antialiasing: Antialiasing::X4,
            ..default()
        });
        app.update();
        let shown = app.world().get::<Window>(window).unwrap();
        assert_eq!(shown.physical_size(), UVec2::new(800, 600));
        assert_eq!(shown.present_mode, PresentMode::AutoNoVsync);
        assert_eq!(app.world().get::<Msaa>(camera), Some(&Msaa::Sample4));

        let mut shown = app.world_mut().get_mut::<Window>(window).unwrap();
        shown.resolution.set(700.0, 500.0);
        app.world_mut().resource_mut::<DisplaySettings>().vsync = true;
        app.update();
        let shown = app.world().get::<Window>(window).unwrap();
        assert_eq!(shown.physical_size(), UVec2::new(700, 500));
        assert_eq!(shown.present_mode, PresentMode::AutoVsync);
    }

    #[test]
    fn a_key_fills_the_screen_and_gives_it_back() {
        let (mut app, window) = app();
        let mut mode = || {
            let mut keys = app.world_mut().resource_mut::<ButtonInput<KeyCode>>();
            keys.press(KeyCode::F11);
            app.update();
            let mut keys = app.world_mut().resource_mut::<ButtonInput<KeyCode>>();
            keys.release(KeyCode::F11);
            keys.clear();
            app.world().get::<Window>(window).unwrap().mode
        };
        let full = WindowMode::BorderlessFullscreen(MonitorSelection::Current);
        assert_eq!([mode(), mode()], [full, WindowMode::Windowed]);
    }
}
