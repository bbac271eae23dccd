"""What the scripts of all peers share: a case as files, and answers as lines of JSON. It knows no peer and no true value.

A script calls answer_each(prepare, infer), is called as `script.py CASE OUT MACHINES [SETTING]`, and goes on where OUT ends.
prepare(case) is done once for all machines of a case (training), infer(case, recording, prepared) once a machine. Reading the
recording is part of the processor time of an answer; what loading Python's modules takes is not.
"""
import dataclasses
import json
import logging
import resource
import sys
import time
import warnings
from pathlib import Path

import numpy as np

#: Of a normal distribution.
SDS_95, SDS_50 = 1.959964, 0.674490


@dataclasses.dataclass
class Answer:
    """Of p parameters: mean and sd; intervals of each as lists of (lower, upper), else those of a normal distribution; what the
    peer says against its answer; and the simulations that it took."""

    mean: np.ndarray
    sd: np.ndarray
    intervals95: list = None
    intervals50: list = None
    warnings: list = dataclasses.field(default_factory=list)
    simulations: int = 0

    def write(self):
        mean, sd = np.asarray(self.mean, float), np.asarray(self.sd, float)
        normal = lambda width: [[[m - width * s, m + width * s]] for m, s in zip(mean, sd)]
        return {
            "mean": mean.tolist(),
            "sd": sd.tolist(),
            "intervals95": self.intervals95 or normal(SDS_95),
            "intervals50": self.intervals50 or normal(SDS_50),
            "warnings": list(dict.fromkeys(self.warnings)),
            "simulations": int(self.simulations),
        }

    @staticmethod
    def from_draws(draws, **rest):
        """Of equally weighted draws, a row each."""
        bounds = lambda tail: [[[a, b]] for a, b in np.quantile(draws, [tail, 1 - tail], axis=0).T]
        return Answer(draws.mean(axis=0), draws.std(axis=0, ddof=1), bounds(0.025), bounds(0.25), **rest)


class Case:
    """Parameters with bounds and, of some, normal priors; outputs with the sd of their noise (None: unknown) at times."""

    def __init__(self, folder):
        self.folder = Path(folder)
        self.__dict__.update(json.loads((self.folder / "case.json").read_text()))
        self.lower, self.upper = np.array(self.lower), np.array(self.upper)
        self.model = self.folder / "model.yaml"

    def files(self, machine):
        """The recording of each trial; one that is named None where there are none."""
        return {trial: self.folder / f"{machine}{'.' + trial if trial else ''}.csv" for trial in self.trials}

    def read(self, machine):
        """All samples: trial by trial, output by output."""
        tables = [np.loadtxt(file, delimiter=",", skiprows=1) for file in self.files(machine).values()]
        return np.concatenate([table[:, 1:].T.ravel() for table in tables])

    def sds(self):
        """Of the noise, as read() orders samples; 1 where it is unknown."""
        return np.tile(np.repeat([1.0 if sd is None else sd for sd in self.noise], len(self.times)), len(self.trials))

    def depart(self, x):
        """From the means of priors, in their sds; x has a parameter a row, and may have columns."""
        known = [i for i, prior in enumerate(self.priors) if prior]
        mean, sd = np.array([self.priors[i] for i in known]).reshape(-1, 2).T
        return ((x[known].T - mean) / sd).T

    def is_noise_known(self):
        return None not in self.noise


class Simulations:
    """twinmap's simulations of a case as a function of a point or of rows of points, which it counts."""

    def __init__(self, case):
        import twinmap

        self.trials = [twinmap.Experiment.from_file(case.model, trial=trial) for trial in case.trials]
        self.count, self.lower, self.upper = 0, case.lower, case.upper

    def __call__(self, points):
        rows = np.atleast_2d(points)
        self.count += len(rows)
        responses = np.hstack([trial.simulate(rows).rows for trial in self.trials])
        return responses if np.ndim(points) > 1 else responses[0]

    def differentiate(self, point):
        """Central differences, which least squares takes from one call; one-sided at a bound."""
        steps = 1e-5 * (self.upper - self.lower)
        ends = [np.clip(point + sign * np.diag(steps), self.lower, self.upper) for sign in (1, -1)]
        above, below = np.split(self(np.vstack(ends)), 2)
        return ((above - below) / np.diagonal(ends[0] - ends[1])[:, None]).T


class Ears(logging.Handler):
    """Hears what is said by warnings and loggers."""

    def __init__(self):
        super().__init__(logging.WARNING)
        self.heard = []

    def emit(self, record):
        self.heard.append(record.getMessage())


def calc_seconds():
    used = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    return sum(one.ru_utime + one.ru_stime for one in used)


def listen(act):
    """What it gives, seconds of a processor and of the clock, and what was said meanwhile."""
    ears = Ears()
    logging.getLogger().addHandler(ears)
    began, clock = calc_seconds(), time.perf_counter()
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        try:
            given = act()
        finally:
            logging.getLogger().removeHandler(ears)
    said = ears.heard + [str(one.message) for one in caught if not issubclass(one.category, (DeprecationWarning,))]
    return given, calc_seconds() - began, time.perf_counter() - clock, said


def answer_each(prepare, infer):
    case, out, machines = Case(sys.argv[1]), Path(sys.argv[2]), int(sys.argv[3])
    done = len(out.read_text().splitlines()) if out.exists() else 0
    if done >= machines:
        return
    (prepared, simulations), shared, _, _ = listen(lambda: prepare(case))
    for machine in range(done + 1, machines + 1):
        line = {"machine": machine, "shared_seconds": shared, "shared_simulations": simulations}
        try:
            answer, seconds, clock, said = listen(lambda: infer(case, machine, prepared))
            answer.warnings += said
            line.update(answer.write(), seconds=seconds, clock=clock)
        except Exception as error:  # a peer that fails is a result
            line["failed"] = f"{type(error).__name__}: {error}"
        with out.open("a") as stream:
            stream.write(json.dumps(line) + "\n")
