//! Addresses of robots, such as `baxter:ros://011305P0002.local:11311`.

use std::{fmt, str::FromStr};

use thiserror::Error;

/// The way to a robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RobotWay {
    /// The robot's own ROS 1: its master and its nodes, without anything between.
    Ros,
    /// A rosbridge server (protocol 2) beside the robot, over a WebSocket.
    Rosbridge,
}

impl RobotWay {
    const ALL: [Self; 2] = [Self::Ros, Self::Rosbridge];

    /// As an address has it.
    pub fn scheme(self) -> &'static str {
        match self {
            Self::Ros => "ros",
            Self::Rosbridge => "ws",
        }
    }

    /// The port where it usually is.
    pub fn usual_port(self) -> u16 {
        match self {
            Self::Ros => 11311,
            Self::Rosbridge => 9090,
        }
    }
}

/// Where a robot is, and by which way it is reached: `ROBOT:ros://HOST[:PORT]` or `ROBOT:ws://HOST[:PORT]`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Address {
    /// The name of the robot's profile, such as `baxter`.
    pub robot: String,
    /// The way.
    pub way: RobotWay,
    /// A name or an IP address; one of version 6 without its brackets.
    pub host: String,
    /// The port.
    pub port: u16,
}

/// A text that is no address of a robot.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error(
    "{text:?} is no address of a robot: {fault}, as in baxter:ros://HOST:11311 or baxter:ws://HOST:9090"
)]
pub struct AddressError {
    text: String,
    fault: String,
}

impl FromStr for Address {
    type Err = AddressError;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        parse(text).map_err(|fault| AddressError {
            text: text.to_owned(),
            fault,
        })
    }
}

impl fmt::Display for Address {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let scheme = self.way.scheme();
        let authority = authority(&self.host, self.port);
        write!(f, "{}:{scheme}://{authority}", self.robot)
    }
}

/// Host and port as a URI has them.
pub(crate) fn authority(host: &str, port: u16) -> String {
    match host.contains(':') {
        true => format!("[{host}]:{port}"),
        false => format!("{host}:{port}"),
    }
}

/// Host and port of a URI's authority; the port is that given if it has none.
pub(crate) fn host_and_port(authority: &str, usual: Option<u16>) -> Result<(String, u16), String> {
    let (host, port) = match authority.strip_prefix('[') {
        Some(bracketed) => {
            let closed = bracketed.split_once(']');
            let (host, rest) = closed.ok_or("the bracket before the host is not closed")?;
            let port = match rest {
                "" => None,
                rest => Some(
                    rest.strip_prefix(':')
                        .ok_or("a colon must follow the bracket")?,
                ),
            };
            (host, port)
        }
        None => match authority.split_once(':') {
            Some((host, port)) => (host, Some(port)),
            None => (authority, None),
        },
    };
    let is_of_host = |letter: char| letter.is_ascii_alphanumeric() || "-._:%".contains(letter);
    if host.is_empty() {
        return Err("the host is missing".into());
    }
    if !host.chars().all(is_of_host) {
        return Err(format!("{host:?} is no host"));
    }
    let port = match port {
        Some(port) => match port.parse() {
            Ok(port) if port > 0 => port,
            Ok(_) | Err(_) => return Err(format!("{port:?} is no port from 1 to 65535")),
        },
        None => usual.ok_or("the port is missing")?,
    };
    Ok((host.to_owned(), port))
}

fn parse(text: &str) -> Result<Address, String> {
    let (robot, rest) = text
        .split_once(':')
        .ok_or("the robot's name and a colon must come first")?;
    let is_of_name =
        |letter: char| letter.is_ascii_lowercase() || letter.is_ascii_digit() || letter == '_';
    if robot.is_empty() || !robot.chars().all(is_of_name) {
        return Err(format!("{robot:?} is no robot's name"));
    }
    if rest.starts_with("//") {
        return Err(format!("the robot's name is missing before {text:?}"));
    }
    let (scheme, authority) = rest
        .split_once("://")
        .ok_or("the way, ros:// or ws://, must follow the robot's name")?;
    let way = RobotWay::ALL.into_iter().find(|way| way.scheme() == scheme);
    let way =
        way.ok_or_else(|| format!("{scheme}:// is no way to a robot, only ros:// and ws:// are"))?;
    let authority = authority.strip_suffix('/').unwrap_or(authority);
    let (host, port) = host_and_port(authority, Some(way.usual_port()))?;
    Ok(Address {
        robot: robot.to_owned(),
        way,
        host,
        port,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn addresses_are_read_as_they_are_written() {
        for text in [
            "baxter:ros://011305P0002.local:11311",
            "baxter:ws://192.168.0.7:9090",
            "panda:ws://[fe80::1]:9091",
        ] {
            assert_eq!(text.parse::<Address>().unwrap().to_string(), text);
        }
        let short: Address = "baxter:ros://robot/".parse().unwrap();
        assert_eq!(short.to_string(), "baxter:ros://robot:11311");
        let short: Address = "panda:ws://robot".parse().unwrap();
        assert_eq!(short.port, 9090);
    }

    #[test]
    fn a_refusal_says_what_is_wrong() {
        for (text, fault) in [
            ("", "the robot's name and a colon must come first"),
            ("ros://robot:11311", "the robot's name is missing"),
            ("baxter:robot:11311", "the way, ros:// or ws://"),
            ("baxter:http://robot", "http:// is no way to a robot"),
            ("baxter:ws://", "the host is missing"),
            ("baxter:ws://:9090", "the host is missing"),
            ("baxter:ws://a b", "is no host"),
            ("baxter:ws://a:0", "\"0\" is no port"),
            ("baxter:ws://a:99999", "\"99999\" is no port"),
            ("baxter:ws://[fe80::1:9090", "is not closed"),
            ("Bax ter:ws://a", "is no robot's name"),
        ] {
            let refusal = text.parse::<Address>().unwrap_err().to_string();
            assert!(refusal.contains(fault), "{text}: {refusal}");
            assert!(refusal.contains("as in baxter:ros://HOST:11311"));
        }
    }
}
