#!/usr/bin/env python3
"""Checks the documents: links between files lead somewhere, and every [Key] of a source is in docs/references.bib.

usage: doc_links.py SOURCE_TREE    one line per fault, exit code 1 if there are any
       doc_links.py --self-test    checks that it finds what it should
"""
import re
import sys
import tempfile
from pathlib import Path
from urllib.parse import unquote

LINK = re.compile(r"!?\[[^\]]*\]\(\s*<?([^)\s>]+)>?[^)]*\)")
IMAGE = re.compile(r'<img\s[^>]*src="([^"]+)"')
CITATION = re.compile(r"\[([A-Z][A-Za-z]+\d{2})(?:,[^\]]*)?\]")
SKIPPED = {"build", "runs", "node_modules", ".git", "data", "corpus"}  # the last two: malformed on purpose


def without_code(text):
    """The same lines with fenced blocks, `code` and <!-- comments --> blanked: what stands there is no link."""
    return re.sub(r"^```.*?^```|`[^`\n]+`|<!--.*?-->", lambda m: re.sub(r"[^\n]", " ", m.group()), text, flags=re.S | re.M)


def anchors(text):
    """The anchors that a page's headings get: lower case, spaces to dashes, punctuation dropped."""
    headings = re.findall(r"^#+\s+(.*)$", re.sub(r"^```.*?^```", "", text, flags=re.S | re.M), flags=re.M)
    return {re.sub(r"[^\w\- ]", "", heading.strip().lower()).replace(" ", "-") for heading in headings}


def files(tree, suffixes):
    for path in sorted(tree.rglob("*")):
        if path.suffix in suffixes and not SKIPPED & set(path.relative_to(tree).parts):
            yield path


def link_faults(tree):
    for page in files(tree, {".md"}):
        for number, line in enumerate(without_code(page.read_text(encoding="utf-8")).splitlines(), 1):
            for target in LINK.findall(line) + IMAGE.findall(line):
                if re.match(r"[a-z]+:", target):  # http:, mailto:
                    continue
                name, _, anchor = target.partition("#")
                file = page.parent / unquote(name) if name else page
                if not file.exists():
                    yield f"{page.relative_to(tree)}:{number}: {target} does not exist"
                elif anchor and file.suffix == ".md" and anchor not in anchors(file.read_text(encoding="utf-8")):
                    yield f"{page.relative_to(tree)}:{number}: {name or page.name} has no heading #{anchor}"


def citation_faults(tree):
    bibliography = tree / "docs" / "references.bib"
    known = set(re.findall(r"^@\w+\{(\w+),", bibliography.read_text(encoding="utf-8"), re.M)) if bibliography.exists() else set()
    for source in files(tree, {".md", ".h", ".cpp", ".cu", ".toml"}):
        for number, line in enumerate(source.read_text(encoding="utf-8").splitlines(), 1):
            for key in CITATION.findall(line):
                if key not in known:
                    yield f"{source.relative_to(tree)}:{number}: [{key}] is not in docs/references.bib"


def faults_of(tree):
    return list(link_faults(tree)) + list(citation_faults(tree))


def self_test():
    with tempfile.TemporaryDirectory() as folder:
        tree = Path(folder)
        (tree / "docs").mkdir()
        (tree / "docs" / "references.bib").write_text("@article{Known99,\n}\n", encoding="utf-8")
        (tree / "docs" / "a.md").write_text(
            "# A title, here\n[up](../b.md) [self](#a-title-here) [web](https://example.org) `[no](x.md)` [Known99]\n<!-- [no](z.md) -->\n"
            "```\n[code](y.md)\n```\n", encoding="utf-8")
        (tree / "b.md").write_text(
            "[gone](docs/gone.md)\n![picture](p.png)\n[heading](docs/a.md#nothing)\n[Unknown01, eq. 3]\n"
            "[fine](docs/a.md#a-title-here)\n<img width=\"9\" src=\"q.png\">\n", encoding="utf-8")
        found = faults_of(tree)
    expected = ["b.md:1:", "b.md:2:", "b.md:3:", "b.md:6:", "b.md:4:"]
    if [fault.split(" ")[0] for fault in found] != expected:
        return [f"expected faults at {expected}", *found]
    return []


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    faults = self_test() if sys.argv[1] == "--self-test" else faults_of(Path(sys.argv[1]))
    for fault in faults:
        print(fault)
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
