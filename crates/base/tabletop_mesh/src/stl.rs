//! STL files, ASCII and binary.

use bevy::math::Vec3;

use crate::{
    Triangle,
    error::MeshFileError,
    text::{lines, point},
};

/// Length of the head of a binary file: a title, and the number of triangles.
const HEAD: usize = 84;

/// Length of a triangle: a normal, three corners, and two bytes without meaning.
const TRIANGLE: usize = 50;

/// The solids of an STL file, each as its triangles, in the file's axes and units. A binary file has one.
///
/// # Errors
/// It is none, or has more than `most` triangles.
pub fn read_stl(bytes: &[u8], most: usize) -> Result<Vec<Vec<Triangle>>, MeshFileError> {
    let count = bytes.get(80..HEAD).and_then(|count| count.try_into().ok());
    let count = count.map(|count| u32::from_le_bytes(count) as usize);
    let is_binary = count
        .and_then(|count| count.checked_mul(TRIANGLE)?.checked_add(HEAD))
        .is_some_and(|length| length == bytes.len());
    match (is_binary, bytes.trim_ascii_start().starts_with(b"solid")) {
        (true, _) => read_binary(bytes, most).map(|solid| vec![solid]),
        (false, true) => read_text(bytes, most),
        (false, false) => Err(MeshFileError::Stl(
            "its length is not that of the triangles that it announces".into(),
        )),
    }
}

fn read_binary(bytes: &[u8], most: usize) -> Result<Vec<Triangle>, MeshFileError> {
    let triangles = bytes[HEAD..].chunks_exact(TRIANGLE);
    if triangles.len() > most {
        return Err(MeshFileError::TooManyTriangles(most));
    }
    let triangles = triangles.map(|triangle| {
        let (numbers, _) = triangle[12..48].as_chunks();
        let numbers: Vec<f32> = numbers
            .iter()
            .map(|&bytes| f32::from_le_bytes(bytes))
            .collect();
        [0, 3, 6].map(|first| Vec3::from_slice(&numbers[first..]))
    });
    Ok(triangles.collect())
}

fn read_text(bytes: &[u8], most: usize) -> Result<Vec<Vec<Triangle>>, MeshFileError> {
    let mut solids: Vec<Vec<Triangle>> = Vec::new();
    let mut corners = Vec::new();
    let mut left = most;
    for (line, words) in lines(bytes).map_err(MeshFileError::Stl)? {
        let [first, rest @ ..] = &words[..] else {
            continue;
        };
        let fault = |what: String| Err(MeshFileError::Stl(format!("line {line}: {what}")));
        match first.to_ascii_lowercase().as_str() {
            "solid" => solids.push(Vec::new()),
            "vertex" => corners.push(point(line, rest).map_err(MeshFileError::Stl)?),
            "endloop" => {
                let [a, b, c] = corners[..] else {
                    return fault(format!("a triangle has {} corners", corners.len()));
                };
                if left == 0 {
                    return Err(MeshFileError::TooManyTriangles(most));
                }
                left -= 1;
                solids
                    .last_mut()
                    .into_iter()
                    .for_each(|solid| solid.push([a, b, c]));
                corners.clear();
            }
            "facet" | "outer" | "endfacet" | "endsolid" => {}
            _ => return fault(format!("STL has no `{first}`")),
        }
    }
    match corners.is_empty() {
        true => Ok(solids),
        false => Err(MeshFileError::Stl("its last triangle does not end".into())),
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::read_obj;

    fn binary(triangles: &[Triangle]) -> Vec<u8> {
        let mut bytes = b"solid, but binary".to_vec();
        bytes.resize(80, b' ');
        bytes.extend((triangles.len() as u32).to_le_bytes());
        for corners in triangles {
            bytes.extend([0; 12]);
            bytes.extend(
                corners
                    .iter()
                    .flat_map(|corner| corner.to_array())
                    .flat_map(f32::to_le_bytes),
            );
            bytes.extend([0; 2]);
        }
        bytes
    }

    #[test]
    fn binary_triangles_come_back() {
        let triangles = [
            [Vec3::ZERO, Vec3::X, Vec3::Y],
            [Vec3::Z, Vec3::ONE, Vec3::NEG_X],
        ];
        let bytes = binary(&triangles);
        assert_eq!(read_stl(&bytes, 2), Ok(vec![triangles.to_vec()]));
        assert_eq!(read_stl(&bytes, 1), Err(MeshFileError::TooManyTriangles(1)));
        assert!(read_stl(&bytes[..bytes.len() - 1], 2).is_err());
    }

    #[test]
    fn solids_of_a_text_are_kept_apart() {
        let facet = "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";
        let text = format!("solid a\n{facet}endsolid a\nsolid b\n{facet}{facet}endsolid b\n");
        let triangle = [Vec3::ZERO, Vec3::X, Vec3::Y];
        let solids = vec![vec![triangle], vec![triangle; 2]];
        assert_eq!(read_stl(text.as_bytes(), 3), Ok(solids));
        assert!(read_stl(text.as_bytes(), 2).is_err());
    }

    #[test]
    fn malformed_stl_is_refused() {
        for (text, fault) in [
            ("", "its length"),
            ("solid\nvertex 1 2\n", "line 2: a corner"),
            (
                "solid\nouter loop\nvertex 1 2 3\nendloop\n",
                "line 4: a triangle has 1",
            ),
            ("solid\nvertex 1 2 3\n", "its last triangle"),
            ("solid\nwhat\n", "line 2: STL has no `what`"),
        ] {
            let found = read_stl(text.as_bytes(), 9).map_err(|error| error.to_string());
            let expected = format!("it is no STL file: {fault}");
            assert!(
                found
                    .as_ref()
                    .is_err_and(|found| found.starts_with(&expected)),
                "{found:?}"
            );
        }
        let mut bytes = binary(&[]);
        bytes[80..84].copy_from_slice(&u32::MAX.to_le_bytes());
        assert!(read_stl(&bytes, 9).is_err());
    }

    proptest! {
        #[test]
        fn no_bytes_panic(bytes in prop::collection::vec(any::<u8>(), 0..300), is_text: bool) {
            let head: &[u8] = if is_text { b"solid\n" } else { b"v 0 0 0\nf 1 1 1\n" };
            let bytes = [head, &bytes].concat();
            let _read = (read_stl(&bytes, 9), read_obj(&bytes, 9));
        }
    }
}
