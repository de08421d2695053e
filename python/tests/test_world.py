"""Worlds."""

import subprocess
import sys

import numpy as np
import pytest

import tabletop

SETUP = "shipped:tablesetup/default.xml"


def test_a_block_is_put_on_another():
    world = tabletop.World(SETUP)
    assert world.objects.id == ["RedBlock", "GreenBlock"]
    world.grasp("RedBlock", hand="right")
    world.glide(to=(-2, 0, 5), seconds=1, hand="right")
    world.turn("Z", 60, hand="right")
    world.glide(to=(-2, 0, 3), seconds=0.5, hand="right")
    world.release(hand="right")
    world.wait_until_rest()
    world.expect('OnTopOf(object: "RedBlock", of: "GreenBlock")')
    assert world.holds('OnTable(object: "GreenBlock")')
    assert not world.holds('OnTable(object: "RedBlock")')
    objects = world.objects
    row = objects.row("RedBlock")
    np.testing.assert_allclose(objects.location[row], (-2, 0, 3), atol=0.01)
    assert np.abs(objects.velocity).max() < 0.01
    np.testing.assert_allclose(objects.color[row], (1, 0, 0))
    with pytest.raises(KeyError, match="RedBlock, GreenBlock"):
        objects.row("Blue")
    names = [fact["fact"] for fact in world.facts()]
    assert "Grasped" in names and "Released" in names
    assert world.facts() == []


def test_errors_are_those_of_the_command_line():
    world = tabletop.World(SETUP)
    with pytest.raises(tabletop.Error, match="Nothing"):
        world.grasp("Nothing")
    with pytest.raises(tabletop.Error, match="there is no Jump"):
        world.command("Jump")
    with pytest.raises(tabletop.Error, match="missing.xml"):
        tabletop.World("missing.xml")
    with pytest.raises(tabletop.Error, match="expected one of setup, scenario and recording"):
        tabletop.World(SETUP, scenario="shipped:scenarios/hanoi.ron")
    with pytest.raises(tabletop.Error, match="expected 3 numbers, found 2"):
        world.move_to((1, 2))


def test_a_moment_comes_back_to_the_bit():
    world = tabletop.World("shipped:tablesetup/tower.xml", show_robot=False)
    world.step(30)
    moment = world.snapshot()

    def push():
        first = world.objects.id[0]
        world.grasp(first)
        world.move_by((1, 0, 0.5))
        world.step(100)
        world.release()
        world.step(60)
        objects = world.objects
        return world.tick, objects.location.tobytes(), objects.rotation.tobytes()

    once = push()
    world.restore(moment)
    assert world.tick == 31
    assert push() == once


def test_the_robot_reaches_and_grips():
    world = tabletop.World("shipped:tablesetup/robot-stack.xml")
    robot = world.robot
    assert robot.name == "Baxter" and robot.is_shown
    assert list(robot.limbs) == ["left", "right"]
    robot.reach("right", (3, -3, 2.5))
    world.wait_until_still()
    np.testing.assert_allclose(robot.limbs["right"].location, (3, -3, 2.5), atol=0.01)
    robot.reach("right", (3, -3, 0.9))
    world.wait_until_still()
    world.close_gripper("right")
    world.wait_until_still()
    assert robot.limbs["right"].holds == ["Red"]
    assert any(contact.thing == "Red" for contact in world.contacts)
    angles = robot.ik("left", (-3, -3, 2))
    location, rotation = robot.fk("left", angles)
    np.testing.assert_allclose(location, (-3, -3, 2), atol=0.001)
    np.testing.assert_allclose(np.abs(rotation), (0, 0, 0, 1), atol=0.001)
    with pytest.raises(tabletop.Error, match="cannot reach"):
        robot.ik("left", (0, 50, 0))
    with pytest.raises(tabletop.Error, match="only left, right"):
        robot.ik("third", (0, 0, 0))
    robot.drive({"left_s0": 0.5})
    world.step()
    assert abs(robot.velocities[robot.joint_names.index("left_s0")] - 0.5) < 1e-6
    assert (robot.limits[:, 0] <= robot.positions).all() and (robot.positions <= robot.limits[:, 1]).all()


def test_cameras_see_colours_depths_and_ids():
    world = tabletop.World(SETUP, show_robot=False)
    picture = world.picture(size=(80, 60))
    assert picture.shape == (60, 80, 3) and picture.dtype == np.uint8
    depth = world.depth("above=0,-1,15", (40, 30))
    assert depth.shape == (30, 40) and 12 < depth.min() < 14
    numbers, names = world.ids("head", (80, 60))
    assert names[:3] == ["table", "RedBlock", "GreenBlock"]
    red = picture[numbers == names.index("RedBlock") + 1]
    assert len(red) > 10 and (np.median(red, axis=0) == (np.median(red[:, 0]), 0, 0)).all()
    png = picture._repr_png_()
    assert png.startswith(b"\x89PNG") and world._repr_png_().startswith(b"\x89PNG")
    with pytest.raises(tabletop.Error, match="no size of a picture"):
        world.picture(size=(0, 10))
    with pytest.raises(tabletop.Error, match="third_camera|third"):
        world.picture("third")


