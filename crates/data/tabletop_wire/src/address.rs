//! Addresses of served policies.

use std::{fmt, str::FromStr};

use thiserror::Error;
use tungstenite::http::Uri;

/// The port of openpi's servers.
const USUAL_PORT: u16 = 8000;

/// Where a policy is served: `ws://HOST[:PORT]`, the port being 8000 if none is named.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PolicyAddress {
    /// A name or an IP address; one of version 6 without its brackets.
    pub host: String,
    /// The port.
    pub port: u16,
}

/// A text that is no address of a policy.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("{text:?} is no address of a policy: {fault}, as in ws://HOST:8000")]
pub struct PolicyAddressError {
    text: String,
    fault: &'static str,
}

impl FromStr for PolicyAddress {
    type Err = PolicyAddressError;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let error = |fault| PolicyAddressError {
            text: text.to_owned(),
            fault,
        };
        let uri: Uri = text.parse().map_err(|_| error("it must be a URI"))?;
        match uri.scheme_str() {
            Some("ws") => {}
            Some("wss") => return Err(error("only unencrypted ones are reached, by ws://")),
            Some(_) | None => return Err(error("it must begin with ws://")),
        }
        if !matches!(uri.path(), "" | "/") || uri.query().is_some() {
            return Err(error("nothing must follow the port"));
        }
        let host = uri.host().unwrap_or_default();
        let host = host.trim_start_matches('[').trim_end_matches(']');
        if host.is_empty() {
            return Err(error("the host is missing"));
        }
        let port = match uri.port() {
            Some(port) => port.as_u16(),
            None => USUAL_PORT,
        };
        // A port that is no number is none for `Uri`.
        let written = uri.authority().map_or("", |authority| authority.as_str());
        let has_port = written.rsplit(']').next().unwrap_or_default().contains(':');
        if port == 0 || has_port != uri.port().is_some() || written.contains('@') {
            return Err(error("a port from 1 to 65535 must follow the host"));
        }
        Ok(Self {
            host: host.to_owned(),
            port,
        })
    }
}

impl fmt::Display for PolicyAddress {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { host, port } = self;
        match host.contains(':') {
            true => write!(f, "ws://[{host}]:{port}"),
            false => write!(f, "ws://{host}:{port}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn addresses_are_read_as_they_are_written() {
        for text in [
            "ws://gpu:8000",
            "ws://192.168.0.7:9090",
            "ws://[fe80::1]:9091",
        ] {
            assert_eq!(text.parse::<PolicyAddress>().unwrap().to_string(), text);
        }
        let usual: PolicyAddress = "ws://gpu/".parse().unwrap();
        assert_eq!(usual.to_string(), "ws://gpu:8000");
        let usual: PolicyAddress = "ws://[::1]".parse().unwrap();
        assert_eq!(usual.to_string(), "ws://[::1]:8000");
    }

    #[test]
    fn a_refusal_says_what_is_wrong() {
        for (text, fault) in [
            ("", "it must be a URI"),
            ("gpu:8000", "it must begin with ws://"),
            ("http://gpu", "it must begin with ws://"),
            ("wss://gpu", "only unencrypted ones"),
            ("ws://gpu:8000/policy", "nothing must follow the port"),
            ("ws://gpu:0", "a port from 1 to 65535"),
            ("ws://gpu:99999", "a port from 1 to 65535"),
            ("ws://me@gpu:8000", "a port from 1 to 65535"),
        ] {
            let refusal = text.parse::<PolicyAddress>().unwrap_err().to_string();
            assert!(refusal.contains(fault), "{text}: {refusal}");
        }
        "ws://:8000".parse::<PolicyAddress>().unwrap_err();
        "ws://a b".parse::<PolicyAddress>().unwrap_err();
    }
}
