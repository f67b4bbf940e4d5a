"""Opens the files of a recording, plain or compressed, for scripts and tests."""
import contextlib
import gzip
import sys
import zlib


@contextlib.contextmanager
def open_recorded(path):
    """The text of `path`, or of the same name with .gz where only that is there. Ends the program with a
    sentence if the compressed file is cut off or damaged."""
    packed = path.with_name(path.name + ".gz")
    if path.exists() or not packed.exists():
        with open(path, encoding="utf-8", newline="") as file:
            yield file
        return
    try:
        with gzip.open(packed, "rt", encoding="utf-8", newline="") as file:
            yield file
    except (EOFError, zlib.error, gzip.BadGzipFile) as error:
        print(f"{packed}: is cut off or damaged ({error}); expected a file that gzip unpacks", file=sys.stderr)
        sys.exit(2)
