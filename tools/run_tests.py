#!/usr/bin/python3
"""Builds everything and runs every check and test; ./test calls it. Each step is a program that prints TAP, or one that
counts as a single test by its exit code. The last line is always `N passed, N failed`."""
import argparse
import concurrent.futures
import dataclasses
import os
import re
import subprocess
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
TESTS = ROOT / "tests"
CODE = ("include", "src", "cli", "reader", "tests", "tools", "bench", "fuzz")

PRESETS = ("release", "sanitize", "debug", "clang", "fuzz")  # warnings are errors in all of them
FUZZ_RUNS, FUZZ_SECONDS = 20000, 30  # always the same inputs; longer runs are started by hand
SECONDS = 1800  # for one step; each test that can hang has a limit of its own


@dataclasses.dataclass
class Step:
    name: str
    command: list
    needs: str = None  # the preset it runs from
    quick: bool = False  # leaves out what takes long
    passed: int = 0
    failed: int = 0
    skipped: list = dataclasses.field(default_factory=list)
    seconds: float = 0
    output: str = ""


def build_step(preset, steps):
    """Everything, so that every file compiles in it; of the fuzzers' build only what runs."""
    targets = " ".join(Path(step.command[0]).name for step in steps) if preset == "fuzz" else ""
    return Step(f"build/{preset}", ["bash", "-c", f'source "{ROOT}/tools/setup.sh" && build {preset} {targets}'])


def static_steps():
    sources = sorted(str(path) for folder in CODE for path in (ROOT / folder).rglob("*.[ch]"))
    return [
        Step("format", ["clang-format", "--dry-run", "-Werror", *sources]),
    ]


def fuzz_steps():
    return [
        Step(f"fuzz/{path.stem}", [str(ROOT / "build/fuzz/bin" / path.stem), "-seed=1", f"-runs={FUZZ_RUNS}",
                                   f"-max_total_time={FUZZ_SECONDS}", f"-artifact_prefix={ROOT}/build/fuzz/"], "fuzz")
        for path in sorted((ROOT / "fuzz").glob("fuzz_*.c"))
    ]


def test_steps():
    """Names come from the files, since the filter must work before anything is built."""
    programs = sorted(path.stem for path in TESTS.glob("test_*.c"))
    scripts = sorted(TESTS.glob("test_*.py"))
    steps = []
    for preset in ("release", "sanitize"):
        quick = preset == "sanitize"
        for name in programs:
            steps.append(Step(f"{preset}/{name}", [str(ROOT / "build" / preset / "bin" / name)], preset, quick))
    for script in scripts:
        text = script.read_text()
        if "AUXSHELL" not in text and "support.command" not in text:  # tests a script of the project, needs no build
            steps.append(Step(script.stem, [sys.executable, str(script)]))
            continue
        steps.append(Step(f"release/{script.stem}", [sys.executable, str(script)], "release"))
        if "QUICK" in text:
            steps.append(Step(f"sanitize/{script.stem}", [sys.executable, str(script)], "sanitize", True))
    return steps


def run(step):
    environment = dict(os.environ, CMOCKA_MESSAGE_OUTPUT="TAP", UBSAN_OPTIONS="print_stacktrace=1")
    if step.quick:
        environment["AX_QUICK"] = "1"
    if step.needs:
        environment["AUXSHELL"] = str(ROOT / "build" / step.needs / "bin" / "auxshell")
    start = time.monotonic()
    try:
        done = subprocess.run(step.command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL,
                              env=environment, timeout=SECONDS, cwd=ROOT)
        code, output = done.returncode, done.stdout
    except subprocess.TimeoutExpired as late:
        code, output = f"no end after {SECONDS} s", late.stdout or b""
    except OSError as reason:
        code, output = str(reason), b""
    step.seconds = time.monotonic() - start
    step.output = output.decode(errors="replace")
    count_results(step, code)
    return step


def count_results(step, code):
    plan = 0
    for line in step.output.splitlines():
        if match := re.match(r"1\.\.(\d+)", line):
            plan += int(match[1])
        elif match := re.match(r"(?:not )?ok \d+.*# SKIP\s*(.*)", line):  # cmocka prints a skipped test as "not ok"
            step.skipped.append(match[1])
        elif re.match(r"ok \d+", line):
            step.passed += 1
        elif re.match(r"not ok \d+", line):
            step.failed += 1
    missing = plan - step.passed - step.failed - len(step.skipped)
    if plan == 0 and code == 0:
        step.passed += 1
    elif missing or (code != 0 and not step.failed):
        step.failed += max(missing, 1)
        step.output += f"\n{step.name} ended with {code}"
        step.output += f" before {missing} of its {plan} tests\n" if missing else "\n"


def show(step, verbose):
    words = f"{step.passed} passed"
    if step.failed:
        words += f", {step.failed} FAILED"
    if step.skipped:
        words += f", {len(step.skipped)} skipped"
    print(f"{step.name:34} {words:28} {step.seconds:7.1f} s", flush=True)
    if step.failed or verbose:
        print("    " + step.output.rstrip().replace("\n", "\n    "), flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("-v", "--verbose", action="store_true", help="print the output of tests that pass, too")
    parser.add_argument("filter", nargs="?", default="", help="run only steps whose name contains this")
    arguments = parser.parse_args()

    wanted = [step for step in [*static_steps(), *test_steps(), *fuzz_steps()] if arguments.filter in step.name]
    named = {f"build/{preset}": preset for preset in PRESETS if arguments.filter in f"build/{preset}"}
    presets = [p for p in PRESETS if p in named.values() or any(step.needs == p for step in wanted)]
    finished = []

    def finish(step):
        show(step, arguments.verbose)
        finished.append(step)

    for preset in presets:
        finish(run(build_step(preset, [step for step in wanted if step.needs == preset])))
    # One at a time in the release build, where times are judged; side by side elsewhere.
    for step in wanted:
        if step.needs == "release" or not step.needs:
            finish(run(step))
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for step in pool.map(run, [step for step in wanted if step.needs and step.needs != "release"]):
            finish(step)

    passed, failed = sum(step.passed for step in finished), sum(step.failed for step in finished)
    if not finished:
        print(f"no test has \"{arguments.filter}\" in its name")
    print(f"{passed} passed, {failed} failed")
    return 1 if failed or not finished else 0


if __name__ == "__main__":
    sys.exit(main())
