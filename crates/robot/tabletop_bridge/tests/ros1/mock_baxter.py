"""A Baxter without a body, on the genuine rospy and rosmaster: topics, rates and habits of software 1.2.0.

Prints the port of its master. A line on standard input is an order, answered by a line of JSON; it ends with its input.
"""

import json
import os
import sys
import threading
import time

os.environ["ROS_IP"] = "127.0.0.1"

import genpy.dynamic
import rosmaster.master
import rospy
from sensor_msgs.msg import Image, JointState
from std_msgs.msg import Bool, Empty, Float64

MESSAGES = {
    "JointCommand": """
int32 mode
float64[] command
string[] names
int32 POSITION_MODE=1
int32 VELOCITY_MODE=2
int32 TORQUE_MODE=3
int32 RAW_POSITION_MODE=4
""",
    "AssemblyState": """
bool ready
bool enabled
bool stopped
bool error
uint8 estop_button
uint8 ESTOP_BUTTON_UNPRESSED=0
uint8 ESTOP_BUTTON_PRESSED=1
uint8 ESTOP_BUTTON_UNKNOWN=2
uint8 ESTOP_BUTTON_RELEASED=3
uint8 estop_source
uint8 ESTOP_SOURCE_NONE=0
uint8 ESTOP_SOURCE_USER=1
uint8 ESTOP_SOURCE_UNKNOWN=2
uint8 ESTOP_SOURCE_FAULT=3
uint8 ESTOP_SOURCE_BRAIN=4
""",
    "HeadPanCommand": """
float32 target
float32 speed_ratio
float32 MAX_SPEED_RATIO=1.0
float32 MIN_SPEED_RATIO=0.0
uint8 enable_pan_request
uint8 REQUEST_PAN_DISABLE=0
uint8 REQUEST_PAN_ENABLE=1
uint8 REQUEST_PAN_VOID=2
""",
    "EndEffectorCommand": """
uint32 id
string command
string CMD_NO_OP=no_op
string CMD_SET=set
string CMD_CONFIGURE=configure
string CMD_REBOOT=reboot
string CMD_RESET=reset
string CMD_CALIBRATE=calibrate
string CMD_CLEAR_CALIBRATION=clear_calibration
string CMD_PREPARE_TO_GRIP=prepare_to_grip
string CMD_GRIP=grip
string CMD_RELEASE=release
string CMD_GO=go
string CMD_STOP=stop
string args
string sender
uint32 sequence
""",
    "EndEffectorState": """
time timestamp
uint32 id
uint8 STATE_FALSE=0
uint8 STATE_TRUE=1
uint8 STATE_UNKNOWN=2
uint8 enabled
uint8 calibrated
uint8 ready
uint8 moving
uint8 gripping
uint8 missed
uint8 error
uint8 reverse
float32 position
float32 POSITION_CLOSED=0.0
float32 POSITION_OPEN=100.0
float32 force
float32 FORCE_MIN=0.0
float32 FORCE_MAX=100.0
string state
string command
string command_sender
uint32 command_sequence
""",
}
OPEN_CAMERA = (
    """
string name
CameraSettings settings
================================================================================
MSG: baxter_core_msgs/CameraSettings
int32 width
int32 height
float32 fps
CameraControl[] controls
================================================================================
MSG: baxter_core_msgs/CameraControl
int32 id
int32 value
int32 CAMERA_CONTROL_EXPOSURE=100
int32 CAMERA_CONTROL_GAIN=101
int32 CAMERA_CONTROL_WHITE_BALANCE_R=102
int32 CAMERA_CONTROL_WHITE_BALANCE_G=103
int32 CAMERA_CONTROL_WHITE_BALANCE_B=104
int32 CAMERA_CONTROL_WINDOW_X=105
int32 CAMERA_CONTROL_WINDOW_Y=106
int32 CAMERA_CONTROL_FLIP=107
int32 CAMERA_CONTROL_MIRROR=108
int32 CAMERA_CONTROL_RESOLUTION_HALF=109
""",
    "int32 err\n",
)
PACKAGE = "baxter_core_msgs/"


def message_class(name, text):
    return genpy.dynamic.generate_dynamic(PACKAGE + name, text)[PACKAGE + name]


CLASSES = {name: message_class(name, text) for name, text in MESSAGES.items()}


class OpenCamera:
    _type = PACKAGE + "OpenCamera"
    _md5sum = "73eacff63d5f9cca2d986614515a5c8c"
    _request_class = message_class("OpenCameraRequest", OPEN_CAMERA[0])
    _response_class = message_class("OpenCameraResponse", OPEN_CAMERA[1])


