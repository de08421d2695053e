"""Says which steps of a task are done, while a demonstration goes on or the robot works.

    tabletop run scenarios/stack_three.ron --record demo
    tabletop run scenarios/stack_three.ron --script python:learners/follow_task.py --task demo

sensor.task is what `tabletop explain demo` says of the recording; see docs/scripts.md.
"""

from math import cos, dist, sin

done = set()


def init(aux):
    done.clear()


def callback(sensor, motor, aux):
    if not hasattr(sensor, "task"):
        print("name a recording with --task")
        aux.exit = True
        return
    task, objects = sensor.task, sensor.objects
    for step, sentence in enumerate(task.sentence):
        if step not in done and is_done(task, objects, step):
            done.add(step)
            print(f"{step + 1}. {sentence} Done.")
    if len(done) == len(task.sentence):
        aux.exit = True


def is_done(task, objects, step):
    """Whether the object of a step is where it is to be, to a fifth of a unit."""
    if task.object[step] not in objects.id:
        return task.relation[step] == "destroyed"
    place = list(task.goalPosition[step])
    if task.reference[step] in objects.id:
        of = objects.id.index(task.reference[step])
        place = [a + b for a, b in zip(turned(place, objects.rotation[of]), objects.position[of])]
    moved = objects.id.index(task.object[step])
    return dist(place, list(objects.position[moved])) < 0.2


def turned(place, rotation):
    """A place, turned about the fixed axes X, then Y, then Z."""
    x, y, z = place
    a, b, c = rotation
    y, z = y * cos(a) - z * sin(a), y * sin(a) + z * cos(a)
    x, z = x * cos(b) + z * sin(b), z * cos(b) - x * sin(b)
    x, y = x * cos(c) - y * sin(c), x * sin(c) + y * cos(c)
    return [x, y, z]
