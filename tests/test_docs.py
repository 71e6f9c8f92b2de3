#!/usr/bin/python3
"""Links in the documentation lead somewhere, and the index knows every page."""
import re
import subprocess
import unittest
from pathlib import Path

import support.tap

ROOT = Path(__file__).resolve().parent.parent
PAGES = [*ROOT.glob("*.md"), *(ROOT / "docs").rglob("*.md"), *(ROOT / "examples").rglob("*.md")]
LINK = re.compile(r"\[[^\]]*\]\(([^)\s]+)\)")


def anchors(text):
    """The names of headings as the usual viewers make them."""
    headings = re.findall(r"^#+ +(.+)$", text, re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


class Docs(unittest.TestCase):
    def test_links_lead_to_files_and_headings(self):
        for page in PAGES:
            for link in LINK.findall(page.read_text()):
                if re.match(r"[a-z]+:", link):
                    continue
                with self.subTest(page=page.name, link=link):
                    name, _, anchor = link.partition("#")
                    path = (page.parent / name).resolve() if name else page
                    self.assertTrue(path.exists())
                    if anchor:
                        self.assertIn(anchor, anchors(path.read_text()))

    def test_index_links_every_page(self):
        index = (ROOT / "docs/index.md").read_text()
        for page in (ROOT / "docs").glob("*.md"):
            if page.name != "index.md":
                self.assertIn(f"({page.name})", index)

    def test_readme_leads_to_the_rest(self):
        links = LINK.findall((ROOT / "README.md").read_text())
        for name in ("docs/index.md", "CHANGELOG.md", "CONTRIBUTING.md", "LICENSE"):
            self.assertIn(name, links)

    def test_pages_are_published_without_asking_another_host(self):
        done = subprocess.run([ROOT / "tools/site.sh"], capture_output=True, text=True, timeout=120)
        self.assertEqual(done.returncode, 0, done.stderr)
        site = ROOT / "build/docs/site"
        for page in (ROOT / "docs").glob("*.md"):
            text = (site / "docs" / f"{page.stem}.html").read_text()
            self.assertNotRegex(text, r'(?:src|rel="stylesheet" href)="(?:https?:)?//')
        self.assertIn("Auxshell", (site / "index.html").read_text())


if __name__ == "__main__":
    support.tap.main()
