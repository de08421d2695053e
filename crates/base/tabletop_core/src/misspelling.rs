//! Suggestions for misspelt names.

/// The name that is at most two typing errors away from the misspelt one, the nearest if there are several.
pub fn nearest_name<'n>(misspelt: &str, names: &[&'n str]) -> Option<&'n str> {
    names
        .iter()
        .map(|&name| (distance(misspelt, name), name))
        .filter(|&(distance, name)| distance <= 2 && distance <= name.len() / 2)
        .min_by_key(|&(distance, _)| distance)
        .map(|(_, name)| name)
}

/// Number of letters to add, remove or replace to turn one name into the other, in upper or lower case.
fn distance(left: &str, right: &str) -> usize {
    if left.len() > 3 * right.len() {
        return left.len();
    }
    let right: Vec<char> = right.chars().collect();
    let mut row: Vec<usize> = (0..=right.len()).collect();
    for (i, l) in left.chars().enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, r) in right.iter().enumerate() {
            let replaced = diagonal + usize::from(!l.eq_ignore_ascii_case(r));
            diagonal = row[j + 1];
            row[j + 1] = replaced.min(row[j] + 1).min(diagonal + 1);
        }
    }
    row[right.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn near_names_are_found() {
        let names = ["id", "color", "xspan", "location", "linkXspan"];
        for (misspelt, name) in [
            ("colour", Some("color")),
            ("Color", Some("color")),
            ("xpsan", Some("xspan")),
            ("locaton", Some("location")),
            ("linkxspan", Some("linkXspan")),
            ("x", None),
            ("size", None),
            ("", None),
            (&"x".repeat(100_000), None),
        ] {
            assert_eq!(nearest_name(misspelt, &names), name, "{misspelt}");
        }
    }
}
