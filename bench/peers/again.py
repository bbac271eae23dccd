"""What a second run from nothing changes: answers in another store beside those of the first, machine by machine."""
import numpy as np
from cases import KINDS
from judge import read
from peers import PEERS

ANSWER = ["mean", "sd", "intervals95", "intervals50", "warnings", "simulations"]
HEAD = """
## A second run

Recordings and answers made again from nothing in another store, of the first {most} machines of a case. {recordings} of {files} recordings are the
same bytes. Same: all that an answer says but its seconds, bit for bit. Largest: difference of a mean, over its sd, and of an sd, relative.

| peer | answers | same | largest, of means | of sds |
|---|--:|--:|--:|--:|
"""


def pair(store, other, peer):
    """Answers of both stores about a machine."""
    for kind in KINDS:
        place = f"answers/{kind.name}/{peer.name}.jsonl"
        again = {line["machine"]: line for line in read(other / place)}
        yield from ((line, again[line["machine"]]) for line in read(store / place) if line["machine"] in again)


def is_same(one, two):
    return all(one.get(key) == two.get(key) for key in [*ANSWER, "failed"])


def calc_difference(one, two):
    mean, sd, mean_again, sd_again = (np.array(line[key], float) for line in (one, two) for key in ("mean", "sd"))
    known = np.isfinite(sd) & np.isfinite(sd_again)
    of_means = np.abs(mean - mean_again)[known] / sd[known]
    return max(of_means, default=0), max(np.abs(sd_again[known] / sd[known] - 1), default=0)


def make_row(peer, pairs):
    same = sum(is_same(*both) for both in pairs)
    differences = [calc_difference(*both) for both in pairs if all("mean" in line for line in both)]
    largest = [f"{max(column):.0e}" if max(column) else "0" for column in zip(*differences)] or ["-", "-"]
    return f"| {peer.title} | {len(pairs)} | {same} | {' | '.join(largest)} |\n"


def count_recordings(store, other):
    files = [file for kind in KINDS for file in sorted((other / "cases" / kind.name).glob("*.csv"))]
    firsts = [store / file.relative_to(other) for file in files]
    return sum(a.exists() and a.read_bytes() == b.read_bytes() for a, b in zip(firsts, files)), len(files)


def describe(store, other):
    rows, most = "", 0
    for peer in PEERS:
        pairs = list(pair(store, other, peer))
        most = max([most, *(line["machine"] for line, _ in pairs)])
        rows += make_row(peer, pairs) if pairs else ""
    recordings, files = count_recordings(store, other)
    return HEAD.format(most=most, recordings=recordings, files=files) + rows
