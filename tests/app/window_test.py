"""One session in a window under Xvfb: start, drag the molecule, move a slider, switch the mode, take
a screenshot, set the graphics up again, change the size, quit. Vulkan's validation watches."""
import ctypes
import json
import os
import shutil
import signal
import struct
import subprocess
import tempfile
import time
import unittest
from array import array
from pathlib import Path

from read_png import read_png
from recorded_files import open_recorded

PROGRAM = os.environ["PALPA_PROGRAM"]
ROOT = Path(os.environ["PALPA_ROOT"])


def size_of_png(path):
    data = path.read_bytes()
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    return struct.unpack(">II", data[16:24])


class Display:
    """A display that nobody sees, on a number that is free."""

    def __init__(self, screen="1280x800"):
        self.screen = screen

    def __enter__(self):
        read, write = os.pipe()
        self.server = subprocess.Popen(
            ["Xvfb", "-displayfd", str(write), "-screen", "0", f"{self.screen}x24", "-nolisten", "tcp",
             "-noreset"],
            pass_fds=[write], stderr=subprocess.DEVNULL)
        os.close(write)
        with os.fdopen(read) as pipe:
            self.name = ":" + pipe.readline().strip()
        return self

    def __exit__(self, *_):
        self.server.terminate()
        self.server.wait()

    def do(self, *words):
        subprocess.run(["xdotool", *map(str, words)], check=True,
                       env={**os.environ, "DISPLAY": self.name}, stdout=subprocess.DEVNULL)

    def cursor(self):
        words = subprocess.run(["xdotool", "getmouselocation"], capture_output=True, text=True,
                               env={**os.environ, "DISPLAY": self.name}).stdout.split()
        return tuple(int(word.split(":")[1]) for word in words[:2])

    def drop(self, window, *files):
        DragSource(self.name, int(window), files).drop()

    def find_window(self):
        return subprocess.run(["xdotool", "search", "--onlyvisible", "--name", "^Palpa - "],
                              capture_output=True, text=True,
                              env={**os.environ, "DISPLAY": self.name}).stdout.split()

    def set_dots_per_inch(self, dots):
        """As desktops tell programs how large text should be."""
        resource_manager, string, eight_bits, replace = 23, 31, 8, 0
        x11 = ctypes.CDLL("libX11.so.6")
        x11.XOpenDisplay.restype, x11.XDefaultRootWindow.restype = ctypes.c_void_p, ctypes.c_ulong
        display = ctypes.c_void_p(x11.XOpenDisplay(self.name.encode()))
        text = f"Xft.dpi:\t{dots}\n".encode()
        x11.XChangeProperty(display, ctypes.c_ulong(x11.XDefaultRootWindow(display)),
                            ctypes.c_ulong(resource_manager), ctypes.c_ulong(string), eight_bits,
                            replace, text, len(text))
        x11.XCloseDisplay(display)

    def focus_window(self):
        """Whether the window could be given the keys; it may not be there yet."""
        found = self.find_window()
        return found and subprocess.run(["xdotool", "windowfocus", "--sync", found[0]],
                                        env={**os.environ, "DISPLAY": self.name},
                                        stderr=subprocess.DEVNULL).returncode == 0


class ClientMessage(ctypes.Structure):
    _fields_ = [("type", ctypes.c_int), ("serial", ctypes.c_ulong), ("send_event", ctypes.c_int),
                ("display", ctypes.c_void_p), ("window", ctypes.c_ulong),
                ("message_type", ctypes.c_ulong), ("format", ctypes.c_int),
                ("data", ctypes.c_long * 5)]


class SelectionRequest(ctypes.Structure):
    _fields_ = [("type", ctypes.c_int), ("serial", ctypes.c_ulong), ("send_event", ctypes.c_int),
                ("display", ctypes.c_void_p), ("owner", ctypes.c_ulong),
                ("requestor", ctypes.c_ulong), ("selection", ctypes.c_ulong),
                ("target", ctypes.c_ulong), ("property", ctypes.c_ulong), ("time", ctypes.c_ulong)]


class SelectionNotify(ctypes.Structure):
    _fields_ = [("type", ctypes.c_int), ("serial", ctypes.c_ulong), ("send_event", ctypes.c_int),
                ("display", ctypes.c_void_p), ("requestor", ctypes.c_ulong),
                ("selection", ctypes.c_ulong), ("target", ctypes.c_ulong),
                ("property", ctypes.c_ulong), ("time", ctypes.c_ulong)]


class Event(ctypes.Union):
    _fields_ = [("type", ctypes.c_int), ("client", ClientMessage), ("request", SelectionRequest),
                ("notify", SelectionNotify), ("pad", ctypes.c_long * 24)]


class DragSource:
    """Drops files on a window as file managers do (XDND)."""

    def __init__(self, display, target, files):
        self.x11 = x11 = ctypes.CDLL("libX11.so.6")
        for function, result in ((x11.XOpenDisplay, ctypes.c_void_p),
                                 (x11.XDefaultRootWindow, ctypes.c_ulong),
                                 (x11.XCreateSimpleWindow, ctypes.c_ulong),
                                 (x11.XInternAtom, ctypes.c_ulong)):
            function.restype = result
        self.display = ctypes.c_void_p(x11.XOpenDisplay(display.encode()))
        self.target = target
        self.data = "".join(file.as_uri() + "\r\n" for file in files).encode()
        root = ctypes.c_ulong(x11.XDefaultRootWindow(self.display))
        zero = ctypes.c_ulong(0)
        self.window = x11.XCreateSimpleWindow(self.display, root, 0, 0, 1, 1, 0, zero, zero)

    def atom(self, name):
        return self.x11.XInternAtom(self.display, name.encode(), 0)

    def send(self, window, event):
        self.x11.XSendEvent(self.display, ctypes.c_ulong(window), 0, ctypes.c_long(0),
                            ctypes.byref(event))
        self.x11.XFlush(self.display)

    def tell(self, name, *data):
        event = Event()
        event.client = ClientMessage(33, 0, 1, None, self.target, self.atom(name), 32,
                                     (ctypes.c_long * 5)(self.window, *data))
        self.send(self.target, event)

    def drop(self):
        version, now, selection_request, selection_notify, client_message = 5, 0, 30, 31, 33
        self.x11.XSetSelectionOwner(self.display, ctypes.c_ulong(self.atom("XdndSelection")),
                                    ctypes.c_ulong(self.window), ctypes.c_ulong(now))
        self.tell("XdndEnter", version << 24, self.atom("text/uri-list"))
        self.tell("XdndDrop", 0, now)
        event = Event()
        while True:
            self.x11.XNextEvent(self.display, ctypes.byref(event))
            if event.type == selection_request:
                asked = event.request
                self.x11.XChangeProperty(
                    self.display, ctypes.c_ulong(asked.requestor), ctypes.c_ulong(asked.property),
                    ctypes.c_ulong(asked.target), 8, 0, self.data, len(self.data))
                answer = Event()
                answer.notify = SelectionNotify(selection_notify, 0, 1, None, asked.requestor,
                                                asked.selection, asked.target, asked.property,
                                                asked.time)
                self.send(asked.requestor, answer)
            elif event.type == client_message:  # XdndFinished
                break
        self.x11.XCloseDisplay(self.display)


