//! Containers, which must have a hollow.

use bevy::math::Vec3;

use crate::elements::attributes::AttributeReader;

/// Notes a fault where the walls of a container leave no hollow.
pub(crate) fn check_hollow(
    name: &'static str,
    span: Vec3,
    thickness: f32,
    attributes: &mut AttributeReader,
) {
    let most = (span.x / 2.0).min(span.y / 2.0).min(span.z);
    if attributes.is_sound() && thickness >= most {
        let problem = format_args!("walls of {thickness} leave no hollow");
        attributes.fault(name, problem, format_args!("less than {most}"));
    }
}

#[cfg(test)]
mod tests {
    use crate::test_support::lines_of;

    #[test]
    fn walls_leave_a_hollow() {
        assert_eq!(
            lines_of("<box location='(0,0,1)' zspan='3' thickness='.5'/>"),
            ["box, thickness: walls of 0.5 leave no hollow, expected less than 0.5"]
        );
        assert_eq!(
            lines_of("<box location='(0,0,1)' zspan='.05'/>"),
            ["box, thickness: walls of 0.05 leave no hollow, expected less than 0.05"]
        );
        assert_eq!(
            lines_of("<lidbox location='(0,0,1)' handleThickness='.25'/>"),
            ["lidbox, handleThickness: walls of 0.25 leave no hollow, expected less than 0.25"]
        );
    }
}
