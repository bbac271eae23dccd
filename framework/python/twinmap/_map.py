"""Trained maps: from features or measurements to parameters."""
import functools
import html
import json
import math
import os
from typing import Any, Dict, List, Mapping, Optional, Tuple, Union

import numpy as np

from . import _twinmap
from ._arguments import PathLike, Points, choose_threads, list_columns, list_known, make_points
from ._recordings import Recording, list_trials
from ._tables import DataFrame, make_frame
from ._twinmap import Quantity

Measurement = Union[PathLike, DataFrame, Mapping[str, Any], np.ndarray]
_DRAWS = 512
_PROBABILITIES = [0.025, 0.16, 0.5, 0.84, 0.975]


class Posterior:
    """The posterior of p parameters given a measurement, without a normal approximation (docs/how-to/sample-the-posterior.md).

    `reliable`: whether its draws stand for the posterior; if not, `message` says why and there are no numbers but the
    diagnostics. `mean`, `stddev` (p): in the parameters' units. `quantiles`: a row for each of 0.025, 0.16, 0.5, 0.84
    and 0.975, a column for each parameter. `draws`: joint draws, a column for each parameter, the nuisance parameters
    too; `weights` (n): theirs, with the sum 1. `effective_sample_size`, `pareto_shape`: of the weights. `source`: what
    the likelihood is computed by, "simulator" or "surrogate".
    """

    def __init__(self, sampled: _twinmap.Posterior, names: List[str], unknown: List[str]) -> None:
        self.source: str = sampled.source
        self.message = sampled.message
        self.reliable = not sampled.message
        self.effective_sample_size = sampled.effective_sample_size
        self.pareto_shape = sampled.pareto_shape
        if self.reliable:
            self.mean: np.ndarray = sampled.mean
            self.stddev: np.ndarray = sampled.stddev
            self._quantiles: np.ndarray = sampled.quantiles
            self.quantiles = make_frame(dict(zip(names, self._quantiles.T)), _PROBABILITIES, "probability")
            self.draws = make_frame(dict(zip(unknown, sampled.draws.T)))
            self.weights: np.ndarray = sampled.weights

    @property
    def interval(self) -> np.ndarray:
        """Between the quantiles at 2.5 and 97.5 % (p, 2): lower and upper bound."""
        return self._quantiles[[0, -1]].T


