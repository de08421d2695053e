"""A robot that swings its arms: all joints turn at 0.5 rad/s, five seconds one way and five seconds back.

Run it with

    tabletop run --script python:python/example.py
"""

import math

SPEED = 0.5  # rad/s
GRIPPER_SPEED = 1.0  # units/s
TURN = 5.0  # s

time = 0.0


def init(aux):
    aux.initJointAngles = [[0.0] * 7, [0.0, 0.0, math.pi / 2, 0.0, 0.0, 0.0, 0.0]]
    aux.drawMarkers = [[-4, 0, 2], [4, 0, 2], [0, -3, 2], [0, 3, 2]]


def callback(sensor, motor, aux):
    global time
    if time == 0:
        print("sensed:", ", ".join(sorted(vars(sensor))))
    direction = 1 if time % (2 * TURN) < TURN else -1
    motor.jointVelocities = [[direction * SPEED] * aux.numJoints for _ in range(aux.numLimbs)]
    motor.gripperVelocities = [-direction * GRIPPER_SPEED] * 2
    time += sensor.timeElapsed
