//! The mock Baxter: a child process, on the genuine rospy and rosmaster.

use std::{
    collections::BTreeMap,
    io::{BufRead as _, BufReader, Write as _},
    process::{Child, ChildStdin, ChildStdout, Command, Stdio},
};

use serde::Deserialize;
use tabletop_bridge::Address;

const SOURCE: &str = include_str!("mock_baxter.py");

/// It ends with its standard input, so with this program, however that ends.
pub struct MockBaxter {
    child: Child,
    orders: Option<ChildStdin>,
    answers: BufReader<ChildStdout>,
    port: u16,
}

/// What it says of itself.
#[derive(Debug, Deserialize)]
pub struct Report {
    pub angles: BTreeMap<String, f64>,
    pub modes: BTreeMap<String, Vec<i32>>,
    pub dropped: usize,
    pub time_limits: [f64; 2],
    pub ratios: [f64; 2],
    pub openings: [f64; 2],
    pub head: f64,
    pub opened: Option<(String, u32, u32, Vec<i32>)>,
    pub enabled: bool,
    /// Each command to an arm: when it came, in s since 1970, and its first number.
    pub log: BTreeMap<String, Vec<(f64, f64)>>,
    /// When the robot was stopped last, in s since 1970.
    pub stopped_at: f64,
}

impl MockBaxter {
    pub fn start() -> Self {
        Self::start_at(&BTreeMap::new())
    }

    /// With joints at these angles, in rad, and the others at 0.5.
    pub fn start_at(angles: &BTreeMap<String, f64>) -> Self {
        let mut command = Command::new("/usr/bin/python3");
        command
            .args(["-c", SOURCE, &serde_json::to_string(angles).unwrap()])
            .stdin(Stdio::piped())
            .stdout(Stdio::piped());
        let mut child = command.spawn().unwrap();
        let orders = child.stdin.take();
        let mut answers = BufReader::new(child.stdout.take().unwrap());
        let mut line = String::new();
        answers.read_line(&mut line).unwrap();
        let port = line.trim().parse().unwrap();
        Self {
            child,
            orders,
            answers,
            port,
        }
    }

    pub fn address(&self) -> Address {
        format!("baxter:ros://127.0.0.1:{}", self.port)
            .parse()
            .unwrap()
    }

    pub fn port(&self) -> u16 {
        self.port
    }

    /// Gives an order: `estop`, `reset`, `disable`, `error`, `stick`, `silence`, `fill` (whenever a gripper closes, half open, something is between its fingers), `forget` (the log),
    /// or anything else for a report alone.
    pub fn order(&mut self, order: &str) -> Report {
        writeln!(self.orders.as_mut().unwrap(), "{order}").unwrap();
        let mut line = String::new();
        self.answers.read_line(&mut line).unwrap();
        serde_json::from_str(&line).unwrap()
    }

    pub fn report(&mut self) -> Report {
        self.order("report")
    }
}

impl Drop for MockBaxter {
    fn drop(&mut self) {
        drop(self.orders.take());
        drop(self.child.wait());
    }
}
