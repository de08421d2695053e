//! Bytes of a task file as text.

/// The text of a file, as far as it is text.
#[derive(Debug, PartialEq)]
pub(crate) struct Decoded<'a> {
    /// The text without a byte order mark, up to the first byte that cannot be read.
    pub text: &'a str,
    /// The reason why the text ends before the file does.
    pub cut: Option<Cut>,
}

/// The reason why a text ends before its file does.
#[derive(Debug, PartialEq)]
pub(crate) struct Cut {
    pub problem: String,
    pub expected: &'static str,
}

const UTF_8: &str = "a file in UTF-8";

/// Reads bytes as UTF-8, up to the first that is invalid or not allowed in XML.
pub(crate) fn decode(bytes: &[u8]) -> Decoded<'_> {
    if let Some(encoding) = other_encoding(bytes) {
        return Decoded {
            text: "",
            cut: Some(Cut {
                problem: format!("the file is in {encoding}"),
                expected: UTF_8,
            }),
        };
    }
    let (text, mut cut) = match str::from_utf8(bytes) {
        Ok(text) => (text, None),
        Err(error) => {
            let (valid, invalid) = bytes.split_at(error.valid_up_to());
            let cut = Cut {
                problem: format!("byte 0x{:02x} is not UTF-8", invalid[0]),
                expected: UTF_8,
            };
            (str::from_utf8(valid).unwrap_or_default(), Some(cut))
        }
    };
    // The XML reader drops byte order marks without counting them.
    let mut text = text.trim_start_matches('\u{feff}');
    if let Some((offset, character)) = text
        .char_indices()
        .find(|&(_, character)| !is_xml_character(character))
    {
        text = &text[..offset];
        cut = Some(Cut {
            problem: format!("character U+{:04X} is not allowed", u32::from(character)),
            expected: "characters of XML 1.0",
        });
    }
    Decoded { text, cut }
}

/// True if XML 1.0 allows the character.
pub(crate) fn is_xml_character(character: char) -> bool {
    match character {
        '\t' | '\n' | '\r' => true,
        '\u{fffe}' | '\u{ffff}' => false,
        other => other >= ' ',
    }
}

/// The encoding that the first bytes reveal, if it is not a superset of ASCII.
fn other_encoding(bytes: &[u8]) -> Option<&'static str> {
    match bytes {
        [0xff, 0xfe, 0, 0, ..] | [0, 0, 0xfe, 0xff, ..] => Some("UTF-32"),
        [b'<', 0, 0, 0, ..] | [0, 0, 0, b'<', ..] => Some("UTF-32"),
        [0xff, 0xfe, ..] | [0xfe, 0xff, ..] => Some("UTF-16"),
        [b'<', 0, ..] | [0, b'<', ..] => Some("UTF-16"),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn problem(bytes: &[u8]) -> String {
        decode(bytes).cut.map(|cut| cut.problem).unwrap_or_default()
    }

    #[test]
    fn text_is_read_up_to_the_first_bad_byte() {
        assert_eq!(decode("<é/>".as_bytes()).text, "<é/>");
        assert_eq!(decode("\u{feff}<a/>".as_bytes()).text, "<a/>");
        assert_eq!(problem("\u{feff}<a/>\r\n\t".as_bytes()), "");
        assert_eq!(decode(b"<a>\xe9</a>").text, "<a>");
        assert_eq!(problem(b"<a>\xe9</a>"), "byte 0xe9 is not UTF-8");
        assert_eq!(decode(b"<a>\x01</a>\xe9").text, "<a>");
        assert_eq!(
            problem(b"<a>\x01</a>\xe9"),
            "character U+0001 is not allowed"
        );
    }

    #[test]
    fn other_encodings_are_named() {
        for (bytes, encoding) in [
            (&b"\xff\xfe<\0a\0"[..], "UTF-16"),
            (b"\xfe\xff\0<\0a", "UTF-16"),
            (b"<\0a\0/\0>\0", "UTF-16"),
            (b"\xff\xfe\0\0<\0\0\0", "UTF-32"),
            (b"\0\0\0<\0\0\0a", "UTF-32"),
        ] {
            assert_eq!(problem(bytes), format!("the file is in {encoding}"));
        }
    }
}
