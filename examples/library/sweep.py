#!/usr/bin/env python3
"""Designs one surface with several numbers of panels and loads, and prints what comes of each as CSV.

usage: sweep.py SURFACE   (auxshell in PATH, or its path in AUXSHELL)"""
import csv
import json
import os
import subprocess
import sys
import tempfile

FIGURES = ("edge_mean", "mouth_min_deg", "simulated_rms_over_L", "hinge_force_max", "seconds_total")


def auxshell(*words):
    """The exit code, what was printed, and the message if it failed."""
    done = subprocess.run([os.environ.get("AUXSHELL", "auxshell"), *map(str, words)], capture_output=True, text=True)
    return done.returncode, done.stdout, done.stderr.strip()


def main(surface):
    code, text, message = auxshell("check", surface, "--json")
    if code not in (0, 4):  # 4: it cannot deploy, and the JSON says why
        sys.exit(message)
    screen = json.loads(text)
    print(screen["words"], file=sys.stderr)
    if code == 4:
        sys.exit(code)
    table = csv.writer(sys.stdout)
    table.writerow(("load", "panels", *FIGURES))
    with tempfile.TemporaryDirectory() as folder:
        document = os.path.join(folder, "design.auxshell")
        for load in ("inflation", "gravity"):
            for count in (200, 400, 800):
                code, _, message = auxshell("design", surface, "-o", document, "--triangles", count, "--load", load, "--project")
                if code != 0:
                    print(f"{load}, {count} panels: {message}", file=sys.stderr)
                    continue
                info = json.loads(auxshell("info", document, "--json")[1])
                table.writerow((load, info["triangles"], *(info["report"][key] for key in FIGURES)))


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main(sys.argv[1])
