"""Every action of the window, worked by a person's mouse and keys under Xvfb: by its menu, by its key and
by the search. The file of --actions says what was done."""
import os
import re
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

from window_case import WindowCase
from window_test import PROGRAM, ROOT, Display

# Menus in the bar at the usual size of text: their place, and their rows.
MENUS = {"File": 24, "Edit": 65, "View": 105, "Select": 151, "Simulate": 211, "Lesson": 273, "Help": 346}
BAR, FIRST_ROW, ROW = 10, 28, 20

# Keys that make an action possible, and keys after it.
BEFORE = {"undo": ["4"], "redo": ["4", "ctrl+z"], "tour": ["shift+w"]}
AFTER = {"export": ["Escape"], "film": ["m"], "record": ["F9"], "redo": ["ctrl+z"], "add": ["Escape"],
         "release": ["ctrl+z"], "panels": ["Tab"], "next-device": ["Escape"], "larger-text": ["ctrl+0"],
         "smaller-text": ["ctrl+0"], "select": ["Escape"], "pause": ["p"], "step": ["p"],
         "tour": ["u"], "lesson": ["l"], "picture": ["Escape"], "measure": ["i"], "search": ["Escape"], "keys": ["Escape"]}
ENDS = {"open", "quit"}  # end the scene, and are worked in windows of their own
OF_TRAJECTORIES = {"play-trajectory", "trajectory-start"}
OF_MEASURES = {"remove-measures"}  # see window_test.py


def list_actions():
    """What `palpa help actions` prints: name, text, menu, first key."""
    text = subprocess.run([PROGRAM, "help", "actions"], capture_output=True, text=True,
                          check=True).stdout
    actions = []
    for name, line, _ in re.findall(r"^(\S+)\n  (.*)\n  (.*)$", text, re.M):
        title, menu, *keys = line.split("; ")
        key = keys[0].split(", ")[0] if keys else ""
        actions.append((name, title, menu.removeprefix("menu "), key))
    return actions


def as_xdotool(key):
    """Ctrl+Shift+Z as xdotool names it."""
    names = {"Esc": "Escape", "Enter": "Return", ".": "period", "+": "plus", "-": "minus", "Tab": "Tab"}
    *modifiers, last = re.match(r"((?:\w+\+)*)(.+)", key).groups()
    last = names.get(last, last if len(last) > 1 else last.lower())
    return modifiers[0].lower() + last


