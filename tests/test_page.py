"""The studio's page: what needs no browser, then a user's work in Chromium against the real server. Both print TAP."""
import os
import subprocess
import sys

from support.command import AUXSHELL, ROOT

PAGE = ROOT / "build/studio"  # tools/build_page.sh installs here what the page's lock file names


def main():
    subprocess.run([ROOT / "tools/build_page.sh"], check=True, stdout=sys.stderr)
    environment = dict(os.environ, AUXSHELL=AUXSHELL, AUXSHELL_ROOT=str(ROOT), NO_COLOR="1")
    commands = [["npx", "--no-install", "vitest", "run", "--reporter=tap-flat"], ["node", "e2e/run.mjs", *sys.argv[1:]]]
    codes = [subprocess.run(command, cwd=PAGE, env=environment, stdin=subprocess.DEVNULL).returncode for command in commands]
    return max(codes)


if __name__ == "__main__":
    sys.exit(main())
