#!/usr/bin/env python3
"""Sums what HIV-1 protease does to TL-3, pair by pair, for poses of scenes/hiv.

usage: make_hiv_poses.py FORCE_FIELD.json SYSTEM.crd > hiv_poses.csv

Independent of the program: charges, sigma and epsilon are the reference set's (nm, kJ/mol), sums
are exact (math.fsum); only the places are the scene's, since that turned them. See README.md
beside this file.
"""
import json
import math
import sys

COULOMB = 332.0716 * 0.4184  # kJ nm/mol/e2, from CHARMM's own kcal A/mol/e2
SEGMENTS = {"S0": "PROA", "S1": "PROB", "LIG": "TL3"}


def read_places(path):
    """(segment, residue number, atom) -> place in nm."""
    lines = [line for line in open(path) if not line.startswith("*")]
    places = {}
    for line in lines[1:]:
        words = line.split()
        places[words[7], words[8], words[3]] = [float(word) / 10 for word in words[4:7]]
    return places


def main():
    force_field = json.load(open(sys.argv[1]))
    rows = force_field["atoms"]["rows"]
    places = read_places(sys.argv[2])
    assert len(places) == len(rows)
    atoms = [(places[SEGMENTS[row[8]], str(row[2]), row[0]], row[4:8]) for row in rows]
    ligand = [atom for atom, row in zip(atoms, rows) if row[8] == "LIG"]
    protein = [(*place, *numbers) for (place, numbers), row in zip(atoms, rows)
               if row[8] != "LIG"]
    # Replaced pairs stand between atoms of the protein only.
    replaced = {name for pair in force_field["nbfix"] for name in pair[:2]}
    assert not replaced & {row[3] for row in rows if row[8] == "LIG"}
    weight = math.fsum(numbers[0] for _, numbers in ligand)
    centre = [math.fsum(numbers[0] * place[k] for place, numbers in ligand) / weight
              for k in range(3)]

    names = ["pose"] + [f"d{axis}_nm" for axis in "xyz"] + ["turn_deg", "lj_kJ_per_mol",
                                                           "coulomb_kJ_per_mol"]
    names += [f"f{axis}_kJ_per_mol_nm" for axis in "xyz"]
    names += [f"t{axis}_kJ_per_mol" for axis in "xyz"]
    print(",".join(names))
    # Turned about z through the centre of mass, then shifted.
    for pose, shift, turn_deg in (("shipped", (0, 0, 0), 0), ("pulled", (0.03, 0.01, -0.005), 0),
                                  ("turned", (-0.01, 0.005, 0.01), 4), ("outside", (2.7, 0, 0), 0)):
        c, s = math.cos(math.radians(turn_deg)), math.sin(math.radians(turn_deg))
        lj, coulomb, forces, torques = [], [], [], []
        for place, (_, charge, sigma, epsilon) in ligand:
            arm = [place[k] - centre[k] for k in range(3)]
            arm = [c * arm[0] - s * arm[1], s * arm[0] + c * arm[1], arm[2]]
            here = [centre[k] + arm[k] + shift[k] for k in range(3)]
            pushes = []
            for x, y, z, _, charge_j, sigma_j, epsilon_j in protein:
                d = here[0] - x, here[1] - y, here[2] - z
                r2 = d[0] ** 2 + d[1] ** 2 + d[2] ** 2
                s6 = (((sigma + sigma_j) / 2) ** 2 / r2) ** 3
                well = 4 * math.sqrt(epsilon * epsilon_j)
                lj.append(well * (s6 * s6 - s6))
                coulomb.append(COULOMB * charge * charge_j / math.sqrt(r2))
                push = (6 * well * (2 * s6 * s6 - s6) + coulomb[-1]) / r2
                pushes.append((push * d[0], push * d[1], push * d[2]))
            f = [math.fsum(push[k] for push in pushes) for k in range(3)]
            forces.append(f)
            torques.append((arm[1] * f[2] - arm[2] * f[1], arm[2] * f[0] - arm[0] * f[2],
                            arm[0] * f[1] - arm[1] * f[0]))
        values = [*shift, turn_deg, math.fsum(lj), math.fsum(coulomb)]
        values += [math.fsum(each[k] for each in sums) for sums in (forces, torques)
                   for k in range(3)]
        print(",".join([pose] + [repr(float(value)) for value in values]))


if __name__ == "__main__":
    main()