class Estimate:
    """What is believed of p parameters after one measurement, and whether to trust it. NaN where nothing is.

    `names`, `units`: of the parameters. `mean`, `stddev` (p): in those units. `covariance` (p, p). `intervals95`,
    `intervals50`: for each parameter a list of intervals (lower, upper), several of a mixture where they lie apart.
    `statuses`: ["ok"], or what is to be said against the estimate, the most severe first (docs/explanation/trust.md); empty where the
    run has no trust model. `components`: where values that lie apart may fit, the weight, mean (p) and stddev (p) of each.
    `method`: "posterior" where it was sampled on the simulator, "refined" where the estimate was refined there and
    accepted, else the kind of the map: "gp", "surrogate" or "network". `posterior`: where it was asked for, or sampled
    because nothing less would do, else None.
    """

    def __init__(self, estimate: _twinmap.Estimate, map_: _twinmap.Map, parameters: List[Quantity]) -> None:
        self._estimate, self._map = estimate, map_
        self.names = [parameter.name for parameter in parameters]
        self.units = [parameter.unit for parameter in parameters]
        given, count = len(estimate.mean) > 0, len(parameters)
        nothing = [[(math.nan, math.nan)]] * count
        self.mean: np.ndarray = estimate.mean if given else np.full(count, math.nan)
        self.stddev: np.ndarray = estimate.stddev if given else np.full(count, math.nan)
        self.covariance: np.ndarray = estimate.covariance if given else np.full((count, count), math.nan)
        self.intervals95: List[List[Tuple[float, float]]] = estimate.intervals95 if given else nothing
        self.intervals50: List[List[Tuple[float, float]]] = estimate.intervals50 if given else nothing
        self.components: List[Tuple[float, np.ndarray, np.ndarray]] = estimate.components
        self.statuses: List[str] = estimate.statuses
        self.method: str = estimate.method
        self.posterior: Optional[Posterior] = None
        if estimate.posterior is not None:
            unknown = [parameter.name for parameter in map_.unknown]
            self.posterior = Posterior(estimate.posterior, self.names, unknown)

    @functools.cached_property
    def details(self) -> Dict[str, Any]:
        """All of it, as `twinmap infer --json` prints it."""
        return json.loads(self._map.write_json(self._estimate))

    @functools.cached_property
    def derived(self) -> DataFrame:
        """A row for each quantity that the experiment derives: unit, mean, stddev, lower, upper (of 95 %)."""
        found = self.details.get("derived", {})
        columns = {"unit": "unit", "mean": "mean", "stddev": "sd", "lower": "lower", "upper": "upper"}
        return make_frame(
            {column: [value[key] for value in found.values()] for column, key in columns.items()},
            list(found),
            "quantity",
        )

    @functools.cached_property
    def profiles(self) -> Dict[str, DataFrame]:
        """Profile likelihoods by parameter, where they were asked for: a row for each value that it is held at, with all
        parameters as they fit best there and `log_likelihood_ratio` to the best of all."""
        found = self.details.get("posterior", {}).get("profiles", {})
        return {
            name: make_frame({**one["parameters"], "log_likelihood_ratio": one["log_likelihood_ratio"]})
            for name, one in found.items()
        }

    @property
    def trust(self) -> Dict[str, Any]:
        """The numbers behind the statuses, as p_value and chi_square; empty where the run has no trust model."""
        return self.details.get("trust", {})

    @property
    def status(self) -> Optional[str]:
        """The most severe of the statuses; None where nobody has judged."""
        return self.statuses[0] if self.statuses else None

    @property
    def interval(self) -> np.ndarray:
        """The outermost bounds of the 95 % intervals (p, 2): lower and upper."""
        return np.array([(intervals[0][0], intervals[-1][1]) for intervals in self.intervals95])

    def to_frame(self) -> DataFrame:
        """A row for each parameter: unit, mean, stddev, lower, upper."""
        lower, upper = self.interval.T
        return make_frame(
            {"unit": self.units, "mean": self.mean, "stddev": self.stddev, "lower": lower, "upper": upper},
            self.names,
            "parameter",
        )

    def write_urdf(self, urdf: PathLike, out: PathLike, *, anyway: bool = False) -> None:
        """Writes the robot's file with what was estimated, all other bytes as they are, and values, sds, status and
        correlations beside it, as .json. anyway: also an estimate that is not ok, which raises ExperimentError else."""
        text, summary = _twinmap.update_urdf(os.fspath(urdf), self._map.write_json(self._estimate), anyway)
        for name, content in ((os.fspath(out), text), (os.path.splitext(os.fspath(out))[0] + ".json", summary)):
            with open(name, "w", encoding="utf-8", newline="") as file:
                file.write(content)

    def __getitem__(self, parameter: str) -> Tuple[float, float]:
        """Mean and standard deviation of one parameter or derived quantity."""
        if parameter in self.derived.index:
            return float(self.derived.loc[parameter, "mean"]), float(self.derived.loc[parameter, "stddev"])
        if parameter not in self.names:
            raise KeyError(f"{parameter}: the parameters are {', '.join(self.names)}")
        index = self.names.index(parameter)
        return float(self.mean[index]), float(self.stddev[index])

    def __repr__(self) -> str:
        return self._map.write_text(self._estimate).rstrip("\n")

    def _repr_html_(self) -> str:
        first_line = html.escape(repr(self).split("\n", 1)[0])
        return f"<p>{first_line}</p>{self.to_frame().to_html()}"


def infer(map_: _twinmap.Map, measurement: Measurement, request: _twinmap.InferRequest) -> Estimate:
    """By a map or an experiment alone (Map.infer)."""
    if isinstance(measurement, (DataFrame, Mapping)):
        estimate = map_.infer_columns(list_columns(measurement), request)
    elif isinstance(measurement, (str, os.PathLike)):
        estimate = map_.infer_file(os.fspath(measurement), request)
    else:
        estimate = map_.infer_features(np.asarray(measurement, dtype=float), request)
    return Estimate(estimate, map_, map_.parameters)


