"""Compares `tabletop robot fk` with yourdfpy, for strangers' URDFs: compare_kinematics.py PROGRAM URDF... (pip install yourdfpy).

A robot.ron is written for each URDF by `tabletop robot new`; then every link's place is compared in twenty postures. Prints a table: what each
URDF says, and the largest distance in m. Ends with 1 if one is above the limit.
"""

import json
import logging
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

import numpy as np
import yourdfpy

LIMIT = 1e-6  # m
POSTURES = 20
UNIT = 0.1  # m


def run(*command, text=None):
    return subprocess.run(command, input=text, capture_output=True, text=True)


def limbs_of(layout):
    """The limbs of a written robot.ron: name, joints, opening in units, joints of the fingers."""
    for part in re.split(r"\n        \(\n", layout)[1:]:
        limb, gripper = part.split("gripper: (", 1)
        name = re.search(r'name: "(.*?)"', limb)[1]
        joints = re.findall(r'\(name: "(.*?)", label: "J', limb)
        opening = re.search(r"opening: \((.*?), (.*?)\)", gripper)
        fingers = re.search(r"finger_joints: \[(.*?)\]", gripper)
        fingers = re.findall(r'"(.*?)"', fingers[1]) if fingers else []
        yield name, joints, float(opening[2]), fingers


def compare(program, folder, urdf):
    """What becomes of a URDF in a folder, and the largest distance of a link from where yourdfpy has it."""
    written = run(program, "robot", "new", urdf)
    if written.returncode:
        return written.stderr.strip().removeprefix(f"tabletop: {urdf}: "), None
    layout = (folder / "robot.ron").read_text()
    limbs = list(limbs_of(layout))
    robot = yourdfpy.URDF.load(str(urdf), load_meshes=False, load_collision_meshes=False, mesh_dir="")
    limits = {joint.name: joint.limit for joint in robot.robot.joints}
    random = np.random.default_rng(0)
    postures, lines = [], []
    for number in range(POSTURES):
        posture, line = {}, {}
        for name, joints, opening, fingers in limbs:
            for joint in joints:
                limit = limits[joint]
                low, high = (limit and limit.lower) or -3, (limit and limit.upper) or 3
                posture[joint] = random.uniform(low, high) if number else 0.0
            line[name] = [posture[joint] for joint in joints]
            # Without word of it, grippers are open.
            posture |= dict.fromkeys(fingers, opening * UNIT / 2)
        still = re.search(r"still: \[(.*)\]", layout)
        for joint, position in re.findall(r'\("(.*?)", (.*?)\)', still[1] if still else ""):
            posture[joint] = float(position)
        neck = re.search(r'neck: \(name: "(.*?)".*home: (.*?),', layout)
        if neck:
            posture[neck[1]] = float(neck[2])
        postures.append(posture)
        lines.append(json.dumps(line))
    answers = run(program, "robot", "fk", "--robot", folder / "robot.ron", text="\n".join(lines))
    farthest = 0.0
    for posture, answer in zip(postures, answers.stdout.splitlines(), strict=True):
        robot.update_cfg({name: posture.get(name, 0.0) for name in robot.actuated_joint_names})
        for link, frame in json.loads(answer)["torso"].items():
            place = robot.get_transform(link, robot.base_link)[:3, 3]
            farthest = max(farthest, float(np.linalg.norm(place - frame["position"])))
    arms = ", ".join(f"{name} of {len(joints)}" for name, joints, _, _ in limbs)
    return f"loads: {arms}", farthest


def main(program, *urdfs):
    logging.disable()
    worst = 0.0
    print("| URDF | what it says | largest distance in m |\n|---|---|---|")
    for urdf in urdfs:
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            copy = folder / pathlib.Path(urdf).name
            shutil.copy(urdf, copy)
            said, farthest = compare(program, folder, copy)
        print(f"| {copy.name} | {said} | {'' if farthest is None else f'{farthest:.1e}'} |", flush=True)
        worst = max(worst, farthest or 0.0)
    return int(worst > LIMIT)


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
