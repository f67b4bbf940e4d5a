"""tools/lab/scripts/compare_peers: what it reads of the scene is what Palpa reads, and what is missing is said."""
import importlib.machinery
import importlib.util
import json
import math
import os
import subprocess
import unittest
from pathlib import Path

PROGRAM = os.environ["PALPA_PROGRAM"]
ROOT = Path(os.environ["PALPA_ROOT"])
SCENE = ROOT / "scenes" / "hiv"


def load_script():
    loader = importlib.machinery.SourceFileLoader("compare_peers",
                                                  str(ROOT / "tools" / "lab" / "scripts" / "compare_peers"))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader(loader.name, loader))
    loader.exec_module(module)
    return module


class ComparePeers(unittest.TestCase):
    def test_springs_and_1_4_pairs_have_palpa_s_energies(self):
        script = load_script()
        system = script.System(SCENE)
        places = system.places

        bond = sum(k * (math.dist(places[a], places[b]) - r0) ** 2
                   for (a, b), (k, r0) in system.bonds)
        urey_bradley = sum(more[0] * (math.dist(places[a], places[c]) - more[1]) ** 2
                           for (a, _, c), (_, _, *more) in system.angles if more)
        lj14 = coulomb14 = 0
        for i, j in system.pairs14:
            depth, rmin = system.numbers14(i, j)
            r = math.dist(places[i], places[j])
            lj14 += depth * ((rmin / r) ** 12 - 2 * (rmin / r) ** 6)
            coulomb14 += script.COULOMB * system.charges[i] * system.charges[j] / r

        result = subprocess.run([PROGRAM, "energy", SCENE / "system.psf", "--coordinates",
                                 SCENE / "system.crd", "--toppar", SCENE / "system.prm",
                                 "--coulomb-constant", str(script.COULOMB), "--json"],
                                capture_output=True, text=True)
        self.assertEqual(result.returncode, 0, result.stderr)
        energy = json.loads(result.stdout)
        for name, ours in (("bond", bond), ("urey_bradley", urey_bradley), ("lj14", lj14),
                           ("coulomb14", coulomb14)):
            self.assertAlmostEqual(ours, energy[name], delta=1e-6 * abs(energy[name]), msg=name)

    def test_the_first_energy_of_a_gromacs_log(self):
        log = ("Potential shift: LJ r^-12\nGenerated table\n   Energies (kJ/mol)\n"
               "        LJ (SR)   Coulomb (SR)      Potential    Kinetic En.   Total Energy\n"
               "   -4.18400e+03   -2.00000e+00   -8.56098e+03    1.00000e+00    2.00000e+00\n"
               "      Potential\n    1.00000e+00\n")
        self.assertAlmostEqual(load_script().gromacs_energy(log), -8560.98 / 4.184)

    def test_without_the_program_it_says_so(self):
        result = subprocess.run([ROOT / "tools" / "lab" / "scripts" / "compare_peers"], capture_output=True, text=True,
                                env={**os.environ, "PALPA_PROGRAM": "/nowhere/palpa"})
        self.assertEqual(result.returncode, 2)
        self.assertIn("/nowhere/palpa is missing", result.stderr)


if __name__ == "__main__":
    unittest.main()
