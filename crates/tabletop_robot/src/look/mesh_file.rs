//! Files of triangles: STL and OBJ, without colours.

use bevy::math::Vec3;

/// Largest number of triangles of a mesh.
const MOST_TRIANGLES: usize = 1_000_000;

/// Length of the head of a binary STL file: a title, and the number of triangles.
const STL_HEAD: usize = 84;

/// Length of its triangles: a normal, three corners, and two bytes without meaning.
const STL_TRIANGLE: usize = 50;

/// The corners of a triangle, in the units of its file.
pub type Corners = [Vec3; 3];

/// The triangles of an STL file, binary or text.
///
/// # Errors
/// It is not such a file, or has too many triangles.
pub fn read_stl(bytes: &[u8]) -> Result<Vec<Corners>, String> {
    let count = bytes
        .get(80..STL_HEAD)
        .and_then(|count| count.try_into().ok());
    let count = count.map(|count| u32::from_le_bytes(count) as usize);
    let is_binary = count
        .and_then(|count| count.checked_mul(STL_TRIANGLE)?.checked_add(STL_HEAD))
        .is_some_and(|length| length == bytes.len());
    match (is_binary, bytes.trim_ascii_start().starts_with(b"solid")) {
        (true, _) => read_binary_stl(bytes),
        (false, true) => read_text_stl(bytes),
        (false, false) => Err(
            "it is no STL file: its length is not that of the triangles that it announces".into(),
        ),
    }
}

fn read_binary_stl(bytes: &[u8]) -> Result<Vec<Corners>, String> {
    let triangles = bytes[STL_HEAD..].chunks_exact(STL_TRIANGLE);
    check_count(triangles.len())?;
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

fn read_text_stl(bytes: &[u8]) -> Result<Vec<Corners>, String> {
    let mut triangles = Vec::new();
    let mut corners = Vec::new();
    for (line, words) in lines(bytes)? {
        let [first, rest @ ..] = &words[..] else {
            continue;
        };
        match first.to_ascii_lowercase().as_str() {
            "vertex" => corners.push(point(rest).ok_or_else(|| no_point(line))?),
            "endloop" => {
                let [a, b, c] = corners[..] else {
                    return Err(format!(
                        "line {line}: a triangle has {} corners",
                        corners.len()
                    ));
                };
                triangles.push([a, b, c]);
                check_count(triangles.len())?;
                corners.clear();
            }
            "solid" | "facet" | "outer" | "endfacet" | "endsolid" => {}
            _ => return Err(format!("line {line}: STL has no `{first}`")),
        }
    }
    match corners.is_empty() {
        true => Ok(triangles),
        false => Err("its last triangle does not end".into()),
    }
}

/// The faces of an OBJ file, as triangles around their first corner. Normals, colours and groups are ignored.
///
/// # Errors
/// It is not such a file, or has too many triangles.
pub fn read_obj(bytes: &[u8]) -> Result<Vec<Corners>, String> {
    let mut points = Vec::new();
    let mut triangles = Vec::new();
    for (line, words) in lines(bytes)? {
        match &words[..] {
            ["v", rest @ ..] => points.push(point(rest).ok_or_else(|| no_point(line))?),
            ["f", corners @ ..] => {
                let corners = corners.iter().map(|word| corner(word, &points));
                let corners: Option<Vec<Vec3>> = corners.collect();
                let Some([first, rest @ ..]) = corners.as_deref() else {
                    return Err(format!(
                        "line {line}: a face has a corner that is not there"
                    ));
                };
                triangles.extend(rest.windows(2).map(|pair| [*first, pair[0], pair[1]]));
                check_count(triangles.len())?;
            }
            _ => {}
        }
    }
    Ok(triangles)
}

/// The point that a word means: `7`, `7/1/3`, or `-1` for the last one so far.
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

/// The words of all lines that are not empty, with the lines' numbers.
fn lines(bytes: &[u8]) -> Result<impl Iterator<Item = (usize, Vec<&str>)>, String> {
    let text = str::from_utf8(bytes).map_err(|error| format!("it is no text: {error}"))?;
    let lines = text.lines().zip(1..).map(|(text, line)| {
        let said = text.split('#').next().unwrap_or_default();
        // A name can be as long as a line; of numbers, no more are needed.
        (line, said.split_whitespace().take(MOST_WORDS).collect())
    });
    Ok(lines)
}

/// Largest number of words of a line that are read, and so of corners of a face.
const MOST_WORDS: usize = 1000;

fn point(words: &[&str]) -> Option<Vec3> {
    let [x, y, z, ..] = words else {
        return None;
    };
    Some(Vec3::new(x.parse().ok()?, y.parse().ok()?, z.parse().ok()?))
}

fn no_point(line: usize) -> String {
    format!("line {line}: a corner is not three numbers")
}

fn check_count(triangles: usize) -> Result<(), String> {
    match triangles > MOST_TRIANGLES {
        true => Err(format!("it has more than {MOST_TRIANGLES} triangles")),
        false => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn binary(triangles: &[Corners]) -> Vec<u8> {
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
        assert_eq!(read_stl(&bytes).unwrap(), triangles);
        assert!(read_stl(&bytes[..bytes.len() - 1]).is_err());
    }

    #[test]
    fn faces_are_divided_and_counted_from_both_ends() {
        let text = b"mtllib /etc/passwd\n# v 1 1 1\nv 0 0 0\nv 1 0 0 1 1 1\nv 1 1 0\nv 0 1 0\nf 1/1/1 2//2 -2 4\n";
        let [first, second] = read_obj(text).unwrap()[..] else {
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
            let fault = read_obj(text.as_bytes()).unwrap_err();
            assert_eq!(fault, "line 5: a face has a corner that is not there");
        }
    }

    #[test]
    fn what_is_no_stl_file_is_refused() {
        for (text, fault) in [
            ("", "it is no STL file"),
            ("solid\nvertex 1 2\n", "line 2: a corner"),
            (
                "solid\nouter loop\nvertex 1 2 3\nendloop\n",
                "line 4: a triangle has 1",
            ),
            ("solid\nvertex 1 2 3\n", "its last triangle"),
            ("solid\nwhat\n", "line 2: STL has no `what`"),
        ] {
            let found = read_stl(text.as_bytes()).unwrap_err();
            assert!(found.starts_with(fault), "{found}");
        }
        let mut bytes = binary(&[]);
        bytes[80..84].copy_from_slice(&u32::MAX.to_le_bytes());
        assert!(read_stl(&bytes).is_err());
    }

    proptest! {
        #[test]
        fn no_bytes_panic(bytes in prop::collection::vec(any::<u8>(), 0..300), is_text: bool) {
            let head: &[u8] = if is_text { b"solid\n" } else { b"v 0 0 0\nf 1 1 1\n" };
            let bytes = [head, &bytes].concat();
            let _read = (read_stl(&bytes), read_obj(&bytes));
        }
    }
}
