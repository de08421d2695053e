//! Pictures of the elements of task files for the documentation, drawn as the head camera draws them:
//! `cargo run --release --example element_pictures`.
//!
//! The objects of a picture have its name as their id, or an id that begins with it. Elements that can be triggered have two pictures beside
//! each other, before and after.
#![expect(clippy::print_stdout, reason = "an example shows what it does")]

use std::{collections::BTreeMap, error::Error, fs, fs::File, io::BufWriter, path::Path};

use bevy::prelude::*;
use tabletop::prelude::*;
use tabletop_camera::{Camera, DrawnSolid, Rasterizer, Scene};
use tabletop_core::{LIGHT, Picture, Table};

const TASK: &str = "tablesetup/elements.xml";
const FOLDER: &str = "docs/elements";

/// The triggered control, and the picture that shows it.
const TRIGGERED: [(&str, &str); 1] = [("button", "customControl")];

/// Direction of the camera from the middle of its subject, in radii of the subject.
const FROM: Vec3 = Vec3::new(-1.0, -3.2, 2.2);

/// Columns and rows of the pictures.
const SIZE: [u32; 2] = [240, 180];

/// Edge of the yellow cubes that mark bond points, in units.
const MARK: f32 = 0.16;

fn main() -> Result<(), Box<dyn Error>> {
    fs::create_dir_all(FOLDER)?;
    let scene = tabletop::xml::read_task(Path::new(TASK))?.scene;
    let mut app = headless_app();
    app.world_mut()
        .write_command(SceneCommand::Set(Box::new(scene)));
    app.step(600);
    let before = pictures(app.world());
    for (control, _) in TRIGGERED {
        app.world_mut().write_command(MechanismCommand::Trigger {
            hand: Hand::Any,
            control: control.into(),
            part: None,
        });
    }
    app.step(120);
    let mut after = pictures(app.world());
    for (name, picture) in before {
        let is_triggered = TRIGGERED.iter().any(|(_, triggered)| *triggered == name);
        let after = after.remove(&name).filter(|_| is_triggered);
        let path = format!("{FOLDER}/{name}.png");
        write_png(&[Some(picture), after], Path::new(&path))?;
        println!("{path}");
    }
    Ok(())
}

/// The pictures of all objects, by their names.
fn pictures(world: &World) -> BTreeMap<String, Picture> {
    let mut groups: BTreeMap<String, Vec<(&ObjectSpec, Pose)>> = BTreeMap::new();
    for object in world.resource::<ObjectIndex>().iter() {
        let (Some(spec), Some(place)) = (
            world.get::<ObjectSpec>(object),
            world.get::<Transform>(object),
        ) else {
            continue;
        };
        let name = spec.id.split(['_', '-']).next().unwrap_or_default();
        let group = groups.entry(name.to_owned()).or_default();
        group.push((spec, place.into()));
    }
    let mut rasterizer = Rasterizer::default();
    let draw = |(name, group): (String, Vec<_>)| {
        let mut picture = Picture::default();
        rasterizer.draw(&scene(&group), &camera(&group), &mut picture);
        (name, picture)
    };
    groups.into_iter().map(draw).collect()
}

/// The objects of a picture on a table, with marks at their bond points.
fn scene(group: &[(&ObjectSpec, Pose)]) -> Scene {
    let table = Table {
        xspan: 100.0,
        yspan: 100.0,
    };
    let mut solids = vec![DrawnSolid::of_table(&table, 1)];
    for (spec, pose) in group {
        let drawn = spec.shape.drawn();
        solids.extend(drawn.iter().map(|solid| DrawnSolid::of(*pose, solid, 2)));
        for point in spec.bond_points() {
            let span = Vec3::splat(MARK);
            let color = Rgb::new(1.0, 1.0, 0.0);
            let mark = Shape::Block { span, color }.drawn();
            solids.extend(
                mark.iter()
                    .map(|solid| DrawnSolid::of(*pose * point.pose, solid, 3)),
            );
        }
    }
    Scene {
        solids,
        ..default()
    }
}

/// A camera from which all of a picture can be seen.
fn camera(group: &[(&ObjectSpec, Pose)]) -> Camera {
    let of_one = |(spec, pose): &(&ObjectSpec, Pose)| spec.shape.bounds(*pose);
    let (mut low, mut high) = (Vec3::MAX, Vec3::MIN);
    for bounds in group.iter().map(of_one) {
        low = low.min(bounds.low);
        high = high.max(bounds.high);
    }
    let (middle, radius) = (low.midpoint(high), low.distance(high) / 2.0);
    let place = Transform::from_translation(middle + FROM * radius).looking_at(middle, Vec3::Z);
    Camera {
        pose: (&place).into(),
        vertical_fov: 32_f32.to_radians(),
        square_fov: false,
        width: SIZE[0],
        height: SIZE[1],
        antialiasing: true,
        light: LIGHT,
    }
}

/// Writes pictures beside each other.
fn write_png(pictures: &[Option<Picture>], path: &Path) -> Result<(), Box<dyn Error>> {
    let pictures: Vec<_> = pictures.iter().flatten().collect();
    let row = 3 * SIZE[0] as usize;
    let mut rgb = Vec::new();
    for number in 0..SIZE[1] as usize {
        let rows = pictures
            .iter()
            .flat_map(|picture| picture.rgb.chunks(row).nth(number));
        rgb.extend(rows.flatten());
    }
    let file = BufWriter::new(File::create(path)?);
    let mut encoder = png::Encoder::new(file, SIZE[0] * pictures.len() as u32, SIZE[1]);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_compression(png::Compression::High);
    encoder.write_header()?.write_image_data(&rgb)?;
    Ok(())
}
