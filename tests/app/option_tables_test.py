"""The option tables in the documents are those of the program.

With --update DOCUMENT...: writes the tables instead of checking them.
"""

import os
import pathlib
import re
import subprocess
import sys

# Between these lines; without a name the table is that of the document's own solver.
TABLE = re.compile(r"(<!-- options(?: (\S+))? -->\n).*?(<!-- /options -->)", re.DOTALL)


def with_table(document):
    """The text of a document, its option tables as `lamella explain` prints them now."""
    def now(match):
        topic = match.group(2) or document.stem
        table = subprocess.run([os.environ["LAMELLA"], "explain", "--markdown", topic], capture_output=True,
                               text=True, check=True).stdout
        return match.group(1) + table + match.group(3)

    text = document.read_text(encoding="utf-8")
    return text, TABLE.sub(now, text)


def main(arguments):
    update = "--update" in arguments
    stale = []
    for document in (pathlib.Path(a) for a in arguments if a != "--update"):
        now, wanted = with_table(document)
        if now == wanted:
            continue
        stale.append(document)
        if update:
            document.write_text(wanted, encoding="utf-8")
    for document in stale:
        print(f"{document}: {'updated' if update else 'the option table is stale'}")
    return 1 if stale and not update else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
