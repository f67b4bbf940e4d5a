#!/usr/bin/env python3
"""Sums what HIV-1 protease does to TL-3, pair by pair, for poses of scenes/hiv.

usage: make_hiv_poses.py SYSTEM.psf SYSTEM.crd PARAMETERS.prm ... > hiv_poses.csv

Independent of the program's sums: sigma and epsilon are read here from CHARMM's own files
(par_all36m_prot.prm, par_all36_cgenff.prm), everything is turned into nm and kJ/mol, sums are exact
(math.fsum). Names, types, charges and places are the scene's. See README.md beside this file.
"""
import math
import sys

COULOMB = 332.0716 * 0.4184  # kJ nm/mol/e2, from CHARMM's own kcal A/mol/e2
LIGAND = "TL3C"


def read_places(path):
    """(segment, residue number, atom) -> place in nm."""
    lines = [line for line in open(path) if not line.startswith("*")]
    places = {}
    for line in lines[1:]:
        words = line.split()
        places[words[7], words[8], words[3]] = [float(word) / 10 for word in words[4:7]]
    return places


def read_atoms(path):
    """((segment, residue number, atom), type, charge, mass) of each atom of a PSF."""
    lines = open(path).read().splitlines()
    at = next(i for i, line in enumerate(lines) if "!NATOM" in line)
    rows = [line.split() for line in lines[at + 1:at + 1 + int(lines[at].split()[0])]]
    return [((row[1], row[2], row[4]), row[5], float(row[6]), float(row[7])) for row in rows]


def read_wells(paths):
    """type -> (sigma in nm, epsilon in kJ/mol), and the types of replaced pairs."""
    wells, replaced = {}, []
    for path in paths:
        section = ""
        for line in open(path):
            words = line.split("!")[0].split()
            if not words or words[0].startswith("*"):
                continue
            if words[0] in ("NONBONDED", "NBFIX", "END", "HBOND", "CMAP", "BONDS"):
                section = words[0]
            elif section == "NONBONDED" and len(words) >= 4 and words[0] != "cutnb":
                wells[words[0]] = (float(words[3]) * 2 / 10 / 2 ** (1 / 6), -float(words[2]) * 4.184)
            elif section == "NBFIX":
                replaced.append(tuple(words[:2]))
    return wells, replaced


def main():
    places = read_places(sys.argv[2])
    wells, pairs = read_wells(sys.argv[3:])
    atoms, types = [], []
    for name, kind, charge, mass in read_atoms(sys.argv[1]):
        # mass, charge, sigma, epsilon
        atoms.append((places[name], (mass, charge, *wells[kind]), name[0] == LIGAND))
        types.append((kind, name[0] == LIGAND))
    ligand = [(place, numbers) for place, numbers, is_ligand in atoms if is_ligand]
    protein = [(*place, *numbers) for place, numbers, is_ligand in atoms if not is_ligand]
    ours = {kind for kind, is_ligand in types if is_ligand}
    theirs = {kind for kind, is_ligand in types if not is_ligand}
    assert not any(a in ours and b in theirs or b in ours and a in theirs for a, b in pairs)
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