class Actions(WindowCase):
    def setUp(self):
        self.folder = Path(tempfile.mkdtemp())
        os.environ.update(SDL_AUDIODRIVER="disk", SDL_DISKAUDIOFILE=str(self.folder / "sound.raw"))

    def start(self, display, *options):
        shutil.copytree(ROOT / "scenes" / "dipeptide", self.folder / "dipeptide", dirs_exist_ok=True)
        self.display, self.shots, self.seen = display, 0, 0
        self.log = self.folder / "actions.csv"
        self.log.unlink(missing_ok=True)
        self.program = subprocess.Popen(
            [PROGRAM, "run", self.folder / "dipeptide", "--files", self.folder, "--size", "640x520",
             "--actions", self.log, *map(str, options)],
            env={**os.environ, "DISPLAY": display.name}, stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE, text=True)
        self.wait_until(display.focus_window, "the window")
        self.see()

    def done(self):
        """Actions since the last look, and how."""
        rows = [row.split(",")[1:] for row in self.log.read_text().splitlines()[1:]]
        return [tuple(row) for row in rows[self.seen:] if row != ["screenshot", "key"]]

    def forget(self):
        self.seen = len(self.log.read_text().splitlines()) - 1

    def see(self):
        """A screenshot: what was done before it has been seen by a frame."""
        name = max((int(path.stem[6:10]) for path in self.folder.glob("palpa-*.png")), default=0) + 1
        path = self.folder / f"palpa-{name:04}.png"
        self.display.do("key", "F12")
        self.wait_until(path.exists, path.name)

    def press(self, keys):
        for key in keys:
            self.display.do("key", key)
            self.see()

    def click(self, x, y):
        self.display.do("mousemove", x, y)
        self.see()
        self.display.do("click", 1)
        self.see()

    def work(self, action, way):
        """Does an action in one of the ways, as a person would."""
        name, title, menu, key = action
        self.press(BEFORE.get(name, []))
        self.forget()
        if way == "menu":
            rows = [other[0] for other in self.actions if other[2] == menu]
            self.click(MENUS[menu], BAR)
            self.display.do("mousemove", MENUS[menu], FIRST_ROW + ROW * rows.index(name), "click", 1)
        elif way == "key":
            self.display.do("key", as_xdotool(key))
        else:
            self.display.do("key", "ctrl+k")
            self.see()
            self.display.do("type", title)
            self.see()
            self.display.do("key", "Return")

    def check(self, action, way):
        """Works the action; once more while the session has not said yet that it is possible."""
        name = action[0]
        expected = [("search", "key")] if way == "search" else []
        waits = name in BEFORE or name in AFTER  # for what its keys, or those of the one before, do
        for _ in range(50 if waits else 1):
            self.work(action, way)
            if name in ENDS:
                self.wait_until(lambda: (name, way) in self.done(), f"{name} by {way}")
                return
            self.see()  # what was chosen is done by the end of the next frame
            self.see()
            if len(self.done()) > len(expected):
                break
            self.press(["Escape"])
        self.assertEqual(self.done(), [*expected, (name, way)])
        self.press(AFTER.get(name, []))

    def ways(self, action):
        """The key of the screenshot is worked with every look."""
        has_key = action[3] and action[0] != "screenshot"
        return ["menu", "key", "search"] if has_key else ["menu", "search"]

    def end(self):
        self.display.do("key", "ctrl+q")
        _, err = self.program.communicate()
        self.assertEqual(self.program.returncode, 0, err)

    def test_each_action_by_menu_key_and_search(self):
        self.actions = list_actions()
        self.assertGreater(len(self.actions), 50)
        with Display("640x520") as display:
            self.start(display)
            for action in self.actions:
                if action[0] in ENDS | OF_TRAJECTORIES | OF_MEASURES:
                    continue
                for way in self.ways(action):
                    with self.subTest(action=action[0], by=way):
                        if action[0] == "select-nothing":
                            self.press(["ctrl+f"])
                            display.do("type", "all")
                            self.press(["Return"])
                        self.check(action, way)
            self.display.do("key", "ctrl+q")  # asks, for there are changes
            self.see()
            self.display.do("key", "q")
            _, err = self.program.communicate()
            problems = [line for line in err.splitlines() if not line.startswith("CRITICAL")]  # SDL
            self.assertEqual((self.program.returncode, problems), (0, []))

    def test_a_trajectory_is_played_by_menu_key_and_search(self):
        self.actions = list_actions()
        subprocess.run([PROGRAM, "run", ROOT / "scenes" / "dipeptide", "--headless", "--seconds", "0.5",
                        "--record", self.folder / "run"], check=True, stdout=subprocess.DEVNULL)
        with Display("640x520") as display:
            self.start(display, "--trajectory", self.folder / "run" / "trajectory.dcd")
            for action in self.actions:
                for way in self.ways(action) if action[0] in OF_TRAJECTORIES else []:
                    with self.subTest(action=action[0], by=way):
                        self.check(action, way)
            self.end()

    def test_a_scene_is_left_by_menu_key_and_search(self):
        self.actions = list_actions()
        for action in self.actions:
            for way in self.ways(action) if action[0] in ENDS else []:
                with self.subTest(action=action[0], by=way), Display("640x520") as display:
                    self.start(display)
                    self.check(action, way)
                    if action[0] == "open":  # the start screen
                        self.see()
                        display.do("key", "ctrl+q")
                    _, err = self.program.communicate()
                    self.assertEqual(self.program.returncode, 0, err)


if __name__ == "__main__":
    unittest.main()
