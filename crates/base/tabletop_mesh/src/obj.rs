//! OBJ files, without colours.

use bevy::math::Vec3;

use crate::{
    Triangle,
    error::MeshFileError,
    text::{lines, point},
};

/// The faces of an OBJ file, as triangles around their first corner. Normals, colours and groups are passed over.
///
/// # Errors
/// It is none, or has more than `most` triangles.
pub fn read_obj(bytes: &[u8], most: usize) -> Result<Vec<Triangle>, MeshFileError> {
    let mut points = Vec::new();
    let mut triangles = Vec::new();
    for (line, words) in lines(bytes).map_err(MeshFileError::Obj)? {
        match &words[..] {
            ["v", rest @ ..] => points.push(point(line, rest).map_err(MeshFileError::Obj)?),
            ["f", corners @ ..] => {
                let corners = corners.iter().map(|word| corner(word, &points));
                let corners: Option<Vec<Vec3>> = corners.collect();
                let Some([first, rest @ ..]) = corners.as_deref() else {
                    let fault = format!("line {line}: a face has a corner that is not there");
                    return Err(MeshFileError::Obj(fault));
                };
                triangles.extend(rest.windows(2).map(|pair| [*first, pair[0], pair[1]]));
                if triangles.len() > most {
                    return Err(MeshFileError::TooManyTriangles(most));
                }
            }
            _ => {}
        }
    }
    Ok(triangles)
}

/// The point that `7`, `7/1/3` or `-1`, the last one so far, means.
fn corner(word: &str, points: &[Vec3]) -> Option<Vec3> {
    let number: i64 = word.split('/').next()?.parse().ok()?;
    let index = match number {
        1.. => usize::try_from(number).ok()? - 1,
        _ => points
            .len()
            .checked_sub(usize::try_from(number.checked_neg()?).ok()?)?,
    };
    points.get(index).copied()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn faces_are_divided_and_counted_from_both_ends() {
        let text = b"mtllib /etc/passwd\n# v 1 1 1\nv 0 0 0\nv 1 0 0 1 1 1\nv 1 1 0\nv 0 1 0\nf 1/1/1 2//2 -2 4\n";
        let [first, second] = read_obj(text, 2).unwrap_or_default()[..] else {
            panic!("a square is two triangles");
        };
        assert_eq!(first, [Vec3::ZERO, Vec3::X, Vec3::new(1.0, 1.0, 0.0)]);
        assert_eq!(second, [Vec3::ZERO, Vec3::new(1.0, 1.0, 0.0), Vec3::Y]);
        for face in [
            "f 0 1 2",
            "f 1 2 5",
            "f -5 1 2",
            "f 1 2 x",
            "f 1 2 -9223372036854775808",
        ] {
            let text = format!("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 1\n{face}\n");
            let fault = read_obj(text.as_bytes(), 9);
            let expected = "line 5: a face has a corner that is not there".to_owned();
            assert_eq!(fault, Err(MeshFileError::Obj(expected)));
        }
    }
}
