//! Descriptions of robots.

use std::path::{Path, PathBuf};

use bevy::prelude::*;
use tabletop_core::{LayoutError, LayoutFile, RobotLayout, UrdfJoint, is_shipped, snake_case};
use tabletop_kinematics::{Geometry, JointType, ModelError, RobotModel};
use thiserror::Error;

use crate::{
    articulation::tree::Articulation,
    look::{meshes::is_ours, shared_figures::SharedFigures},
    source::DescriptionSource,
};

/// The description of the robot at the table.
#[derive(Resource, Clone, Debug)]
pub struct Description {
    /// Its model.
    pub model: RobotModel,
    /// Its limbs and joints.
    pub layout: RobotLayout,
    /// The files that it was read from; `None` for the robot that ships with the program.
    pub source: Option<DescriptionSource>,
    /// The looks of its bodies, which its clones share.
    pub(crate) figures: SharedFigures,
}

/// The error of a robot that cannot be used.
#[derive(Debug, Error)]
pub enum DescriptionError {
    /// Its URDF cannot be used.
    #[error("{}: {error}", .path.display())]
    Urdf {
        /// The URDF.
        path: PathBuf,
        /// The fault, with its line.
        error: Box<ModelError>,
    },
    /// Its URDF lacks a name of the `robot.ron`.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// Its `robot.ron` cannot be used.
    #[error("robot.ron: {0}")]
    Layout(#[from] LayoutError),
    /// It has meshes, in folders that it may not name.
    #[error(
        "the meshes of its URDF {} are outside of the recording; `--allow-path DIR` lets it name files in DIR",
        .0.display()
    )]
    Outside(PathBuf),
}

impl Description {
    /// The folder of the files that it was read from.
    pub fn folder(&self) -> Option<&Path> {
        self.source.as_ref().map(DescriptionSource::folder)
    }

    /// The robot that files describe.
    ///
    /// # Errors
    ///
    /// The texts cannot be used, or the URDF lacks joints or links that the `robot.ron` names; the error names them.
    pub fn read(source: DescriptionSource) -> Result<Self, DescriptionError> {
        let mut model =
            RobotModel::from_urdf(&source.urdf).map_err(|error| DescriptionError::Urdf {
                path: source.path.clone(),
                error: Box::new(error),
            })?;
        let folder = source.folder();
        let is_there = !is_shipped(&source.path) && folder.is_dir();
        if is_there && !source.reaches(folder) && names_files(&model) {
            return Err(DescriptionError::Outside(source.path));
        }
        let file = source.layout.as_deref().map(LayoutFile::read).transpose()?;
        let layout = match &file {
            Some(file) => {
                hold_still(&mut model, file)?;
                file.layout(|name| urdf_joint(&model, name))?
            }
            None => RobotLayout::default(),
        };
        Articulation::new(model.clone(), layout.clone())
            .map_err(|error| located(error, file.as_ref()))?;
        Ok(Self {
            model,
            layout,
            source: Some(source),
            figures: SharedFigures::default(),
        })
    }

    /// The Baxter that ships with the program.
    ///
    /// # Errors
    ///
    /// None that the program's tests would not find.
    pub fn baxter() -> Result<Self, DescriptionError> {
        Ok(Self {
            model: tabletop_kinematics::baxter()?,
            layout: RobotLayout::default(),
            source: None,
            figures: SharedFigures::default(),
        })
    }
}

/// The fault that the URDF lacks a name of a file, with the line of the name.
fn located(error: ModelError, file: Option<&LayoutFile>) -> DescriptionError {
    let name = if let ModelError::NoSuchLink { link: name, .. }
    | ModelError::NoSuchJoint { joint: name, .. }
    | ModelError::NoArm { tip: name, .. } = &error
    {
        Some(name)
    } else {
        None
    };
    let line = file.zip(name).and_then(|(file, name)| file.line_of(name));
    match line {
        Some(line) => LayoutError::Fault(format!("line {line}: {error}")).into(),
        None => error.into(),
    }
}

/// Fixes the joints that stand still.
fn hold_still(model: &mut RobotModel, file: &LayoutFile) -> Result<(), LayoutError> {
    for (name, position) in &file.still {
        let line = file.line_of(name).unwrap_or(1);
        let fault = |what: &str| LayoutError::Fault(format!("line {line}: still: {what} {name}"));
        let joint = urdf_joint(model, name);
        let joint = joint.and_then(|joint| model.find_joint(&joint.name).ok());
        let joint = joint.ok_or_else(|| fault("the URDF has no joint"))?;
        if !position.is_finite() {
            return Err(fault("a position that is not finite for the joint"));
        }
        model.hold(joint, *position);
    }
    Ok(())
}

