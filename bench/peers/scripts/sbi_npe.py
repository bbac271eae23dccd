"""sbi's neural posterior estimation on noisy simulations of twinmap; the setting is their number.

Documentation: tutorials 00 (getting started), 04 (density estimators) and 16 (implemented methods) of sbi 0.22: simulate from the prior,
append_simulations, train, build_posterior, sample. Tried: the default `maf` and `nsf`; the former is kept, as it trains in a fifth of the time.
"""
import signal
import sys
from pathlib import Path

import numpy as np
import torch
from sbi.inference import SNPE
from sbi.utils import BoxUniform

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from harness import Answer, Simulations, answer_each

COUNT = int(sys.argv[4])
#: Rejection outside of the prior can last for ever.
LONGEST = 120


def make_prior(case):
    return BoxUniform(torch.tensor(case.lower, dtype=torch.float32), torch.tensor(case.upper, dtype=torch.float32))


def prepare(case):
    torch.manual_seed(1)
    prior = make_prior(case)
    points = prior.sample((COUNT,))
    clean = Simulations(case)(points.double().numpy()) / case.sds()
    noisy = torch.tensor(clean + np.random.default_rng(1).standard_normal(clean.shape), dtype=torch.float32)
    inference = SNPE(prior, show_progress_bars=False)
    inference.append_simulations(points, noisy).train()
    return inference.build_posterior(), COUNT


def infer(case, machine, posterior):
    torch.manual_seed(machine)
    signal.alarm(LONGEST)
    observed = torch.tensor(case.read(machine) / case.sds(), dtype=torch.float32)
    draws = posterior.sample((2000,), x=observed, show_progress_bars=False).numpy()
    signal.alarm(0)
    return Answer.from_draws(draws.astype(float))


def give_up(*_):
    raise TimeoutError(f"no draws within the prior in {LONGEST} s")


if __name__ == "__main__":
    signal.signal(signal.SIGALRM, give_up)
    answer_each(prepare, infer)
