"""GPyTorch's exact Gaussian processes as a map: one a parameter, on 250 noisy simulations of twinmap.

Documentation: the regression tutorial (ExactGP, ScaleKernel of RBFKernel, Adam with a rate of 0.1 on the exact marginal likelihood).
Tried: the tutorial's 50 steps and 300, the latter are kept. Features are those of sklearn_map.py.
"""
import sys
from pathlib import Path

import gpytorch
import numpy as np
import torch

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from harness import Answer, Simulations, answer_each

SAMPLES, COMPONENTS, STEPS = 250, 10, 300


class Process(gpytorch.models.ExactGP):
    def __init__(self, inputs, outputs, likelihood):
        super().__init__(inputs, outputs, likelihood)
        self.mean_module = gpytorch.means.ConstantMean()
        self.covar_module = gpytorch.kernels.ScaleKernel(gpytorch.kernels.RBFKernel(ard_num_dims=COMPONENTS))

    def forward(self, x):
        return gpytorch.distributions.MultivariateNormal(self.mean_module(x), self.covar_module(x))


def train(inputs, outputs):
    likelihood = gpytorch.likelihoods.GaussianLikelihood(noise_constraint=gpytorch.constraints.GreaterThan(1e-6))
    process = Process(inputs, outputs, likelihood)
    likelihood_of_data = gpytorch.mlls.ExactMarginalLogLikelihood(likelihood, process)
    process.train(), likelihood.train()
    optimizer = torch.optim.Adam(process.parameters(), lr=0.1)
    for _ in range(STEPS):
        optimizer.zero_grad()
        loss = -likelihood_of_data(process(inputs), outputs)
        loss.backward()
        optimizer.step()
    process.eval(), likelihood.eval()
    return lambda x: likelihood(process(x))


def prepare(case):
    torch.manual_seed(1)
    points = torch.quasirandom.SobolEngine(len(case.lower), scramble=True, seed=1).draw(SAMPLES).double().numpy()
    clean = Simulations(case)(case.lower + (case.upper - case.lower) * points) / case.sds()
    noisy = clean + np.random.default_rng(1).standard_normal(clean.shape)
    center = noisy.mean(axis=0)
    axes = np.linalg.svd(noisy - center, full_matrices=False)[2][:COMPONENTS].T
    scale = ((noisy - center) @ axes).std(axis=0)
    reduce = lambda rows: torch.tensor((rows - center) @ axes / scale)
    middle, spread = points.mean(axis=0), points.std(axis=0)
    maps = [train(reduce(noisy), torch.tensor(column)) for column in ((points - middle) / spread).T]
    return (reduce, maps, middle, spread), SAMPLES


def infer(case, machine, prepared):
    reduce, maps, middle, spread = prepared
    with torch.no_grad():
        found = [one(reduce((case.read(machine) / case.sds())[None])) for one in maps]
    widths = case.upper - case.lower
    mean = case.lower + widths * (middle + spread * np.array([one.mean.item() for one in found]))
    return Answer(mean, widths * spread * np.array([one.stddev.item() for one in found]))


if __name__ == "__main__":
    torch.set_default_dtype(torch.float64)
    answer_each(prepare, infer)