/// The joint of this name or, if there is none, the one that has it in snake case.
fn urdf_joint(model: &RobotModel, name: &str) -> Option<UrdfJoint> {
    let named = |is_it: &dyn Fn(&str) -> bool| model.joints().iter().find(|it| is_it(&it.name));
    let snake = snake_case(name);
    let joint = named(&|it| it == name).or_else(|| named(&|it| snake_case(it) == snake))?;
    Some(UrdfJoint {
        name: joint.name.clone(),
        slides: joint.kind == JointType::Prismatic,
        limits: joint.limits,
    })
}

/// Whether a robot has meshes that are not part of the program.
fn names_files(model: &RobotModel) -> bool {
    let mut shapes = model
        .links()
        .iter()
        .flat_map(|link| link.visuals.iter().chain(&link.collisions));
    shapes.any(|shape| matches!(shape.geometry, Geometry::Mesh { .. }) && !is_ours(shape))
}

#[cfg(test)]
mod tests {
    use bevy::math::DVec3;
    use tabletop_core::{JointName, LimbId};
    use tabletop_geometry::Pose;

    use super::*;

    const PANDA: &str = include_str!("../../../../assets/panda/panda.urdf");
    const LAYOUT: &str = include_str!("../../../../assets/panda/robot.ron");

    fn read(urdf: &str, layout: &str) -> Result<Description, DescriptionError> {
        Description::read(DescriptionSource {
            path: "arm/panda.urdf".into(),
            urdf: urdf.to_owned(),
            layout: Some(layout.to_owned()),
            reach: None,
        })
    }

    #[test]
    fn names_with_capitals_are_found() {
        let urdf = PANDA.replace("panda_joint", "Actuator");
        for layout in ["Actuator", "actuator"] {
            let layout = LAYOUT.replace("panda_joint", layout);
            let robot = read(&urdf, &layout).unwrap();
            let first = &robot.layout.joints[0];
            assert_eq!(first.urdf_name, "Actuator1");
            assert_eq!(first.name, JointName::new("Actuator1").unwrap());
        }
    }

    #[test]
    fn an_exact_name_comes_before_one_in_snake_case() {
        let urdf = PANDA
            .replace("panda_joint1", "joint_a")
            .replace("panda_joint2", "JointA");
        let joint = |name| {
            urdf_joint(&RobotModel::from_urdf(&urdf).unwrap(), name)
                .unwrap()
                .name
        };
        assert_eq!(joint("JointA"), "JointA");
        assert_eq!(joint("joint_a"), "joint_a");
    }

    #[test]
    fn an_arm_may_begin_with_a_lift() {
        let turn = "<joint name=\"panda_joint1\" type=\"revolute\">";
        assert!(PANDA.contains(turn));
        let urdf = PANDA.replace(turn, &turn.replace("revolute", "prismatic"));
        let robot = read(&urdf, LAYOUT).unwrap();
        assert!(robot.layout.joints[0].slides && !robot.layout.joints[1].slides);
        let articulation = Articulation::new(robot.model, robot.layout).unwrap();
        let home: Vec<_> = articulation
            .layout
            .joints
            .iter()
            .map(|joint| joint.home)
            .collect();
        let mut up = home.clone();
        up[0] += 0.1;
        let base = Pose::at(bevy::math::Vec3::ZERO);
        let [low, high] = [home, up].map(|positions| articulation.posture(&positions, base));
        let rise = high.end_effectors()[0].location - low.end_effectors()[0].location;
        assert!((rise.z - 1.0).abs() < 1e-5, "0.1 m is a unit: {rise}");
        let [first, ..] = &articulation.axes(LimbId(0), &low)[..] else {
            panic!("no axes")
        };
        assert_eq!(first.motion_of(DVec3::new(1.0, 2.0, 3.0)), DVec3::Z);
    }

    #[test]
    fn joints_that_stand_still_are_no_limbs() {
        let still = |name: &str| {
            let layout = LAYOUT.replace(
                "(name: \"panda_joint3\", label: \"J3\", home: 0, key: \"KeyO\"),",
                "",
            );
            let layout = layout.replace("urdf:", &format!("still: [(\"{name}\", 0.5)],\n urdf:"));
            // Every posture has one number fewer.
            let layout = layout
                .replace("-0.6, 0, ", "-0.6, ")
                .replace("482, 0, ", "482, ");
            read(
                PANDA,
                &layout.replace("[0, 0, 0, -0.0698", "[0, 0, -0.0698"),
            )
        };
        let robot = still("panda_joint3").unwrap();
        assert_eq!(robot.layout.limbs[0].joints.len(), 6);
        let joint = robot.model.find_joint("panda_joint3").unwrap();
        assert_eq!(robot.model.joint(joint).kind, JointType::Fixed);
        let error = still("panda_joint9").unwrap_err().to_string();
        assert_eq!(
            error,
            "robot.ron: line 5: still: the URDF has no joint panda_joint9"
        );
        let error = still("panda_joint1").unwrap_err().to_string();
        assert_eq!(
            error,
            "robot.ron: line 5: still: panda_joint1 is a joint of a limb"
        );
    }

