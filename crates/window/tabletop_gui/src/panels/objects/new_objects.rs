//! New objects of every simple shape.

use bevy::math::Vec3;
use bevy_egui::egui::Ui;
use tabletop_core::{ObjectSpec, Shape};
use tabletop_geometry::{Pose, Rgb};

/// Mass of a new object in kg.
const MASS: f32 = 1.0;

/// Shows a menu of shapes, and returns the new object that the user chooses, of about the size of a block.
pub(super) fn show(ui: &mut Ui) -> Option<ObjectSpec> {
    let mut chosen = None;
    let menu = ui.menu_button("New object", |ui| {
        for (name, shape) in shapes() {
            if ui.button(name).clicked() {
                let id = name.to_lowercase();
                chosen = Some(ObjectSpec::new(id, Pose::at(Vec3::ZERO), MASS, shape));
                ui.close();
            }
        }
    });
    menu.response.on_hover_text(
        "An object of this shape above the middle of the table; then change it below",
    );
    chosen
}

/// The simple shapes, each with its name.
fn shapes() -> [(&'static str, Shape); 7] {
    let (radius, sides) = (0.5, 6);
    let yspan = 1.0;
    [
        (
            "Block",
            Shape::Block {
                span: Vec3::ONE,
                color: Rgb::RED,
            },
        ),
        (
            "Ball",
            Shape::Sphere {
                radius,
                color: Rgb::BLUE,
            },
        ),
        (
            "Cylinder",
            Shape::Cylinder {
                radius,
                yspan,
                color: Rgb::GREEN,
            },
        ),
        (
            "Prism",
            Shape::Prism {
                radius,
                yspan,
                sides,
                color: Rgb::ORANGE,
            },
        ),
        (
            "Frustum",
            Shape::Frustum {
                radius_top: 0.25,
                radius_bottom: 0.5,
                zspan: 1.0,
                sides,
                color: Rgb::CYAN,
            },
        ),
        (
            "Ring",
            Shape::Ring {
                radius_outer: 0.75,
                radius_inner: 0.4,
                zspan: 0.5,
                sides: 16,
                color: Rgb::MAGENTA,
            },
        ),
        (
            "Box",
            Shape::Box {
                span: Vec3::new(3.0, 3.0, 1.5),
                thickness: 0.2,
                color: Rgb::GRAY,
            },
        ),
    ]
}
