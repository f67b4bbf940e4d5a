"""palpa run --serve from outside: a client of IMD written from the protocol alone watches and pulls, others send
what no client should, and the run ends in order."""
import json
import os
import re
import shutil
import signal
import socket
import struct
import subprocess
import tempfile
import threading
import time
import unittest
from pathlib import Path

PROGRAM = os.environ["PALPA_PROGRAM"]
WATER = Path(os.environ["PALPA_ROOT"]) / "scenes" / "water"

(DISCONNECT, ENERGIES, COORDINATES, GO, HANDSHAKE, KILL, FORCES, PAUSE, RATE, ERROR, SESSION, RESUME, TIME, BOX,
 VELOCITIES, ENGINE_FORCES, WAIT) = range(17)
PATIENCE_S = 60  # of a test that hangs
LONG = ("--seconds", 1000)  # a run that the test ends

# A water that moves by itself below two others, of which the hand holds one still.
FREE_WATER = """
title = "A free water"
[force_field]
files = ["tip3p.str"]
[molecules.standing]
structure = "three.crd"
segment = "FIX"
reference_atom = "OH2"
motion = "free"
[molecules.left]
structure = "three.crd"
segment = "LEFT"
reference_atom = "OH2"
motion = "translate"
[molecules.right]
structure = "three.crd"
segment = "RIGH"
reference_atom = "OH2"
[grab]
molecule = "left"
measured_from = "right"
[hand]
stroke = "path"
path = [[0.0, 0.0, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0]]
[statics]
relax_steps = 0
method = "quasi-static"
[run]
period_ms = 2.0
"""
MASSES = [15.9994, 1.008, 1.008]


def read_crd(path):
    rows = [line.split() for line in path.read_text().splitlines() if not line.startswith("*")]
    return [tuple(map(float, row[4:7])) for row in rows[1:]]


def write_crd(path, like, places):
    lines = like.read_text().splitlines()
    first = next(i for i, line in enumerate(lines) if line.rstrip().endswith("EXT")) + 1
    for i, place in enumerate(places):
        line = lines[first + i]
        lines[first + i] = line[:40] + "".join(f"{x:20.10f}" for x in place) + line[100:]
    path.write_text("\n".join(lines) + "\n")


def middle(places):
    total = sum(MASSES)
    return [sum(m * p[k] for m, p in zip(MASSES, places)) / total for k in range(3)]


class Frame:
    def __init__(self):
        self.energies = self.time = self.places = None


class Client:
    def __init__(self, port, says_go=True, host="127.0.0.1"):
        self.socket = socket.create_connection((host, port), PATIENCE_S)
        kind, = struct.unpack(">i", self.receive(4))
        version = self.receive(4)
        assert kind == HANDSHAKE, kind
        self.order = next(o for o in "<>" if 0 < struct.unpack(o + "i", version)[0] < 100)
        self.version, = struct.unpack(self.order + "i", version)
        self.flags = None
        if self.version == 3:
            kind, length = struct.unpack(">ii", self.receive(8))
            assert (kind, length) == (SESSION, 7), (kind, length)
            self.flags = list(self.receive(7))
        if says_go:
            self.command(GO)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.socket.close()

    def receive(self, size):
        got = b""
        while len(got) < size:
            part = self.socket.recv(size - len(got))
            if not part:
                raise EOFError
            got += part
        return got

    def command(self, kind, number=0):
        self.socket.sendall(struct.pack(">ii", kind, number))

    def forces(self, atoms, forces):
        flat = [x for force in forces for x in force]
        return (struct.pack(">ii", FORCES, len(atoms)) + struct.pack(f"{self.order}{len(atoms)}i", *atoms) +
                struct.pack(f"{self.order}{len(flat)}f", *flat))

    def pull(self, atoms, forces):
        self.socket.sendall(self.forces(atoms, forces))

    # Up to the coordinates, which are the last of a frame in both sessions.
    def frame(self):
        frame = Frame()
        while frame.places is None:
            kind, length = struct.unpack(">ii", self.receive(8))
            if kind == ENERGIES:
                frame.energies = struct.unpack(self.order + "i9f", self.receive(40))
            elif kind == TIME:
                frame.time = struct.unpack(self.order + "ddq", self.receive(24))
            elif kind == COORDINATES:
                flat = struct.unpack(f"{self.order}{3 * length}f", self.receive(12 * length))
                frame.places = [flat[3 * i:3 * i + 3] for i in range(length)]
            else:
                raise AssertionError(f"message of type {kind}")
        return frame

    def is_closed(self):
        try:
            while self.socket.recv(1 << 16):
                pass
        except ConnectionError:
            pass
        return True


