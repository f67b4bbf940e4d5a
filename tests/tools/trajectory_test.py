"""Trajectories that runs record beside the trace, read by code of its own, and by GROMACS and
MDAnalysis where they are installed."""
import os
import shutil
import struct
import subprocess
import tempfile
import unittest
from pathlib import Path

PROGRAM = os.environ["PALPA_PROGRAM"]
WATER = Path(os.environ["PALPA_ROOT"]) / "scenes" / "water"

try:
    import MDAnalysis
except ImportError:
    MDAnalysis = None


def read_dcd(path):
    """Step of the first frame, time step in ps, and frames of positions in angstrom."""
    data, at, records = path.read_bytes(), 0, []
    while at < len(data):
        size, = struct.unpack_from("<i", data, at)
        records.append(data[at + 4:at + 4 + size])
        at += size + 8
    header = struct.unpack("<4s9if10i", records[0])
    atoms, = struct.unpack("<i", records[2])
    columns = [struct.unpack(f"<{atoms}f", record) for record in records[3:]]
    frames = [list(zip(*columns[i:i + 3])) for i in range(0, len(columns), 3)]
    assert header[0] == b"CORD" and header[1] == len(frames)
    return header[2], header[10] * 0.0488882129, frames


class Trajectories(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.tmp = Path(self.folder.name)

    def palpa(self, *arguments):
        return subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True)

    def run_water(self, *arguments, scene=WATER):
        result = self.palpa("run", scene, "--headless", *arguments)
        self.assertEqual(result.returncode, 0, result.stderr)
        return result

    def record(self, name, *arguments, scene=WATER):
        self.run_water("--seconds", "1", "--record", self.tmp / name, *arguments, scene=scene)
        return self.tmp / name

    def refused(self, expected, *arguments):
        result = self.palpa("run", *arguments)
        self.assertEqual(result.returncode, 2, result.stderr)
        self.assertEqual(len(result.stderr.strip().splitlines()), 1, result.stderr)
        self.assertIn(expected, result.stderr)


