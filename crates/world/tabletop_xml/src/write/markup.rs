//! Elements and attributes as text.

use std::fmt::Write as _;

use bevy::math::{DVec3, Vec3};
use tabletop_geometry::{NAMED_COLORS, Pose, Rgb};

use crate::write::{
    Writer,
    angles::angles_of,
    text::{as_attribute, as_id, as_literal},
};

impl Writer {
    pub(super) fn descriptions(&mut self, descriptions: &[(String, String)]) {
        for (name, value) in descriptions {
            self.open("description");
            self.attribute("name", &as_id(name));
            self.attribute("value", &as_attribute(&as_literal(value)));
            self.close();
        }
    }

    pub(super) fn id(&mut self, id: &str) {
        if !id.is_empty() {
            self.attribute("id", &as_id(id));
        }
    }

    pub(super) fn pose(&mut self, pose: Pose) {
        self.vector("location", pose.location);
        if pose.rotation != Pose::IDENTITY.rotation {
            let DVec3 { x, y, z } = angles_of(pose.rotation);
            self.attribute("rotation", &format!("({x},{y},{z})"));
        }
    }

    pub(super) fn vector(&mut self, name: &str, vector: Vec3) {
        let Vec3 { x, y, z } = vector;
        self.attribute(name, &format!("({x},{y},{z})"));
    }

    pub(super) fn spans(&mut self, names: [&str; 3], spans: Vec3) {
        for (name, span) in names.into_iter().zip(spans.to_array()) {
            self.number(name, span);
        }
    }

    pub(super) fn number(&mut self, name: &str, number: f32) {
        self.attribute(name, &number.to_string());
    }

    pub(super) fn color(&mut self, name: &str, color: Rgb) {
        match NAMED_COLORS.iter().find(|(_, named)| *named == color) {
            Some((known, _)) => self.attribute(name, known),
            None => self.attribute(name, &color.to_string()),
        }
    }

    pub(super) fn attribute(&mut self, name: &str, value: &str) {
        // Writing to a `String` does not fail.
        let _written = write!(self.text, " {name}=\"{value}\"");
    }

    pub(super) fn open(&mut self, name: &'static str) {
        if self.is_empty {
            self.text.push('>');
        }
        self.begin_line();
        self.text.push('<');
        self.text.push_str(name);
        self.open.push(name);
        self.is_empty = true;
    }

    pub(super) fn close(&mut self) {
        let Some(name) = self.open.pop() else {
            return;
        };
        if self.is_empty {
            self.text.push_str("/>");
        } else {
            self.begin_line();
            let _written = write!(self.text, "</{name}>");
        }
        self.is_empty = false;
    }

    pub(super) fn begin_line(&mut self) {
        self.text.push('\n');
        self.text.push_str(&"  ".repeat(self.open.len()));
    }
}
