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
ATOMS = 62
EDGE = 18.631
SPRING = 10            # kcal/mol/A^2
NM_OF_KCAL = 6.9477e-2  # nN of 1 kcal/mol/A
NM_OF_KJ_PER_NM = 1.66054e-3  # nN of 1 kJ/mol/nm


def free_port():
    with socket.create_server(("127.0.0.1", 0)) as listening:
        return listening.getsockname()[1]


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

    def pull(self, program, way_angstrom, seconds, rate):
        record = self.folder / "record"
        result = self.palpa("connect", f"127.0.0.1:{self.port}", "--topology", self.run_folder / "sent.psf",
                            "--headless", "--seconds", seconds, "--lead", f"{way_angstrom},0,0", "--spring", SPRING,
                            "--rate", rate, "--wait", 200, "--set", "engine.late_s=30", "--program", program,
                            "--record", record, "--json")
        output = (self.folder / "output").read_text(errors="replace")[-2000:]
        self.assertEqual(result.returncode, 0, result.stderr + output)
        with open(record / "trace.csv", newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        summary = json.loads(result.stdout)["engine"]
        self.assertGreater(summary["frames"], 100)

        def atoms_at(row):
            """The middle of the peptide: the hand's end, and the stretch of the spring."""
            return [float(row[f"molecule_{axis}_angstrom"]) + float(row[f"force_{axis}_nN"]) / NM_OF_KCAL / SPRING
                    for axis in "xyz"]

        last = [atoms_at(row) for row in rows[-400:]]
        way = [sum(p[i] for p in last) / len(last) - atoms_at(rows[0])[i] for i in range(3)]
        print(f"{self.id()}: went {way[0]:.2f}, {way[1]:.2f}, {way[2]:.2f} A")
        # Where the hand led it, less by what the water drags, within what heat does to it.
        self.assertGreater(way[0], 0.6 * way_angstrom, way)
        self.assertLess(way[0], way_angstrom + 1, way)
        self.assertLess(math.hypot(way[1], way[2]), 1.5, way)
        return -min(float(row["force_x_nN"]) for row in rows)

    def check_gromacs_had(self, felt_nN):
        """The strongest pull that GROMACS says it had, all atoms together, kJ/mol/nm."""
        strongest = 0
        for line in (self.run_folder / "forces.xvg").read_text().splitlines():
            if line.startswith(("#", "@")):
                continue
            _, count, *atoms = map(float, line.split())
            if not atoms:  # nobody pulls
                continue
            self.assertEqual((count, len(atoms)), (ATOMS, 4 * ATOMS))
            strongest = max(strongest, sum(atoms[1::4]))
        print(f"{self.id()}: {NM_OF_KJ_PER_NM * strongest:.3f} nN at most, and the hand felt {felt_nN:.3f}")
        self.assertAlmostEqual(NM_OF_KJ_PER_NM * strongest, felt_nN, delta=0.2 * felt_nN)


@unittest.skipIf(engines.missing("gmx"), engines.missing("gmx"))
class Gromacs(Played):
    def test_a_peptide_is_pulled_through_water(self):
        self.write("gromacs")
        engine = self.start("sh", "run.sh", "-if", "forces.xvg")
        felt = self.pull("gromacs", 3, 12, 10)
        self.end(engine)
        self.check_gromacs_had(felt)


@unittest.skipIf(engines.missing("gmx_mpi", "mpirun"), engines.missing("gmx_mpi", "mpirun"))
class GromacsOnTwoRanks(Played):
    def test_a_peptide_is_pulled_through_water(self):
        self.write("gromacs")
        engines.run(self.run_folder, "gmx_mpi", "grompp", "-f", "run.mdp", "-c", "system.gro", "-p", "system.top", "-n",
                    "index.ndx", "-o", "run.tpr")
        engine = self.start("mpirun", "--allow-run-as-root", "--oversubscribe", "-np", 2, "gmx_mpi", "mdrun", "-s",
                            "run.tpr", "-deffnm", "run", "-npme", 1, "-ntomp", 1, "-imdport", self.port, "-imdwait",
                            "-imdpull", "-if", "forces.xvg")
        felt = self.pull("gromacs", 3, 12, 10)
        self.end(engine)
        self.check_gromacs_had(felt)


@unittest.skipIf(engines.missing("lmp"), engines.missing("lmp"))
class Lammps(Played):
    def test_a_peptide_is_pulled_through_water(self):
        self.write("lammps")
        self.start("sh", "run.sh")
        self.pull("lammps", 3, 20, 4)


if __name__ == "__main__":
    unittest.main()