class Recorded(Trajectories):
    def test_frames_are_where_the_trace_has_the_molecule(self):
        folder = self.record("a", "--trajectory-fps", "10")
        first, step_ps, frames = read_dcd(folder / "trajectory.dcd")
        self.assertEqual((first, len(frames), len(frames[0])), (0, 10, 6))
        self.assertAlmostEqual(step_ps, 0.1, places=6)
        rows = (folder / "trace.csv").read_text().splitlines()
        columns = rows[0].split(",")
        x = columns.index("molecule_x_angstrom")
        distances = []
        for number, frame in enumerate(frames):
            told = float(rows[1 + 100 * number].split(",")[x])
            # The table is one step ahead of what the trace says was felt at that tick.
            oxygens = [frame[0][0], frame[3][0]]
            distances.append(abs(oxygens[1] - oxygens[0]))
            self.assertAlmostEqual(distances[-1], abs(told), delta=0.05)
        self.assertGreater(max(distances) - min(distances), 0.1)

    def test_the_trace_is_the_same_with_and_without(self):
        bare = self.record("a", "--trajectory-fps", "0")
        full = self.record("b", "--trajectory-fps", "100", "--trajectory-xtc")
        for name in ("trace.csv", "session.toml"):
            self.assertEqual((bare / name).read_bytes(), (full / name).read_bytes())
        self.assertFalse((bare / "trajectory.dcd").exists() or (bare / "system.psf").exists())

    def test_unless_told_there_are_25_frames_a_second(self):
        folder = self.record("a")
        self.assertEqual(len(read_dcd(folder / "trajectory.dcd")[2]), 25)
        self.assertFalse((folder / "trajectory.xtc").exists())

    def test_the_psf_lists_all_atoms_with_bonds_charges_and_masses(self):
        text = (self.record("a") / "system.psf").read_text().splitlines()
        at = next(i for i, line in enumerate(text) if line.endswith("!NATOM"))
        self.assertEqual(text[at].split()[0], "6")
        atoms = [line.split() for line in text[at + 1:at + 7]]
        self.assertEqual([row[4] for row in atoms], ["OH2", "H1", "H2"] * 2)
        self.assertAlmostEqual(sum(float(row[6]) for row in atoms), 0, places=5)
        self.assertAlmostEqual(sum(float(row[7]) for row in atoms), 2 * 18.0154, places=2)
        bonds = next(line for line in text if "!NBOND" in line)
        self.assertIn(int(bonds.split()[0]), (4, 6))

    def test_an_edit_that_changes_atoms_begins_another_file(self):
        scene = self.tmp / "scene"
        shutil.copytree(WATER, scene)
        with open(scene / "scene.toml", "a") as file:
            file.write('[[edits]]\nat_s = 0.5\nadd = { structure = "three.crd", segment = "LEFT", '
                       'name = "w2", at_angstrom = [0, 4, 0] }\n')
        result = self.run_water("--seconds", "1", "--trajectory-fps", "10", "--trajectory-xtc", "--record",
                                self.tmp / "a", scene=scene)
        first, second = (read_dcd(self.tmp / "a" / name) for name in ("trajectory.dcd", "trajectory-2.dcd"))
        self.assertEqual([len(first[2][0]), len(second[2][0])], [6, 9])
        self.assertEqual(len(first[2]) + len(second[2]), 10)
        self.assertEqual(second[0], len(first[2]))
        self.assertIn("9 !NATOM", (self.tmp / "a" / "system-2.psf").read_text())
        self.assertIn("trajectory-2.dcd", result.stderr)
        self.assertTrue((self.tmp / "a" / "trajectory-2.xtc").exists())

    def test_a_recording_that_is_replaced_takes_its_trajectory_with_it(self):
        folder = self.record("a", "--trajectory-xtc")
        (folder / "mine.dcd").write_text("somebody's")
        self.record("a", "--overwrite", "--trajectory-fps", "0")
        self.assertEqual([(folder / name).exists() for name in
                          ("trajectory.dcd", "trajectory.xtc", "system.psf", "mine.dcd")],
                         [False, False, False, True])

    def test_options_of_a_trajectory_want_a_recording(self):
        self.refused("--trajectory-fps", WATER, "--headless", "--trajectory-fps", "5")

    def test_gromacs_reads_the_frames(self):
        gmx = shutil.which("gmx")
        if not gmx:
            return
        folder = self.record("a", "--trajectory-fps", "10", "--trajectory-xtc")
        checked = subprocess.run([gmx, "-nobackup", "check", "-f", folder / "trajectory.xtc"],
                                 capture_output=True, text=True, cwd=self.tmp)
        said = checked.stdout + checked.stderr
        self.assertEqual(checked.returncode, 0, said)
        coordinates = next(line.split() for line in said.splitlines() if line.startswith("Coords"))
        self.assertEqual(coordinates[1:3], ["10", "0.1"], said)
        dumped = subprocess.run([gmx, "-nobackup", "dump", "-f", folder / "trajectory.xtc"],
                                capture_output=True, text=True, cwd=self.tmp)
        rows = [line for line in dumped.stdout.splitlines() if line.strip().startswith("x[")]
        frames = read_dcd(folder / "trajectory.dcd")[2]
        self.assertEqual(len(rows), 60, dumped.stderr)
        for row, atom in zip(rows, (atom for frame in frames for atom in frame)):
            numbers = [10 * float(number) for number in row.split("{")[1].strip("}").split(",")]
            for read, written in zip(numbers, atom):
                self.assertAlmostEqual(read, written, delta=1e-3)

    def test_mdanalysis_reads_the_files(self):
        if not MDAnalysis:
            return
        folder = self.record("a", "--trajectory-fps", "10")
        universe = MDAnalysis.Universe(str(folder / "system.psf"), str(folder / "trajectory.dcd"))
        frames = read_dcd(folder / "trajectory.dcd")[2]
        self.assertEqual(len(universe.trajectory), 10)
        for step, frame in zip(universe.trajectory, frames):
            for read, written in zip(step.positions, frame):
                for a, b in zip(read, written):
                    self.assertAlmostEqual(float(a), b, places=5)


if __name__ == "__main__":
    unittest.main()
