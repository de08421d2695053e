//! A description as plain XML: elements, attributes and text, without XML's other features.
//!
//! The URDF reader descends by recursion, trusts the declarations of a DOCTYPE and panics at unbound namespaces. It only ever sees
//! plain texts.

use quick_xml::{
    Reader, XmlVersion,
    escape::{escape, resolve_xml_entity},
    events::{BytesRef, BytesStart, Event},
};

use crate::outline::DEEPEST;

/// The largest text that is read.
const MOST_BYTES: usize = 16 << 20;

/// Most attributes of an element.
const MOST_ATTRIBUTES: usize = 100;

/// The fault of a text, and the number of bytes read.
pub(crate) struct ReadFault {
    pub offset: usize,
    pub what: String,
}

/// The elements of URDF that are not used, and whose faults need not concern anybody.
const UNUSED: [&str; 1] = ["texture"];

/// Rewrites a text without comments, processing instructions, namespaces, unused elements, and parts in other languages: elements and
/// attributes with a prefix.
pub(crate) fn plain(text: &str) -> Result<String, ReadFault> {
    if text.len() > MOST_BYTES {
        let what = format!("it has more than {MOST_BYTES} bytes");
        return Err(ReadFault { offset: 0, what });
    }
    let mut writer = Plain::default();
    let mut reader = Reader::from_str(text);
    loop {
        let offset = |reader: &Reader<_>| usize::try_from(reader.buffer_position()).unwrap_or(0);
        let event = reader.read_event().map_err(|error| ReadFault {
            offset: usize::try_from(reader.error_position()).unwrap_or(0),
            what: error.to_string(),
        })?;
        if let Event::Eof = event {
            return writer.finish(text.len());
        }
        writer.write(event).map_err(|what| ReadFault {
            offset: offset(&reader),
            what,
        })?;
    }
}

#[derive(Default)]
struct Plain {
    text: String,
    /// The names of the elements that have not ended.
    open: Vec<String>,
    /// Number of enclosing elements, including this one, that belong to another language, are unused, or are in such an element.
    foreign: usize,
}

impl Plain {
    fn write(&mut self, event: Event) -> Result<(), String> {
        match event {
            Event::Start(tag) => self.begin(&tag),
            Event::Empty(tag) => self.begin(&tag).and_then(|()| self.end()),
            Event::End(_) => self.end(),
            Event::Text(text) => self.write_text(&text),
            Event::CData(text) => self.write_text(&text),
            Event::GeneralRef(reference) => self.write_text(&character(&reference)?),
            Event::DocType(_) => Err("a DOCTYPE is not read: remove it".to_owned()),
            Event::Comment(_) | Event::Decl(_) | Event::PI(_) | Event::Eof => Ok(()),
        }
    }

    fn begin(&mut self, tag: &BytesStart) -> Result<(), String> {
        let name = name_of(tag.name().0)?.to_owned();
        let is_foreign = name.contains(':') || UNUSED.contains(&&*name);
        if self.open.len() >= DEEPEST {
            return Err(format!("elements are nested more than {DEEPEST} deep"));
        }
        if self.open.is_empty() && !self.text.is_empty() {
            return Err("a second element stands beside the root element".to_owned());
        }
        self.open.push(name.clone());
        if self.foreign > 0 || is_foreign {
            self.foreign += 1;
            return Ok(());
        }
        self.text.push('<');
        self.text.push_str(&name);
        for (count, attribute) in tag.attributes().enumerate() {
            let attribute = attribute.map_err(|error| error.to_string())?;
            if count == MOST_ATTRIBUTES {
                return Err(format!("it has more than {MOST_ATTRIBUTES} attributes"));
            }
            let name = name_of(attribute.key.0)?;
            if name == "xmlns" || name.contains(':') {
                continue;
            }
            let value = attribute.normalized_value(XmlVersion::Implicit1_0);
            let value = value.map_err(|error| error.to_string())?;
            self.text += &format!(" {name}=\"{}\"", escape(value));
        }
        self.text.push('>');
        Ok(())
    }

    fn end(&mut self) -> Result<(), String> {
        let Some(name) = self.open.pop() else {
            return Err("a tag closes no element".to_owned());
        };
        match self.foreign.checked_sub(1) {
            Some(foreign) => self.foreign = foreign,
            None => self.text += &format!("</{name}>"),
        }
        Ok(())
    }

    fn write_text(&mut self, text: &str) -> Result<(), String> {
        if self.foreign == 0 && !self.open.is_empty() {
            self.text.push_str(&escape(text));
        }
        Ok(())
    }

    fn finish(self, offset: usize) -> Result<String, ReadFault> {
        match self.open.last() {
            None => Ok(self.text),
            Some(name) => Err(ReadFault {
                offset,
                what: format!("{name} does not end"),
            }),
        }
    }
}

/// A name of URDF, perhaps with a prefix.
fn name_of(name: &str) -> Result<&str, String> {
    let is_letter = |byte: u8| byte.is_ascii_alphanumeric() || b"_-.:".contains(&byte);
    match !name.is_empty() && name.bytes().all(is_letter) {
        true => Ok(name),
        false => Err(format!("`{name}` is no name of an element or attribute")),
    }
}

/// The character that a reference such as `&lt;` means.
fn character(reference: &BytesRef) -> Result<String, String> {
    let character = match reference.resolve_char_ref() {
        Ok(Some(character)) => Some(character.to_string()),
        Ok(None) => resolve_xml_entity(reference).map(str::to_owned),
        Err(_) => None,
    };
    character.ok_or_else(|| format!("`&{};` is not known", &**reference))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn written(text: &str) -> String {
        plain(text).unwrap_or_else(|fault| format!("{}: {}", fault.offset, fault.what))
    }

    #[test]
    fn comments_declarations_and_foreign_elements_are_removed() {
        let text = "<?xml version='1.0'?><!-- a --><robot xmlns='x' xmlns:g='y' name='&lt;a&#x41;'>\
            <g:plugin><link name='no'/></g:plugin><texture/>\n<link g:a='b' name='l'/><t>a &amp; <![CDATA[<b>]]></t></robot>";
        assert_eq!(
            written(text),
            "<robot name=\"&lt;aA\">\n<link name=\"l\"></link><t>a &amp; &lt;b&gt;</t></robot>"
        );
    }

    #[test]
    fn unsafe_or_malformed_xml_is_refused() {
        let deep = "<a>".repeat(20_000);
        for (text, what) in [
            ("<!DOCTYPE r [<!ENTITY a '<b>'>]><r>&a;</r>", "DOCTYPE"),
            ("<r>&a;</r>", "`&a;` is not known"),
            ("<r a='&a;'/>", "a"),
            ("<r/><r/>", "second element"),
            ("<r></r></r>", ""),
            ("<r><a></r>", ""),
            ("<r", ""),
            ("<r a='1' a='2'/>", ""),
            ("<r a=1/>", ""),
            ("<r é='1'/>", "`é` is no name"),
            ("< r/>", "`` is no name"),
            (deep.as_str(), "more than 64 deep"),
        ] {
            let fault = plain(text).map_err(|fault| fault.what);
            let fault = fault.expect_err(text.get(..40).unwrap_or(text));
            assert!(fault.contains(what), "{fault}");
        }
    }
}