# Least and largest angle in rad, greatest speed in rad/s.
JOINTS = {
    "s0": (-1.70167993878, 1.70167993878, 1.5),
    "s1": (-2.147, 1.047, 1.5),
    "e0": (-3.05417993878, 3.05417993878, 1.5),
    "e1": (-0.05, 2.618, 1.5),
    "w0": (-3.059, 3.059, 4.0),
    "w1": (-1.57079632679, 2.094, 4.0),
    "w2": (-3.059, 3.059, 4.0),
}
SIDES = ("left", "right")
GRIPPER_ID = 65538


class Arm:
    def __init__(self, side):
        self.names = [side + "_" + joint for joint in JOINTS]
        self.limits = dict(zip(self.names, JOINTS.values()))
        self.angles = dict.fromkeys(self.names, 0.5)
        self.speeds, self.goals = {}, {}
        self.time_limit, self.ratio = 0.2, 0.3
        self.commanded_at = 0.0
        self.modes = []
        self.dropped = 0
        self.log = []

    def command(self, message):
        self.modes.append(message.mode)
        self.log.append((time.time(), message.command[0]))
        given = dict(zip(message.names, message.command))
        if message.mode == 2:
            if any(not self.may_turn(name, speed) for name, speed in given.items()):
                self.dropped += 1
                return
            self.speeds, self.goals = given, {}
        elif message.mode == 1:
            self.speeds, self.goals = {}, given
        self.commanded_at = time.monotonic()

    def may_turn(self, name, speed):
        least, largest, fastest = self.limits[name]
        return abs(speed) <= fastest and least <= self.angles[name] + 0.01 * speed <= largest

    def move(self, seconds):
        if time.monotonic() - self.commanded_at > self.time_limit:
            self.speeds, self.goals = {}, {}
        speeds = dict(self.speeds)
        for name, goal in self.goals.items():
            most = self.ratio * self.limits[name][2]
            speeds[name] = max(-most, min(most, (goal - self.angles[name]) / 0.05))
        for name, speed in speeds.items():
            least, largest, _ = self.limits[name]
            self.angles[name] = max(least, min(largest, self.angles[name] + speed * seconds))
        return speeds


class Gripper:
    def __init__(self, side):
        self.state = CLASSES["EndEffectorState"](id=GRIPPER_ID, position=100.0)
        # The thickness of what is between the fingers, in percent of the widest opening.
        self.filled = 0.0
        topic = "/robot/end_effector/%s_gripper/" % side
        self.publisher = rospy.Publisher(topic + "state", CLASSES["EndEffectorState"], queue_size=10)
        rospy.Subscriber(topic + "command", CLASSES["EndEffectorCommand"], self.command)

    def command(self, message):
        if message.id != GRIPPER_ID:
            return
        self.state.command = message.command
        self.state.command_sender = message.sender
        self.state.command_sequence = message.sequence
        if message.command == "calibrate":
            self.state.calibrated = 1
        elif message.command == "go" and self.state.calibrated == 1:
            asked = json.loads(message.args)["position"]
            self.state.position = max(asked, self.filled)
            self.state.gripping = int(self.filled > 0.0 and asked <= self.filled)


