"""GROMACS and LAMMPS, for tests of what is written for them."""
import os
import re
import shutil
import socket
import struct
import subprocess
import time
from pathlib import Path

# Debian's GROMACS refuses to run where the list of the processor's features lacks rdtscp. Virtual
# machines hide it though the instruction is there. So this reports an unknown processor to
# GROMACS: gmx::CpuInfo::detect() returns what its constructor makes, at support level 0 (none).
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



ENERGIES, COORDINATES, GO, HANDSHAKE, KILL, FORCES = 1, 2, 3, 4, 5, 6  # of IMD


def pull(port, running, frames):
    """Joins an engine by IMD, version 2, pulls its first atom, and ends it. Atoms of each frame that came."""
    until = time.monotonic() + 60
    while True:
        try:
            connection = socket.create_connection(("127.0.0.1", port), timeout=60)
            break
        except OSError:
            if time.monotonic() > until or running.poll() is not None:
                raise
            time.sleep(0.1)
    with connection:
        def receive(size):
            data = b""
            while len(data) < size:
                more = connection.recv(size - len(data))
                if not more:
                    raise OSError("the engine hung up")
                data += more
            return data
        kind, = struct.unpack(">i", receive(4))
        order = "<" if struct.unpack("<i", receive(4))[0] == 2 else ">"
        if kind != HANDSHAKE:
            raise OSError(f"message {kind} in place of a handshake")
        connection.sendall(struct.pack(">ii", GO, 0) + struct.pack(">ii", FORCES, 1) +
                           struct.pack(order + "ifff", 0, 1.0, 0.0, 0.0))
        sizes = []
        while len(sizes) < frames:
            kind, count = struct.unpack(">ii", receive(8))
            if kind == ENERGIES:
                receive(40)
            elif kind == COORDINATES:
                receive(12 * count)
                sizes.append(count)
            else:
                raise OSError(f"message {kind}")
        connection.sendall(struct.pack(">ii", KILL, 0))
    return sizes
