"""palpa connect from outside: an engine written of the wire facts alone is watched, pulled, and misbehaves."""
import csv
import json
import os
import socket
import struct
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
from engine_peer import COORDINATES, Engine, write_gro  # noqa: E402

PROGRAM = os.environ["PALPA_PROGRAM"]
NM_OF_KCAL = 6.9477e-2  # nN of 1 kcal/mol/A
# A molecule of three atoms, and two waters.
NAMES = [(1, "LIG", "C1"), (1, "LIG", "C2"), (1, "LIG", "O3"), (2, "SOL", "OW"), (2, "SOL", "HW1"), (2, "SOL", "HW2"),
         (3, "SOL", "OW"), (3, "SOL", "HW1"), (3, "SOL", "HW2")]
PLACES = [(10, 10, 10), (11.5, 10, 10), (12.5, 11, 10), (20, 20, 20), (20.9, 20, 20), (19.8, 20.9, 20), (25, 20, 20),
          (25.9, 20, 20), (24.8, 20.9, 20)]
MASSES = [12.011, 12.011, 15.999] + 2 * [15.999, 1.008, 1.008]


class Connected(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.topology = self.folder / "run.gro"
        write_gro(self.topology, PLACES, NAMES)

    def start(self, **arguments):
        engine = Engine(PLACES, masses=MASSES, **arguments)
        engine.start()
        self.addCleanup(engine.stop)
        return engine

    def connect(self, engine, *arguments, topology=None):
        command = [PROGRAM, "connect", f"127.0.0.1:{engine if isinstance(engine, int) else engine.port}", "--topology",
                   topology or self.topology, "--headless", *arguments]
        return subprocess.run([str(word) for word in command], capture_output=True, text=True,
                              stdin=subprocess.DEVNULL, timeout=120)

    def lead(self, engine, *arguments):
        return self.record(engine, "--lead", "3,0,0", *arguments)

    def record(self, engine, *arguments):
        record = self.folder / "record"
        result = self.connect(engine, "--seconds", 4, "--hold", "M1", "--record", record, "--overwrite", "--json",
                              *arguments)
        self.assertEqual(result.returncode, 0, result.stderr)
        with open(record / "trace.csv", newline="", encoding="utf-8") as file:
            rows = [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]
        return json.loads(result.stdout), rows

    def check_led(self, engine, rows):
        """The molecule went along x with the hand, and nothing else did."""
        places, pulls = engine.history[-1]
        for atom in range(3):
            self.assertAlmostEqual(places[atom][0] - PLACES[atom][0], 3, delta=0.2)
            self.assertAlmostEqual(places[atom][1], PLACES[atom][1], delta=0.05)
        self.assertEqual(places[3:], [list(place) for place in PLACES[3:]])
        # By their masses, and the opposite of what the hand feels, which is some ticks ahead.
        pulled = [pulls for _, pulls in engine.history if pulls]
        self.assertEqual(set(pulled[-1]), {0, 1, 2})
        for atom in range(3):
            share = MASSES[atom] / sum(MASSES[:3])
            self.assertAlmostEqual(pulled[-1][atom][0], share * sum(f[0] for f in pulled[-1].values()), delta=1e-4)
        self.assertGreater(max(sum(f[0] for f in p.values()) for p in pulled), 0.5)
        felt = [row["force_x_nN"] for row in rows]
        strongest = min(felt)
        self.assertLess(strongest, 0)
        most_sent = max(sum(f[0] for f in p.values()) for p in pulled)
        self.assertAlmostEqual(-strongest, NM_OF_KCAL * most_sent, delta=0.15 * abs(strongest))

    def test_a_molecule_is_led(self):
        for order in (">", "<"):
            with self.subTest(order=order):
                engine = self.start(order=order)
                summary, rows = self.lead(engine)
                self.check_led(engine, rows)
                self.assertGreater(summary["engine"]["frames"], 200)
                self.assertEqual(summary["engine"]["interruptions"], 0)
                engine.stop()

    def test_version_3_is_pulled_where_it_is_asked_for(self):
        engine = self.start(version=3)
        _, rows = self.lead(engine, "--protocol", "3")
        self.check_led(engine, rows)

    def test_version_3_is_watched_otherwise(self):
        engine = self.start(version=3)
        summary, _ = self.lead(engine)
        self.assertFalse(any(pulls for _, pulls in engine.history))
        self.assertGreater(summary["engine"]["frames"], 200)

    def test_another_version_than_asked_for_is_refused(self):
        engine = self.start(version=2)
        result = self.connect(engine, "--seconds", 1, "--protocol", "3", "--wait", 2)
        self.assertEqual(result.returncode, 4)
        # What came first, and neither what follows nor advice to start what is there.
        self.assertIn("uses IMD version 2, expected 3; leave --protocol out", result.stderr)
        self.assertNotIn("start it first", result.stderr)

    def test_another_number_of_atoms_is_refused_with_both(self):
        engine = Engine(PLACES[:6], masses=MASSES[:6])
        engine.start()
        self.addCleanup(engine.stop)
        result = self.connect(engine, "--seconds", 1, "--wait", 2)
        self.assertEqual(result.returncode, 4)
        self.assertIn("run.gro lists 9 atoms, the engine sends 6: give the structure", result.stderr)
        self.assertNotIn("start it first", result.stderr)

    def test_one_that_is_held_by_another_client(self):
        with socket.create_server(("127.0.0.1", 0)) as busy:
            result = self.connect(busy.getsockname()[1], "--seconds", 1, "--wait", 1)
        self.assertEqual(result.returncode, 4)
        self.assertIn("has not sent its handshake; another client may be connected", result.stderr)

    def test_bad_arguments_are_named(self):
        cases = ((("--lead", "nan,0,0"), "--lead"), (("--record", self.topology / "r"), "is not a folder"))
        for arguments, expected in cases:
            result = self.connect(1, *arguments)
            self.assertEqual(result.returncode, 2, result.stderr)
            self.assertIn(expected, result.stderr)
        for address in ("127.0.0.1:99999", "999.0.0.1:8888", "127.0.0.1", "1.2.3.4.5:8888"):
            result = subprocess.run([PROGRAM, "connect", address, "--topology", self.topology, "--headless"],
                                    capture_output=True, text=True, stdin=subprocess.DEVNULL, timeout=60)
            self.assertEqual(result.returncode, 2, result.stderr)
            self.assertIn("is not the address of an engine", result.stderr)
        wrong = self.folder / "run.txt"
        wrong.write_text("")
        for topology in (wrong, self.folder):
            result = self.connect(1, topology=topology)
            self.assertEqual(result.returncode, 2)
            self.assertIn("expected a .psf", result.stderr)

    def test_its_recording_cannot_be_played_again(self):
        summary, _ = self.record(self.start())
        self.assertNotIn("closest_angstrom", summary)
        self.assertNotIn("run it again", (self.folder / "record" / "session.toml").read_text())
        result = subprocess.run([PROGRAM, "replay", self.folder / "record"], capture_output=True, text=True, timeout=60)
        self.assertEqual(result.returncode, 2)
        self.assertIn("the recording does not have its frames", result.stderr)

    def test_an_atom_is_held_by_number_and_by_name(self):
        for hold in ("5", "HW1 2", "2 HW1", "WAT HW1 2"):
            with self.subTest(hold=hold):
                engine = self.start()
                result = self.connect(engine, "--seconds", 1, "--hold", hold, "--lead", "1,0,0")
                self.assertEqual(result.returncode, 0, result.stderr)
                self.assertEqual({atom for _, pulls in engine.history for atom in pulls}, {4})
                engine.stop()
        for hold, why in (("99", "is not one of 9 atoms"), ("XX 2", "names 0 atoms"), ("what is that", "names 0 atoms")):
            with self.subTest(hold=hold):
                result = self.connect(1, "--hold", hold)
                self.assertEqual(result.returncode, 2)
                self.assertIn(why, result.stderr)

    def test_forces_end_with_the_run(self):
        engine = self.start()
        self.lead(engine)
        deadline = time.monotonic() + 5
        while engine.problem is None and time.monotonic() < deadline:
            time.sleep(0.05)
        # Zeros for what was held, before the client leaves.
        _, pulls = engine.history[-1]
        self.assertTrue(all(force == [0, 0, 0] for force in engine.pulls.values()), engine.pulls)

    def test_nobody_answers(self):
        engine = self.start()
        port = engine.port
        engine.stop()
        result = self.connect(port, "--seconds", 1, "--wait", 1)
        self.assertEqual(result.returncode, 4)
        self.assertIn(f"127.0.0.1:{port}", result.stderr)
        self.assertIn("start it first, or wait longer (--wait)", result.stderr)

    def test_an_engine_that_ends_is_lost(self):
        engine = self.start(frames=50)
        engine.script = lambda peer, number: peer.sessions == 1
        result = self.connect(engine, "--seconds", 100)
        self.assertEqual(result.returncode, 4)
        self.assertIn("expected an engine that listens there", result.stderr)

    def test_no_force_while_it_is_late_and_it_comes_back(self):
        def stall(peer, number):
            if number == 100:
                time.sleep(2.5)

        engine = self.start(script=stall)
        summary, rows = self.lead(engine)
        self.assertEqual(summary["engine"]["interruptions"], 1)
        self.assertTrue(any(row["force_x_nN"] == 0 for row in rows[100:-100]))
        self.assertNotEqual(rows[-1]["force_x_nN"], 0)

    def test_it_comes_back_after_it_was_lost(self):
        engine = self.start(script=lambda peer, number: peer.sessions > 1 or number < 100)
        summary, _ = self.lead(engine)
        self.assertGreaterEqual(engine.sessions, 2)
        self.assertEqual(summary["engine"]["interruptions"], 1)

    def test_nonsense_is_refused(self):
        nan = struct.pack(">27f", *[float("nan")] * 27)
        far = struct.pack(">27f", *[1e30] * 27)
        cases = {"others": struct.pack(">ii", COORDINATES, 8) + bytes(96),
                 "many": struct.pack(">ii", COORDINATES, 2**31 - 1), "nan": struct.pack(">ii", COORDINATES, 9) + nan,
                 "far": struct.pack(">ii", COORDINATES, 9) + far, "unknown": struct.pack(">ii", 77, 1) + bytes(64)}
        for name, data in cases.items():
            with self.subTest(name=name):
                def script(peer, _number, data=data):
                    peer.raw(data)
                    time.sleep(0.2)
                    return False

                engine = self.start(script=script)
                result = self.connect(engine, "--seconds", 1, "--wait", 1)
                self.assertEqual(result.returncode, 4, result.stderr)
                self.assertIn("expected", result.stderr)
                engine.stop()

    def test_what_jumps_is_held_anew(self):
        def jump(peer, number):
            if number == 150:
                for place in peer.places[:3]:
                    place[1] += 18

        engine = self.start(script=jump)
        _, rows = self.record(engine)
        self.assertLess(max(abs(row["force_y_nN"]) for row in rows), 0.1)
        self.assertAlmostEqual(rows[-1]["molecule_y_angstrom"] - rows[0]["molecule_y_angstrom"], 18, delta=0.5)

    def test_the_scene_that_it_writes_runs(self):
        scene = self.folder / "scene.toml"
        engine = self.start()
        result = self.connect(engine, "--seconds", 1, "--write-scene", scene)
        self.assertEqual(result.returncode, 0, result.stderr)
        result = subprocess.run([PROGRAM, "run", scene, "--headless", "--json"], capture_output=True, text=True,
                                stdin=subprocess.DEVNULL, timeout=60)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertGreater(json.loads(result.stdout)["engine"]["frames"], 50)

    def test_which_atoms_are_which(self):
        # A scene of the first water alone, of an engine that has all; and of one that sends it alone.
        water = self.folder / "water.gro"
        write_gro(water, PLACES[3:6], NAMES[3:6])
        index = self.folder / "sent.ndx"
        index.write_text("[ water ]\n1 2 3\n")
        for atoms, places, held in ((self.topology, PLACES, {3, 4, 5}), (index, PLACES[3:6], {0, 1, 2})):
            with self.subTest(atoms=atoms.name):
                engine = Engine(places)
                engine.start()
                self.addCleanup(engine.stop)
                result = self.connect(engine, "--seconds", 1, "--hold", "WAT", "--lead", "1,0,0", "--set",
                                      f"engine.atoms={atoms}", topology=water)
                self.assertEqual(result.returncode, 0, result.stderr)
                self.assertEqual({atom for _, pulls in engine.history for atom in pulls}, held)
        result = self.connect(1, "--hold", "M1", "--set", f"engine.atoms={water}")
        self.assertEqual(result.returncode, 2)
        self.assertIn("expected exactly one, to match", result.stderr)


if __name__ == "__main__":
    unittest.main()
