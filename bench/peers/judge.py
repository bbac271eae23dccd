"""Figures of a cell: the answers of one peer about the machines of one case, beside the true values."""
import dataclasses
import json
import statistics

import numpy as np

#: An answer off by more of its own sds than chance leaves to one parameter in 16000.
FAR = 4
#: Machines of which errors are compared.
FEWEST = 5
#: The median of a normal error, in sds.
MEDIAN = 0.674490


@dataclasses.dataclass
class Cell:
    asked: int
    answered: int = 0
    #: Median of errors over that of a normal error at the limit; root mean square; median of stated sds over the limit.
    error: float = np.nan
    worst: float = np.nan
    sd: float = np.nan
    covered95: float = np.nan
    covered50: float = np.nan
    far: int = 0
    silent: int = 0
    warned: int = 0
    simulations: float = np.nan
    seconds: float = np.nan
    shared_simulations: int = 0
    shared_seconds: float = 0.0
    failures: list = dataclasses.field(default_factory=list)
    warnings: list = dataclasses.field(default_factory=list)


def holds(intervals, value):
    return any(lower <= value <= upper for lower, upper in intervals)


def read(file):
    """The answer of each machine, the first where there are two."""
    lines = [json.loads(line) for line in file.read_text().splitlines()] if file.exists() else []
    return list({line["machine"]: line for line in reversed(lines)}.values())[::-1]


def judge(lines, truths):
    answers = [line for line in lines if "mean" in line and np.all(np.isfinite(line["mean"]))]
    cell = Cell(asked=len(lines), answered=len(answers))
    cell.failures = [line.get("failed", "no finite answer") for line in lines if line not in answers]
    if not answers:
        return cell
    values, limits = (np.array([truths[one["machine"] - 1][key] for one in answers]) for key in ("values", "limits"))
    mean, sd = (np.array([one[key] for one in answers], dtype=float) for key in ("mean", "sd"))
    errors = np.abs(mean - values)
    is_far = np.any(errors > FAR * sd, axis=1)  # not where sd is infinite or NaN
    warned = np.array([bool(one["warnings"]) for one in answers])
    cell.error = np.median(errors / limits) / MEDIAN
    cell.worst = np.sqrt(np.mean((errors / limits) ** 2))
    cell.sd = np.median(np.where(np.isfinite(sd), sd, np.inf) / limits)
    for level in (95, 50):
        held = [
            holds(intervals, value)
            for one, truth in zip(answers, values)
            for intervals, value in zip(one[f"intervals{level}"], truth)
        ]
        setattr(cell, f"covered{level}", np.mean(held))
    cell.far, cell.silent, cell.warned = int(is_far.sum()), int((is_far & ~warned).sum()), int(warned.sum())
    cell.simulations = statistics.median(one["simulations"] for one in answers)
    cell.seconds = statistics.median(one["seconds"] for one in answers)
    cell.shared_simulations, cell.shared_seconds = lines[0]["shared_simulations"], lines[0]["shared_seconds"]
    cell.warnings = sorted({word.split("\n")[0] for one in answers for word in one["warnings"]})
    return cell


def list_better(lines, own_lines, truths):
    """In what a peer is plainly better than twinmap on the machines that both were asked about."""
    asked = {line["machine"] for line in lines} & {line["machine"] for line in own_lines}
    both = [[line for line in some if line["machine"] in asked] for some in (lines, own_lines)]
    better = compare(*[judge(some, truths) for some in both])
    return ["error", *better] if is_closer(*[calc_errors(some, truths) for some in both]) else better


def calc_errors(lines, truths):
    """Of each machine with an answer: errors over the limit, one a parameter."""
    answers = {one["machine"]: np.array(one["mean"], dtype=float) for one in lines if "mean" in one}
    known = {machine: [np.array(truths[machine - 1][key]) for key in ("values", "limits")] for machine in answers}
    return {machine: np.abs(mean - known[machine][0]) / known[machine][1] for machine, mean in answers.items()}


def is_closer(errors, own_errors):
    """Whether the median is a tenth less, and less in 39 of 40 resamples of the machines, of which few tell nothing."""
    machines = sorted(set(errors) & set(own_errors))
    if len(machines) < FEWEST:
        return False
    one, own = (np.array([some[machine] for machine in machines]) for some in (errors, own_errors))
    draws = np.random.default_rng(1).integers(0, len(machines), (1000, len(machines)))
    less = np.mean([np.median(one[draw]) < np.median(own[draw]) for draw in draws])
    return np.median(one) < 0.9 * np.median(own) and less >= 39 / 40


def compare(cell, own):
    if not cell.answered or not own.answered:
        return []
    better = []
    chance = 2 * np.sqrt(0.95 * 0.05 / own.answered)  # of machines, whose parameters hold or fail together
    if abs(cell.covered95 - 0.95) + chance < abs(own.covered95 - 0.95):
        better.append("coverage")
    if cell.silent < own.silent:
        better.append("silent")
    if cell.answered == cell.asked and own.answered < own.asked:
        better.append("answered")
    if cell.seconds < 0.8 * own.seconds:
        better.append("time")
    return better