class Baxter:
    def __init__(self):
        self.lock = threading.RLock()
        self.arms = {side: Arm(side) for side in SIDES}
        self.grippers = {side: Gripper(side) for side in SIDES}
        self.state = CLASSES["AssemblyState"](ready=True, enabled=True)
        self.head = 0.0
        self.opened = None
        self.stopped_at = 0.0
        self.is_stuck = self.is_silent = False
        self.joint_states = rospy.Publisher("/robot/joint_states", JointState, queue_size=10, tcp_nodelay=True)
        self.states = rospy.Publisher("/robot/state", CLASSES["AssemblyState"], queue_size=10, latch=True)
        self.pictures = rospy.Publisher("/cameras/head_camera/image", Image, queue_size=1)
        for side, arm in self.arms.items():
            limb = "/robot/limb/%s/" % side
            rospy.Subscriber(limb + "joint_command", CLASSES["JointCommand"], self.command, arm, tcp_nodelay=True)
            rospy.Subscriber(limb + "joint_command_timeout", Float64, self.set_arm, (arm, "time_limit"))
            rospy.Subscriber(limb + "set_speed_ratio", Float64, self.set_arm, (arm, "ratio"))
        rospy.Subscriber("/robot/head/command_head_pan", CLASSES["HeadPanCommand"], self.turn_head)
        rospy.Subscriber("/robot/set_super_enable", Bool, self.enable)
        rospy.Subscriber("/robot/set_super_stop", Empty, lambda _: self.order("estop"))
        rospy.Subscriber("/robot/set_super_reset", Empty, lambda _: self.order("reset"))
        rospy.Service("/cameras/open", OpenCamera, self.open_camera)
        rospy.set_param("/rethink/software_version", "1.2.0")

    def command(self, message, arm):
        with self.lock:
            arm.command(message)

    @staticmethod
    def set_arm(message, place):
        setattr(*place, message.data)

    def turn_head(self, message):
        self.head = message.target

    def enable(self, message):
        with self.lock:
            self.state.enabled = message.data and not self.state.stopped

    def open_camera(self, request):
        settings = request.settings
        self.opened = [request.name, settings.width, settings.height, [control.id for control in settings.controls]]
        return OpenCamera._response_class(err=0)

    def order(self, order):
        with self.lock:
            if order == "estop":
                self.state.enabled, self.state.stopped, self.state.estop_button = False, True, 1
                self.stopped_at = time.time()
                for arm in self.arms.values():
                    arm.modes = []
            elif order == "reset":
                self.state.stopped, self.state.error, self.state.estop_button = False, False, 0
            elif order == "disable":
                self.state.enabled = False
            elif order == "error":
                self.state.error = True
            elif order == "stick":
                self.is_stuck = True
            elif order == "silence":
                self.is_silent = True
            elif order == "fill":
                for gripper in self.grippers.values():
                    gripper.filled = 50.0
            elif order == "forget":
                for arm in self.arms.values():
                    arm.log = []
            self.states.publish(self.state)
            return {
                "angles": {name: angle for arm in self.arms.values() for name, angle in arm.angles.items()},
                "modes": {side: arm.modes for side, arm in self.arms.items()},
                "dropped": sum(arm.dropped for arm in self.arms.values()),
                "time_limits": [arm.time_limit for arm in self.arms.values()],
                "ratios": [arm.ratio for arm in self.arms.values()],
                "openings": [gripper.state.position for gripper in self.grippers.values()],
                "head": self.head,
                "opened": self.opened,
                "enabled": bool(self.state.enabled),
                "log": {side: arm.log for side, arm in self.arms.items()},
                "stopped_at": self.stopped_at,
            }

    def tick(self, seconds):
        with self.lock:
            message = JointState(name=["torso_t0", "head_pan"], position=[0.0, self.head], velocity=[0.0, 0.0], effort=[0.0, 0.0])
            message.header.stamp = rospy.Time.now()
            for arm in self.arms.values():
                is_moving = self.state.enabled and not self.is_stuck
                speeds = arm.move(seconds) if is_moving else {}
                for name in reversed(arm.names):
                    message.name.append(name)
                    message.position.append(arm.angles[name])
                    message.velocity.append(speeds.get(name, 0.0))
                    message.effort.append(0.5)
            if not self.is_silent:
                self.joint_states.publish(message)

    def run(self):
        last = time.monotonic()
        ticks = 0
        while not rospy.is_shutdown():
            time.sleep(max(0.0, last + 0.01 - time.monotonic()))
            now = time.monotonic()
            self.tick(now - last)
            last = now
            if ticks % 10 == 0:
                with self.lock:
                    self.states.publish(self.state)
                for gripper in self.grippers.values():
                    gripper.state.timestamp = rospy.Time.now()
                    gripper.publisher.publish(gripper.state)
                # A gripper's own states share the joints' topic.
                self.joint_states.publish(JointState(name=["l_gripper_l_finger_joint"], position=[0.01]))
            if ticks % 25 == 0 and self.opened:
                _, width, height, _ = self.opened
                data = bytes([10, 20, 30, 255]) * (width * height)
                self.pictures.publish(Image(width=width, height=height, encoding="bgra8", step=4 * width, data=data))
            ticks += 1


def main():
    home = json.loads(sys.argv[1]) if len(sys.argv) > 1 else {}
    master = rosmaster.master.Master(port=0)
    master.start()
    while not master.ok() or not master.uri:
        time.sleep(0.01)
    os.environ["ROS_MASTER_URI"] = master.uri
    rospy.init_node("baxter", disable_signals=True)
    baxter = Baxter()
    for arm in baxter.arms.values():
        arm.angles.update({name: home[name] for name in arm.names if name in home})
    threading.Thread(target=baxter.run, daemon=True).start()
    print(master.uri.rstrip("/").rsplit(":", 1)[1], flush=True)
    for line in sys.stdin:
        print(json.dumps(baxter.order(line.strip())), flush=True)
    os._exit(0)


main()
