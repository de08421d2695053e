//! From URDF to a [`RobotModel`].

mod lines;
mod link_tree;
mod model;
mod numbers;

use crate::{
    ModelError, RobotModel,
    outline::{Outline, outline},
    plain,
    urdf::lines::Lines,
};

impl RobotModel {
    /// Reads a robot from the text of a URDF file.
    ///
    /// ```
    /// use tabletop_kinematics::RobotModel;
    ///
    /// let text = r#"<robot name="door">
    ///   <link name="frame"/>
    ///   <link name="leaf"/>
    ///   <joint name="hinge" type="revolute">
    ///     <parent link="frame"/> <child link="gate"/>
    ///   </joint>
    /// </robot>"#;
    /// let error = RobotModel::from_urdf(text).unwrap_err();
    /// assert_eq!(error.to_string(), "line 4: joint hinge: there is no link gate");
    /// ```
    ///
    /// # Errors
    ///
    /// The text is no URDF, or its links and joints are no tree, or one of its numbers cannot be.
    pub fn from_urdf(text: &str) -> Result<Self, ModelError> {
        let outline = outline(text)?;
        let robot = read(text).map_err(|error| locate(error, text, &outline))?;
        Lines::new(&outline.children).model(robot)
    }
}

/// The reason why a text cannot be read.
enum Unread {
    Xml(plain::ReadFault),
    Urdf(urdf_rs::UrdfError),
}

fn read(text: &str) -> Result<urdf_rs::Robot, Unread> {
    let plain = plain::plain(text).map_err(Unread::Xml)?;
    urdf_rs::read_from_string(&plain).map_err(Unread::Urdf)
}

/// Finds the part that the reader could not read: an element that does not end, or one of the links and joints, each read alone.
fn locate(error: Unread, text: &str, outline: &Outline) -> ModelError {
    if let Some((tag, line, fault)) = &outline.unbalanced {
        return ModelError::Syntax {
            line: *line,
            element: (*tag).to_owned(),
            message: fault.clone(),
        };
    }
    let alone = outline
        .children
        .iter()
        .filter(|child| matches!(child.tag, "link" | "joint" | "material"))
        .find_map(|child| {
            let text = format!("<robot name=\"\">{}</robot>", child.text);
            Some((child, read(&text).err()?))
        });
    let (line, element, error) = match alone {
        Some((child, error)) => (child.line, child.named(), error),
        None => (line_of(&error, text), "robot".to_owned(), error),
    };
    let message = match error {
        Unread::Xml(fault) => fault.what,
        Unread::Urdf(error) => remedied(&error.to_string()),
    };
    ModelError::Syntax {
        line,
        element,
        message,
    }
}

/// A message of the reader without its prefix, and with what to do if it names something that is missing.
fn remedied(message: &str) -> String {
    let message = message.trim_start_matches("custom: ");
    let missing = message.strip_prefix("missing field `");
    match missing.and_then(|rest| rest.strip_suffix('`')) {
        Some(field) => {
            let field = field.trim_start_matches('@');
            format!("`{field}` is missing: write it, or remove what needs it")
        }
        None => message.to_owned(),
    }
}

fn line_of(error: &Unread, text: &str) -> usize {
    let before = match error {
        Unread::Xml(fault) => text.get(..fault.offset).unwrap_or_default(),
        Unread::Urdf(_) => "",
    };
    1 + before.matches('\n').count()
}
