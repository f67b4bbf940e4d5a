"""What a program shows on a terminal."""
import os
import pty
import subprocess


def run_on_terminal(command):
    """Exit code and standard error, which is a terminal; standard output goes nowhere."""
    main, terminal = pty.openpty()
    with subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=terminal) as process:
        os.close(terminal)
        shown = b""
        try:
            while part := os.read(main, 4096):
                shown += part
        except OSError:  # the other end is closed
            pass
    os.close(main)
    return process.returncode, shown.decode()
