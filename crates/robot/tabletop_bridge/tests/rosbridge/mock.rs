//! A mock rosbridge server with a robot behind it, and everything that can be the matter with the two.

use std::{
    collections::{BTreeMap, BTreeSet},
    io::Write as _,
    net::{TcpListener, TcpStream},
    sync::{
        Arc, Mutex, MutexGuard,
        atomic::{AtomicBool, Ordering},
    },
    thread::{self, JoinHandle},
    time::{Duration, Instant, SystemTime, UNIX_EPOCH},
};

use base64::{Engine as _, engine::general_purpose::STANDARD as BASE64};
use serde_json::{Value, json};
use tabletop_bridge::{Address, BridgeProfile, RosVersion};
use tungstenite::{Message, WebSocket};

/// What is the matter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Trouble {
    Nothing,
    /// Messages come in pieces, in any order.
    Fragments,
    /// The same state comes again and again.
    Frozen,
    /// States come ten times a second.
    Slow,
    /// Joints come in another order every time, beside others.
    Shuffled,
    /// An angle is no number.
    NotANumber,
    /// A megabyte of nonsense comes before each state, and other things that are no messages.
    Garbage,
    /// The connection is closed.
    Closed,
    /// Nothing is read or written any more, and the connection stays.
    HalfOpen,
    /// A long message comes byte by byte.
    Drip,
    /// Commands have no effect.
    Stuck,
    /// The button is pressed.
    EmergencyStop,
    /// States are on their way for 0.3 s.
    Delayed,
    /// Nothing is said of its health.
    SilentHealth,
    /// Of two publishers, one says that a joint is elsewhere.
    Jump,
    /// Speeds and efforts are bare numbers that are not finite.
    BareNumbers,
    /// What comes on the topic of joints is of another type.
    OtherType,
}

/// The robot behind the server.
pub struct MockRobot {
    profile: BridgeProfile,
    pub trouble: Trouble,
    pub is_enabled: bool,
    pub software: String,
    pub angles: BTreeMap<String, f64>,
    speeds: BTreeMap<String, f64>,
    goals: BTreeMap<String, f64>,
    commanded_at: Instant,
    passed_at: Instant,
    pub time_limit: f64,
    /// Modes of the commands; 2 for arrays of speeds.
    pub modes: Vec<i64>,
    /// Commands that were dropped because of a limit.
    pub dropped: usize,
    /// The size of the pictures of the camera, once it is open.
    pub camera: Option<(u64, u64)>,
    /// How far from where it is each joint is measured, in rad.
    pub bias: f64,
    /// The kinds of operation that were asked for.
    pub operations: BTreeSet<String>,
    /// Types of the topics that were subscribed to and advertised.
    pub types: BTreeMap<String, String>,
}

pub struct MockServer {
    robot: Arc<Mutex<MockRobot>>,
    name: &'static str,
    port: u16,
    is_over: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

impl MockServer {
    pub fn start(name: &'static str) -> Self {
        let profile = BridgeProfile::shipped(name).unwrap();
        let joints = profile.limbs.iter().flat_map(|limb| &limb.joints);
        let joints = joints.chain(profile.head.iter().map(|head| &head.joint));
        let middle = joints.map(|joint| {
            (
                joint.name.clone(),
                f64::midpoint(joint.limits.0, joint.limits.1),
            )
        });
        let robot = MockRobot {
            angles: middle.collect(),
            profile,
            trouble: Trouble::Nothing,
            is_enabled: true,
            software: "1.2.0\n".into(),
            speeds: BTreeMap::new(),
            goals: BTreeMap::new(),
            commanded_at: Instant::now(),
            passed_at: Instant::now(),
            time_limit: 0.2,
            modes: Vec::new(),
            dropped: 0,
            camera: None,
            bias: 0.0,
            operations: BTreeSet::new(),
            types: BTreeMap::new(),
        };
        let robot = Arc::new(Mutex::new(robot));
        let is_over = Arc::new(AtomicBool::new(false));
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let port = listener.local_addr().unwrap().port();
        let (moving, over) = (robot.clone(), is_over.clone());
        thread::spawn(move || {
            while !over.load(Ordering::SeqCst) {
                moving.lock().unwrap().pass();
                thread::sleep(Duration::from_millis(2));
            }
        });
        let (of_thread, over) = (robot.clone(), is_over.clone());
        let thread = thread::spawn(move || {
            for stream in listener.incoming() {
                if over.load(Ordering::SeqCst) {
                    return;
                }
                let (robot, over) = (of_thread.clone(), over.clone());
                let stream = stream.unwrap();
                thread::spawn(move || drop(serve(stream, &robot, &over)));
            }
        });
        Self {
            robot,
            name,
            port,
            is_over,
            thread: Some(thread),
        }
    }