class Served:
    """A run that serves, until its end."""

    def __init__(self, scene, *arguments, port=0, address="127.0.0.1"):
        self.program = subprocess.Popen(
            [PROGRAM, "run", str(scene), "--headless", "--serve", str(port), *map(str, arguments)],
            stdout=subprocess.PIPE, stderr=subprocess.PIPE, stdin=subprocess.DEVNULL, text=True)
        self.watchdog = threading.Timer(5 * PATIENCE_S, self.program.kill)
        self.watchdog.start()
        line = self.program.stdout.readline()
        found = re.fullmatch(rf"serving on {re.escape(address)}:(\d+)\n", line)
        if not found:
            raise AssertionError(line + self.program.communicate()[1])
        self.port = int(found.group(1))

    def stop(self):
        self.program.send_signal(signal.SIGINT)

    def end(self):
        out, err = self.program.communicate()
        self.watchdog.cancel()
        return self.program.returncode, out, err

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.watchdog.cancel()
        if self.program.poll() is None:
            self.program.kill()
            self.program.communicate()


class Serve(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.tmp = Path(self.folder.name)

    def tearDown(self):
        self.folder.cleanup()

    def scene(self, text=FREE_WATER):
        for name in ("three.crd", "tip3p.str"):
            shutil.copy(WATER / name, self.tmp)
        file = self.tmp / "scene.toml"
        file.write_text(text)
        return file

    def palpa(self, *arguments):
        return subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True, cwd=self.tmp,
                              stdin=subprocess.DEVNULL)

    def end_well(self, run):
        code, out, err = run.end()
        self.assertEqual(code, 0, err)
        return out, err

    def stop_well(self, run):
        run.stop()
        code, out, err = run.end()
        self.assertEqual(code, 128 + signal.SIGINT, err)
        return out, err

    def energy_of(self, places):
        write_crd(self.tmp / "now.crd", WATER / "dimer.crd", places)
        result = self.palpa("energy", "now.crd", "--toppar", WATER / "tip3p.str", "--json")
        self.assertEqual(result.returncode, 0, result.stderr)
        return json.loads(result.stdout)

    # ---- frames

    def test_clients_of_both_versions_see_the_scene(self):
        crd = read_crd(WATER / "dimer.crd")
        for version in (2, 3):
            with self.subTest(version=version), \
                    Served(WATER, "--serve-version", version, "--serve-wait", "--serve-rate", 1, *LONG) as run, \
                    Client(run.port) as client:
                self.assertEqual(client.version, version)
                first = client.frame()
                self.assertEqual(len(first.places), len(crd))
                for place, expected in zip(first.places, crd):
                    for x, y in zip(place, expected):
                        self.assertAlmostEqual(x, y, places=5)
                self.assertEqual(first.energies[0], 0)
                frames = [client.frame() for _ in range(2000)]
                steps = [frame.energies[0] for frame in frames]
                self.assertEqual(steps, sorted(set(steps)))
                last = frames[-1]
                self.assertNotEqual(last.places[3], first.places[3])  # the hand moves it
                unit = 4.184 if version == 3 else 1
                for frame in (first, last):
                    terms = self.energy_of(frame.places)
                    self.assertAlmostEqual(frame.energies[3] / unit, terms["lj"] + terms["coulomb"], places=3)
                    self.assertEqual(frame.energies[2], frame.energies[3])
                if version == 3:
                    self.assertEqual(client.flags, [1, 1, 0, 1, 0, 0, 0])
                    self.assertEqual(first.time[0], 1e9)  # the scene's period of 1 ms
                    self.assertEqual([frame.time[2] for frame in frames], steps)
                    self.assertEqual(last.time[1], last.time[0] * last.time[2])
                else:
                    self.assertIsNone(first.time)
                client.command(DISCONNECT)
                self.assertTrue(client.is_closed())
                _, err = self.stop_well(run)
                self.assertIn("serve: client 1 is watching\n", err)
                self.assertIn("serve: client 1 disconnected normally\n", err)

    def test_a_run_that_is_watched_gives_the_bytes_of_one_that_is_not(self):
        arguments = [WATER, "--seconds", 0.5, "--record"]
        result = self.palpa("run", *arguments, "alone", "--headless")
        self.assertEqual(result.returncode, 0, result.stderr)
        with Served(*arguments, self.tmp / "watched", "--serve-wait", "--serve-fast", "--serve-rate", 1) as run, \
                Client(run.port) as client:
            for _ in range(20):
                client.frame()
            self.end_well(run)
        alone, watched = ((self.tmp / name / "trace.csv").read_bytes() for name in ("alone", "watched"))
        self.assertGreater(len(alone), 10000)
        self.assertEqual(alone, watched)
        self.assertNotIn("client_pulls", json.loads((self.tmp / "watched" / "summary.json").read_text()))
        result = self.palpa("replay", "watched", "--verify")
        self.assertEqual(result.returncode, 0, result.stderr)

    def test_a_client_of_version_2_pauses_and_resumes(self):
        with Served(WATER, "--serve-wait", "--serve-rate", 1, *LONG) as run, Client(run.port) as client:
            before = client.frame().energies[0]
            client.command(PAUSE)
            with self.assertRaises(TimeoutError):
                client.socket.settimeout(0.5)
                while True:
                    before = client.frame().energies[0]
            client.socket.settimeout(PATIENCE_S)
            client.command(PAUSE)
            self.assertEqual(client.frame().energies[0], before + 1)
            self.stop_well(run)

    # ---- forces

    def test_one_client_pulls_and_the_other_watches(self):
        crd = read_crd(WATER / "three.crd")
        with Served(self.scene(), "--serve-rate", 1, "--serve-wait", *LONG, "--record",
                    self.tmp / "pulled") as run, Client(run.port) as puller:
            first = puller.frame().places
            for place, expected in zip(first, crd):
                for x, y in zip(place, expected):
                    self.assertAlmostEqual(x, y, places=5)
            share = [m / sum(MASSES) for m in MASSES]
            puller.pull([0, 1, 2], [(0, -4 * s, 3 * s) for s in share])
            with Client(run.port) as watcher:
                watcher.frame()
                watcher.pull([0], [(200, 0, 0)])
                watcher.frame()
                self.assertEqual(len(watcher.frame().places), 9)
                last = first
                for _ in range(600):
                    last = puller.frame().places
            way = [b - a for a, b in zip(middle(first[:3]), middle(last[:3]))]
            along = (-4 * way[1] + 3 * way[2]) / 5
            self.assertGreater(along, 1)
            across = [way[0], way[1] + 0.8 * along, way[2] - 0.6 * along]
            self.assertLess(max(map(abs, across)), 0.2 * along)
            self.assertEqual(last[3:], first[3:])  # what a hand holds, and what is fixed
            # A force on what is fixed does nothing, which is said; one beyond the bound is cut.
            puller.pull([0, 6], [(0, 900, 0), (1, 0, 0)])
            for _ in range(10):
                last = puller.frame().places
            self.assertEqual(last[6:], first[6:])
            _, err = self.stop_well(run)
        self.assertIn("serve: client 1 is pulling\n", err)
        self.assertIn("serve: client 2 may not pull: client 1 is pulling\n", err)
        self.assertEqual(err.count("the limit for one atom is 10 nN"), 1)
        self.assertEqual(err.count("forces on 1 of 2 atoms have no effect"), 1)
        # Its forces are in no file, so it cannot be played again, and says so.
        summary = json.loads((self.tmp / "pulled" / "summary.json").read_text())
        self.assertGreater(summary["client_pulls"], 600)
        for arguments in ([], ["--verify"]):
            result = self.palpa("replay", "pulled", *arguments)
            self.assertEqual(result.returncode, 2, result.stdout + result.stderr)
            self.assertIn("clients pulled in this run", result.stderr)

    def test_what_a_client_pulled_is_let_go_when_it_leaves(self):
        with Served(self.scene(), "--serve-rate", 1, "--serve-wait", *LONG) as run, \
                Client(run.port) as watcher:
            with Client(run.port) as puller:
                puller.frame()
                puller.pull([0], [(0, -20, 0)])
                for _ in range(200):
                    puller.frame()
            places = [watcher.frame().places[:3] for _ in range(900)]
            heights = [middle(place)[1] for place in places]
            # Away from the others while it was pulled, then back towards them.
            self.assertLess(min(heights), heights[0] - 1)
            self.assertGreater(heights[-1], heights[-50])
            self.stop_well(run)

    # ---- what no client should do

    def join_in_time(self, run, says_go=True):
        """Those that have just left take places until the next step, and whoever comes then is turned away."""
        until = time.monotonic() + PATIENCE_S
        while True:
            try:
                return Client(run.port, says_go=says_go)
            except (EOFError, ConnectionError):
                if time.monotonic() > until:
                    raise
                time.sleep(0.02)

    def test_hostile_clients_are_dropped_and_the_run_ends_in_order(self):
        def answer(sent, says_go=True):
            client = Client(run.port, says_go=says_go)
            with client:
                client.socket.sendall(sent(client) if callable(sent) else sent)
                self.assertTrue(client.is_closed())

        def header(kind, length):
            return struct.pack(">iI", kind, length)

        with Served(self.scene(), *LONG, "--serve-wait", "--serve-rate", 1) as run, \
                Client(run.port) as watcher:
            watcher.frame()
            nan, endless = float("nan"), float("inf")
            answer(header(FORCES, 1 << 31))
            answer(header(FORCES, (1 << 31) - 1))
            answer(header(FORCES, 10))
            answer(header(99, 0))
            answer(header(COORDINATES, 9))
            answer(b"GET / HTTP/1.1\r\n\r\n", says_go=False)
            for force in ((nan, 0, 0), (0, endless, 0), (0, 0, 3e38)):
                answer(lambda client, force=force: client.forces([0], [force]))
            for atoms in ([9], [-1], [1 << 30], [0, 0]):
                answer(lambda client, atoms=atoms: client.forces(atoms, [(1, 0, 0)] * len(atoms)))
            # A stream that is in order, cut anywhere.
            with self.join_in_time(run) as whole:
                stream = header(RATE, 3) + whole.forces([0, 2], [(1, 0, 0), (0, 1, 0)]) + header(DISCONNECT, 0)
            for size in range(0, len(stream), 3):
                with self.join_in_time(run) as client:
                    client.socket.sendall(stream[:size])
            with self.join_in_time(run, says_go=False):
                pass
            for _ in range(100):
                for place in watcher.frame().places:
                    self.assertTrue(all(abs(x) < 100 for x in place))
            _, err = self.stop_well(run)
        self.assertIn("was dropped: ", err)
        self.assertIn("came, expected", err)

    def test_clients_that_never_read_do_not_hold_the_run_up(self):
        with Served(WATER, "--serve-rate", 1, "--serve-wait", "--seconds", 2) as run:
            clients = [Client(run.port) for _ in range(3)]
            self.end_well(run)
            for client in clients:
                client.socket.close()

    # ---- addresses

    def test_only_this_machine_is_served_unless_an_address_is_given(self):
        other = "127.0.0.2"  # another address of this machine
        with Served(WATER, *LONG) as run:
            with self.assertRaises(ConnectionRefusedError):
                socket.create_connection((other, run.port), PATIENCE_S)
            for address in own_addresses():
                with self.subTest(address=address), self.assertRaises(OSError):
                    socket.create_connection((address, run.port), PATIENCE_S)
            _, err = self.stop_well(run)
            self.assertNotIn("password", err)
        with Served(WATER, *LONG, "--listen", other, "--serve-wait", address=other) as run, \
                Client(run.port, host=other) as client:
            self.assertEqual(len(client.frame().places), 6)
            self.stop_well(run)
        with Served(WATER, "--seconds", 0.1, "--listen", "0.0.0.0", address="0.0.0.0") as run:
            self.assertIn("there is no password", self.end_well(run)[1])

    def test_what_cannot_be_listened_at_is_bad_input(self):
        with Served(WATER, *LONG) as run:
            for arguments, said in ((("--serve", run.port), "cannot listen at"),
                                    (("--serve", 0, "--listen", "my.host"), "is not a numeric address"),
                                    (("--serve", 70000), "--serve"),
                                    (("--serve-wait",), "--serve"),
                                    (("--serve", 0, "--serve-version", 4), "--serve-version")):
                with self.subTest(arguments=arguments):
                    result = self.palpa("run", WATER, "--headless", "--seconds", 1, *arguments)
                    self.assertEqual(result.returncode, 2, result.stderr)
                    self.assertIn(said, result.stderr)
            self.stop_well(run)

    # ---- edits

    def test_another_number_of_atoms_ends_what_clients_knew(self):
        scene = self.scene(FREE_WATER + """
[[edits]]
at_s = 0.3
add = { residue = "TIP3", name = "fourth", at_angstrom = [0.0, 0.0, 40.0] }
""")
        with Served(scene, "--serve-rate", 1, "--serve-wait", *LONG) as run:
            with Client(run.port) as client:
                with self.assertRaises(EOFError):
                    while True:
                        self.assertEqual(len(client.frame().places), 9)
            with Client(run.port) as client:
                self.assertEqual(len(client.frame().places), 12)
            _, err = self.stop_well(run)
        self.assertIn("client 1 was dropped: the number of atoms is now 12, no longer 9", err)


def own_addresses():
    """Of this machine on its networks, as far as it has any."""
    try:
        found = socket.getaddrinfo(socket.gethostname(), None, socket.AF_INET)
    except OSError:
        return []
    return sorted({entry[4][0] for entry in found if not entry[4][0].startswith("127.")})


if __name__ == "__main__":
    unittest.main()