class Map:
    """A trained map, made ready for measurements. Immutable, for any number of threads at once."""

    def __init__(self, map_: _twinmap.Map) -> None:
        self._map = map_
        self._parameters: List[Quantity] = map_.parameters

    @staticmethod
    def load(path: PathLike) -> "Map":
        """Opens the folder of a finished run, or its maps.h5, which holds all that is needed."""
        return Map(_twinmap.Map.load(os.fspath(path)))

    @property
    def name(self) -> str:
        return self._map.name

    @property
    def parameters(self) -> List[Quantity]:
        """What is inferred: the columns of predict()'s results."""
        return list(self._parameters)

    @property
    def features(self) -> List[Quantity]:
        """The columns of predict()'s X."""
        return self._map.features

    @property
    def inputs(self) -> List[Quantity]:
        """Settings of the set-up that must be known with a measurement."""
        return self._map.inputs

    @property
    def outputs(self) -> List[Quantity]:
        """Signals that a measurement holds."""
        return self._map.outputs

    @property
    def residual_correlation(self) -> np.ndarray:
        """R (p, p): the correlation of the errors of one measurement's parameters, so that the covariance of a
        prediction is diag(stddev) R diag(stddev)."""
        return self._map.residual_correlation

    def to_yaml(self) -> str:
        """The experiment that the map was trained by."""
        return self._map.write_experiment()

    def predict(
        self, X: np.ndarray, return_std: bool = False, *, inputs: Optional[Points] = None, threads: int = 1
    ) -> Union[np.ndarray, Tuple[np.ndarray, np.ndarray]]:
        """The mean (n, p), and with return_std the standard deviation (n, p), for features X (n, d), like
        scikit-learn's regressors; in the parameters' units. The map alone: no status, no refinement.

        inputs: the known inputs (n, q), or a mapping from their names to values, where the map has any. The result does
        not depend on the number of threads. An X of float64 in C order is not copied.
        """
        array = np.asarray(X, dtype=float)
        known = np.empty((len(array), 0))
        if inputs is not None or self.inputs:
            known = self._spread(make_points({} if inputs is None else inputs, self.inputs, "inputs"), len(array))
        mean, stddev = self._map.predict(array, known, choose_threads(threads))
        return (mean, stddev) if return_std else mean

    @staticmethod
    def _spread(known: np.ndarray, count: int) -> np.ndarray:
        """One row of known inputs stands for all measurements."""
        return np.broadcast_to(known, (count, known.shape[1])) if len(known) == 1 else known

    def infer(
        self,
        measurement: Measurement,
        *,
        known: Optional[Mapping[str, float]] = None,
        start: Optional[float] = None,
        refine: Optional[bool] = None,
        posterior: Union[bool, int] = False,
        posterior_from: Optional[str] = None,
        profiles: bool = False,
    ) -> Estimate:
        """Infers the parameters of one measurement and judges the estimate.

        measurement: a file (CSV, MATLAB, HDF5); a DataFrame or mapping from columns to samples, named as in a file ("t",
        "enc1 [mm]"; a DataFrame's named index is a column as well); or an array (d) of features. known: values of the
        known inputs by name. start: the time in the measurement (s) that is the model's 0, instead of the
        experiment's. refine: on the simulator, or not; None: as the experiment says. posterior: the posterior as well;
        a number of draws instead of True's 512. posterior_from: "simulator" or "surrogate"; None: the simulator where
        that takes tenths of a second. profiles: profile likelihoods as well, on the simulator. Raises MeasurementError
        for a measurement that cannot be used.
        """
        if profiles and posterior_from == "surrogate":
            raise ValueError("profiles: are the simulator's: leave posterior_from out")
        posterior, posterior_from = (posterior or True, "simulator") if profiles else (posterior, posterior_from)
        if posterior_from is not None and posterior_from not in ("simulator", "surrogate"):
            raise ValueError(f"posterior_from: is 'simulator' or 'surrogate', not {posterior_from!r}")
        draws = _DRAWS if posterior is True or (not posterior and posterior_from) else int(posterior)
        request = _twinmap.InferRequest(list_known(known), start, refine, draws, posterior_from or "", profiles)
        return infer(self._map, measurement, request)

    def read_trials(self, recordings: Mapping[str, Recording]) -> np.ndarray:
        """The features (d) of a map that was trained on several trials, for infer() and predict().

        recordings: one of each trial, by its name: a file, DataFrame or mapping from columns to samples. Raises
        MeasurementError where one cannot be used or lacks samples, ExperimentError for an unknown trial.
        """
        return _twinmap.read_trials(self._map, list_trials(recordings))

    def __repr__(self) -> str:
        names = ", ".join(parameter.name for parameter in self._parameters)
        return f"<twinmap.Map '{self.name}': {len(self.features)} features to {names}>"
