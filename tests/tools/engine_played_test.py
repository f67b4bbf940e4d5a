"""A peptide is pulled through water that GROMACS, LAMMPS, and GROMACS on two MPI ranks move."""
import csv
import json
import math
import os
import signal
import socket
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

ROOT = Path(os.environ["PALPA_ROOT"])
sys.path.insert(0, str(ROOT / "tests/support"))
import engines  # noqa: E402

PROGRAM = os.environ["PALPA_PROGRAM"]
PEPTIDE = ROOT / "scenes/engine/peptide"
EDGE = 18.631
SPRING = 5             # kcal/mol/A^2
NM_OF_KCAL = 6.9477e-2  # nN of 1 kcal/mol/A
WAY = 4                # A


def free_port():
    with socket.create_server(("127.0.0.1", 0)) as listening:
        return listening.getsockname()[1]


def read_gro(path):
    """Residue name, atom name, A of each atom."""
    lines = path.read_text().splitlines()
    return [(line[5:10].strip(), line[10:15].strip(), [10 * float(line[20 + 8 * i:28 + 8 * i]) for i in range(3)])
            for line in lines[2:2 + int(lines[1])]]


class Played(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.run_folder = self.folder / "run"
        self.port = free_port()

    def palpa(self, *words):
        return subprocess.run([PROGRAM, *map(str, words)], capture_output=True, text=True, stdin=subprocess.DEVNULL,
                              timeout=300)

    def write(self, engine):
        result = self.palpa("engine", engine, "-o", self.run_folder, "--box", f"{EDGE},{EDGE},{EDGE}", "--send", "PEPA",
                            "--port", self.port, "--psf", PEPTIDE / "system.psf", "--coordinates",
                            PEPTIDE / "system.crd", "--toppar", PEPTIDE / "system.prm")
        self.assertEqual(result.returncode, 0, result.stderr)

    def start(self, *command):
        with open(self.folder / "output", "w", encoding="utf-8") as output:
            engine = subprocess.Popen(list(map(str, command)), cwd=self.run_folder, stdin=subprocess.DEVNULL,
                                      stdout=output, stderr=output, env=engines.environment(self.folder),
                                      start_new_session=True)
        self.addCleanup(self.end, engine)
        return engine

    def end(self, engine):
        """In order, so that GROMACS writes where its atoms are."""
        if engine.poll() is None:
            os.killpg(engine.pid, signal.SIGTERM)
            try:
                engine.wait(60)
            except subprocess.TimeoutExpired:
                os.killpg(engine.pid, signal.SIGKILL)
                engine.wait()

    def pull(self, *options):
        record = self.folder / "record"
        result = self.palpa("connect", f"127.0.0.1:{self.port}", "--topology", self.run_folder / "sent.psf",
                            "--headless", "--seconds", 20, "--lead", f"{WAY},0,0", "--spring", SPRING, "--wait", 60,
                            "--record", record, "--json", *options)
        output = (self.folder / "output").read_text(errors="replace")[-2000:]
        self.assertEqual(result.returncode, 0, result.stderr + output)
        with open(record / "trace.csv", newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        summary = json.loads(result.stdout)["engine"]
        self.assertGreater(summary["frames"], 100)
        self.assertEqual(summary["interruptions"], 0)

        def atoms_at(row):
            """The middle of the peptide: the hand's end, and the stretch of the spring."""
            return [float(row[f"molecule_{axis}_angstrom"]) + float(row[f"force_{axis}_nN"]) / NM_OF_KCAL / SPRING
                    for axis in "xyz"]

        last = [atoms_at(row) for row in rows[-500:]]
        way = [sum(p[i] for p in last) / len(last) - atoms_at(rows[0])[i] for i in range(3)]
        # Where the hand led it, within what heat does to it.
        self.assertAlmostEqual(way[0], WAY, delta=1.2, msg=way)
        self.assertLess(math.hypot(way[1], way[2]), 1.5, way)
        # The water resists on the way.
        middle = [float(row["force_x_nN"]) for row in rows[2000:19000]]
        self.assertLess(sum(middle) / len(middle), -0.005)
        return way

    def check_gromacs_went(self, engine, way):
        """What GROMACS says itself of where the peptide is, in the nearest image of the box."""
        self.end(engine)
        names = {"ALA", "GLU", "ARG"}
        before = [atom for atom in read_gro(self.run_folder / "system.gro") if atom[0] in names]
        after = [atom for atom in read_gro(self.run_folder / "run.gro") if atom[0] in names]
        self.assertEqual([a[:2] for a in before], [a[:2] for a in after])
        moves = []
        for (_, _, a), (_, _, b) in zip(before, after):
            move = b[0] - a[0] - way
            moves.append(move - EDGE * round(move / EDGE))
        # It has gone on by itself since the hand let go.
        self.assertLess(abs(sum(moves) / len(moves)), 3)


@unittest.skipIf(engines.missing("gmx"), engines.missing("gmx"))
class Gromacs(Played):
    def test_a_peptide_is_pulled_through_water(self):
        self.write("gromacs")
        engine = self.start("sh", "run.sh")
        way = self.pull("--program", "gromacs")
        self.check_gromacs_went(engine, way[0])


@unittest.skipIf(engines.missing("gmx_mpi", "mpirun"), engines.missing("gmx_mpi", "mpirun"))
class GromacsOnTwoRanks(Played):
    def test_a_peptide_is_pulled_through_water(self):
        self.write("gromacs")
        engines.run(self.run_folder, "gmx_mpi", "grompp", "-f", "run.mdp", "-c", "system.gro", "-p", "system.top", "-n",
                    "index.ndx", "-o", "run.tpr")
        engine = self.start("mpirun", "--allow-run-as-root", "--oversubscribe", "-np", 2, "gmx_mpi", "mdrun", "-s",
                            "run.tpr", "-deffnm", "run", "-npme", 1, "-ntomp", 1, "-imdport", self.port, "-imdwait",
                            "-imdpull")
        way = self.pull("--program", "gromacs")
        self.check_gromacs_went(engine, way[0])


@unittest.skipIf(engines.missing("lmp"), engines.missing("lmp"))
class Lammps(Played):
    def test_a_peptide_is_pulled_through_water(self):
        self.write("lammps")
        self.start("sh", "run.sh")
        self.pull("--program", "lammps")


if __name__ == "__main__":
    unittest.main()