    pub fn address(&self) -> Address {
        format!("{}:ws://127.0.0.1:{}", self.name, self.port)
            .parse()
            .unwrap()
    }

    pub fn robot(&self) -> MutexGuard<'_, MockRobot> {
        self.robot.lock().unwrap()
    }
}

impl Drop for MockServer {
    fn drop(&mut self) {
        self.is_over.store(true, Ordering::SeqCst);
        drop(TcpStream::connect(("127.0.0.1", self.port)));
        drop(self.thread.take().map(JoinHandle::join));
    }
}

/// A connection.
struct Session {
    socket: WebSocket<TcpStream>,
    subscribed: BTreeSet<String>,
    fragments: usize,
    /// A state that is sent again, and those that are on their way.
    frozen: Option<Value>,
    delayed: Vec<(Instant, Value)>,
}

fn serve(
    stream: TcpStream,
    robot: &Mutex<MockRobot>,
    is_over: &AtomicBool,
) -> Result<(), Box<dyn std::error::Error>> {
    stream.set_nodelay(true)?;
    let mut session = Session {
        socket: tungstenite::accept(stream)?,
        subscribed: BTreeSet::new(),
        fragments: 0,
        frozen: None,
        delayed: Vec::new(),
    };
    let mut last = Instant::now();
    let mut ticks = 0u64;
    while !is_over.load(Ordering::SeqCst) {
        // It answers until the next state is due.
        let due = last + Duration::from_millis(10);
        let trouble = robot.lock().unwrap().trouble;
        if trouble == Trouble::Closed {
            return Ok(());
        }
        if trouble == Trouble::HalfOpen {
            thread::sleep(Duration::from_millis(5));
            continue;
        }
        if trouble == Trouble::Drip {
            // The head of a text of a megabyte, unmasked, and its first bytes.
            let stream = session.socket.get_mut();
            stream.write_all(&[0x81, 127, 0, 0, 0, 0, 0, 0x10, 0, 0])?;
            while !is_over.load(Ordering::SeqCst) {
                stream.write_all(b" ")?;
                thread::sleep(Duration::from_millis(1));
            }
            return Ok(());
        }
        while let Some(wait) = due
            .checked_duration_since(Instant::now())
            .filter(|wait| !wait.is_zero())
        {
            session
                .socket
                .get_ref()
                .set_read_timeout(Some(wait.max(Duration::from_millis(1))))?;
            match session.socket.read() {
                Ok(Message::Text(text)) => {
                    let said: Value = serde_json::from_str(text.as_str())?;
                    let answer = robot.lock().unwrap().obey(&said);
                    if said["op"] == "subscribe" {
                        session
                            .subscribed
                            .insert(said["topic"].as_str().unwrap().to_owned());
                    }
                    if let Some(answer) = answer {
                        session.socket.send(Message::text(answer.to_string()))?;
                    }
                }
                Ok(_) => {}
                Err(tungstenite::Error::Io(error))
                    if matches!(
                        error.kind(),
                        std::io::ErrorKind::WouldBlock | std::io::ErrorKind::TimedOut
                    ) => {}
                Err(error) => return Err(error.into()),
            }
        }
        let now = Instant::now();
        let messages = {
            let mut robot = robot.lock().unwrap();
            robot.pass();
            robot.messages(ticks)
        };
        last = now;
        ticks += 1;
        session.say(trouble, ticks, messages)?;
    }
    Ok(())
}

