"""palpa prepare CODE and palpa CODE against a server on loopback: what is downloaded, kept, and refused."""
import gzip
import json
import os
import re
import shutil
import signal
import socket
import ssl
import subprocess
import tempfile
import time
import unittest
from pathlib import Path

from entry_server import EntryServer, content, dripping, endless, packed, redirect, stalled, status

PROGRAM, ROOT = os.environ["PALPA_PROGRAM"], Path(os.environ["PALPA_ROOT"])
CUT = gzip.compress(b"data_6CUT\n" + os.urandom(5000))[:3000]


def clean_environment():
    """Without a display, which nothing here needs."""
    return {key: value for key, value in os.environ.items() if key not in ("DISPLAY", "WAYLAND_DISPLAY")}


class Fetch(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        with tempfile.TemporaryDirectory() as folder:
            structure = Path(folder) / "s.cif"
            result = subprocess.run([PROGRAM, "export", ROOT / "scenes" / "hairpin", "-o", structure],
                                    capture_output=True, text=True)
            assert result.returncode == 0, result.stderr
            cls.text = structure.read_text()

    def entry(self, code):
        """mmCIF of a hairpin, as an entry of that code."""
        text, changed = re.subn(r"(?m)^data_\S+", f"data_{code.upper()}", self.text, count=1)
        self.assertEqual(changed, 1)
        return text

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.tmp = Path(folder.name)
        self.cache = self.tmp / "cache" / "palpa" / "structures"
        self.env = {**clean_environment(), "XDG_CACHE_HOME": str(self.tmp / "cache"),
                    "XDG_CONFIG_HOME": str(self.tmp / "config"), "http_proxy": "http://127.0.0.1:9/",
                    "no_proxy": ""}  # a proxy that is not asked for this computer
        (self.tmp / "config" / "palpa").mkdir(parents=True)
        (self.tmp / "here").mkdir()

    def serve(self, stall_s=600, **answers):
        server = EntryServer(answers)
        self.addCleanup(server.stop)
        self.prefer(server.base, stall_s)
        return server

    def prefer(self, base, stall_s=600):
        (self.tmp / "config" / "palpa" / "preferences.toml").write_text(
            f'download_from = "{base}"\ndownload_stall_seconds = {stall_s}\n')

    def palpa(self, *arguments, **environment):
        return subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True, cwd=self.tmp / "here",
                              stdin=subprocess.DEVNULL, env={**self.env, **environment})

    def prepare(self, code, *options, **environment):
        return self.palpa("prepare", code, "--no-scene", "--no-relax", *options, "-o", self.tmp / "out", **environment)

    def cached(self):
        return sorted(path.name for path in self.cache.glob("*"))

    def assert_refused(self, result, *words):
        self.assertEqual(result.returncode, 2, result.stderr)
        self.assertEqual(result.stdout, "")
        self.assertEqual(len(result.stderr.splitlines()), 1, result.stderr)
        for word in words:
            self.assertIn(word, result.stderr)
        self.assertEqual(self.cached(), [])
        self.assertFalse((self.tmp / "out").exists())

    def test_an_entry_is_downloaded_once_and_said(self):
        data = gzip.compress(self.entry("1abc").encode())
        server = self.serve(**{"1abc": content(data)})
        for asked in ("1ABC", "1abc", "https://www.rcsb.org/structure/1ABC", "pdb_00001abc"):
            result = self.prepare(asked, "--overwrite")
            self.assertEqual(result.returncode, 0, result.stderr)
            note, = (line for line in result.stderr.splitlines() if line.startswith("note: "))
            self.assertIn(str(self.cache / "1abc.cif.gz"), note)
            self.assertIn(f"({len(data) / 1e6:.2f} MB)", note)
            self.assertEqual("from the cache" not in note and server.base in note, asked == "1ABC", note)
        self.assertEqual(server.asked, ["/1abc.cif.gz"])
        self.assertEqual(self.cached(), ["1abc.cif.gz"])
        self.assertEqual((self.cache / "1abc.cif.gz").read_bytes(), data)
        # The same file is prepared that somebody has saved.
        saved = self.tmp / "1abc.cif.gz"
        saved.write_bytes(data)
        result = self.palpa("prepare", saved, "--no-scene", "--no-relax", "-o", self.tmp / "saved")
        self.assertEqual(result.returncode, 0, result.stderr)
        for name in ("system.crd", "system.psf"):
            self.assertEqual(*((self.tmp / folder / name).read_text() for folder in ("out", "saved")))

    def test_it_is_downloaded_again_on_request_and_kept_if_that_fails(self):
        server = self.serve(**{"1abc": packed(self.entry("1abc"))})
        self.assertEqual(self.prepare("1abc").returncode, 0)
        self.assertEqual(self.prepare("1abc", "--overwrite", "--again").returncode, 0)
        self.assertEqual(len(server.asked), 2)
        before = (self.cache / "1abc.cif.gz").read_bytes()
        self.serve(**{"1abc": status(500)})
        result = self.prepare("1abc", "--overwrite", "--again")
        self.assertEqual(result.returncode, 2)
        self.assertIn("answered 500", result.stderr)
        self.assertEqual((self.cache / "1abc.cif.gz").read_bytes(), before)
        self.assertEqual(self.cached(), ["1abc.cif.gz"])
        result = self.palpa("prepare", ROOT / "scenes" / "hairpin" / "none.pdb", "--again", "-o", self.tmp / "x")
        self.assertIn("--again: needs the code", result.stderr)

    def test_its_scene_is_named_after_it(self):
        self.serve(**{"1abc": packed(self.entry("1abc"))})
        result = self.palpa("prepare", "1abc", "-o", self.tmp / "out")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn('title = "1abc"', (self.tmp / "out" / "scene.toml").read_text())

    def test_a_plain_answer_and_json(self):
        self.serve(**{"1abc": content(self.entry("1abc").encode())})
        result = self.prepare("1abc", "--json")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertGreater(json.loads(result.stdout)["atoms"], 100)

    def test_redirects_are_followed_on_this_computer(self):
        server = self.serve(**{"1abc": redirect("second"), "second": redirect("third"), "third": redirect("fourth"),
                               "fourth": redirect("fifth"), "fifth": redirect("sixth"),
                               "sixth": packed(self.entry("1abc"))})
        result = self.prepare("1abc")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(len(server.asked), 6)
        self.assertEqual(self.cached(), ["1abc.cif.gz"])

    def test_redirects_elsewhere_and_without_end_are_refused(self):
        secret = self.tmp / "1abc.cif.gz"
        secret.write_bytes(gzip.compress(self.entry("3fil").encode()))
        server = self.serve(**{"1lop": redirect("1lop"), "3fil": redirect(secret.as_uri()),
                               "4oth": redirect("http://example.org/4oth.cif.gz"),
                               "4at0": redirect("http://127.0.0.1@example.org/4at0.cif.gz"),
                               "4ftp": redirect("ftp://127.0.0.1/4ftp.cif.gz")})
        for code, words in (("1lop", "leads on more than 5 times"), ("3fil", "leads to file:///"),
                            ("4oth", "leads to http://example.org/"), ("4at0", "leads to http://127.0.0.1@example.org/"),
                            ("4ftp", "leads to ftp://")):
            with self.subTest(code=code):
                self.assert_refused(self.prepare(code), f"{server.base}{code}.cif.gz: ", words)
        self.assertEqual(server.asked.count("/1lop.cif.gz"), 6)

    def test_wrong_answers_are_refused(self):
        good = gzip.compress(self.entry("6gz0").encode())
        server = self.serve(**{
            "2sta": status(500), "2bus": status(503), "2for": status(403),
            "3cut": content(CUT, 3500), "3unc": content(good[:len(good) // 2], False),
            "4len": content(b"\x1f\x8b", 10_000_000_000), "4end": endless,
            "6htm": content(b"<!DOCTYPE html><html>Not here</html>"), "6oth": packed(self.entry("2abc")),
            "6gar": content(b"\x1f\x8b\x08" + bytes(range(256)) * 9), "6non": content(b""),
            "6pdb": packed("HEADER    HYDROLASE\n"), "6emp": packed(self.entry("6emp").split("\n")[0] + "\n#\n")})
        for code, words in (("9non", "no such file (404); check the code"), ("2sta", "answered 500; try again later"),
                            ("2bus", "answered 503"), ("2for", "answered 403"), ("3cut", "was cut off after 3000 bytes"),
                            ("3unc", "is cut off"), ("4len", "is larger than 200 MB"), ("4end", "is larger than 200 MB"),
                            ("6htm", "is not the mmCIF file of 6htm; it begins with '<!DOCTYPE'"),
                            ("6oth", "begins with 'data_2ABC'"), ("6gar", "is damaged"),
                            ("6non", "is not the mmCIF file of 6non"), ("6pdb", "begins with 'HEADER'")):
            with self.subTest(code=code):
                self.assert_refused(self.prepare(code), f"{server.base}{code}.cif.gz: ", words)
        # An entry without atoms is one, which cannot be prepared.
        result = self.prepare("6emp")
        self.assertEqual(result.returncode, 2)
        self.assertIn("6emp.cif.gz", result.stderr.splitlines()[-1])

    def test_slow_answers_end(self):
        server = self.serve(1, **{"5sta": stalled(b"\x1f\x8b\x08"), "5nev": stalled(), "5dri": dripping})
        for code in ("5sta", "5nev", "5dri"):
            with self.subTest(code=code):
                self.assert_refused(self.prepare(code), f"{server.base}{code}.cif.gz: ",
                                    "less than 100 bytes a second came for 1 s; check the network")

    def test_without_a_network_it_says_so(self):
        with socket.create_server(("127.0.0.1", 0)) as closed:
            port = closed.getsockname()[1]
        self.prefer(f"http://127.0.0.1:{port}")
        self.assert_refused(self.prepare("1abc"), f"http://127.0.0.1:{port}/1abc.cif.gz: cannot be reached",
                            "check the network, or save the file with a browser")

    def test_only_https_is_asked(self):
        for base in ("http://example.org/", "ftp://example.org/", "example.org", "file:///folder/", ""):
            with self.subTest(base=base):
                self.prefer(base)
                self.assert_refused(self.prepare("1abc"), "expected an address with https://")
        (self.tmp / "config" / "palpa" / "preferences.toml").write_text("download_from = 3\n")
        self.assert_refused(self.prepare("1abc"), "preferences.toml:1:", "download_from is not text")

    def test_a_server_without_tls_is_not_trusted(self):
        server = self.serve(**{"1abc": packed(self.entry("1abc"))})
        self.prefer(server.base.replace("http:", "https:"))
        self.assert_refused(self.prepare("1abc", no_proxy="127.0.0.1"), "cannot be downloaded (")

    def test_a_certificate_that_nobody_has_signed_is_not_trusted(self):
        if not shutil.which("openssl"):
            self.skipTest("openssl is not installed")
        subprocess.run(["openssl", "req", "-x509", "-newkey", "rsa:2048", "-nodes", "-keyout", self.tmp / "key",
                        "-out", self.tmp / "certificate", "-subj", "/CN=localhost", "-addext",
                        "subjectAltName=DNS:localhost,IP:127.0.0.1"], check=True, capture_output=True)
        context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
        context.load_cert_chain(self.tmp / "certificate", self.tmp / "key")
        server = self.serve(**{"1abc": packed(self.entry("1abc"))})
        server.server.socket = context.wrap_socket(server.server.socket, server_side=True)
        self.prefer(server.base.replace("http:", "https:"))
        self.assert_refused(self.prepare("1abc", no_proxy="127.0.0.1"), "cannot be trusted (SSL peer certificate")
        self.assertEqual(server.asked, [])

    def test_nothing_but_a_persons_word_downloads(self):
        server = self.serve(**{"1abc": packed(self.entry("1abc"))})
        scene = self.tmp / "here" / "scene.toml"
        for structure in ("1abc", server.base + "1abc.cif.gz", "https://www.rcsb.org/structure/1ABC"):
            scene.write_text(f'title = "t"\n[molecules.a]\nstructure = "{structure}"\n[hand.grab]\nmolecule = "a"\n')
            for command in (("run", scene, "--headless"), ("run", scene, "--check"), ("render", scene, "-o", "x.png"),
                            ("prepare", scene, "-o", "x")):
                self.assertEqual(self.palpa(*command).returncode, 2, command)
        for command in (("run", "1abc", "--headless"), ("energy", "1abc"), ("run", "1abc.pdb"), ("1abc.cif",),
                        ("prepare", "1abc.cif", "-o", "x")):
            self.assertEqual(self.palpa(*command).returncode, 2, command)
        self.assertEqual(server.asked, [])

    def test_a_file_or_folder_of_that_name_comes_first_and_is_said(self):
        server = self.serve(**{"1abc": packed(self.entry("1abc"))})
        (self.tmp / "here" / "1abc").write_text(self.entry("1abc"))
        result = self.prepare("1abc")
        self.assertIn("note: 1abc is a file or folder here and is used", result.stderr)
        (self.tmp / "here" / "1abc").unlink()
        shutil.copytree(ROOT / "scenes" / "water", self.tmp / "here" / "1abc")
        result = self.palpa("1abc")
        self.assertIn("note: 1abc is a file or folder here and is used", result.stderr)
        self.assertIn("needs a display", result.stderr)
        self.assertEqual(server.asked, [])

    def test_alone_it_needs_a_display_and_asks_nothing_before(self):
        server = self.serve(**{"1abc": packed(self.entry("1abc"))})
        self.assert_refused(self.palpa("1abc"), "1abc: needs a display", "palpa prepare")
        self.assertEqual(server.asked, [])

    def test_what_is_interrupted_leaves_nothing(self):
        for sent in (signal.SIGINT, signal.SIGTERM, signal.SIGKILL):
            with self.subTest(signal=sent):
                server = self.serve(**{"5sta": stalled(b"\x1f\x8b\x08")})
                with subprocess.Popen([PROGRAM, "prepare", "5sta", "-o", self.tmp / "out"], env=self.env,
                                      cwd=self.tmp / "here", stdout=subprocess.PIPE, stderr=subprocess.PIPE) as running:
                    while not server.asked and running.poll() is None:
                        time.sleep(0.01)
                    running.send_signal(sent)
                    running.communicate()
                self.assertEqual(running.returncode, -sent)
                self.assertEqual(self.cached(), [])
                self.assertFalse((self.tmp / "out").exists())

    def test_without_libcurl_it_says_how_to_go_on(self):
        server = self.serve(**{"1abc": packed(self.entry("1abc"))})
        other = next(Path("/usr/lib").glob("*/libz.so.1"), None)  # a library without these functions
        if not other:
            self.skipTest("there is no libz.so.1 in /usr/lib")
        for name in ("libcurl.so", "libcurl.so.4", "libcurl-gnutls.so.4"):
            shutil.copyfile(other, self.tmp / name)
        self.assert_refused(self.prepare("1abc", LD_LIBRARY_PATH=str(self.tmp)), "libcurl is not installed",
                            "or save the file with a browser and open it")
        self.assertEqual(server.asked, [])
        said = self.palpa("--version", LD_LIBRARY_PATH=str(self.tmp)).stdout
        self.assertRegex(said, r"(?m)^libcurl    none: ")
        self.assertRegex(self.palpa("--version").stdout, r"(?m)^libcurl    \d+\.\d+\.\d+$")


if __name__ == "__main__":
    unittest.main()