    #[test]
    fn names_that_the_urdf_lacks_have_a_line() {
        let layout = LAYOUT.replace("link: \"panda_flange\"", "link: \"flange\"");
        let error = read(PANDA, &layout).unwrap_err().to_string();
        assert_eq!(error, "robot.ron: line 34: robot panda has no link flange");
        let layout = LAYOUT.replace("link: \"panda_flange\"", "link: \"panda_link5\"");
        let error = read(PANDA, &layout).unwrap_err().to_string();
        let said = "robot.ron: line 34: no arm leads from link panda_link0 to link panda_link5: ";
        assert!(error.starts_with(said), "{error}");
    }

    #[test]
    fn fingers_of_the_urdf_are_no_bodies_of_their_own() {
        let fingers = |names: &str| {
            let layout = LAYOUT.replace(
                "kind: Parallel,",
                &format!("kind: Parallel, fingers: {names},"),
            );
            let robot = read(PANDA, &layout).unwrap();
            Articulation::new(robot.model, robot.layout).unwrap()
        };
        let [all, fewer] = ["([], [])", "([], [\"panda_link7\"])"].map(fingers);
        assert_eq!(all.bodies.len(), fewer.bodies.len() + 1);
        assert!(fewer.bodies.iter().all(|body| body.id != "panda_link7"));
        assert_eq!(fewer.finger_links(LimbId(0), -1), []);
        let links = fewer.finger_links(LimbId(0), 1);
        let [(link, frame), ..] = links[..] else {
            panic!("no links")
        };
        assert_eq!(fewer.model().link(link).name, "panda_link7");
        // It is half a finger beside the middle of the closed hand.
        let middle = frame.inverse().translation;
        assert!(
            (middle - DVec3::new(0.0053, 0.0053, 0.0))
                .truncate()
                .length()
                < 1e-3,
            "{middle}"
        );
    }

    #[test]
    fn a_collision_shape_of_collada_is_a_convex_hull() {
        let folder = std::env::temp_dir().join(format!("tabletop-hull-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let pyramid = "<COLLADA><library_geometries><geometry id='g'><mesh>\
            <source id='s'><float_array>0 0 0 1 0 0 0 1 0 0 0 1</float_array>\
            <technique_common><accessor stride='3'/></technique_common></source>\
            <vertices id='v'><input semantic='POSITION' source='#s'/></vertices><triangles>\
            <input semantic='VERTEX' source='#v'/><p>0 2 1 0 1 3 0 3 2 1 2 3</p></triangles></mesh></geometry></library_geometries>\
            <library_visual_scenes><visual_scene><node><instance_geometry url='#g'/></node></visual_scene></library_visual_scenes>\
            </COLLADA>";
        std::fs::write(folder.join("hull.dae"), pyramid).unwrap();
        let collision = "<collision><geometry><mesh filename=\"hull.dae\" scale=\"0.1 0.1 0.1\"/></geometry></collision></link>";
        let urdf = PANDA.replacen("</link>", collision, 1);
        let robot = Description::read(DescriptionSource {
            path: folder.join("panda.urdf"),
            urdf,
            layout: Some(LAYOUT.to_owned()),
            reach: None,
        })
        .unwrap();
        let mut articulation = Articulation::new(robot.model, robot.layout).unwrap();
        let before = articulation.bodies[0].parts.len();
        let lacking = articulation.add_meshes(robot.source.as_ref());
        assert!(lacking.is_empty(), "{lacking:?}");
        let [_, .., hull] = &articulation.bodies[0].parts[..] else {
            panic!("no parts")
        };
        assert_eq!(articulation.bodies[0].parts.len(), before + 1);
        let far = hull.shape.as_convex_polyhedron().unwrap().points();
        let far = far.iter().map(|point| point.x).fold(0.0, f32::max);
        assert!((far - 1.0).abs() < 1e-4, "0.1 m in units: {far}");
        std::fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn a_fault_of_the_urdf_names_its_file_and_line() {
        let urdf = PANDA.replace("<mass value=\"2.2\"/>", "<mass value=\"-1\"/>");
        let error = read(&urdf, LAYOUT).unwrap_err().to_string();
        assert!(error.starts_with("arm/panda.urdf: line "), "{error}");
        let error = read(PANDA, &LAYOUT.replace("panda_joint7", "joint7")).unwrap_err();
        assert!(!error.to_string().contains("panda.urdf"), "{error}");
    }
}
