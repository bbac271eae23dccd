"""Checks that nothing includes itself by way of others: the folders within each folder, and the sources."""
import re
import sys
from pathlib import Path

INCLUDE = re.compile(r'^\s*#\s*include\s*"((?:framework|kernels)/[^"]+)"', re.MULTILINE)
OWN = "its own files"


def list_includes(root):
    """Pairs of files, the first of which includes the second."""
    for top in ("kernels", "framework"):
        for file in sorted((root / top).rglob("*")):
            if file.suffix in (".hpp", ".cpp", ".h", ".c"):
                for included in INCLUDE.findall(file.read_text()):
                    yield file.relative_to(root), Path(included)


def make_graph(pairs):
    graph = {}
    for a, b in pairs:
        graph.setdefault(a, set())
        graph.setdefault(b, set())
        if a != b:
            graph[a].add(b)
    return graph


def find_reached(graph, start):
    reached, waiting = set(), [start]
    while waiting:
        for node in graph[waiting.pop()] - reached:
            reached.add(node)
            waiting.append(node)
    return reached


def find_groups(graph):
    """Sets of nodes each of which reaches itself by way of all others: the strongly connected components."""
    reached = {node: find_reached(graph, node) for node in graph}
    groups = {frozenset(b for b in reached[a] if a in reached[b]) for a in graph}
    return sorted((group for group in groups if len(group) > 1), key=sorted)


def find_child(folder, file):
    parts = file.relative_to(folder).parts
    return parts[0] if len(parts) > 1 else OWN


def check_folder(folder, includes):
    inner = [(a, b) for a, b in includes if folder in a.parents and folder in b.parents]
    children = [(find_child(folder, a), find_child(folder, b)) for a, b in inner]
    for group in find_groups(make_graph(children)):
        yield f"{folder}: {', '.join(sorted(group))} include each other:"
        for (a, b), ends in zip(inner, children):
            if ends[0] != ends[1] and group.issuperset(ends):
                yield f"  {a} includes {b}"


def check_sources(includes):
    """A source and its header are one."""
    for group in find_groups(make_graph((a.with_suffix(""), b.with_suffix("")) for a, b in includes)):
        yield f"include each other: {', '.join(sorted(map(str, group)))}"


def main():
    includes = list(list_includes(Path(sys.argv[1]).resolve()))
    folders = sorted({folder for pair in includes for file in pair for folder in file.parents if folder.name})
    errors = [error for folder in folders for error in check_folder(folder, includes)]
    errors += check_sources(includes)
    print("\n".join(errors) or f"{len(folders)} folders and their sources have an order.")
    sys.exit(bool(errors) or len(folders) < 10)


if __name__ == "__main__":
    main()
