"""Runs the auxshell command as a process."""
import json
import os
import resource
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

AUXSHELL = os.environ["AUXSHELL"]
QUICK = bool(os.environ.get("AX_QUICK"))  # leave out what takes long: the build is slow
ROOT = Path(__file__).resolve().parent.parent.parent
SURFACES = ROOT / "examples/surfaces"


def run(*words, seconds=120, **options):
    """The finished process, with its output as text."""
    return subprocess.run([AUXSHELL, *map(str, words)], capture_output=True, text=True, timeout=seconds,
                          stdin=subprocess.DEVNULL, **options)


def run_measured(*words):
    """The finished process, and its wall time (s) and peak memory (bytes)."""
    code = ("import json, resource, subprocess, sys, time; start = time.monotonic();"
            "done = subprocess.run(sys.argv[1:], capture_output=True, text=True);"
            "print(json.dumps([done.returncode, done.stdout, done.stderr, time.monotonic() - start,"
            "resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss * 1024]))")
    output = subprocess.run([sys.executable, "-c", code, AUXSHELL, *map(str, words)], capture_output=True, check=True)
    code, out, error, seconds, memory = json.loads(output.stdout)
    return subprocess.CompletedProcess(words, code, out, error), seconds, memory


class CommandCase(unittest.TestCase):
    """Each test has an empty folder of its own, and says what the command said when it fails."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def succeed(self, *words, **options):
        done = run(*words, **options)
        self.assertEqual(done.returncode, 0, f"{words}\n{done.stdout}{done.stderr}")
        return done.stdout

    def refuse(self, code, word, *words, **options):
        """It ends with this code and a message on stderr that contains the word and names the command, and leaves no file."""
        before = self.files()
        done = run(*words, **options)
        self.assertEqual(done.returncode, code, f"{words}\n{done.stdout}{done.stderr}")
        self.assertIn(word.lower(), done.stderr.lower(), words)
        self.assertTrue(done.stderr.startswith("auxshell"), done.stderr)
        self.assertEqual(self.files(), before, words)
        return done

    def files(self):
        return sorted(str(path.relative_to(self.folder)) for path in self.folder.rglob("*"))


def with_file_size_limit(size):
    """For preexec_fn: no file can grow beyond this, as on a full disk."""
    return lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))