def difference(one, two):
    """In levels of 255, on average over pixels and channels."""
    return sum(abs(a - b) for a, b in zip(one, two)) / len(one)


class Session(unittest.TestCase):
    def setUp(self):
        self.folder = Path(tempfile.mkdtemp())
        self.sound = self.folder / "sound.raw"  # what the sound library plays, into a file
        os.environ.update(SDL_AUDIODRIVER="disk", SDL_DISKAUDIOFILE=str(self.sound))

    def tearDown(self):
        keep = os.environ.get("PALPA_KEEP_SCREENSHOTS")
        if keep:
            shutil.copytree(self.folder, keep, dirs_exist_ok=True)
        shutil.rmtree(self.folder)

    def wait_until(self, is_so, what):
        for _ in range(1200):
            if is_so():
                return
            self.assertIsNone(self.program.poll(), "the program ended early")
            time.sleep(0.05)
        self.fail("waited in vain for " + what)

    def start(self, display, *options, scene=ROOT / "scenes" / "water"):
        self.program = subprocess.Popen(
            [PROGRAM, "run", scene, "--screenshots", self.folder, "--json",
             "--validation", *map(str, options)],
            env={**os.environ, "DISPLAY": display.name, "XDG_CONFIG_HOME": str(self.folder)},
            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.wait_until(display.focus_window, "the window")
        self.screenshots = 0
        self.screenshot(display)  # the first picture is there: it takes part from now on

    def screenshot(self, display):
        self.screenshots += 1
        path = self.folder / f"palpa-{self.screenshots:04}.png"
        display.do("key", "F12")
        self.wait_until(path.exists, path.name)
        return path

    def last_sound(self):
        """A fifth of a second of samples, the last ones so far."""
        data = self.sound.read_bytes() if self.sound.exists() else b""
        return array("f", data[:len(data) // 4 * 4])[-9600:]

    def wait_for_tone(self, amplitude):
        """Until the hand feels a force that sounds so loud: with --sound. 0.05 is 0.14 N, 0.15 is 1.1 N
        (engine/sound/tone.h)."""
        self.wait_until(lambda: max(self.last_sound(), default=0) > amplitude, "a tone")

    def quit(self, display, *, changed=False):
        display.do("key", "ctrl+q")
        if changed:  # asked whether to save
            self.screenshot(display)
            self.assertIsNone(self.program.poll(), "it did not ask")
            display.do("key", "q")
        out, err = self.program.communicate(timeout=60)
        self.assertEqual(self.program.returncode, 0, err)
        return json.loads(out)

    def quit_once_saved(self, display):
        """Nothing is asked as soon as what the session has undone has reached the window; until then
        Escape closes the question."""
        for _ in range(60):
            display.do("key", "ctrl+q")
            try:
                _, err = self.program.communicate(timeout=2)
            except subprocess.TimeoutExpired:
                display.do("key", "Escape")
                continue
            return self.assertEqual(self.program.returncode, 0, err)
        self.fail("it asks whether to save what is saved")

    def test_a_session_with_mouse_and_keys(self):
        with Display() as display:
            self.start(display)
            self.assertEqual(size_of_png(self.folder / "palpa-0001.png"), (1280, 800))

            # A plain drag turns the view and pushes no atoms.
            display.do("mousemove", 640, 330, "mousedown", 1)
            for _ in range(10):
                display.do("mousemove_relative", "--", -8, 2)
            display.do("mouseup", 1)
            display.do("key", "Home")
            # With Space held the molecule comes along.
            first = self.find_waters(display)
            display.do("mousemove", 660, 330, "keydown", "space")
            self.draw_until_nearer(display, first)
            display.do("keyup", "space")
            self.screenshot(display)

            # The first slider of the gains, A_f max, to its far right.
            # A screenshot between two events makes sure that a frame has seen the first.
            self.open_tab(display, self.COUPLING)
            display.do("mousemove", 1040, 615)
            self.screenshot(display)
            display.do("mousedown", 1)
            self.screenshot(display)
            display.do("mousemove", 1170, 615)
            self.screenshot(display)
            display.do("mouseup", 1)
            self.screenshot(display)
            display.do("key", "3")
            display.do("key", "v")
            display.do("key", "F5")
            self.screenshot(display)
            display.do("windowsize", "--sync", display.find_window()[0], 900, 600)
            self.wait_until(lambda: size_of_png(self.screenshot(display)) == (900, 600),
                            "the new size")
            summary = self.quit(display, changed=True)

        self.assertLess(summary["closest_angstrom"], 6.5)
        # That a busy machine is too slow is no fault of the program.
        self.assertEqual([w for w in summary["warnings"] if "too slow" not in w], [])
        self.assertEqual(summary["mode"], "3")
        self.assertGreater(summary["coupling"]["A_f_max"], 6e9)
        self.assertGreater(summary["steps"], 0)
        self.assertFalse(summary["stopped"])

    def test_a_hand_that_nobody_moves_moves_nothing(self):
        with Display() as display:
            self.start(display)
            display.do("mousemove", 640, 330, "mousedown", 1)
            for _ in range(10):
                display.do("mousemove_relative", "--", -20, 0)
            display.do("mouseup", 1)
            summary = self.quit(display)
        self.assertAlmostEqual(summary["closest_angstrom"], 7, delta=0.7)

    def test_a_click_takes_the_other_water_and_undo_gives_it_back(self):
        """Which one is in hand is seen by which one an arrow key moves."""
        with Display() as display:
            self.start(display)
            display.do("key", "l")
            fixed, _ = self.find_waters(display)
            self.take(display, fixed, 0)
            display.do("mousemove", 640, 700)
            _, moved = self.find_waters(display)
            self.pull_until(display, "Right", lambda now: now[0][0] > fixed[0] + 40)
            self.assertLess(self.way(self.find_waters(display)[1], moved), 6)

            self.press_until(display, "ctrl+z",  # pulls, as many as there were rests between
                             lambda: self.way(self.find_waters(display)[0], fixed) < 6,
                             "the water back in its place")
            display.do("key", "ctrl+z")  # the grip
            self.screenshot(display)
            self.pull_until(display, "Left", lambda now: now[1][0] < moved[0] - 40)
            self.assertLess(self.way(self.find_waters(display)[0], fixed), 6)

            display.do("key", "g")  # let go: no key moves it
            self.wait_until(lambda: self.find_held(display) is None, "an empty hand")
            there = self.find_waters(display)
            display.do("keydown", "Right")
            time.sleep(1)
            self.screenshot(display)
            display.do("keyup", "Right")
            for one, other in zip(there, self.find_waters(display)):
                self.assertLess(self.way(one, other), 6)
            summary = self.quit(display)
        self.assertEqual([w for w in summary["warnings"] if "too slow" not in w], [])
        self.assertFalse(summary["stopped"])

    def test_a_pull_is_undone_and_redone(self):
        with Display() as display:
            self.start(display)
            display.do("key", "l")
            first = self.find_waters(display)
            display.do("mousemove", 660, 330, "keydown", "space")
            self.draw_until_nearer(display, first, 0.6)
            display.do("keyup", "space")
            self.screenshot(display)
            pulled = self.way(*self.find_waters(display))
            middle = 0.5 * (pulled + self.way(*first))
            self.press_until(display, "ctrl+z", lambda: self.way(*self.find_waters(display)) > middle,
                             "waters as far apart as before the pull")
            self.press_until(display, "ctrl+shift+z",
                             lambda: self.way(*self.find_waters(display)) < middle,
                             "waters as near as after the pull")
            self.quit(display)

    def test_what_is_added_and_removed_is_seen_undone_recorded_and_played_again(self):
        recording = self.folder / "palpa-session-0001"
        with Display() as display:
            self.start(display)
            display.do("key", "l")
            self.assertEqual(self.count_waters(display), 2)
            display.do("key", "F9")
            self.wait_until((recording / "journal.txt").exists, "the recording")
            display.do("key", "Insert")
            self.screenshot(display)  # the dialog is there
            display.do("type", "tip")
            display.do("key", "Return")
            self.wait_for_waters(display, 3)
            display.do("key", "ctrl+z")
            self.wait_for_waters(display, 2)
            display.do("key", "ctrl+shift+z")
            self.wait_for_waters(display, 3)
            self.assertIsNotNone(self.find_arrow(display))
            display.do("key", "Delete")
            self.wait_for_waters(display, 2)
            self.assertIsNone(self.find_arrow(display))  # it was in hand
            display.do("key", "Delete")  # nothing is
            self.screenshot(display)
            self.assertEqual(self.count_waters(display), 2)
            display.do("key", "ctrl+z")
            self.wait_for_waters(display, 3)
            self.assertIsNotNone(self.find_arrow(display))
            display.do("key", "Insert")
            self.screenshot(display)
            display.do("key", "Escape")  # closes the dialog, not the program
            self.screenshot(display)
            self.assertEqual(self.count_waters(display), 3)
            display.do("key", "F9")
            self.wait_until(lambda: self.is_compressed(recording), "the compressed recording")
            self.quit(display, changed=True)

        edits = self.edits_of(recording)
        self.assertEqual([edit.split("\n")[4].split(" = ")[0] for edit in edits],
                         ["add", "undo", "redo", "remove", "undo"])
        self.assertIn('residue = "TIP3", name = "w2"', edits[0])
        self.assertIn('remove = "moved"', edits[3])
        self.assertTrue(self.plays_again(recording))
        # Its atoms, which the recording leaves out, follow from the journal: the third water too.
        again = subprocess.run([PROGRAM, "replay", recording, "--trajectory-fps", "25"], capture_output=True,
                               text=True)
        self.assertEqual(again.returncode, 0, again.stderr)
        self.assertIn(" 6 !NATOM", (recording / "system.psf").read_text())
        self.assertIn(" 9 !NATOM", (recording / "system-2.psf").read_text())
        self.assertTrue((recording / "trajectory-2.dcd").exists())

    def test_a_file_that_is_dropped_is_added_and_recorded(self):
        recording, dropped = self.folder / "recording", self.folder / "a water.crd"
        lines = (ROOT / "scenes" / "water" / "three.crd").read_text().splitlines()
        dropped.write_text("\n".join(["* One", "*", f"{3:10}  EXT", *lines[4:7]]) + "\n")
        with Display() as display:
            self.start(display, "--record", recording)
            display.do("key", "l")
            display.drop(display.find_window()[0], dropped)
            self.wait_until(lambda: self.is_shaded(display), "the question")
            display.do("key", "a", "key", "Return")
            self.wait_for_waters(display, 3)
            self.quit(display, changed=True)
        dropped.unlink()

        self.assertTrue(self.is_compressed(recording))  # on quitting
        self.assertEqual(len(self.edits_of(recording)), 1)
        self.assertIn('structure = "inputs/a_water.crd"', self.edits_of(recording)[0])
        self.assertIn('name = "a_water2"', self.edits_of(recording)[0])
        self.assertTrue(self.plays_again(recording))

    @staticmethod
    def is_compressed(recording):
        files = {file.name for file in recording.iterdir() if file.is_file()} if recording.exists() else set()
        return files == {"journal.txt.gz", "session.toml", "summary.json", "trace.csv.gz"}

    def edits_of(self, recording):
        with open_recorded(recording / "journal.txt") as journal:
            events = [line.split(" ", 2)[2] for line in journal if line.startswith("c ")]
        return [event["edit"] for event in map(json.loads, events) if "edit" in event]

    def plays_again(self, recording):
        result = subprocess.run([PROGRAM, "replay", recording, "--json"], capture_output=True,
                                text=True)
        played = json.loads(result.stdout)
        self.assertGreater(played["recorded"], 100)
        self.assertEqual(played["compared"], played["recorded"])
        return played["different"] == 0 and result.returncode == 0

    def is_shaded(self, display):
        """As the picture is behind a dialog."""
        (width, _), pixels = read_png(self.screenshot(display))
        return pixels[4 * (width * 600 + 640)] < 200

    def test_a_drag_takes_nothing(self):
        with Display() as display:
            self.start(display)
            display.do("key", "l")
            fixed, moved = self.find_waters(display)
            display.do("mousemove", *fixed)
            self.screenshot(display)
            display.do("mousedown", 1)
            for way in (-3, 3):  # there and back: the view is as it was
                for _ in range(10):
                    display.do("mousemove_relative", "--", way, 0)
            self.screenshot(display)
            display.do("mouseup", 1)
            time.sleep(1)
            self.pull_until(display, "Left", lambda now: now[1][0] < moved[0] - 40)
            self.assertLess(self.way(self.find_waters(display)[0], fixed), 6)
            self.quit(display)

    def way(self, a, b):
        return ((a[0] - b[0]) ** 2 + (a[1] - b[1]) ** 2) ** 0.5

    def pull_until(self, display, key, is_so):
        """Bit by bit, so that nothing goes on while a slow machine looks."""
        display.do("mousemove", 640, 700)

        def pull():
            display.do("keydown", key)
            self.screenshot(display)
            display.do("keyup", key)
            return is_so(self.find_waters(display))

        self.wait_until(pull, "a water that moves")

    def draw_until_nearer(self, display, first, share=0.9):
        """With Space held; to this share of 7 Å or nearer."""
        def draw():
            for _ in range(10):
                display.do("mousemove_relative", "--", -6, 0)
            return self.way(*self.find_waters(display)) < share * self.way(*first)

        self.wait_until(draw, "waters that are nearer")

    def press_until(self, display, key, is_so, what):
        def press():
            display.do("key", key)
            self.screenshot(display)
            return is_so()

        self.wait_until(press, what)

    def take(self, display, water, number):
        """By a click on it, until it is in hand: that number from the left."""
        display.do("mousemove", *water)
        self.screenshot(display)  # the picture of what a click would take
        display.do("click", 1)
        self.wait_until(lambda: self.find_held(display) == number, "the water in hand")

    def find_held(self, display):
        """The water, from the left, that the arrow of the hand's force stands on; None: there is none."""
        picture = read_png(self.screenshot(display))
        arrow = self.find_arrow_in(picture)
        if not arrow:
            return None
        waters = self.find_waters_in(picture)
        ways = [min(self.way(water, point) for point in arrow) for water in waters]
        return ways.index(min(ways))

    def find_arrow(self, display):
        return self.find_arrow_in(read_png(self.screenshot(display)))

    def find_arrow_in(self, picture):
        """Some of its pixels; None: no force is shown."""
        (width, height), pixels = picture
        arrow = [(x, y) for y in range(90, height - 90, 2) for x in range(362, width - 362, 2)
                 if self.is_orange(*pixels[4 * (width * y + x):4 * (width * y + x) + 3])]
        return arrow or None

    def is_orange(self, red, green, blue):
        return red > 120 and 0.4 * red < green < 0.75 * red and blue < 0.3 * red

    def find_waters(self, display):
        """The middles of the two oxygens, from left to right, in pixels between the panels."""
        return self.find_waters_in(read_png(self.screenshot(display)))

    def count_waters(self, display):
        """Red patches: oxygens that are seen apart from each other. The ring of the hand may cross one."""
        (width, height), pixels = read_png(self.screenshot(display))
        red = {(x, y) for y in range(100, height - 60, 2) for x in range(362, width - 362, 2)
               if self.is_red(*pixels[4 * (width * y + x):4 * (width * y + x) + 3])}
        count = 0
        while red:
            front, size = [red.pop()], 0
            while front:
                x, y = front.pop()
                size += 1
                near = {(x + dx, y + dy) for dx in range(-12, 13, 2) for dy in range(-12, 13, 2)} & red
                red -= near
                front += near
            count += size > 50
        return count

    def is_red(self, red, green, blue):
        return red > 120 and green < 0.3 * red and blue < 0.3 * red

    def wait_for_waters(self, display, count):
        self.wait_until(lambda: self.count_waters(display) == count, f"{count} waters")

    def find_waters_in(self, picture):
        (width, height), pixels = picture
        columns = {}
        for y in range(90, height - 90, 2):
            for x in range(310, width - 310, 2):
                if self.is_red(*pixels[4 * (width * y + x):4 * (width * y + x) + 3]):
                    columns.setdefault(x, []).append(y)
        groups, last = [], None
        for x in sorted(columns):
            if last is None or x - last > 6:
                groups.append([])
            groups[-1] += [(x, y) for y in columns[x]]
            last = x
        groups = sorted(sorted(groups, key=len)[-2:])
        self.assertEqual(len(groups), 2)
        return [tuple(sum(place[i] for place in group) // len(group) for i in (0, 1))
                for group in groups]

    BUTTON, FIELD, PANEL = (178, 212, 252), (230, 235, 242), (253, 253, 254)
    HAND, INSPECTOR, COUPLING, MACHINE = 1002, 1062, 1134, 1202  # the middles of tabs at the right

    def open_tab(self, display, x):
        display.do("mousemove", x, 69)
        self.screenshot(display)
        display.do("click", 1)
        self.screenshot(display)

    def find_list(self, display):
        """The middle of the arrow of the drop-down list at the top of the right panel."""
        (width, _), pixels = read_png(self.screenshot(display))
        for x in range(width - 30, 980, -1):
            ys = [y for y in range(80, 300) if self.is_near(pixels, width, x, y, self.BUTTON)
                  and self.is_near(pixels, width, x - 1, y, self.FIELD)]
            if len(ys) > 10:
                return x + 10, min(ys) + 10
        self.fail("there is no list")

    def is_near(self, pixels, width, x, y, colour):
        return all(abs(pixels[4 * (width * y + x) + i] - colour[i]) < 4 for i in range(3))

    def open_list(self, display, arrow):
        """Until its entries cover what is below it."""
        display.do("mousemove", arrow[0], arrow[1], "click", 1)
        self.wait_until(lambda: not self.is_panel(display, arrow[0] - 10, arrow[1] + 14), "a list")

    def is_panel(self, display, x, y):
        (width, _), pixels = read_png(self.screenshot(display))
        return self.is_near(pixels, width, x, y, self.PANEL)

    def choose_entry(self, display, arrow, number):
        """From 0, of a list that is open, once it is marked as what the mouse is on."""
        x, y = arrow[0] - 100, arrow[1] + 25 + 20 * number
        before = read_png(self.screenshot(display))[1]
        display.do("mousemove", x, y)

        def is_marked():
            (width, _), pixels = read_png(self.screenshot(display))
            there = slice(4 * (width * y + x + 60), 4 * (width * y + x + 63))
            return pixels[there] != before[there]

        self.wait_until(is_marked, "an entry that is marked")
        display.do("click", 1)

    def test_arrow_keys_pull_the_molecule_too(self):
        with Display() as display:
            self.start(display, "--sound")
            display.do("keydown", "Left")
            self.wait_for_tone(0.05)
            display.do("keyup", "Left")
            self.screenshot(display)
            summary = self.quit(display)
        self.assertEqual(summary["device"], "mouse and keys")
        self.assertLess(summary["closest_angstrom"], 6)

    def test_a_lost_device_comes_back(self):
        with Display() as display:
            self.start(display, "--lose-device-at", 5)
            self.screenshot(display)
            self.quit(display)

    def test_what_a_window_cannot_be(self):
        with Display() as display:
            for options, environment, expected in (
                    (["--size", "99999x99999"], {}, "more than 67108864 pixels"),
                    (["--size", "99999x600"], {}, "a window of "),
                    ([], {"VK_DRIVER_FILES": "/nowhere", "VK_ICD_FILENAMES": "/nowhere"},
                     "install a driver"),
                    (["--screenshots", "/nowhere"], {}, "/nowhere"),
                    (["--after", "nan", "--shot", "x.png"], {}, "nan")):
                with self.subTest(options=options):
                    result = subprocess.run(
                        [PROGRAM, "run", ROOT / "scenes" / "water", *options], text=True,
                        env={**os.environ, "DISPLAY": display.name, **environment},
                        capture_output=True, timeout=60)
                    self.assertEqual(result.returncode, 2, result.stderr)
                    self.assertEqual(len(result.stderr.strip().splitlines()), 1, result.stderr)
                    self.assertIn(expected, result.stderr)

    def test_a_device_that_was_chosen_is_remembered(self):
        chosen = self.folder / "palpa" / "preferences.toml"
        os.environ["PALPA_STUB"] = "free"
        try:
            with Display() as display:
                self.start(display)
                # From the list: nothing is on the bus, so that D passes the Omni over.
                self.open_tab(display, self.MACHINE)
                devices = self.find_list(display)
                self.open_list(display, devices)
                self.choose_entry(display, devices, 2)
                self.wait_until(lambda: "device = 'omni'" in chosen.read_text(),
                                "the choice on disk")
                self.assertEqual(self.quit(display)["device"], "emulated PHANTOM Omni")

                for file in self.folder.glob("*.png"):
                    file.unlink()
                self.start(display)
                summary = self.quit(display)
        finally:
            del os.environ["PALPA_STUB"]
        self.assertEqual(summary["device"], "emulated PHANTOM Omni")

    def test_without_hardware_an_emulated_device_is_asked_for_and_forgotten(self):
        chosen = self.folder / "palpa" / "preferences.toml"
        with Display() as display:
            self.start(display)
            display.do("key", "d")  # the Omni's library is there, but nothing on the bus
            self.screenshot(display)
            display.do("key", "Escape")  # no
            self.screenshot(display)
            display.do("key", "d")
            self.screenshot(display)
            display.do("key", "y")
            self.screenshot(display)
            self.assertEqual(self.quit(display)["device"], "emulated Omni")
        self.assertNotIn("device", chosen.read_text())

    def test_a_scene_is_saved_as_set_and_can_be_run(self):
        scene = Path(shutil.copytree(ROOT / "scenes" / "water", self.folder / "mine"))
        with Display() as display:
            self.start(display, scene=scene)
            display.do("key", "2", "key", "v", "key", "c")
            display.do("key", "ctrl+s")
            saved = scene / "scene-2.toml"
            self.wait_until(saved.exists, "the saved scene")
            display.do("key", "3")
            # A quick undo: both keys between two pictures.
            display.do("key", "ctrl+z")
            self.quit_once_saved(display)
        self.assertIn('mode = "2"', saved.read_text())
        self.assertIn('representation = "space-filling"', saved.read_text())
        self.assertIn('colour = "residue"', saved.read_text())
        self.assertFalse((scene / "scene-3.toml").exists())
        for options in ((saved, "--check"), (saved, "--headless", "--seconds", "0.1")):
            result = subprocess.run([PROGRAM, "run", *options], capture_output=True, text=True)
            self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("mode 2", result.stdout)

    @staticmethod
    def poses_of(recording):
        """The place of the water in hand from the other one, Å, a row each."""
        with open_recorded(recording / "trace.csv") as trace:
            rows = trace.read().splitlines()
        first = rows[0].split(",").index("molecule_x_angstrom")
        return [tuple(map(float, row.split(",")[first:first + 3])) for row in rows[1:]]

    def test_a_pull_is_saved_and_opened_again(self):
        scene = Path(shutil.copytree(ROOT / "scenes" / "water", self.folder / "mine"))
        saved, before, after = (scene / "scene-2.toml", self.folder / "before", self.folder / "after")
        with Display() as display:
            self.start(display, "--record", before, scene=scene)
            display.do("key", "l")
            first = self.find_waters(display)
            display.do("mousemove", 660, 330, "keydown", "space")
            self.draw_until_nearer(display, first, 0.6)
            apart = self.way(*self.find_waters(display))
            display.do("key", "ctrl+s")
            self.wait_until(saved.exists, "the saved scene")
            display.do("keyup", "space")
            self.quit(display)
            places = {line.split()[7]: line.split()[4:7]
                      for line in saved.with_suffix(".crd").read_text().splitlines()
                      if " OH2 " in line}
            pose = [float(a) - float(b) for a, b in zip(places["MOV"], places["FIX"])]
            off = min(max(abs(a - b) for a, b in zip(pose, row)) for row in self.poses_of(before))
            self.assertLess(off, 1e-9)
            self.assertLess(pose[0], 0.7 * self.poses_of(before)[0][0])

            for shot in self.folder.glob("palpa-*.png"):
                shot.unlink()
            self.start(display, "--record", after, scene=saved)
            # As large as it was seen, though the molecules are nearer to each other.
            self.assertAlmostEqual(self.way(*self.find_waters(display)), apart, delta=0.2 * apart)
            self.quit(display)
        for a, b in zip(pose, self.poses_of(after)[0]):
            self.assertAlmostEqual(a, b, delta=1e-9)

    def count_selected(self, display):
        """Pixels in the tint of what is selected, between the panels."""
        (width, height), pixels = read_png(self.screenshot(display))
        count = 0
        for y in range(90, height - 260, 2):
            for x in range(362, width - 362, 2):
                red, green, blue = pixels[4 * (width * y + x):4 * (width * y + x) + 3]
                count += red > 130 and green < 0.65 * red and 0.5 * red < blue < 0.95 * red
        return count

    def has_selected(self, display):
        # The edges of the arrow and of words have a few pixels of such a tint.
        return self.count_selected(display) > 100

    def wait_for_nothing_selected(self, display):
        self.wait_until(lambda: not self.has_selected(display), "nothing selected")

    def test_atoms_are_selected_by_words_and_by_a_box(self):
        with Display() as display:
            self.start(display)
            display.do("key", "l")
            self.assertFalse(self.has_selected(display))
            fixed, moved = self.find_waters(display)
            display.do("key", "ctrl+f")
            self.screenshot(display)  # the field has the keys
            display.do("type", "molecule fixt")
            display.do("key", "Return")
            self.screenshot(display)
            self.assertFalse(self.has_selected(display))  # an error, and no program's end
            display.do("key", "ctrl+f")
            self.screenshot(display)
            display.do("type", "molecule fixed")
            display.do("key", "Return")
            self.wait_until(lambda: self.has_selected(display), "what is selected")
            one = self.count_selected(display)
            display.do("key", "Escape")  # ends the selection, not the program
            self.wait_for_nothing_selected(display)

            # A box around both oxygens; the panel below has moved them up.
            fixed, moved = self.find_waters(display)
            display.do("mousemove", fixed[0] - 30, fixed[1] - 30, "keydown", "ctrl", "mousedown", 1,
                       "keyup", "ctrl")
            self.screenshot(display)
            display.do("mousemove", moved[0] + 30, moved[1] + 30)
            self.screenshot(display)
            display.do("mouseup", 1)
            self.wait_until(lambda: self.count_selected(display) > 1.5 * one, "both waters")
            for a, b in zip((fixed, moved), self.find_middles(display)):
                self.assertLess(self.way(a, b), 30)  # the view did not turn
            self.quit(display)

    def find_middles(self, display):
        """Of both waters, once nothing is tinted."""
        display.do("key", "Escape")
        self.wait_for_nothing_selected(display)
        return self.find_waters(display)

    def test_names_and_views_are_saved_with_the_scene(self):
        scene = Path(shutil.copytree(ROOT / "scenes" / "water", self.folder / "mine"))
        saved = scene / "scene-2.toml"
        with Display() as display:
            self.start(display, scene=scene)
            display.do("key", "l")
            fixed, moved = self.find_waters(display)
            display.do("mousemove", *fixed)
            self.screenshot(display)
            display.do("keydown", "alt", "click", 1, "keyup", "alt")
            self.screenshot(display)
            display.do("mousemove", *moved)
            self.screenshot(display)
            display.do("click", 3)  # the right button does the same
            self.screenshot(display)
            display.do("click", 3)  # no longer
            self.screenshot(display)
            display.do("mousemove", 640, 400, "click", 4, "click", 4)  # the wheel: nearer
            self.screenshot(display)
            display.do("key", "shift+w")
            self.screenshot(display)
            display.do("key", "ctrl+s")
            self.wait_until(saved.exists, "the saved scene")
            self.assertIn('label = ["molecule fixed and resid 1 and name OH2"]', saved.read_text())
            self.assertIn('[[view.saved]]\nname = "view 1"', saved.read_text())
            near = self.find_waters(display)
            display.do("key", "Home")
            self.screenshot(display)
            away = self.find_waters(display)
            self.assertGreater(self.way(*near), 1.1 * self.way(*away))
            display.do("key", "w")
            self.wait_until(lambda: abs(self.way(*self.find_waters(display)) - self.way(*near)) <
                            0.03 * self.way(*near), "the saved view")
            display.do("key", "Home", "key", "u")  # the tour comes to it too
            self.wait_until(lambda: abs(self.way(*self.find_waters(display)) - self.way(*near)) <
                            0.03 * self.way(*near), "the saved view")
            display.do("key", "Escape")  # ends the tour, not the program
            self.screenshot(display)
            display.do("key", "ctrl+z")  # the name of the one that was named and is no longer
            self.screenshot(display)
            self.quit(display, changed=True)
        result = subprocess.run([PROGRAM, "run", saved, "--check"], capture_output=True, text=True)
        self.assertEqual(result.returncode, 0, result.stderr)

    def test_a_step_of_the_lesson_shows_its_view(self):
        scene = Path(shutil.copytree(ROOT / "scenes" / "water", self.folder / "mine")) / "scene.toml"
        text = scene.read_text()
        self.assertIn("[lesson.approach]\n", text)
        scene.write_text(text.replace("[lesson.approach]\n", '[lesson.approach]\nview = "near"\n') +
                         '\n[[view.saved]]\nname = "near"\ncamera = [0.0, 0.0, 2.2]\n')
        with Display() as display:
            self.start(display, "--set", "stroke=hold", scene=scene)
            self.wait_until(lambda: not self.is_flying(display), "the view")
            near = self.way(*self.find_waters(display))
            display.do("key", "Home")
            self.screenshot(display)
            self.assertGreater(near, 1.2 * self.way(*self.find_waters(display)))
            self.quit(display)

    def is_flying(self, display):
        before = self.find_waters(display)
        time.sleep(0.5)
        return self.way(before[0], self.find_waters(display)[0]) > 1

    def test_a_window_that_is_hidden_or_tiny_comes_back(self):
        with Display() as display:
            self.start(display)
            window = display.find_window()[0]
            display.do("windowunmap", window)
            time.sleep(0.5)
            self.assertIsNone(self.program.poll())
            display.do("windowmap", window)
            self.wait_until(display.focus_window, "the window")
            display.do("windowsize", "--sync", window, 320, 240)
            self.wait_until(lambda: size_of_png(self.screenshot(display)) == (320, 240), "that size")
            display.do("key", "F5")
            display.do("windowsize", "--sync", window, 1280, 720)
            self.wait_until(lambda: size_of_png(self.screenshot(display)) == (1280, 720),
                            "that size")
            self.quit(display)

    def test_without_a_font_file_words_remain(self):
        os.environ["PALPA_FONT"] = __file__  # no font
        try:
            with Display() as display:
                self.start(display)
                (width, _), pixels = read_png(self.screenshot(display))
                row = [pixels[4 * (width * y + x)] for y in range(20, 60) for x in range(20, 340)]
                self.assertGreater(sum(value < 100 for value in row), 50)  # dark letters
                self.quit(display)
        finally:
            del os.environ["PALPA_FONT"]

    def test_space_keeps_the_cursor_and_gives_it_back(self):
        with Display() as display:
            self.start(display)
            first = self.find_waters(display)
            display.do("mousemove", 640, 330, "keydown", "space")
            self.screenshot(display)
            for _ in range(60):
                display.do("mousemove_relative", "--", -20, 0)
            self.draw_until_nearer(display, first)
            display.do("keyup", "space")
            self.screenshot(display)
            self.assertEqual(display.cursor(), (640, 330))
            summary = self.quit(display)
        self.assertLess(summary["closest_angstrom"], 6.5)

    def test_what_the_mouse_did_before_space_moves_nothing(self):
        """Both come at once: a program that is stopped sees neither before the other."""
        with Display() as display:
            self.start(display, "--set", "grip=firm")
            display.do("key", "l")
            display.do("mousemove", 400, 700)
            first = self.find_waters(display)
            self.program.send_signal(signal.SIGSTOP)
            display.do("mousemove", 900, 700, "keydown", "space")
            self.program.send_signal(signal.SIGCONT)
            self.screenshot(display)
            display.do("keyup", "space")
            self.screenshot(display)
            for one, other in zip(first, self.find_waters(display)):
                self.assertLess(self.way(one, other), 40)
            self.quit(display)

    def test_text_grows_by_keys_and_stays_so(self):
        chosen = self.folder / "palpa" / "preferences.toml"
        with Display() as display:
            self.start(display)
            display.do("key", "ctrl+equal")
            self.wait_until(lambda: "text_scale = 1.1" in chosen.read_text(), "the choice on disk")
            self.screenshot(display)
            display.do("key", "ctrl+0")
            self.wait_until(lambda: "text_scale = 1.0" in chosen.read_text(), "the choice on disk")
            self.quit(display)

    def test_a_window_grows_with_the_text_that_the_display_asks_for(self):
        for options, size in (([], (2560, 1500)), (["--size", "900x600"], (900, 600))):
            with self.subTest(options=options), Display("2560x1500") as display:
                display.set_dots_per_inch(192)  # twice as large: 2560x1600, but for the screen
                for file in self.folder.glob("*.png"):
                    file.unlink()
                self.start(display, *options)
                self.assertEqual(size_of_png(self.folder / "palpa-0001.png"), size)
                self.quit(display)

    def test_escape_closes_what_is_open_before_it_quits(self):
        with Display() as display:
            self.start(display)
            self.open_tab(display, self.COUPLING)
            self.open_list(display, self.find_list(display))
            display.do("key", "Escape")
            self.screenshot(display)
            display.do("key", "h", "key", "Escape")  # the help
            self.screenshot(display)
            display.do("key", "shift+w")
            display.do("key", "Escape")  # quits nothing
            self.screenshot(display)
            display.do("key", "ctrl+q")  # asks
            self.screenshot(display)
            display.do("key", "Escape")  # stays
            self.screenshot(display)
            self.assertIsNone(self.program.poll())
            self.quit(display, changed=True)

    def test_a_drag_from_a_slider_does_not_turn_the_view(self):
        """Pressed and moved away at once, before a picture could see the mouse on the panel."""
        with Display() as display:
            self.start(display, "--size", "900x600", "--set", "stroke=hold", "--set", "grip=none")
            display.do("key", "p")
            self.screenshot(display)
            before = self.middle_of(self.screenshot(display))
            display.do("mousemove", 700, 410, "mousedown", 1, "mousemove", 450, 250, "mousemove",
                       400, 200)
            self.screenshot(display)
            display.do("mousemove", 500, 300, "mouseup", 1)
            self.screenshot(display)
            display.do("key", "ctrl+z")
            self.assertLess(self.share_that_differs(before, display), 0.02)
            # The same way from the picture turns it.
            display.do("mousemove", 450, 250, "mousedown", 1, "mousemove", 400, 200)
            self.screenshot(display)
            display.do("mouseup", 1)
            self.assertGreater(self.share_that_differs(before, display), 0.04)
            self.quit(display)

    def test_home_and_reset_bring_the_first_view_back(self):
        with Display() as display:
            self.start(display, "--size", "480x320", "--set", "stroke=hold")
            display.do("key", "l")  # no lesson: all of the picture is seen
            self.screenshot(display)
            display.do("key", "Home")
            first = self.wait_for_rest(display)
            for change in (["v"], ["f"], ["v", "v", "f", "a"]):
                for back in ("Home", "r"):
                    with self.subTest(change=change, back=back):
                        for key in change:
                            display.do("key", key)
                        self.wait_for_view(display, lambda view: difference(view, first) > 4)
                        display.do("key", back)
                        # How long a frame takes decides of its effects, so that it is the same only
                        # nearly.
                        self.wait_for_view(display, lambda view: difference(view, first) < 1)
            self.quit(display)

    def wait_for_rest(self, display):
        """The picture once nothing in it moves any more."""
        views = [self.lower_part_of(self.screenshot(display))]
        for _ in range(200):
            views.append(self.lower_part_of(self.screenshot(display)))
            if difference(views[-1], views[-2]) < 0.1:
                return views[-1]
        self.fail("the picture does not come to rest")

    def wait_for_view(self, display, is_so):
        self.wait_until(lambda: is_so(self.lower_part_of(self.screenshot(display))), "a view")

    def lower_part_of(self, picture):
        """The pixels below its notes, as the program's PNG files have them: 8-bit RGBA."""
        (width, height), pixels = read_png(picture)
        return pixels[4 * width * (height * 2 // 5):]

    def middle_of(self, picture):
        """Its pixels between the panels, below the notes and above the lesson."""
        (width, height), pixels = read_png(picture)
        self.assertEqual((width, height), (900, 600))
        return b"".join(pixels[4 * (width * y + 300):4 * (width * y + 600)] for y in range(100, 370))

    def share_that_differs(self, before, display):
        """Of the bytes now, by more than a picture that was drawn smaller meanwhile."""
        after = self.middle_of(self.screenshot(display))
        return sum(abs(a - b) > 60 for a, b in zip(before, after)) / len(before)

    def test_a_device_that_is_gone_is_said_and_not_forgotten(self):
        chosen = self.folder / "palpa" / "preferences.toml"
        chosen.parent.mkdir()
        for text, told in (("device = 'omni'\n", "omni, the device used last, cannot be used now"),
                           ("device = 'omni\n", "preferences.toml:1:")):
            with self.subTest(text=text), Display() as display:
                chosen.write_text(text)
                for file in self.folder.glob("*.png"):
                    file.unlink()
                os.environ["PALPA_OPENHAPTICS"], stub = "/nowhere", os.environ["PALPA_OPENHAPTICS"]
                try:
                    self.start(display)
                finally:
                    os.environ["PALPA_OPENHAPTICS"] = stub
                display.do("key", "ctrl+q")
                out, err = self.program.communicate(timeout=60)
                self.assertEqual(self.program.returncode, 0, err)
                self.assertEqual(json.loads(out)["device"], "mouse and keys")
                self.assertEqual(len(err.strip().splitlines()), 1, err)
                self.assertIn(told, err)
                if told.startswith("omni"):
                    self.assertIn("device = 'omni'\n", chosen.read_text())
                else:  # whoever wrote it can mend it
                    self.assertEqual(chosen.read_text(), text)

    def test_the_force_is_heard_until_it_is_paused(self):
        with Display() as display:
            self.start(display, "--sound")
            display.do("keydown", "Left")
            self.wait_for_tone(0.05)
            self.screenshot(display)
            self.assertGreater(max(self.last_sound()), 0.05)  # it stays
            display.do("key", "p")
            self.wait_until(lambda: not any(self.last_sound()), "silence")
            display.do("key", "p")
            self.wait_until(lambda: any(self.last_sound()), "the tone again")
            display.do("keyup", "Left")
            self.quit(display)
        played = array("f", self.sound.read_bytes())
        self.assertLessEqual(max(map(abs, played)), 0.25)
        self.assertEqual(played[-1], 0)
        self.assertNotIn("sound", (self.folder / "palpa" / "preferences.toml").read_text())

    def test_sound_is_off_until_it_is_chosen_and_then_remembered(self):
        chosen = self.folder / "palpa" / "preferences.toml"
        with Display() as display:
            self.start(display)
            self.assertFalse(self.sound.exists())
            display.do("key", "s")
            self.wait_until(self.sound.exists, "the sound library")
            self.wait_until(chosen.exists, "the choice on disk")
            self.quit(display)
            self.assertIn("sound = true", chosen.read_text())

            for file in (self.sound, *self.folder.glob("*.png")):
                file.unlink()
            self.start(display)
            self.assertTrue(self.sound.exists())
            display.do("key", "s")
            self.wait_until(lambda: "sound = false" in chosen.read_text(), "the choice on disk")
            self.quit(display)

    def test_sound_stays_off_where_there_is_none(self):
        for driver, file in (("none of that name", ""), ("disk", "/nowhere"), ("disk", "/dev/full")):
            with self.subTest(driver=driver, file=file), Display() as display:
                os.environ.update(SDL_AUDIODRIVER=driver, SDL_DISKAUDIOFILE=file)
                for picture in self.folder.glob("*.png"):
                    picture.unlink()
                self.start(display, "--sound")
                display.do("key", "s")
                self.screenshot(display)
                self.quit(display)

    def test_the_emulated_hand_can_play(self):
        with Display() as display:
            # Again and again, for a machine that looks late.
            self.start(display, "--play", "--sound", "--set", "stroke_s=0.5", "--set",
                       "cycles=1000", "--set", "seconds=3000")
            self.wait_for_tone(0.15)  # no attraction of two waters is felt so strongly
            summary = self.quit(display)
        self.assertLess(summary["closest_angstrom"], 2.77)

    def test_a_real_device_holds_the_molecule(self):
        """Behind the library that stands in for its maker's, an emulated one that nobody holds."""
        os.environ["PALPA_STUB"] = "free"
        with Display() as display:
            self.start(display, "--device", "omni", "--set", "stroke_s=0.5")
            self.screenshot(display)
            summary = self.quit(display)
        self.assertEqual(summary["device"], "emulated PHANTOM Omni")
        self.assertGreater(summary["steps"], 0)
        self.assertFalse(summary["stopped"])

    def test_a_signal_closes_the_window_in_order(self):
        with Display() as display:
            self.start(display, "--play")
            self.program.send_signal(signal.SIGTERM)
            out, err = self.program.communicate(timeout=60)
        self.assertEqual(self.program.returncode, 128 + signal.SIGTERM, err)
        self.assertEqual(json.loads(out)["device"], "emulated Omni")

    def test_a_pad_that_is_not_there_leaves_the_mouse_and_is_waited_for(self):
        chosen = self.folder / "palpa" / "preferences.toml"
        chosen.parent.mkdir()
        chosen.write_text("device = 'gamepad'\n")
        with Display() as display:
            self.start(display)
            summary = self.quit(display)
        self.assertEqual(summary["device"], "mouse and keys")
        self.assertIn("device = 'gamepad'\n", chosen.read_text())

    def test_no_display_is_one_line(self):
        clean = {key: value for key, value in os.environ.items()
                 if key not in ("DISPLAY", "WAYLAND_DISPLAY")}
        result = subprocess.run([PROGRAM, "run", ROOT / "scenes" / "water"], env=clean,
                                capture_output=True, text=True)
        self.assertEqual(result.returncode, 2)
        self.assertEqual(len(result.stderr.strip().splitlines()), 1, result.stderr)
        self.assertIn("no display", result.stderr)


if __name__ == "__main__":
    unittest.main()
