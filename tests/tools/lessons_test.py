"""Every lesson but those of whole proteins: the emulated operator does it, a hand that holds still or wanders does not."""
import json
import os
import pathlib
import re
import subprocess
import unittest

ROOT = pathlib.Path(os.environ["PALPA_ROOT"])
PROGRAM = os.environ["PALPA_PROGRAM"]


def palpa(*arguments):
    return subprocess.run([PROGRAM, *arguments], capture_output=True, text=True, check=False,
                          timeout=800)


def lessons():
    return json.loads(palpa("lessons", "--json").stdout)


def play(name, *options):
    result = palpa("lessons", "play", name, "--headless", "--json", *options)
    return result.returncode, json.loads(result.stdout)


def check_that_it_is_not_done(test, name):
    for options in (["--idle"], ["--random", "--seed", "7"]):
        with test.subTest(lesson=name, options=options):
            code, report = play(name, *options)
            test.assertEqual(code, 1)
            test.assertFalse(report["done"])
            done = [step["done"] for step in report["steps"]]
            test.assertFalse(done[-1])
            if options == ["--idle"]:
                test.assertFalse(any(done), report)


# A workspace that needs many clutches, and a person at the mouse.
DEVICES = ("omni", "small", "mouse")


def check_that_the_operator_does_it(test, lesson, device, seeds=(1,)):
    """With one of the seeds, which are tried in turn."""
    with test.subTest(lesson=lesson["name"], device=device):
        for seed in seeds:
            code, report = play(lesson["name"], "--by", device, "--seed", str(seed))
            if code == 0:
                break
            for step in report["steps"][:4]:  # on the way out nothing is chance
                test.assertTrue(step["done"], report)
        test.assertEqual(code, 0, report)
        test.assertTrue(report["done"])
        test.assertEqual(len(report["steps"]), lesson["steps"])
        times = [step["at_s"] for step in report["steps"]]
        test.assertEqual(times, sorted(times))
        test.assertTrue(all(step["done"] for step in report["steps"]))


# Whole proteins: they are played in lessons_long_test.py.
LONG = ("hiv/lesson",)


class Lessons(unittest.TestCase):
    def test_the_list_says_what_each_is_for(self):
        listed = lessons()
        self.assertGreaterEqual(len(listed), 6)
        text = palpa("lessons").stdout
        for lesson in listed:
            with self.subTest(lesson=lesson["name"]):
                self.assertIn(lesson["title"], text)
                shortest = 2 if lesson["name"] == "water/tour" else 5
                self.assertTrue(shortest <= lesson["minutes"] <= 10, lesson)
                self.assertTrue(4 <= lesson["steps"] <= 7, lesson)
                self.assertGreater(len(lesson["goal"]), 30)
        names = [lesson["name"] for lesson in listed]
        page = (ROOT / "scenes/lessons.md").read_text()
        for name in names:
            self.assertIn(f"| {name} |", page)

    def test_each_has_one_question_that_explains_every_answer(self):
        for lesson in lessons():
            name = lesson["name"]
            folder, _, file = name.partition("/")
            scene = (ROOT / "scenes" / folder / f"{file or 'scene'}.toml").read_text()
            with self.subTest(lesson=name):
                self.assertEqual(len(re.findall(r"^\[lesson\.\w+\.question\]$", scene, re.M)), 1)

    def test_the_operator_does_every_step(self):
        for lesson in lessons():
            for device in DEVICES:
                if lesson["name"] not in LONG:
                    check_that_the_operator_does_it(self, lesson, device)

    def test_a_hand_that_knows_nothing_does_none(self):
        for lesson in lessons():
            if lesson["name"] not in LONG:
                check_that_it_is_not_done(self, lesson["name"])

    def test_the_same_command_gives_the_same_lines(self):
        first = palpa("lessons", "play", "water", "--headless")
        self.assertEqual(first.stdout, palpa("lessons", "play", "water", "--headless").stdout)
        self.assertRegex(first.stdout, r"approach +done +\d+\.\d\d s +[\d.]+; wanted: "
                                       r"distance_angstrom at most 4\n")
        self.assertIn("6 of 6 steps done in", first.stdout)

    def test_what_is_wrong_is_said(self):
        for arguments, message in ((["play", "watr"], "no lesson 'watr'; expected one of"),
                                   (["play"], "needs a lesson"),
                                   (["play", "water", "--idle"], "--headless"),
                                   (["play", "water", "--headless", "--by", "hand"],
                                    "omni, small"),
                                   (["ply", "water"], "play")):
            with self.subTest(arguments=arguments):
                result = palpa("lessons", *arguments)
                self.assertEqual(result.returncode, 2)
                self.assertIn(message, result.stderr)


if __name__ == "__main__":
    unittest.main()
