//! The shapes of objects.

mod simple;
mod solids;

use crate::{BondEnd, ControlKind, Rgb, Shape};

impl Shape {
    /// The name of this shape's element in a task file, or its name in recordings.
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Block { .. } | Self::Link { .. } => "block",
            Self::Cylinder { .. } | Self::Prism { .. } => "cylinder",
            Self::Sphere { .. } => "sphere",
            Self::Box { .. } => "box",
            Self::Frustum { .. } => "frustum",
            Self::Ring { .. } => "ring",
            Self::Mesh { .. } => "custom",
            Self::Composite { .. } => "composite",
            Self::Lid { .. } => "lid",
            Self::Control(control) => match control.kind {
                ControlKind::ToggleSwitch(_) => "toggleSwitch",
                ControlKind::IndicatorLights(_) => "indicatorLights",
                ControlKind::Custom(_) => "customControl",
            },
            Self::BondPoint(point) => match point.end {
                BondEnd::Guest(_) => "guestBondPoint",
                BondEnd::Host(_) => "hostBondPoint",
            },
        }
    }

    /// Paints everything but controls in this colour.
    pub fn paint(&mut self, new: Rgb) {
        match self {
            Self::Block { color, .. }
            | Self::Cylinder { color, .. }
            | Self::Sphere { color, .. }
            | Self::Box { color, .. }
            | Self::Prism { color, .. }
            | Self::Frustum { color, .. }
            | Self::Ring { color, .. }
            | Self::Mesh { color, .. }
            | Self::Link { color, .. } => *color = new,
            Self::Lid {
                color,
                handle_color,
                ..
            } => {
                *color = new;
                *handle_color = new;
            }
            Self::Composite { parts } => parts.iter_mut().for_each(|part| part.shape.paint(new)),
            Self::Control(_) | Self::BondPoint(_) => {}
        }
    }
}
