"""Writes docs/benchmarks/peers.md from the answers of a store."""
import json

import real
import yaml
from cases import KINDS
from judge import judge, list_better, read
from peers import HERE, PEERS

OWN = "twinmap_infer"
HEAD = """# Beside what a user would take instead

Written by `bench/peers/run.py BUILD STORE --page docs/benchmarks/peers.md`; a call that was stopped goes on. Machines of a case are
drawn by seed, simulated by twinmap, and given to all as the same CSV files: 40, but ten of the arm, of profiles, of sbi, and where one takes a peer more than
ten seconds. `answers` says of how many machines a row is. Scripts are in `bench/peers/scripts`, models in `bench/peers/models`, explanations in
`bench/peers/remarks.yaml`.

Versions: {versions}. These answers took {hours:.1f} hours of a processor.

- **Error**: median of errors over the [information limit](../explanation/information-limit.md), 1 where it is reached; in brackets the root mean
  square, which one answer in the wrong place makes large. Priors count in the limit, uniform ones by their variance.
- **Sd**: median of the stated standard deviations over the limit.
- **95 %, 50 %**: share of true values that intervals hold.
- **Silent**: answers of which a parameter is off by more than four of its sds without a word of warning. **Warned**: answers with one.
- **Seconds**: of a processor, from the file to the answer, median; `+` what all machines of a case share (training). They were taken beside other
  work, and say less than simulations do.
- **Lines**: of model and script that the user writes, without comments. twinmap's are those of the YAML file and the commands.

## In short

Error over limit, coverage of 95 % intervals, silent wrong answers of those asked.

{overview}
"""


def count_lines(*files):
    text = [line.strip() for file in files for line in file.read_text().splitlines()]
    return sum(bool(line) and not line.startswith(("#", '"""', "import ", "from ")) for line in text)


def count_user_lines(peer, kind):
    """Model and script; the commands are twinmap's script."""
    model = peer.find_model(kind)
    if peer.script.startswith("twinmap"):
        return count_lines(model) + (1 if peer.name == OWN else 2)
    return count_lines(model, HERE / "scripts" / f"{peer.script}.py")


def show(value, digits=2):
    if value != value:
        return "-"
    if value == float("inf") or value > 9999:
        return "inf" if value == float("inf") else f"{value:.0e}"
    return f"{value:.{digits}f}" if value < 100 else f"{value:.0f}"


def show_silent(cell):
    return f"**{cell.silent}**" if cell.silent else "0"


def make_row(peer, kind, cell):
    answered = f"{cell.answered}" if cell.answered == cell.asked else f"{cell.answered} of {cell.asked}"
    seconds = show(cell.seconds) + (f" + {cell.shared_seconds:.0f}" if cell.shared_seconds >= 0.5 else "")
    simulations = f"{cell.simulations:.0f}" + (f" + {cell.shared_simulations}" if cell.shared_simulations else "")
    cells = [peer.title, answered, f"{show(cell.error)} ({show(cell.worst)})", show(cell.sd)]
    cells += [show(cell.covered95), show(cell.covered50), show_silent(cell), cell.warned, simulations, seconds]
    return f"| {' | '.join(map(str, cells))} | {count_user_lines(peer, kind)} |\n"


COLUMNS = ["peer", "answers", "error", "sd", "95 %", "50 %", "silent", "warned", "simulations", "seconds", "lines"]


