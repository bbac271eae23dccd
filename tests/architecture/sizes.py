"""Checks that folders and functions keep a size that a reader can hold: 4 files or more, at most 50 lines.

And that the rooms that judge measurements do not grow by rules: 250 named numbers together. Who adds one finds another that
means the same, follows from others, or moves no row of bench/posterior_rows.py and bench/diagnosis.py.
"""
import json
import re
import subprocess
import sys
from pathlib import Path

LEAST_FILES, MOST_LINES, MOST_NUMBERS = 4, 50, 250
JUDGING = ("framework/estimation/", "framework/inference/", "framework/diagnosis/")
NAMED_NUMBER = re.compile(r"constexpr [^=]*\bk[A-Z]")
# An example to copy.
NOT_COUNTED = {"framework/c_api/example"}
NOT_FUNCTIONS = {"framework/export/runtime/fmi3.c"}  # ctags takes its macros for functions


def list_tracked(root):
    found = subprocess.run(["git", "ls-files", "framework", "kernels"], cwd=root, capture_output=True, text=True)
    if found.returncode == 0:
        return [Path(line) for line in found.stdout.splitlines() if (root / line).exists()]
    return [p.relative_to(root) for top in ("framework", "kernels") for p in (root / top).rglob("*") if p.is_file()]


def check_folders(files):
    own, inner = {}, set()
    for file in files:
        own.setdefault(file.parent, []).append(file)
        inner.update(file.parent.parents)
    for folder, found in sorted(own.items()):
        if str(folder) in NOT_COUNTED:
            continue
        if len(found) < LEAST_FILES and folder not in inner:
            yield f"{folder}: {len(found)} files, fewer than {LEAST_FILES}"


def check_functions(root, files):
    sources = [str(f) for f in files if f.suffix in (".cpp", ".hpp", ".c", ".h", ".py") and str(f) not in NOT_FUNCTIONS]
    tags = subprocess.run(
        [
            "ctags",
            "--output-format=json",
            "--fields=+ne",
            "--kinds-C=f",
            "--kinds-C++=f",
            "--kinds-Python=fm",
            "-f",
            "-",
            "-L",
            "-",
        ],
        cwd=root,
        input="\n".join(sources),
        capture_output=True,
        text=True,
        check=True,
    )
    count = 0
    for tag in map(json.loads, tags.stdout.splitlines()):
        count += 1
        lines = tag.get("end", tag["line"]) - tag["line"] + 1
        if lines > MOST_LINES:
            yield f"{tag['path']}:{tag['line']}: {tag['name']} has {lines} lines, more than {MOST_LINES}"
    if count < 1000:
        yield f"ctags found {count} functions only"


def check_numbers(root, files):
    judging = [root / f for f in files if str(f).startswith(JUDGING) and f.suffix in (".cpp", ".hpp")]
    count = sum(bool(NAMED_NUMBER.search(line)) for f in judging for line in f.read_text().splitlines())
    if count > MOST_NUMBERS:
        yield f"{count} named numbers in {', '.join(JUDGING)}: more than {MOST_NUMBERS}"


def main():
    root = Path(sys.argv[1]).resolve()
    files = list_tracked(root)
    errors = [*check_folders(files), *check_functions(root, files), *check_numbers(root, files)]
    print("\n".join(errors) or f"{len(files)} files are of a size that one can read.")
    sys.exit(bool(errors) or len(files) < 10)


if __name__ == "__main__":
    main()
