"""palpa run --trajectory: frames of other programs, and what a hand feels in them."""
import json
import struct
import unittest

from trajectory_test import WATER, Trajectories, read_dcd


def write_dcd(path, frames):
    """X-PLOR's form, without a cell."""
    def record(content):
        return struct.pack("<i", len(content)) + content + struct.pack("<i", len(content))
    text = record(struct.pack("<4s9if10i", b"CORD", len(frames), 0, 1, *[0] * 6, 0.0, *[0] * 10))
    text += record(struct.pack("<i80s", 1, b"made by a test".ljust(80)))
    text += record(struct.pack("<i", len(frames[0])))
    for frame in frames:
        for axis in zip(*frame):
            text += record(struct.pack(f"<{len(axis)}f", *axis))
    path.write_bytes(text)


def crd_rows(path):
    lines = [line for line in path.read_text().splitlines() if not line.startswith("*")]
    return [line.split() for line in lines[1:]]


class Played(Trajectories):
    def positions(self):
        return [tuple(map(float, row[4:7])) for row in crd_rows(WATER / "dimer.crd")]

    def write(self, shifts):
        """A trajectory in which the second water stands farther out by so much, frame by frame."""
        start = self.positions()
        path = self.tmp / "others.dcd"
        write_dcd(path, [[(x + (shift if i >= 3 else 0), y, z) for i, (x, y, z) in enumerate(start)]
                         for shift in shifts])
        return path

    def play(self, path, *arguments):
        folder = self.tmp / f"r{len(list(self.tmp.iterdir()))}"
        self.run_water("--trajectory", path, "--record", folder, "--hand", "none",
                       "--set", "hand.stroke=hold", "--mode", "5", *arguments)
        rows = (folder / "trace.csv").read_text().splitlines()
        return folder, [dict(zip(rows[0].split(","), map(float, row.split(",")))) for row in rows[1:]]

    def test_frames_come_one_after_the_other_and_the_last_one_stays(self):
        path = self.write([0, 0.5, 1.0, 1.5])
        folder, _ = self.play(path, "--seconds", "1", "--trajectory-speed", "5", "--trajectory-fps", "10")
        frames = read_dcd(folder / "trajectory.dcd")[2]
        gone = [frame[3][0] - frames[0][3][0] for frame in frames]
        for k, far in enumerate(gone):
            # A frame is put in by the step that follows the moment when it is due.
            expected = {0.5 * min(max(k - back, 0) // 2, 3) for back in (0, 1)}
            self.assertTrue(any(abs(far - each) < 0.02 for each in expected), (k, gone))
        self.assertAlmostEqual(gone[-1], 1.5, delta=0.02)

    def test_a_hand_feels_the_force_of_the_frozen_frame(self):
        path = self.write([0, 1.0])
        for frame, shift in ((1, 0.0), (2, 1.0)):
            _, rows = self.play(path, "--seconds", "0.2", "--trajectory-speed", "0", "--trajectory-frame",
                                frame)
            expected = self.force_at(self.positions(), shift)
            self.assertAlmostEqual(rows[-1]["force_x_nN"], expected, delta=1e-3 * abs(expected))

    def force_at(self, start, shift):
        """On the second water along x, nN, by TIP3P's own numbers (CHARMM's, with Lennard-Jones on
        hydrogen)."""
        charge = [-0.834, 0.417, 0.417]
        epsilon, half = [0.1521, 0.046, 0.046], [1.7682, 0.2245, 0.2245]
        force = 0.0
        for i in range(3):
            for j in range(3):
                a = start[i]
                b = (start[3 + j][0] + shift, *start[3 + j][1:])
                d = [b[k] - a[k] for k in range(3)]
                r = sum(x * x for x in d) ** 0.5
                well = (epsilon[i] * epsilon[j]) ** 0.5
                s6 = ((half[i] + half[j]) / r) ** 6
                pull = 332.0716 * charge[i] * charge[j] / r ** 2 + 12 * well * (s6 * s6 - s6) / r
                force += pull * d[0] / r
        return force * 0.0694770  # nN per kcal/mol/angstrom

    def test_another_number_of_atoms_is_refused(self):
        path = self.tmp / "short.dcd"
        write_dcd(path, [[(0.0, 0.0, 0.0)] * 5])
        self.refused("5 atoms", WATER, "--headless", "--trajectory", path)

    def test_a_frame_that_is_not_there_is_refused(self):
        path = self.write([0, 1])
        self.refused("frame 9", WATER, "--headless", "--trajectory", path, "--trajectory-frame", 9)

    def check_warned(self, folder, *expected):
        warnings = " ".join(json.loads((folder / "summary.json").read_text())["warnings"])
        for words in expected:
            self.assertIn(words, warnings)

    def test_a_damaged_frame_is_warned_of_and_the_one_before_it_stays(self):
        path = self.write([0, 0.5, float("nan"), 1.5])
        folder, rows = self.play(path, "--seconds", "1", "--trajectory-speed", "10")
        self.check_warned(folder, "stopped at frame 2 of 4", "frame 3", "coordinate")
        self.assertAlmostEqual(rows[-1]["molecule_x_angstrom"] - rows[0]["molecule_x_angstrom"], 0.5, delta=0.02)
        self.refused("coordinate", WATER, "--headless", "--trajectory", path, "--trajectory-frame", 3)

    def test_a_file_that_was_cut_off_is_warned_of(self):
        path = self.write([0, 0.5, 1.0, 1.5])
        path.write_bytes(path.read_bytes()[:-50])
        folder, _ = self.play(path, "--seconds", "0.3")
        self.check_warned(folder, "has 3 complete frames", "within frame 4", "cut off")

    def test_a_recording_of_it_cannot_be_played_again(self):
        folder, _ = self.play(self.write([0, 1]), "--seconds", "0.2")
        self.assertNotIn("run it again", (folder / "session.toml").read_text())
        result = self.palpa("replay", folder, "--verify")
        self.assertEqual(result.returncode, 2)
        self.assertIn("does not have its frames", result.stderr)

    def test_models_of_a_pdb_file_are_frames(self):
        first, second = self.tmp / "1.pdb", self.tmp / "2.pdb"
        for path, time in ((first, 0), (second, 2)):
            result = self.palpa("export", WATER, "-o", path, "--time", time)
            self.assertEqual(result.returncode, 0, result.stderr)
        atoms = [[line for line in path.read_text().splitlines() if line.startswith(("ATOM", "TER"))]
                 for path in (first, second)]
        models = self.tmp / "models.pdb"
        models.write_text("".join(f"MODEL     {i + 1:4}\n" + "\n".join(lines) + "\nENDMDL\n"
                                  for i, lines in enumerate(atoms)) + "END\n")
        folder, _ = self.play(models, "--seconds", "0.3", "--trajectory-speed", "10", "--trajectory-fps", "10")
        last = read_dcd(folder / "trajectory.dcd")[2][-1]
        x = [float(line[30:38]) for line in atoms[1] if line.startswith("ATOM")]
        for read, told in zip(last, x):
            self.assertAlmostEqual(read[0], told, delta=0.02)


if __name__ == "__main__":
    unittest.main()
