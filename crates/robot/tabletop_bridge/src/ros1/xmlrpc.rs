//! XML-RPC: how nodes of ROS 1 talk with their master and ask each other for topics.

use std::collections::BTreeMap;

use quick_xml::{Reader, XmlVersion, escape::partial_escape, events::Event};

/// The deepest that values may be nested.
const MOST_DEPTH: usize = 16;

/// A value of a call or an answer.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum RpcValue {
    Int(i32),
    Bool(bool),
    Double(f64),
    Text(String),
    List(Vec<RpcValue>),
    Struct(BTreeMap<String, RpcValue>),
}

/// What a peer has said.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum RpcMessage {
    /// It calls a method.
    Call {
        method: String,
        arguments: Vec<RpcValue>,
    },
    /// It answers.
    Answer(RpcValue),
    /// It answers that it cannot.
    Fault(RpcValue),
}

impl RpcValue {
    pub(super) fn text(text: impl Into<String>) -> Self {
        Self::Text(text.into())
    }

    pub(super) fn as_text(&self) -> Option<&str> {
        match self {
            Self::Text(text) => Some(text),
            Self::Int(_) | Self::Bool(_) | Self::Double(_) | Self::List(_) | Self::Struct(_) => {
                None
            }
        }
    }

    pub(super) fn as_int(&self) -> Option<i32> {
        match self {
            Self::Int(number) => Some(*number),
            Self::Text(_) | Self::Bool(_) | Self::Double(_) | Self::List(_) | Self::Struct(_) => {
                None
            }
        }
    }

    pub(super) fn as_list(&self) -> Option<&[RpcValue]> {
        match self {
            Self::List(values) => Some(values),
            Self::Text(_) | Self::Int(_) | Self::Bool(_) | Self::Double(_) | Self::Struct(_) => {
                None
            }
        }
    }

    fn xml(&self) -> String {
        let content = match self {
            Self::Int(number) => format!("<int>{number}</int>"),
            Self::Bool(truth) => format!("<boolean>{}</boolean>", u8::from(*truth)),
            Self::Double(number) => format!("<double>{number}</double>"),
            Self::Text(text) => format!("<string>{}</string>", partial_escape(text)),
            Self::List(values) => {
                let values: String = values.iter().map(Self::xml).collect();
                format!("<array><data>{values}</data></array>")
            }
            Self::Struct(members) => {
                let members = members.iter().map(|(name, value)| {
                    let name = partial_escape(name.as_str());
                    format!("<member><name>{name}</name>{}</member>", value.xml())
                });
                format!("<struct>{}</struct>", members.collect::<String>())
            }
        };
        format!("<value>{content}</value>")
    }
}

/// The text of a call.
pub(super) fn call(method: &str, arguments: &[RpcValue]) -> String {
    let arguments = arguments
        .iter()
        .map(|argument| format!("<param>{}</param>", argument.xml()));
    let params: String = arguments.collect();
    format!(
        "<?xml version=\"1.0\"?><methodCall><methodName>{method}</methodName><params>{params}</params></methodCall>"
    )
}

/// The text of an answer.
pub(super) fn answer(value: &RpcValue) -> String {
    let value = value.xml();
    format!(
        "<?xml version=\"1.0\"?><methodResponse><params><param>{value}</param></params></methodResponse>"
    )
}

/// What a text says.
pub(super) fn parse(xml: &str) -> Result<RpcMessage, String> {
    let root = XmlNode::read(xml)?;
    let params = root.child("params");
    let values = params.iter().flat_map(|params| &params.children);
    let values: Result<Vec<_>, _> = values
        .map(|param| param.only_child("value")?.value())
        .collect();
    let mut values = values?;
    match root.name.as_str() {
        "methodCall" => {
            let method = root.child("methodName").ok_or("a call without a method")?;
            Ok(RpcMessage::Call {
                method: method.text.trim().to_owned(),
                arguments: values,
            })
        }
        "methodResponse" => match (root.child("fault"), values.pop()) {
            (Some(fault), _) => Ok(RpcMessage::Fault(fault.only_child("value")?.value()?)),
            (None, Some(value)) => Ok(RpcMessage::Answer(value)),
            (None, None) => Err("an answer without a value".into()),
        },
        name => Err(format!("<{name}> is neither call nor answer")),
    }
}

/// An element.
#[derive(Debug, Default)]
struct XmlNode {
    name: String,
    text: String,
    children: Vec<XmlNode>,
}

