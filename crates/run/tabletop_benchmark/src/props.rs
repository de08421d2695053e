//! The objects on the tables of lessons.

use bevy::math::Vec3;
use tabletop_core::{JointKind, JointSpec, ObjectSpec, Shape};
use tabletop_geometry::{Pose, Rgb};

/// An object that is on every table of a lesson.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Prop {
    Box(Rgb),
    /// A box with a lid that is open or closed at random.
    Chest(Rgb),
    Plate(Rgb),
    /// A block that others are put on.
    Base(Rgb),
    /// Three pegs, the first with rings around it.
    Pegs,
}

/// What an object in a lesson's stock is.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PieceSpec {
    pub form: Form,
    pub color: Rgb,
    pub size: PieceSize,
}

#[derive(Clone, Copy, Debug)]
pub(crate) enum Form {
    Block,
    Ball,
}

/// Sizes of pieces, which are edges or diameters.
#[derive(Clone, Copy, Debug)]
pub(crate) enum PieceSize {
    Equal,
    Small,
    Large,
    /// Another one for each piece.
    Varied,
}

impl PieceSize {
    /// The size of a piece by its number.
    fn length(self, number: usize) -> f32 {
        match self {
            Self::Equal => 1.0,
            Self::Small => 0.8,
            Self::Large => 1.2,
            // Far from the order of the numbers.
            Self::Varied => 0.7 + 0.08 * (number * 7 % 10) as f32,
        }
    }
}

/// A block like all others in a stock, but for its colour.
pub(crate) const fn block(color: Rgb) -> PieceSpec {
    PieceSpec {
        form: Form::Block,
        color,
        size: PieceSize::Equal,
    }
}

/// A ball like all others in a stock, but for its colour.
pub(crate) const fn ball(color: Rgb) -> PieceSpec {
    PieceSpec {
        form: Form::Ball,
        color,
        size: PieceSize::Equal,
    }
}

impl PieceSpec {
    /// The same of another size.
    pub const fn of_size(self, size: PieceSize) -> Self {
        Self { size, ..self }
    }

    /// The object with this number, standing at a place.
    pub fn object(self, number: usize, at: Vec3) -> ObjectSpec {
        let (length, color) = (self.size.length(number), self.color);
        let (name, shape) = match self.form {
            Form::Block => {
                let span = Vec3::splat(length);
                ("Block", Shape::Block { span, color })
            }
            Form::Ball => {
                let radius = length / 2.0;
                ("Ball", Shape::Sphere { radius, color })
            }
        };
        let pose = Pose::at(at.with_z(length / 2.0));
        // Masses in another order than sizes.
        let mass = 0.5 + 0.1 * (number * 3 % 10) as f32;
        ObjectSpec::new(format!("{name}{number}"), pose, mass, shape)
    }
}

impl Prop {
    /// The radius of the circle around it, in units.
    pub fn reach(self) -> f32 {
        match self {
            Self::Box(_) => 3.2,
            Self::Chest(_) => 4.2,
            Self::Plate(_) => 2.6,
            Self::Base(_) => 1.0,
            Self::Pegs => 7.5,
        }
    }

    /// Its objects and joints, with a number in its ids.
    pub fn objects(
        self,
        number: usize,
        at: Vec3,
        is_open: bool,
    ) -> (Vec<ObjectSpec>, Vec<JointSpec>) {
        let id = |name: &str| format!("{name}{number}");
        match self {
            Self::Box(color) => (
                vec![holder(&id("Box"), Vec3::new(4.4, 4.4, 1.4), color, at)],
                Vec::new(),
            ),
            Self::Chest(color) => chest(&id("Chest"), color, at, is_open),
            Self::Plate(color) => {
                let span = Vec3::new(3.6, 3.6, 0.2);
                (vec![plate(&id("Plate"), span, color, at)], Vec::new())
            }
            Self::Base(color) => {
                let span = Vec3::splat(1.3);
                let pose = Pose::at(at.with_z(0.65));
                (
                    vec![ObjectSpec::new(
                        id("Base"),
                        pose,
                        1.0,
                        Shape::Block { span, color },
                    )],
                    Vec::new(),
                )
            }
            Self::Pegs => (pegs(at), Vec::new()),
        }
    }
}

pub(crate) fn holder(id: &str, span: Vec3, color: Rgb, at: Vec3) -> ObjectSpec {
    let shape = Shape::Box {
        span,
        thickness: 0.1,
        color,
    };
    ObjectSpec::new(id, Pose::at(at.with_z(span.z / 2.0)), 2.0, shape)
}

pub(crate) fn plate(id: &str, span: Vec3, color: Rgb, at: Vec3) -> ObjectSpec {
    let pose = Pose::at(at.with_z(span.z / 2.0));
    let mut plate = ObjectSpec::new(id, pose, 1.0, Shape::Block { span, color });
    plate.descriptions.push(("shape".into(), "plate".into()));
    plate
}

fn chest(id: &str, color: Rgb, at: Vec3, is_open: bool) -> (Vec<ObjectSpec>, Vec<JointSpec>) {
    let span = Vec3::new(3.0, 3.0, 1.8);
    let holder = holder(&format!("{id}-box"), span, color, at);
    let plate = Vec3::new(span.x, span.y, 0.2);
    let shape = Shape::Lid {
        span: plate,
        color,
        handle_span: Vec3::new(0.6, 1.0, 0.6),
        handle_thickness: 0.1,
        handle_color: color,
    };
    let opening = if is_open { span.x } else { 0.0 };
    let place = at.with_z(span.z + plate.z / 2.0) - Vec3::X * opening;
    let lid = ObjectSpec::new(format!("{id}-lid"), Pose::at(place), 1.0, shape);
    let joint = JointSpec {
        objects: [holder.id.clone(), lid.id.clone()],
        frames: [
            Pose::at(Vec3::Z * span.z / 2.0),
            Pose::at(Vec3::NEG_Z * plate.z / 2.0),
        ],
        kind: JointKind::Slider {
            min: 0.0,
            max: span.x,
            friction: 0.0,
            damping: 0.0,
        },
        collides: false,
    };
    (vec![holder, lid], vec![joint])
}

/// Distance between pegs, in units.
const PEGS_APART: f32 = 4.5;

fn pegs(at: Vec3) -> Vec<ObjectSpec> {
    let names = ["PegA", "PegB", "PegC"].into_iter().enumerate();
    let all = names.map(|(i, name)| {
        let span = Vec3::new(0.3, 0.3, 4.0);
        let color = Rgb::BROWN;
        let place = at + Vec3::X * PEGS_APART * (i as f32 - 1.0);
        ObjectSpec::new(
            name,
            Pose::at(place.with_z(span.z / 2.0)),
            0.0,
            Shape::Block { span, color },
        )
    });
    all.collect()
}

/// A ring around the first of three pegs, by its number from below.
pub(crate) fn ring(number: usize, at: Vec3) -> ObjectSpec {
    const HEIGHT: f32 = 0.4;
    let shape = Shape::Ring {
        radius_outer: 1.8 - 0.12 * number as f32,
        radius_inner: 0.3,
        zspan: HEIGHT,
        sides: 32,
        color: Rgb::RED,
    };
    let place = at - Vec3::X * PEGS_APART + Vec3::Z * HEIGHT * (number as f32 + 0.5);
    ObjectSpec::new(format!("Ring{number}"), Pose::at(place), 1.0, shape)
}
