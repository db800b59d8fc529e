"""Films that lamella exports load in the Surface Evolver without a complaint and come to the reference area there."""

import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from program import lamella

AREA = 13.1281682444334  # three bubbles of volume 1
COMMANDS = "M 2\ng 20\nhessian\nhessian\nhessian\nprint total_area\nq\nq\n"


def main():
    if shutil.which("evolver") is None:
        print("skipped: there is no evolver (apt-get install evolver)")
        return 77
    with tempfile.TemporaryDirectory() as folder:
        run, film = Path(folder) / "run", Path(folder) / "triple.fe"
        for command in (("run", "equilibrium/triple-bubble-small", "--out", run),
                        ("export", run, "--to", "fe", "--frame", "last", "--out", film)):
            done = lamella(*command)
            if done.returncode != 0:
                sys.exit(done.stderr)
        result = subprocess.run(["evolver", str(film)], input=COMMANDS, capture_output=True, text=True, timeout=120)
        text = result.stdout + result.stderr
        if re.search(r"error|warning", text, re.IGNORECASE):
            sys.exit("evolver complains:\n" + text)
        area = float(re.findall(r"print total_area\s+([0-9.]+)", text)[-1])
        print(f"evolver: {area:.10f}, relative error {area / AREA - 1:.1e}")
        # A thousand quadratic facets: 4e-7.
        if abs(area / AREA - 1) > 2e-6:
            sys.exit(f"the area should be {AREA}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