def test_a_world_is_recorded_saved_and_opened_again(tmp_path):
    world = tabletop.World(SETUP)
    with world.record(tmp_path / "demo"):
        world.grasp("RedBlock")
        world.glide((-2, 0, 4))
        world.glide((-2, 0, 3))
        world.release()
        world.wait_until_rest()
    assert world.save(tmp_path / "after.xml") == []
    again = tabletop.World(tmp_path / "after.xml")
    np.testing.assert_allclose(again.objects.location, world.objects.location, atol=1e-5)
    begun = tabletop.World(recording=tmp_path / "demo")
    assert begun.objects.id == ["RedBlock", "GreenBlock"]
    recording = tabletop.Recording(tmp_path / "demo")
    frames = list(recording.frames())
    assert len(frames) > 4 and frames[0].picture().shape == (150, 200, 3)
    assert any("RedBlock" in field for _, fields in recording.events() for field in fields)
    assert len(recording.states()["tick"]) >= len(frames)
    steps = recording.task["task"]["steps"]
    assert len(steps) == 1
    with pytest.raises(tabletop.Error, match="no recording"):
        tabletop.Recording(tmp_path)


def test_a_recording_is_read_as_it_is_written(tmp_path):
    file = tmp_path / "two.xml"
    file.write_text(
        """<tabletop xmlns="http://synapse.cs.umd.edu/tabletop-xml">
        <block id="1" location="(2,0,1)"><description name="label" value="a &quot;red&quot; one, small"/></block>
        <block id="2" location="(-2,0,1)"/></tabletop>"""
    )
    world = tabletop.World(file)
    with world.record(tmp_path / "demo"):
        world.step(100)
        world.grasp("1")
        world.glide((-2, 0, 4))
        world.release()
        world.step(7)
    recording = tabletop.Recording(tmp_path / "demo")
    events = recording.events()
    assert [(segment, it[1:]) for segment, it in events if it[1] == "grasp"] == [(1, ["grasp", "AnyHand", "1"])]
    assert any(it[1:5] == ["create", "1", "shape", "block"] and 'a "red" one, small' in it for _, it in events)
    assert events[0][0] == 0 and {segment for segment, _ in events} == {0, 1, 2}
    start, last = recording.header["start_tick"], max(recording.states()["tick"])
    frames = list(recording.frames())
    files = [it for it in (tmp_path / "demo").glob("*/*.png") if it.stem.isdigit()]
    assert sorted(it.path for it in frames) == sorted(files)
    assert all(it.path == tmp_path / "demo" / str(it.segment) / f"{it.number}.png" for it in frames)
    # Frames in which nothing moves have no picture.
    assert [it.number for it in frames] != list(range(len(frames)))
    assert [it.tick for it in frames] == [min(start + 15 * it.number, last) for it in frames]
    assert set(recording.states()["id"]) == {"1", "2"}


def test_a_recording_after_a_restored_moment_replays(tmp_path):
    world = tabletop.World(SETUP)
    moment = world.snapshot()
    world.grasp("RedBlock")
    world.move_by((0, 2, 2))
    world.step(30)
    world.restore(moment)
    with world.record(tmp_path / "demo"):
        world.grasp("GreenBlock")
        world.glide((-4, 1, 3))
        world.release()
    with pytest.raises(tabletop.Error, match="finish it first"):
        world.start_recording(tmp_path / "other")
        world.restore(moment)
    verify = [sys.executable, "-m", "tabletop", "replay", str(tmp_path / "demo"), "--verify"]
    subprocess.run(verify, check=True)


def test_the_robot_imitates_and_multiplies(tmp_path):
    world = tabletop.World("shipped:tablesetup/blocks.xml", show_robot=False)
    with world.record(tmp_path / "demo"):
        world.grasp("Green")
        world.glide((3, -2.5, 4))
        world.turn("Z", 70)
        world.glide((3, -2.5, 1.5))
        world.release()
        world.wait_until_rest()
    result = tabletop.imitate(tmp_path / "demo")
    assert (result.done, result.trials) == (1, 1), result.report
    seen = []
    made = tabletop.multiply(
        tmp_path / "demo", tmp_path / "many", count=3, colors=True, progress=lambda *it: seen.append(it)
    )
    assert [folder.name for folder in made] == ["0000", "0001", "0002"] and seen[-1] == (3, 3)


def test_it_understands_what_it_was_told(tmp_path):
    said = "Put every block into the box."
    told = tabletop.tell(said, setup="shipped:tablesetup/small-blocks.xml", record=tmp_path / "demo")
    assert told.done == 0, told.report  # There is no box.
    told = tabletop.tell("Swap Red and Green.", setup="shipped:tablesetup/blocks.xml", record=tmp_path / "swap")
    assert (told.done, told.trials) == (1, 1), told.report
    taught = tabletop.teach(tmp_path / "swap")
    assert taught["sentences"].startswith("Swap "), taught
    assert taught["program"]["sentences"] and isinstance(taught["alternatives"], list)


def test_it_says_what_it_is():
    assert "2 objects (RedBlock, GreenBlock)" in repr(tabletop.World(SETUP))
    assert "Baxter: left at" in repr(tabletop.World(SETUP).robot)
