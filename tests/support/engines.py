"""GROMACS and LAMMPS, for tests of what is written for them."""
import os
import re
import shutil
import subprocess
from pathlib import Path

# Debian's GROMACS refuses to run where the list of the processor's features lacks rdtscp. Virtual
# machines hide it though the instruction is there. So GROMACS is told that nothing is known of the
# processor: gmx::CpuInfo::detect() returns what its constructor makes, at support level 0 (none).
UNKNOWN_PROCESSOR = """
void _ZN3gmx7CpuInfoC1Ev(void*);
void* _ZN3gmx7CpuInfo6detectEv(int* result) { _ZN3gmx7CpuInfoC1Ev(result); *result = 0; return result; }
"""


def missing(*programs):
    """Those that are not installed, in words; empty where all are."""
    absent = [program for program in programs if not shutil.which(program)]
    return f"{', '.join(absent)} not installed" if absent else ""


def environment(folder):
    """In which GROMACS runs here."""
    result = dict(os.environ, GMX_MAXBACKUP="-1", OMP_NUM_THREADS="1")
    flags = Path("/proc/cpuinfo").read_text() if Path("/proc/cpuinfo").exists() else "rdtscp"
    if "rdtscp" not in flags:
        library = Path(folder) / "unknown_processor.so"
        if not library.exists():
            subprocess.run(["cc", "-shared", "-fPIC", "-x", "c", "-", "-o", library], input=UNKNOWN_PROCESSOR,
                           text=True, check=True)
        result["LD_PRELOAD"] = str(library)
    return result


class EngineFailed(Exception):
    pass


def run(folder, *words, answers=None):
    result = subprocess.run([str(word) for word in words], cwd=folder, env=environment(folder), input=answers,
                            stdin=None if answers else subprocess.DEVNULL, stdout=subprocess.PIPE,
                            stderr=subprocess.STDOUT, text=True, errors="replace")
    if result.returncode:
        raise EngineFailed(f"{' '.join(map(str, words))}\n{result.stdout[-3000:]}")
    return result.stdout


def gromacs_energies(folder):
    """Name -> kJ/mol, of the places of a folder that palpa engine gromacs wrote, in double precision."""
    run(folder, "gmx_d", "grompp", "-f", "energy.mdp", "-c", "system.gro", "-p", "system.top", "-o", "energy.tpr",
        "-po", "energy-all.mdp")
    run(folder, "gmx_d", "mdrun", "-s", "energy.tpr", "-rerun", "system.gro", "-deffnm", "energy", "-nt", 1)
    run(folder, "gmx_d", "energy", "-f", "energy.edr", "-o", "energy.xvg", "-dp",
        answers="\n".join(map(str, range(1, 40))) + "\n\n")
    text = (Path(folder) / "energy.xvg").read_text()
    names = re.findall(r'@ s\d+ legend "(.*)"', text)
    return dict(zip(names, map(float, text.splitlines()[-1].split()[1:])))


def lammps_rows(folder, *variables):
    """Rows of what LAMMPS prints of a run without a client: name -> number."""
    text = run(folder, "lmp", "-in", "run.in", "-log", "none", "-var", "port", 0, *variables)
    lines = iter(text.splitlines())
    names = next(line.split() for line in lines if line.startswith("Step "))
    rows = []
    for line in lines:
        if line.startswith("Loop time"):
            break
        rows.append(dict(zip(names, map(float, line.split()))))
    return rows
