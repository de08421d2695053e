"""A robot of any shape that waves: the last joint of every limb swings, and its gripper opens and closes.

    tabletop run --script python:python/wave.py --robot assets/panda/robot.ron
"""

import math

SPEED = 0.5  # rad/s
SWING = 2.0  # s one way

time = 0.0


def init(aux):
    aux.initJointAngles = [[0.5 * (low + high) for low, high in zip(*limits)]
                           for limits in zip(aux.minJointAngles, aux.maxJointAngles)]


def callback(sensor, motor, aux):
    global time
    direction = 1 if time % (2 * SWING) < SWING else -1
    motor.jointVelocities = [[0.0] * (aux.numJoints - 1) + [direction * SPEED]
                             for _ in range(aux.numLimbs)]
    motor.gripperVelocities = [-0.3 * direction] * aux.numLimbs
    time += sensor.timeElapsed
