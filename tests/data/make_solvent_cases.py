#!/usr/bin/env python3
"""Packs what other programs say of EEF1's solvation, one file a set of cases.

usage: make_solvent_cases.py SOLVENT_FOLDER EEF1SB_FOLDER OUTPUT_FOLDER

SOLVENT_FOLDER holds eef1sb_parameters.csv and oracle/; EEF1SB_FOLDER holds tetra/ and
top_all36_prot_eef1sb.rtf. See README.md beside this file.
"""
import csv
import sys
from pathlib import Path


def table(path):
    with open(path) as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


def number(text):
    text = f"{float(text):.10f}".rstrip("0").rstrip(".")
    return "0" if text == "-0" else text


def write_case(file, name, total, atoms, bonds):
    """Atoms: type, place and one number; bonds by their places in that list."""
    file.write(f"case {name} {total}\n")
    for words in atoms:
        file.write("atom " + " ".join(words) + "\n")
    for a, b in bonds:
        file.write(f"bond {a} {b}\n")


def numbered(path):
    lines = [line.split() for line in open(path) if line[0] != "#"]
    return [(int(a), int(b)) for a, b in lines]


def charmm(folder, output):
    for row in table(folder / "totals.csv"):
        name = row["name"]
        rows = table(folder / f"{name}.csv")
        place = {int(r["atom"]): k for k, r in enumerate(rows)}
        bonds = [(place[a], place[b]) for a, b in numbered(folder / f"{name}.bonds")]
        atoms = [[r["type"]] + [number(r[k]) for k in ("x", "y", "z", "G")] for r in rows]
        with open(output / f"{name}.txt", "w") as file:
            write_case(file, name, row["solvation"], atoms, bonds)


def residues_of(path):
    """Types and bonds of each residue and patch."""
    found, current = {}, None
    for line in open(path):
        words = line.split("!")[0].split()
        if not words:
            continue
        if words[0] in ("RESI", "PRES"):
            current = found[words[1]] = ({}, [])
        elif current and words[0] == "ATOM":
            current[0][words[1]] = words[2]
        elif current and words[0] in ("BOND", "DOUBLE"):
            current[1].extend(zip(words[1::2], words[2::2]))
    return found


def tetrapeptides(folder, totals, output):
    residues = residues_of(folder / "top_all36_prot_eef1sb.rtf")
    with open(output / "tetrapeptides.txt", "w") as file:
        for row in table(totals):
            atoms, places, chain = [], {}, []
            for line in open(folder / "tetra" / f"{row['name']}.pdb"):
                if not line.startswith("ATOM"):
                    continue
                name, residue, at = line[12:16].strip(), line[17:21].strip(), int(line[22:26])
                if name[0] == "H" or line[76:78].strip() == "H":
                    continue
                if len(chain) < at:
                    chain.append(residue)
                places[at, name] = len(atoms)
                atoms.append([name, at] + [number(line[k:k + 8]) for k in (30, 38, 46)])
            for words in atoms:
                name, at = words[:2]
                types = dict(residues[chain[at - 1]][0])
                if at == 1:
                    types.update(residues["NTER"][0])
                if at == len(chain):
                    types.update(residues["CTER"][0])
                words[:2] = [types[name]]
                words.append("0")
            bonds = []
            for at, residue in enumerate(chain, 1):
                pairs = [(at, a, at, b) for a, b in residues[residue][1]]
                if at == len(chain):
                    pairs += [(at, a, at, b) for a, b in residues["CTER"][1]]
                if at > 1:
                    pairs.append((at - 1, "C", at, "N"))
                for i, a, j, b in pairs:  # without those of hydrogens and of the next residue
                    bond = (places.get((i, a)), places.get((j, b)))
                    if None not in bond and bond not in bonds:
                        bonds.append(bond)
            write_case(file, row["name"], row["solvation_charmm"], atoms, bonds)


def genesis(folder, output):
    rows = table(folder / "atoms.csv")
    bonds = [(a - 1, b - 1) for a, b in numbered(folder / "bonds.txt")]
    atoms = [[r["type"]] + [number(r[k]) for k in ("x", "y", "z", "charge")] for r in rows]
    with open(output / "genesis_1afo.txt", "w") as file:
        write_case(file, "genesis_1afo", "-558.6822", atoms, bonds)


def parameters(path, output, columns):
    with open(output, "w") as file:
        file.write(",".join(columns) + "\n")
        for row in table(path):
            file.write(",".join(number(row[c]) if c != "type" else row[c] for c in columns) + "\n")


def main():
    solvent, eef1sb, output = map(Path, sys.argv[1:4])
    oracle = solvent / "oracle"
    columns = ["type", "volume_A3", "dG_ref", "dG_free", "dH_ref", "dCp_ref", "lambda_A",
               "R_min_half_A"]
    parameters(solvent / "eef1sb_parameters.csv", output / "eef1sb.csv", columns)
    parameters(oracle / "genesis_1afo/solvpar22_water.csv", output / "eef1_1999.csv", columns)
    charmm(oracle / "charmm", output)
    tetrapeptides(eef1sb, oracle / "charmm/tetra_totals.csv", output)
    genesis(oracle / "genesis_1afo", output)


if __name__ == "__main__":
    main()
