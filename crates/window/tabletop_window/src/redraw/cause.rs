//! Causes of frames.

/// The cause of drawing a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum RedrawCause {
    /// The program has just started.
    Start,
    /// The window has another size, or has been uncovered.
    Window,
    /// Another camera, or another place of it.
    Camera,
    /// Something drawn has moved, come, gone, or become visible or invisible.
    Scene,
    /// The lines around held objects.
    Lines,
    /// The windows inside the window.
    Panels,
    /// A mesh, a material or a shader.
    Asset,
    /// A texture. Those of the panels change with their texts, and reach the graphics card in time.
    Texture,
    /// Someone waits for a picture.
    Screenshot,
    /// The last changes have not all reached the graphics card.
    Settling,
    /// The last picture is old.
    Refresh,
}

impl RedrawCause {
    /// True if something in the picture moves.
    pub const fn is_motion(self) -> bool {
        match self {
            Self::Start
            | Self::Window
            | Self::Camera
            | Self::Scene
            | Self::Lines
            | Self::Screenshot => true,
            Self::Panels | Self::Asset | Self::Texture | Self::Settling | Self::Refresh => false,
        }
    }

    /// True if the change does not reach the graphics card at once.
    pub const fn needs_settling(self) -> bool {
        self.is_motion() || matches!(self, Self::Asset)
    }

    /// True if the user sees something new.
    pub const fn is_event(self) -> bool {
        self.needs_settling() || matches!(self, Self::Panels | Self::Texture)
    }
}
