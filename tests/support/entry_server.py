"""A server of PDB entries on loopback, for tests of downloads: each code has an answer of its own."""
import gzip
import http.server
import threading


class EntryServer:
    """`answers`: code -> function of the request's handler. Counts what is asked for in `asked`."""

    def __init__(self, answers):
        self.asked, self.is_over = [], threading.Event()
        owner = self

        class Handler(http.server.BaseHTTPRequestHandler):
            def do_GET(self):
                owner.asked.append(self.path)
                name = self.path.strip("/").split(".")[0]
                try:
                    answers.get(name, not_found)(self)
                except OSError:  # the program has left
                    pass

            def log_message(self, *_):
                pass

        self.server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Handler)
        self.server.owner = self
        self.server.daemon_threads = True
        self.port = self.server.server_address[1]
        self.base = f"http://127.0.0.1:{self.port}/"
        self.thread = threading.Thread(target=self.server.serve_forever, args=(0.05,), daemon=True)
        self.thread.start()

    def stop(self):
        self.is_over.set()
        self.server.shutdown()
        self.server.server_close()
        self.thread.join()


def not_found(request):
    request.send_error(404)


def status(code):
    return lambda request: request.send_error(code)


def content(data, length=None):
    """Says that it is `length` bytes long, if that is given, or as long as it is; False: says nothing."""
    def answer(request):
        request.send_response(200)
        if length is not False:
            request.send_header("Content-Length", str(len(data) if length is None else length))
        request.end_headers()
        request.wfile.write(data)
    return answer


def redirect(to):
    """To another code, or to an address."""
    def answer(request):
        request.send_response(302)
        request.send_header("Location", to if ":" in to else f"/{to}.cif.gz")
        request.send_header("Content-Length", "0")
        request.end_headers()
    return answer


def endless(request):
    request.send_response(200)
    request.end_headers()
    while True:  # until the program leaves
        request.wfile.write(b"\x1f\x8b" + bytes(1 << 20))


def stalled(first=b""):
    """Sends these bytes, or not even a status, and then waits for the test's end."""
    def answer(request):
        if first:
            request.send_response(200)
            request.send_header("Content-Length", "1000000")
            request.end_headers()
            request.wfile.write(first)
        request.server.owner.is_over.wait()
    return answer


def dripping(request):
    request.send_response(200)
    request.end_headers()
    while not request.server.owner.is_over.wait(0.1):
        request.wfile.write(b"\x1f")


def packed(text):
    return content(gzip.compress(text.encode()))
