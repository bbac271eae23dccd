#!/usr/bin/env python3
"""Answers of twinmap and of what a user would take instead, on the same recordings, and the page that compares them.

Usage: bench/peers/run.py BUILD STORE [--peers A,B] [--cases A,B] [--machines N] [--jobs N] [--real FOLDER]
                          [--page docs/benchmarks/peers.md [--again OTHER]]

BUILD is a build of twinmap with its Python package (build/release). STORE, outside of the source tree, keeps environments,
recordings and answers (a line of JSON each): a call that was stopped goes on where it ended. --machines: at most so many of a
case, of 40 or, where one takes long, 10. --jobs: so many at a time, of a core each. --real: the recordings of the real
machines, as bench/real_machines.py takes them, which are not part of the project. --page writes the page from what
STORE has, and --only-page runs nothing. --again: the page says in what answers differ from those of the store OTHER, a second
run. Versions are pinned in bench/peers/requirements and printed.
"""
import argparse
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from pathlib import Path

import again
import real
from cases import KINDS, Maker
from environments import Environments
from page import write_page
from peers import HERE, PEERS


class Table:
    def __init__(self, arguments):
        self.build, self.store = arguments.build.resolve(), arguments.store.resolve()
        self.environments = Environments(self.store / "env", self.build)
        self.machines = arguments.machines
        sys.path.insert(0, str(self.build / "framework/python"))

    def prepare(self, kinds, peers):
        for name in dict.fromkeys(peer.environment for peer in peers):
            self.environments.make(name)
            versions = self.environments.list_versions(name)
            print(", ".join(versions) or self.environments.explain_lack(name), flush=True)
        for kind in kinds:
            folder = self.store / "cases" / kind.name
            Maker(kind, folder, self.build / "framework/cli/twinmap").make(min(self.machines, kind.machines))

    def answer(self, kind, peer):
        if peer.explain_lack(kind) or not self.environments.is_ready(peer.environment):
            return
        out = self.store / "answers" / kind.name / f"{peer.name}.jsonl"
        out.parent.mkdir(parents=True, exist_ok=True)
        machines = min(self.machines, peer.count_machines(kind))
        command = [
            self.environments.get_python(peer.environment),
            HERE / "scripts" / f"{peer.script}.py",
            self.store / "cases" / kind.name,
            out,
            machines,
            *peer.setting.split(),
        ]
        variables = self.environments.get_variables(peer.environment)
        done = subprocess.run(list(map(str, command)), env=variables, capture_output=True, text=True, cwd=self.store)
        lines = len(out.read_text().splitlines()) if out.exists() else 0
        print(f"{kind.name}: {peer.name}: {lines} of {machines}", flush=True)
        if done.returncode != 0:
            print(done.stderr[-3000:], flush=True)


def choose(values, names):
    wanted = names.split(",") if names else [one.name for one in values]
    unknown = set(wanted) - {one.name for one in values}
    if unknown:
        sys.exit(f"unknown: {', '.join(sorted(unknown))}; there are {', '.join(one.name for one in values)}")
    return [one for one in values if one.name in wanted]


def ask(table, kinds, peers, arguments):
    """So many jobs at a time; none waits for another."""
    jobs = [partial(table.answer, kind, peer) for peer in peers for kind in kinds]
    if arguments.real:
        jobs += [partial(real.measure, name, arguments.real, table.store, table.environments) for name in real.MACHINES]
    with ThreadPoolExecutor(arguments.jobs) as pool:
        list(pool.map(lambda job: job(), jobs))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=Path)
    parser.add_argument("store", type=Path)
    parser.add_argument("--peers", help="names, with commas; else all")
    parser.add_argument("--cases", help="names, with commas; else all")
    parser.add_argument("--machines", type=int, default=40)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--real", type=Path)
    parser.add_argument("--page", type=Path)
    parser.add_argument("--again", type=Path)
    parser.add_argument("--only-page", action="store_true", help="run nothing")
    arguments = parser.parse_args()
    kinds, peers = choose(KINDS, arguments.cases), choose(PEERS, arguments.peers)
    table = Table(arguments)
    if not arguments.only_page:
        table.prepare(kinds, peers)
        ask(table, kinds, peers, arguments)
    if arguments.page:
        text = write_page(table)
        text += again.describe(table.store, arguments.again.resolve()) if arguments.again else ""
        arguments.page.write_text(text)


if __name__ == "__main__":
    main()
