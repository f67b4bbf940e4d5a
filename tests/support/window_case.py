"""A test case with a program in a window, and a folder of its own."""
import shutil
import time
import unittest


class WindowCase(unittest.TestCase):
    def tearDown(self):
        if self.program.poll() is None:
            self.program.kill()
            self.program.communicate()
        shutil.rmtree(self.folder)

    def wait_until(self, is_so, what):
        """However long it takes: ctest ends what never comes."""
        while not is_so():
            self.assertIsNone(self.program.poll(), "the program ended early, waiting for " + what)
            time.sleep(0.02)
