"""What tests of scripts that make the inputs of a scene share."""
import os
import subprocess


def places(path):
    """The rows of a CRD file."""
    lines = [line for line in path.read_text().splitlines() if not line.startswith("*")]
    return [line.split() for line in lines[1:]]


def assert_same_atoms(test, made, committed, delta):
    """The same atoms in the same order, none farther than delta (A) along an axis."""
    for a, b in zip(places(made), places(committed), strict=True):
        test.assertEqual(a[:4] + a[7:9], b[:4] + b[7:9])
        for x, y in zip(a[4:7], b[4:7]):
            test.assertAlmostEqual(float(x), float(y), delta=delta, msg=a[:4])


def assert_explains_itself(test, script):
    """--help works without PALPA_DATA, and making does not."""
    kept = {key: value for key, value in os.environ.items() if key != "PALPA_DATA"}
    shown = subprocess.run([script, "--help"], capture_output=True, text=True, env=kept)
    test.assertEqual(shown.returncode, 0)
    test.assertIn("PALPA_DATA", shown.stdout)
    refused = subprocess.run([script], capture_output=True, text=True, env=kept)
    test.assertEqual(refused.returncode, 2)
    test.assertIn("PALPA_DATA is not set", refused.stderr)
