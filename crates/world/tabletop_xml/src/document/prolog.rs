//! The prolog of a file: declaration, document type, processing instructions.

use quick_xml::events::BytesDecl;

use crate::{
    document::build::Builder,
    document::syntax::{is_declaration, is_name},
    fault::{Excerpt, Place},
};

impl Builder<'_, '_> {
    pub fn check_declaration(&mut self, offset: usize, declaration: &BytesDecl) {
        let place = Place::outside(self.source, offset);
        if offset > 0 {
            let problem = "the XML declaration is not at the beginning";
            self.faults.report(place, problem, "nothing before it");
        }
        if !is_declaration(declaration) {
            let problem = "the XML declaration is not complete";
            let expected = "version=\"1.0\" encoding=\"UTF-8\"";
            self.faults.report(place, problem, expected);
        } else if !matches!(declaration.version().as_deref(), Ok("1.0" | "1.1")) {
            let problem = "the XML declaration has no known version";
            self.faults.report(place, problem, "version=\"1.0\"");
        }
        if let Some(encoding) = declaration.encoding() {
            let encoding = encoding.unwrap_or_default();
            let is_known = ["utf-8", "utf8", "us-ascii", "ascii"]
                .iter()
                .any(|known| known.eq_ignore_ascii_case(&encoding));
            if !is_known && !self.text.is_ascii() {
                let problem = format_args!("the encoding is `{}`", Excerpt(&encoding));
                self.faults.report(place, problem, "UTF-8");
            }
        }
    }

    pub fn check_instruction(&mut self, offset: usize, target: &str) {
        if !is_name(target) || target.eq_ignore_ascii_case("xml") {
            let place = self.place(offset);
            let problem = "the processing instruction has no name";
            self.faults.report(place, problem, "<?name ...?>");
        }
    }

    pub fn check_doctype(&mut self, offset: usize, doctype: &str) {
        let place = self.place(offset);
        if !self.open.is_empty() || self.root.is_some() {
            let problem = "the DOCTYPE is not before the root element";
            self.faults.report(place, problem, "elements and comments");
        }
        if doctype.contains("<!ENTITY") {
            let problem = "entities are declared, which are not read";
            self.faults
                .report(place, problem, "a file without entities");
        }
    }
}
