"""Every shipped scene, small or not, has its picture in the gallery: python3 gallery.py ROOT, or --self-test."""

import pathlib
import re
import sys
import tempfile


def family(scene):
    """A scene and its small version are one."""
    return scene.removesuffix("-small")


def entries(script):
    """Name, scene, text of each line in the list of make.sh."""
    listed = re.search(r"^pictures\(\) \{\n    cat <<'TEXT'\n(.*?)^TEXT$", script, re.MULTILINE | re.DOTALL)
    rows = [line.split("|") for line in listed.group(1).splitlines()] if listed else []
    return [(row[0], row[1].split()[0], row[4]) for row in rows if len(row) == 5]


def faults(root):
    gallery = root / "docs" / "gallery"
    page, pictures = (gallery / "README.md").read_text(), entries((gallery / "make.sh").read_text())
    scenes = {file.relative_to(root / "scenes").with_suffix("").as_posix() for file in (root / "scenes").glob("*/*.toml")}
    shown = {family(scene) for _, scene, text in pictures if text}
    found = [f"scene {scene} has no picture" for scene in sorted({family(s) for s in scenes} - shown)]
    for name, scene, text in pictures:
        if scene not in scenes:
            found.append(f"picture {name}: there is no scene {scene}")
        if not (gallery / f"{name}.jpg").exists():
            found.append(f"picture {name} was not made")
        if text and f"]({name}.jpg)" not in page:
            found.append(f"picture {name} is not on the page")
    names = {f"{name}.jpg" for name, _, _ in pictures}
    found += [f"{file.name} is in no list" for file in sorted(gallery.glob("*.jpg")) if file.name not in names]
    return found


def self_test():
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        gallery = root / "docs" / "gallery"
        gallery.mkdir(parents=True)
        (root / "scenes" / "melp").mkdir(parents=True)
        (gallery / "make.sh").write_text("pictures() {\n    cat <<'TEXT'\na|melp/a-small|last||A\nb|melp/c --until 1|3||B\nTEXT\n}\n")
        (gallery / "README.md").write_text("![A](a.jpg)")
        for scene in ("a", "a-small", "d"):
            (root / "scenes" / "melp" / f"{scene}.toml").touch()
        for picture in ("a", "e"):
            (gallery / f"{picture}.jpg").touch()
        assert faults(root) == ["scene melp/d has no picture", "picture b: there is no scene melp/c", "picture b was not made",
                                "picture b is not on the page", "e.jpg is in no list"], faults(root)


if __name__ == "__main__":
    if sys.argv[1] == "--self-test":
        self_test()
    else:
        problems = faults(pathlib.Path(sys.argv[1]))
        print("\n".join(problems))
        sys.exit(1 if problems else 0)