impl Session {
    fn say(
        &mut self,
        trouble: Trouble,
        ticks: u64,
        messages: Vec<(String, Value)>,
    ) -> Result<(), tungstenite::Error> {
        for (topic, message) in messages {
            if !self.subscribed.contains(&topic)
                || (trouble == Trouble::Slow && !ticks.is_multiple_of(10))
            {
                continue;
            }
            let is_joints = topic.ends_with("joint_states");
            let mut said = json!({"op": "publish", "topic": topic, "msg": message});
            if is_joints && trouble == Trouble::Frozen {
                said = self.frozen.get_or_insert(said).clone();
            }
            if trouble == Trouble::Garbage {
                self.socket.send(Message::text("x".repeat(1 << 20)))?;
                self.socket.send(Message::binary(vec![0xff; 100]))?;
                self.socket.send(Message::text("{\"op\": 5}"))?;
                self.socket.send(Message::text(
                    "{\"op\": \"publish\", \"topic\": \"/robot/joint_states\", \"msg\": [[[]]]}",
                ))?;
            }
            if is_joints && trouble == Trouble::Delayed {
                self.delayed
                    .push((Instant::now() + Duration::from_millis(300), said));
                continue;
            }
            if trouble == Trouble::Fragments {
                self.say_in_pieces(&said.to_string())?;
                continue;
            }
            let text = said.to_string().replace("\"BARE\"", "NaN");
            self.socket.send(Message::text(text))?;
        }
        while let Some((at, _)) = self.delayed.first()
            && *at <= Instant::now()
        {
            let (_, said) = self.delayed.remove(0);
            self.socket.send(Message::text(said.to_string()))?;
        }
        Ok(())
    }

    fn say_in_pieces(&mut self, text: &str) -> Result<(), tungstenite::Error> {
        self.fragments += 1;
        let pieces: Vec<_> = text
            .as_bytes()
            .chunks(100)
            .map(|piece| String::from_utf8(piece.to_vec()).unwrap())
            .collect();
        let places = 0..pieces.len();
        // The last one first, every other time.
        let order: Vec<_> = match self.fragments % 2 {
            0 => places.collect(),
            _ => places.rev().collect(),
        };
        for place in order {
            let piece = json!({"op": "fragment", "id": self.fragments.to_string(), "num": place, "total": pieces.len(), "data": pieces[place]});
            self.socket.send(Message::text(piece.to_string()))?;
        }
        Ok(())
    }
}

impl MockRobot {
    /// Does what a client asks for; the answer, if there is one.
    fn obey(&mut self, said: &Value) -> Option<Value> {
        let operation = said["op"].as_str()?.to_owned();
        let topic = said["topic"].as_str().unwrap_or_default().to_owned();
        if let Some(kind) = said["type"].as_str() {
            self.types.insert(topic.clone(), kind.to_owned());
        }
        self.operations.insert(operation.clone());
        if said["service"] == "/cameras/open" {
            let settings = &said["args"]["settings"];
            self.camera = Some((settings["width"].as_u64()?, settings["height"].as_u64()?));
            return Some(
                json!({"op": "service_response", "id": said["id"], "service": said["service"], "values": {"err": 0}, "result": true}),
            );
        }
        if said["service"] == "/rosapi/topic_type" {
            let kind = self.type_of(said["args"]["topic"].as_str()?);
            return Some(
                json!({"op": "service_response", "id": said["id"], "service": said["service"], "values": {"type": kind}, "result": true}),
            );
        }
        if operation == "call_service" {
            let value = serde_json::to_string(&self.software).unwrap();
            return Some(
                json!({"op": "service_response", "id": said["id"], "service": said["service"], "values": {"value": value}, "result": true}),
            );
        }
        if operation != "publish" {
            return None;
        }
        let message = &said["msg"];
        if topic.ends_with("/joint_command") {
            let names = message["names"]
                .as_array()
                .unwrap()
                .iter()
                .map(|name| name.as_str().unwrap().to_owned());
            let numbers = message["command"]
                .as_array()
                .unwrap()
                .iter()
                .map(|number| number.as_f64().unwrap());
            self.command(
                message["mode"].as_i64().unwrap(),
                names.zip(numbers).collect(),
            );
        } else if topic == "/joint_velocity_controller/commands" {
            let names = self.profile.limbs[0]
                .joints
                .iter()
                .map(|joint| joint.name.clone());
            let numbers = message["data"]
                .as_array()
                .unwrap()
                .iter()
                .map(|number| number.as_f64().unwrap());
            let speeds = names.zip(numbers).collect();
            self.command(2, speeds);
        } else if topic.ends_with("/joint_command_timeout") {
            self.time_limit = message["data"].as_f64().unwrap();
        } else if topic == "/robot/set_super_enable" {
            self.is_enabled = message["data"].as_bool().unwrap();
        }
        None
    }

