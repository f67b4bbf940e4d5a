"""A scene of four hands, run as a person runs it: each hand with its device, grip and coupling, each with its columns."""
import csv
import json
import math
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

PROGRAM = os.environ["PALPA_PROGRAM"]
SCENE = Path(os.environ["PALPA_ROOT"]) / "tests" / "data" / "four_hands" / "scene.toml"
A_F, A_D = [1e9, 2e9, 1e9, 0.5e9], [0.05e9, 0.025e9, 0.05e9, 0.025e9]
START = [(9, 0, 0), (-9, 0, 0), (0, 9, 0), (0, -9, 0)]


def palpa(*arguments):
    return subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True, stdin=subprocess.DEVNULL)


def vector(row, name, hand):
    suffix = "" if hand == 0 else f"_{hand + 1}"
    column, unit = name.rsplit("_", 1)
    return [float(row[f"{column}_{axis}_{unit}{suffix}"]) for axis in "xyz"]


class FourHands(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.temporary.cleanup)
        cls.folder = Path(cls.temporary.name) / "recording"
        result = palpa("run", SCENE, "--headless", "--record", cls.folder)
        if result.returncode != 0:
            raise AssertionError(result.stderr)
        cls.output = result.stdout
        with open(cls.folder / "trace.csv") as file:
            cls.rows = list(csv.DictReader(file))
        cls.summary = json.loads((cls.folder / "summary.json").read_text())

    def test_each_hand_leads_its_own_water_by_its_own_gain(self):
        for hand in range(4):
            for row in self.rows[::100]:
                handle = vector(row, "handle_m", hand)
                place = vector(row, "molecule_angstrom", hand)
                for axis in range(3):
                    led = START[hand][axis] + 1e10 * handle[axis] / A_D[hand]
                    # The molecule follows within a step of 1 ms.
                    self.assertAlmostEqual(place[axis], led, delta=0.05, msg=f"hand {hand + 1} at {row['time_s']} s")
            end = vector(self.rows[-1], "molecule_angstrom", hand)
            self.assertLess(math.dist(end, (0, 0, 0)), 9 - 1.5)

    def test_each_hand_feels_the_force_on_its_water_times_its_gain(self):
        for hand in range(4):
            row = self.rows[-1]  # at rest: delays do not matter
            molecule = vector(row, "force_nN", hand)
            felt = vector(row, "device_force_N", hand)
            self.assertGreater(math.hypot(*molecule), 1e-3)
            for axis in range(3):
                self.assertAlmostEqual(felt[axis], A_F[hand] * 1e-9 * molecule[axis], delta=1e-4)

    def test_reports_are_per_hand(self):
        others = [self.summary] + [self.summary[f"hand_{hand}"] for hand in (2, 3, 4)]
        for hand, report in enumerate(others):
            self.assertEqual(report["coupling"]["A_f"], A_F[hand])
            self.assertEqual(report["mode"], "4")
            largest = max(math.hypot(*vector(row, "device_force_N", hand)) for row in self.rows)
            self.assertAlmostEqual(report["largest_felt_N"], largest, delta=1e-9)
        self.assertEqual([report["hand"] for report in others], ["medium", "medium", "medium", "firm"])
        self.assertNotIn("hand_5", self.summary)

    def test_the_recording_is_found_again_and_the_scene_is_written_with_four_tables(self):
        result = palpa("replay", self.folder, "--verify")
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        session = (self.folder / "session.toml").read_text()
        self.assertEqual(session.count("\n[[hand]]\n"), 4)
        self.assertEqual(session.count("\n[hand.grab]\n"), 4)
        self.assertEqual(session.count("\n[hand.coupling]\n"), 2)
        self.assertEqual(session.count("\n[hand.device]\n"), 2)

    def test_a_hand_alone_is_changed_by_its_number(self):
        folder = Path(self.temporary.name) / "changed"
        result = palpa("run", SCENE, "--headless", "--seconds", "1.5", "--record", folder, "--set", "hand[3].path=[[0.2,0],[0.3,0]]",
                       "--set", "hand.release_s=0.1")
        self.assertEqual(result.returncode, 0, result.stderr)
        with open(folder / "trace.csv") as file:
            last = list(csv.DictReader(file))[-1]
        self.assertAlmostEqual(vector(last, "molecule_angstrom", 2)[1], 9, delta=0.1)
        self.assertGreater(vector(last, "molecule_angstrom", 3)[1], -7.5)

    def test_two_hands_never_hold_a_molecule_as_a_whole(self):
        # A third that holds an atom of it does not hide the second.
        commands = 'take = "west:1 OH2", hand = "third"\ntake = "west", hand = "first"\nread\n'
        result = subprocess.run([PROGRAM, "run", str(SCENE), "--headless", "--commands"], input=commands,
                                capture_output=True, text=True)
        self.assertGreaterEqual(result.returncode, 0, result.stderr)
        answers = [json.loads(line) for line in result.stdout.splitlines()]
        self.assertEqual([answer["ok"] for answer in answers][:3], [True, False, True])
        self.assertIn("another hand holds 'west' as a whole", answers[1]["error"])

    def test_help_knows_the_keys_of_every_hand(self):
        self.assertEqual(palpa("help", "hand[2].grab.atom").stdout, palpa("help", "grab.atom").stdout)
        self.assertTrue(palpa("help", "hand[3].stroke").stdout.startswith("hand.stroke\n"))
        self.assertTrue(palpa("help", "hand").stdout.startswith("hand[N].KEY\n"))
        for asked, listed in (("hand[2].grab", "grab"), ("hand.coupling.mode", "coupling.mode"), ("hand[2]", "hand"),
                              ("second.grab.atom", "grab.atom"), ("second.hand.grip", "hand.grip")):
            self.assertEqual(palpa("help", asked).stdout, palpa("help", listed).stdout, asked)
            self.assertTrue(palpa("help", asked).stdout, asked)
        self.assertEqual(palpa("help", "hand[5].grip").returncode, 2)

    def test_the_text_summary_has_a_block_for_each_hand(self):
        self.assertIn("hand 1: mode 4, medium hand", self.output)
        for hand, grip in ((2, "medium"), (3, "medium"), (4, "firm")):
            block = self.output.split(f"  hand {hand}      mode 4, {grip} hand, friction ")[1].split("  hand ")[0]
            self.assertIn(f"felt        at most {self.summary[f'hand_{hand}']['largest_felt_N']:.3f} N", block)

    def test_a_hand_grabs_with_its_own_spring(self):
        stiffness = []
        for k in (10, 20):
            folder = Path(self.temporary.name) / f"spring-{k}"
            result = subprocess.run([PROGRAM, "run", str(SCENE), "--headless", "--commands", "--record", str(folder), "--set",
                                     f"hand[3].grab.spring_kcal_per_mol_angstrom2={k}"],
                                    input='take = "west:1 OH2", hand = "third"\nstep 5\n', capture_output=True, text=True)
            self.assertEqual(result.returncode, 0, result.stderr)
            with open(folder / "trace.csv") as file:
                stiffness.append(float(list(csv.DictReader(file))[-1]["stiffness_N_per_m_3"]))
        self.assertAlmostEqual(stiffness[1] / stiffness[0], 2, delta=0.01)

    def test_what_is_wrong_names_the_hand(self):
        for setting, message in [("hand[4].stroke=in", "'hand[4].stroke' is the text \"in\""),
                                 ("hand[3].grab.molecule=north", "'hand[3].grab.molecule' is \"north\", which is not a molecule"),
                                 ("hand[5].grip=firm", "the scene has no hand[5]; expected hand[1] to hand[4]")]:
            result = palpa("run", SCENE, "--headless", "--set", setting)
            self.assertEqual(result.returncode, 2, setting)
            self.assertIn(message, result.stderr)


if __name__ == "__main__":
    unittest.main()
