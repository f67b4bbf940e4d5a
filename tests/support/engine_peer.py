"""A remote engine in a few lines, of the wire facts of IMD alone: for tests of palpa connect.

Header: type and length, two 32-bit integers, the most significant byte first; in the handshake the second is the
version in the engine's own byte order, which numbers behind headers have too. Coordinates in Angstrom.
"""
import socket
import struct
import threading
import time

DISCONNECT, ENERGIES, COORDINATES, GO, HANDSHAKE, KILL, FORCES, PAUSE, RATE, ERROR = range(10)
SESSION, RESUME, TIME, BOX, VELOCITIES, FORCES_OF_FRAME, WAIT = range(10, 17)
KCAL = 4.184  # kJ/mol: version 3 has kJ/mol/A


class Engine(threading.Thread):
    """Overdamped beads: each moves by its force over its mass times `mobility` (amu A per kcal/mol/A, each frame).

    `script` is called before each frame with the engine and its number; it may change `places`, sleep, or
    send bytes of its own with `raw` and end the session by returning False.
    """

    def __init__(self, places, version=2, order=">", mobility=0.5, masses=None, frames=None, script=None, pause_s=0.002):
        super().__init__(daemon=True)
        self.places = [list(place) for place in places]
        self.version, self.order, self.mobility = version, order, mobility
        self.masses = masses or [16] * len(self.places)
        self.frames, self.script, self.pause_s = frames, script, pause_s
        self.pulls = {}      # atom: force, kcal/mol/A, as the client has them
        self.history = []    # of every frame: places, pulls
        self.sessions = 0
        self.problem = None
        self.listening = socket.create_server(("127.0.0.1", 0))
        self.listening.settimeout(0.2)
        self.port = self.listening.getsockname()[1]
        self.is_over = False

    def stop(self):
        self.is_over = True
        self.listening.close()
        self.join(10)

    def run(self):
        while not self.is_over:
            try:
                connection, _ = self.listening.accept()
            except OSError:
                continue
            self.sessions += 1
            try:
                with connection:
                    self.serve(connection)
            except OSError as error:
                self.problem = str(error)

    def send(self, kind, length, body=b""):
        self.connection.sendall(struct.pack(">ii", kind, length) + body)

    def raw(self, data):
        self.connection.sendall(data)

    def floats(self, numbers):
        numbers = list(numbers)
        return struct.pack(f"{self.order}{len(numbers)}f", *numbers)

    def serve(self, connection):
        self.connection, self.incoming = connection, b""
        connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        connection.sendall(struct.pack(">i", HANDSHAKE) + struct.pack(f"{self.order}i", self.version))
        if self.version == 3:  # time, energies, box, coordinates, wrapped, velocities, forces
            self.send(SESSION, 7, bytes([1, 1, 0, 1, 0, 0, 0]))
        self.await_go()
        number = 0
        while not self.is_over and (self.frames is None or number < self.frames):
            self.take()
            if self.script and self.script(self, number) is False:
                return
            for atom, force in self.pulls.items():
                for axis in range(3):
                    self.places[atom][axis] += self.mobility * force[axis] / self.masses[atom]
            self.history.append(([list(p) for p in self.places], dict(self.pulls)))
            if self.version == 3:
                self.send(TIME, 1, struct.pack(f"{self.order}ddq", 0.001, 0.001 * number, number))
            self.send(ENERGIES, 1, struct.pack(f"{self.order}i", number) + self.floats([300] + [-1] * 8))
            self.send(COORDINATES, len(self.places), self.floats(x for place in self.places for x in place))
            number += 1
            time.sleep(self.pause_s)

    def await_go(self):
        self.connection.settimeout(5)
        while b"" == self.incoming or len(self.incoming) < 8:
            data = self.connection.recv(4096)
            if not data:
                raise OSError("the client left before it said go")
            self.incoming += data
        kind, _ = struct.unpack(">ii", self.incoming[:8])
        if kind != GO:
            raise OSError(f"the client said {kind}, no go")
        self.incoming = self.incoming[8:]

    def take(self):
        self.connection.setblocking(False)
        has_left = False
        try:
            while not has_left:
                data = self.connection.recv(65536)
                self.incoming += data
                has_left = not data
        except BlockingIOError:
            pass
        self.connection.setblocking(True)
        while len(self.incoming) >= 8:
            kind, length = struct.unpack(">ii", self.incoming[:8])
            size = 16 * length if kind == FORCES else 0
            if len(self.incoming) < 8 + size:
                break
            body, self.incoming = self.incoming[8:8 + size], self.incoming[8 + size:]
            if kind == FORCES:
                atoms = struct.unpack(f"{self.order}{length}i", body[:4 * length])
                numbers = struct.unpack(f"{self.order}{3 * length}f", body[4 * length:])
                unit = KCAL if self.version == 3 else 1
                self.pulls = {atom: [x / unit for x in numbers[3 * i:3 * i + 3]] for i, atom in enumerate(atoms)}
            elif kind == DISCONNECT:
                has_left = True
        if has_left:
            raise OSError("the client has left")


def write_gro(path, places, names):
    """`names`: (residue number, residue, atom) of each."""
    lines = ["made by a test", f"{len(places)}"]
    for i, (place, (number, residue, atom)) in enumerate(zip(places, names)):
        lines.append(f"{number:5}{residue:<5}{atom:>5}{i + 1:5}" + "".join(f"{x / 10:8.3f}" for x in place))
    path.write_text("\n".join(lines) + "\n   5.00000   5.00000   5.00000\n")