impl XmlNode {
    fn read(xml: &str) -> Result<Self, String> {
        let mut reader = Reader::from_str(xml);
        reader.config_mut().expand_empty_elements = true;
        let mut open: Vec<Self> = Vec::new();
        loop {
            let event = reader.read_event().map_err(|error| error.to_string())?;
            match event {
                Event::Start(start) => {
                    if open.len() > 5 * MOST_DEPTH {
                        return Err(format!("values are nested deeper than {MOST_DEPTH}"));
                    }
                    let name = start.name().as_ref().to_owned();
                    open.push(Self {
                        name,
                        ..Self::default()
                    });
                }
                Event::End(_) => {
                    let done = open.pop().ok_or("an element ends that has not begun")?;
                    match open.last_mut() {
                        Some(parent) => parent.children.push(done),
                        None => return Ok(done),
                    }
                }
                Event::Text(text) => {
                    if let Some(last) = open.last_mut() {
                        last.text
                            .push_str(&text.xml_content(XmlVersion::Implicit1_0));
                    }
                }
                Event::CData(text) => {
                    if let Some(last) = open.last_mut() {
                        last.text
                            .push_str(&text.xml_content(XmlVersion::Implicit1_0));
                    }
                }
                Event::GeneralRef(reference) => {
                    let letter = match reference.resolve_char_ref() {
                        Ok(Some(letter)) => letter,
                        Ok(None) => predefined(&reference.xml_content(XmlVersion::Implicit1_0))?,
                        Err(error) => return Err(error.to_string()),
                    };
                    if let Some(last) = open.last_mut() {
                        last.text.push(letter);
                    }
                }
                Event::DocType(_) => return Err("a document type has no place here".into()),
                Event::Eof => return Err("the text ends too early".into()),
                Event::Empty(_) | Event::Comment(_) | Event::Decl(_) | Event::PI(_) => {}
            }
        }
    }

    fn child(&self, name: &str) -> Option<&Self> {
        self.children.iter().find(|child| child.name == name)
    }

    fn only_child(&self, name: &str) -> Result<&Self, String> {
        self.child(name)
            .ok_or_else(|| format!("<{}> without <{name}>", self.name))
    }

    /// The value of a `<value>`: a text, if it does not say what it is.
    fn value(&self) -> Result<RpcValue, String> {
        let Some(kind) = self.children.first() else {
            return Ok(RpcValue::Text(self.text.clone()));
        };
        let text = kind.text.trim();
        let unfit = || format!("{text:?} is no {}", kind.name);
        Ok(match kind.name.as_str() {
            "int" | "i4" => RpcValue::Int(text.parse().map_err(|_| unfit())?),
            "boolean" => RpcValue::Bool(match text {
                "0" => false,
                "1" => true,
                _ => return Err(unfit()),
            }),
            "double" => RpcValue::Double(text.parse().map_err(|_| unfit())?),
            "string" => RpcValue::Text(kind.text.clone()),
            "array" => {
                let values = &kind.only_child("data")?.children;
                RpcValue::List(values.iter().map(Self::value).collect::<Result<_, _>>()?)
            }
            "struct" => {
                let members = kind.children.iter().map(|member| {
                    let name = member.only_child("name")?.text.clone();
                    Ok::<_, String>((name, member.only_child("value")?.value()?))
                });
                RpcValue::Struct(members.collect::<Result<_, _>>()?)
            }
            kind => return Err(format!("values of the kind {kind} are not known")),
        })
    }
}

fn predefined(name: &str) -> Result<char, String> {
    Ok(match name {
        "lt" => '<',
        "gt" => '>',
        "amp" => '&',
        "quot" => '"',
        "apos" => '\'',
        _ => return Err(format!("&{name}; is not known")),
    })
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn values() -> impl Strategy<Value = RpcValue> {
        let leaf = prop_oneof![
            any::<i32>().prop_map(RpcValue::Int),
            any::<bool>().prop_map(RpcValue::Bool),
            (-1e9..1e9f64).prop_map(RpcValue::Double),
            "[ -~äß&<>]{0,20}".prop_map(RpcValue::Text),
        ];
        leaf.prop_recursive(3, 20, 5, |inner| {
            prop_oneof![
                prop::collection::vec(inner.clone(), 0..5).prop_map(RpcValue::List),
                prop::collection::btree_map("[a-z<&]{1,5}", inner, 0..5).prop_map(RpcValue::Struct),
            ]
        })
    }

    proptest! {
        #[test]
        fn what_is_said_is_understood(value in values()) {
            let said = answer(&value);
            prop_assert_eq!(parse(&said).unwrap(), RpcMessage::Answer(value.clone()));
            let said = call("requestTopic", &[value.clone(), RpcValue::text("x")]);
            let arguments = vec![value, RpcValue::text("x")];
            prop_assert_eq!(parse(&said).unwrap(), RpcMessage::Call { method: "requestTopic".into(), arguments });
        }

        #[test]
        fn any_text_is_understood_or_refused(text in "(<[/]?(value|array|data|int|params|param|methodResponse|fault)>|[a-z&;]){0,30}") {
            drop(parse(&text));
        }
    }

    #[test]
    fn values_that_do_not_say_what_they_are_are_texts() {
        let xml = "<?xml version='1.0'?>\n<methodResponse>\n<params>\n<param>\n<value><array><data>\n<value><i4>1</i4></value>\n<value>a &lt; b</value>\n<value></value><value/></data></array></value>\n</param>\n</params>\n</methodResponse>\n";
        let values = [
            RpcValue::Int(1),
            RpcValue::text("a < b"),
            RpcValue::text(""),
            RpcValue::text(""),
        ];
        assert_eq!(
            parse(xml).unwrap(),
            RpcMessage::Answer(RpcValue::List(values.into()))
        );
    }

    #[test]
    fn faults_and_depths_are_told() {
        let xml =
            "<methodResponse><fault><value><string>no</string></value></fault></methodResponse>";
        assert_eq!(parse(xml).unwrap(), RpcMessage::Fault(RpcValue::text("no")));
        let deep = "<value><array><data>".repeat(1000);
        let refusal = parse(&format!("<methodResponse><params><param>{deep}")).unwrap_err();
        assert_eq!(refusal, "values are nested deeper than 16");
    }
}
