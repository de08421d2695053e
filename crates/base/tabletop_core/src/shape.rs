//! The shapes of objects.

pub(crate) mod attributes;
mod simple;
mod solids;

use std::borrow::Cow;

use bevy::prelude::*;
use tabletop_geometry::{Pose, Rgb};

use crate::{BondEnd, BondPoint, Control, ControlKind, Part, Shape};

impl Shape {
    /// All names of shapes.
    pub const NAMES: [&'static str; 15] = [
        "block",
        "cylinder",
        "sphere",
        "box",
        "frustum",
        "ring",
        "custom",
        "composite",
        "lid",
        "toggleSwitch",
        "pushButton",
        "indicatorLights",
        "customControl",
        "guestBondPoint",
        "hostBondPoint",
    ];

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
                ControlKind::PushButton(_) => "pushButton",
                ControlKind::IndicatorLights(_) => "indicatorLights",
                ControlKind::Custom(_) => "customControl",
            },
            Self::BondPoint(point) => match point.end {
                BondEnd::Guest(_) => "guestBondPoint",
                BondEnd::Host(_) => "hostBondPoint",
            },
        }
    }

    /// Its composition.
    pub fn composition(&self) -> Composition<'_> {
        match *self {
            Self::Block { .. }
            | Self::Cylinder { .. }
            | Self::Sphere { .. }
            | Self::Box { .. }
            | Self::Prism { .. }
            | Self::Frustum { .. }
            | Self::Ring { .. }
            | Self::Mesh { .. }
            | Self::Link { .. } => Composition::Simple,
            Self::Composite { ref parts } => Composition::Parts(parts),
            Self::Lid {
                span,
                color,
                handle_span,
                handle_thickness,
                handle_color,
            } => {
                let on_top = Pose::at(Vec3::Z * (span.z + handle_span.z) / 2.0);
                let handle = Self::Box {
                    span: handle_span,
                    thickness: handle_thickness,
                    color: handle_color,
                };
                let plate = Self::Block { span, color };
                Composition::Lid(Box::new([
                    Part::new("", Pose::IDENTITY, plate),
                    Part::new("", on_top, handle),
                ]))
            }
            Self::Control(ref control) => Composition::Control(control),
            Self::BondPoint(ref point) => Composition::BondPoint(point),
        }
    }

    /// As it is drawn: a link as the block that covers the gaps at its joints.
    pub fn as_drawn(&self) -> Cow<'_, Self> {
        if let Self::Link {
            span,
            padding,
            color,
        } = *self
        {
            let span = span + Vec3::Y * 2.0 * padding;
            Cow::Owned(Self::Block { span, color })
        } else {
            Cow::Borrowed(self)
        }
    }

    /// Paints everything but controls in this colour.
    pub fn paint(&mut self, new: Rgb) {
        for color in self.colors_mut() {
            *color = new;
        }
    }

    /// The colours of everything but controls, whose colours tell their states.
    pub fn colors_mut(&mut self) -> Vec<&mut Rgb> {
        match self {
            Self::Block { color, .. }
            | Self::Cylinder { color, .. }
            | Self::Sphere { color, .. }
            | Self::Box { color, .. }
            | Self::Prism { color, .. }
            | Self::Frustum { color, .. }
            | Self::Ring { color, .. }
            | Self::Mesh { color, .. }
            | Self::Link { color, .. } => vec![color],
            Self::Lid {
                color,
                handle_color,
                ..
            } => vec![color, handle_color],
            Self::Composite { parts } => parts
                .iter_mut()
                .flat_map(|part| part.shape.colors_mut())
                .collect(),
            Self::Control(_) | Self::BondPoint(_) => Vec::new(),
        }
    }
}

/// The composition of a shape.
#[derive(Clone, Debug)]
pub enum Composition<'a> {
    /// It is a simple shape.
    Simple,
    /// A composite's parts.
    Parts(&'a [Part]),
    /// The plate of a lid and the handle on it.
    Lid(Box<[Part; 2]>),
    /// A shape with states.
    Control(&'a Control),
    /// A point without extents.
    BondPoint(&'a BondPoint),
}