    /// The type of a topic that it publishes; empty for others.
    fn type_of(&self, topic: &str) -> &'static str {
        match topic {
            _ if topic != self.profile.joint_states => "",
            _ if self.trouble == Trouble::OtherType => "std_msgs/String",
            _ => "sensor_msgs/JointState",
        }
    }

    fn command(&mut self, mode: i64, given: BTreeMap<String, f64>) {
        self.modes.push(mode);
        let limbs = &self.profile.limbs;
        let joint = |name: &String| {
            limbs
                .iter()
                .flat_map(|limb| &limb.joints)
                .find(|joint| joint.name == *name)
                .unwrap()
        };
        if mode == 2 {
            let passes = given.iter().any(|(name, speed)| {
                let (joint, next) = (joint(name), self.angles[name] + 0.01 * speed);
                next < joint.limits.0 || next > joint.limits.1 || speed.abs() > joint.speed
            });
            if passes {
                self.dropped += 1;
                return;
            }
        }
        // Those of the other limb stay.
        for name in given.keys() {
            self.speeds.remove(name);
            self.goals.remove(name);
        }
        match mode {
            2 => self.speeds.extend(given),
            _ => self.goals.extend(given),
        }
        self.commanded_at = Instant::now();
    }

    /// Moves until now, whoever is connected.
    fn pass(&mut self) {
        let seconds = self.passed_at.elapsed().as_secs_f64();
        self.passed_at = Instant::now();
        let is_panda = self.profile.ros == RosVersion::Ros2;
        if !is_panda && self.commanded_at.elapsed().as_secs_f64() > self.time_limit {
            self.speeds.clear();
            self.goals.clear();
        }
        if !self.is_enabled || matches!(self.trouble, Trouble::Stuck | Trouble::EmergencyStop) {
            return;
        }
        for (name, speed) in &self.speeds {
            *self.angles.get_mut(name).unwrap() += speed * seconds;
        }
        for (name, goal) in &self.goals {
            let angle = self.angles.get_mut(name).unwrap();
            *angle += (goal - *angle).clamp(-0.45 * seconds, 0.45 * seconds);
        }
    }

    fn messages(&self, ticks: u64) -> Vec<(String, Value)> {
        let since = SystemTime::now().duration_since(UNIX_EPOCH).unwrap();
        let stamp = match self.profile.ros {
            RosVersion::Ros1 => json!({"secs": since.as_secs(), "nsecs": since.subsec_nanos()}),
            RosVersion::Ros2 => json!({"sec": since.as_secs(), "nanosec": since.subsec_nanos()}),
        };
        let mut joints: Vec<_> = self
            .angles
            .iter()
            .map(|(name, angle)| (name.as_str(), json!(angle + self.bias)))
            .collect();
        if self.trouble == Trouble::Shuffled {
            joints.push(("torso_t0", json!(0.0)));
            let by = usize::try_from(ticks).unwrap() % joints.len();
            joints.rotate_left(by);
        }
        if self.trouble == Trouble::NotANumber {
            joints[3].1 = Value::Null;
        }
        if self.trouble == Trouble::Jump && ticks.is_multiple_of(2) {
            let joint = joints.iter_mut().find(|(name, _)| *name == "left_w2");
            joint.unwrap().1 = json!(2.5);
        }
        let (names, angles): (Vec<_>, Vec<_>) = joints.into_iter().unzip();
        let mut states = json!({"header": {"stamp": stamp, "frame_id": ""}, "name": names, "position": angles, "velocity": [], "effort": []});
        if self.trouble == Trouble::BareNumbers {
            let bare = vec!["BARE"; names.len()];
            (states["velocity"], states["effort"]) = (json!(bare), json!(bare));
        }
        if self.trouble == Trouble::OtherType {
            states = json!({"data": "nothing of joints"});
        }
        let is_stopped = self.trouble == Trouble::EmergencyStop;
        let health = match self.profile.ros {
            RosVersion::Ros1 => json!({
                "ready": true, "enabled": self.is_enabled && !is_stopped, "stopped": is_stopped, "error": false,
                "estop_button": u8::from(is_stopped), "estop_source": 0,
            }),
            RosVersion::Ros2 => json!({"robot_mode": if is_stopped { 5 } else { 2 }}),
        };
        let mut messages = vec![
            (self.profile.joint_states.clone(), states),
            (self.profile.health.topic().to_owned(), health),
        ];
        if self.trouble == Trouble::SilentHealth {
            messages.pop();
        }
        if let Some((width, height)) = self.camera.filter(|_| ticks.is_multiple_of(20)) {
            let data =
                BASE64.encode([10, 20, 30, 255].repeat(usize::try_from(width * height).unwrap()));
            let picture = json!({"width": width, "height": height, "encoding": "bgra8", "is_bigendian": 0, "step": 4 * width, "data": data});
            messages.push(("/cameras/head_camera/image".into(), picture));
        }
        messages
    }
}