class Page:
    def __init__(self, table):
        self.table = table
        self.remarks = yaml.safe_load((HERE / "remarks.yaml").read_text())
        self.cells, self.lines, self.truths = {}, {}, {}
        for kind in KINDS:
            truth = table.store / "cases" / kind.name / "truth.json"
            self.truths[kind.name] = json.loads(truth.read_text()) if truth.exists() else []
            for peer in PEERS:
                lines = read(table.store / "answers" / kind.name / f"{peer.name}.jsonl")
                if lines:
                    self.lines[kind.name, peer.name] = lines
                    self.cells[kind.name, peer.name] = judge(lines, self.truths[kind.name])

    def calc_hours(self):
        """Of a processor, of all answers; training once a case and peer."""
        alone = sum(line.get("seconds", 0) for lines in self.lines.values() for line in lines)
        return (alone + sum(lines[0]["shared_seconds"] for lines in self.lines.values())) / 3600

    def explain_empty(self, peer, kind):
        known = {**self.remarks["not run"], **self.remarks.get(kind.name, {}).get("not run", {})}
        lack = peer.explain_lack(kind) or self.table.environments.explain_lack(peer.environment)
        return lack or known.get(peer.name, known["any"])

    def make_overview(self):
        names = [kind.name for kind in KINDS]
        text = f"| peer | {' | '.join(names)} |\n|---|{'---|' * len(names)}\n"
        for peer in PEERS:
            row = []
            for name in names:
                cell = self.cells.get((name, peer.name))
                row.append(
                    f"{show(cell.error)}, {show(cell.covered95)}, {show_silent(cell)} of {cell.asked}" if cell else ""
                )
            text += f"| {peer.title} | {' | '.join(row)} |\n"
        return text

    def make_case(self, kind):
        text = f"## {kind.name}\n\n{kind.about[0].upper()}{kind.about[1:]}.\n\n"
        text += f"| {' | '.join(COLUMNS)} |\n|---|{'--:|' * (len(COLUMNS) - 1)}\n"
        lacking = {}
        for peer in PEERS:
            cell = self.cells.get((kind.name, peer.name))
            if cell and cell.answered:
                text += make_row(peer, kind, cell)
            elif not peer.only:
                why = cell.failures[0].split("\n")[0][:160] if cell else self.explain_empty(peer, kind)
                lacking.setdefault(why, []).append(peer.title)
        if lacking:
            text += "\nWithout an answer:\n\n" + "".join(f"- {why}: {'; '.join(who)}\n" for why, who in lacking.items())
        return text + self.make_counts(kind) + self.make_words(kind) + self.make_remarks(kind) + "\n"

    def make_counts(self, kind):
        """Where a store has fewer machines than the command asks about by default."""
        few = []
        for peer in PEERS:
            cell, wanted = self.cells.get((kind.name, peer.name)), peer.count_machines(kind)
            if cell and cell.asked < wanted:
                each = f", {cell.seconds:.0f} s each" if cell.seconds >= 5 else ""
                few.append(f"{peer.title} ({cell.asked} of {wanted}{each})")
        return f"\nFewer machines than a whole run asks about: {'; '.join(few)}.\n" if few else ""

    def make_words(self, kind):
        """What was said against answers."""
        said = []
        for peer in PEERS:
            cell = self.cells.get((kind.name, peer.name))
            if cell and cell.warnings:
                words = [f"`{word[:90].replace('|', '/')}`" for word in cell.warnings[:4]]
                said.append(f"{peer.title}: {', '.join(words)}" + (", ..." if len(cell.warnings) > 4 else ""))
        return f"\nWords of warning: {'; '.join(said)}.\n" if said else ""

    def make_remarks(self, kind):
        """Each cell in which a peer is better has its line, or says that it has none."""
        known, text = self.remarks.get(kind.name, {}), ""
        for peer in PEERS:
            lines, own = (self.lines.get((kind.name, name)) for name in (peer.name, peer.beside))
            if lines and own and not peer.name.startswith("twinmap"):
                better = list_better(lines, own, self.truths[kind.name])
                general = self.remarks["peers"].get(peer.name, known.get("any", "not explained yet"))
                why = known.get(peer.name, general)
                text += f"- {peer.title} is better in {', '.join(better)}: {why}\n" if better else ""
        if known.get("all"):
            text += f"- {known['all']}\n"
        return "\n" + text if text else ""


def make_real(store, remark):
    described = real.describe(store)
    return f"\n## Real machines\n\n{remark}\n\n{described}" if described else ""


def write_page(table):
    page = Page(table)
    versions = [one for name in ("plain", "torch", "figaroh") for one in table.environments.list_versions(name)]
    versions.insert(0, table.environments.get_twinmap_version())
    text = HEAD.format(versions=", ".join(versions), hours=page.calc_hours(), overview=page.make_overview())
    text += "\n" + "\n".join(page.make_case(kind) for kind in KINDS)
    return text + make_real(table.store, page.remarks["real"])
