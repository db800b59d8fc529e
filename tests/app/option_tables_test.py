"""The option tables in the documents are those of the program.

With --update DOCUMENT...: writes the tables instead of checking them.
"""

import os
import pathlib
import subprocess
import sys

BEGIN, END = "<!-- options -->\n", "<!-- /options -->"


def with_table(document):
    """The text of a document, its option table as `lamella explain` prints it now."""
    text = document.read_text(encoding="utf-8")
    before, _, rest = text.partition(BEGIN)
    _, _, after = rest.partition(END)
    table = subprocess.run([os.environ["LAMELLA"], "explain", "--markdown", document.stem], capture_output=True,
                           text=True, check=True).stdout
    return text, before + BEGIN + table + END + after


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
