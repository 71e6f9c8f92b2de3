"""Runs the unittest cases of the calling script and prints TAP, as the C tests do."""
import sys
import time
import unittest


class TapResult(unittest.TestResult):
    def __init__(self):
        super().__init__()
        self.number = 0

    def line(self, word, test, note=""):
        self.number += 1
        name = test.id().split(".", 1)[1] if test.id().startswith("__main__") else test.id()
        print(f"{word} {self.number} - {name}{note}  [{time.monotonic() - self.start:.1f} s]", flush=True)

    def startTest(self, test):
        super().startTest(test)
        self.start = time.monotonic()
        self.subtest_failed = False

    def addSuccess(self, test):
        self.line("ok", test)

    def addSkip(self, test, reason):
        if not hasattr(self, "start"):  # a whole class was skipped
            self.start = time.monotonic()
        self.line("ok", test, f" # SKIP {reason}")

    def fail(self, test, error):
        self.failures.append(test)
        self.line("not ok", test)
        print("# " + self._exc_info_to_string(error, test).rstrip().replace("\n", "\n# "), flush=True)

    def addFailure(self, test, error):
        self.fail(test, error)

    def addError(self, test, error):
        if not isinstance(test, unittest.TestCase):  # setUpClass or setUpModule broke: none of its tests ran
            self.start = time.monotonic()
        self.fail(test, error)

    def addSubTest(self, test, subtest, error):
        if error:
            self.failures.append(subtest)
            self.subtest_failed = True
            print(f"# in {subtest.id()}\n# " + self._exc_info_to_string(error, test).rstrip().replace("\n", "\n# "))

    def stopTest(self, test):
        super().stopTest(test)
        if self.subtest_failed:
            self.line("not ok", test)


def main():
    """The script's arguments, if any, are parts of the names of tests to run."""
    suite = unittest.defaultTestLoader.loadTestsFromModule(sys.modules["__main__"])
    tests = [test for group in suite for test in group]
    if sys.argv[1:]:
        tests = [test for test in tests if any(word in test.id() for word in sys.argv[1:])]
    result = TapResult()
    print(f"1..{len(tests)}")
    unittest.TestSuite(tests).run(result)
    sys.exit(0 if result.wasSuccessful() else 1)
