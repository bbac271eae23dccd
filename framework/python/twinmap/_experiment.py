"""Experiments: read, changed, simulated, run."""
import json
import os
import shlex
import warnings
from typing import Any, List, Mapping, Optional, Sequence, Tuple, Union

import numpy as np

from . import _twinmap
from ._arguments import PathLike, Points, choose_threads, list_known, list_overrides, make_points
from ._errors import ExperimentError
from ._map import Estimate, Measurement, infer
from ._progress import ProgressChoice, ProgressReport
from ._recordings import Diagnosis, Recording, diagnose, read_recording
from ._results import Results
from ._tables import DataFrame, make_frame, make_frame_of_rows, read_csv
from ._twinmap import Quantity
from ._view import View


class Responses:
    """What simulations gave, a row a sample. Arrays are views of `rows`: nothing is copied.

    `rows` (n, rows): all outputs at all times, output by output, then natural frequencies (Hz) and damping ratios;
    NaN where a sample failed. `ok` (n): which samples did not. `reasons`: why the others did, or "".
    `times` (T): s. `responses["y"]` (n, T): an output, in its unit.
    """

    def __init__(
        self, rows: np.ndarray, reasons: Sequence[str], times: np.ndarray, outputs: Sequence[Quantity], modes: int
    ) -> None:
        self.rows = rows
        self.reasons = list(reasons)
        self.ok = np.array([not reason for reason in reasons], dtype=bool)
        self.times = times
        self.outputs = [output.name for output in outputs]
        self._modes = modes

    def __len__(self) -> int:
        return len(self.rows)

    def __getitem__(self, output: str) -> np.ndarray:
        if output not in self.outputs:
            raise KeyError(f"{output}: the outputs are {', '.join(self.outputs)}")
        first = self.outputs.index(output) * len(self.times)
        return self.rows[:, first : first + len(self.times)]

    @property
    def frequencies(self) -> np.ndarray:
        """Natural frequencies (n, modes), Hz."""
        first = len(self.outputs) * len(self.times)
        return self.rows[:, first : first + self._modes]

    @property
    def damping_ratios(self) -> np.ndarray:
        """(n, modes)"""
        first = len(self.outputs) * len(self.times) + self._modes
        return self.rows[:, first : first + self._modes]

    def to_frame(self, sample: int = 0) -> DataFrame:
        """One sample as a measurement that Map.infer() takes: a column t (s), then one for each output."""
        return make_frame({"t": self.times, **{name: self[name][sample] for name in self.outputs}})

    def __repr__(self) -> str:
        failed = len(self) - int(self.ok.sum())
        return (
            f"<twinmap.Responses: {len(self)} of {', '.join(self.outputs)} at {len(self.times)} times, {failed} failed>"
        )


class Experiment:
    """An experiment file, with overrides. Immutable: override() gives another one."""

    def __init__(
        self, experiment: _twinmap.Experiment, source: Tuple[str, Optional[str]], overrides: List[str]
    ) -> None:
        self._experiment = experiment
        self._source = source  # the file's name, and the text where it is not a file
        self._overrides = overrides
        self._inferring: Optional[_twinmap.Map] = None  # made when first needed

    @staticmethod
    def from_file(path: PathLike, *, trial: Optional[str] = None) -> "Experiment":
        """Reads and checks a YAML file; of one with trials the one that is named. Raises ExperimentError for the first
        thing wrong."""
        return Experiment._make((os.fspath(path), None), Experiment._choose(trial))

    @staticmethod
    def from_yaml(text: str, source: str = "experiment.yaml", *, trial: Optional[str] = None) -> "Experiment":
        """The same from a text; `source` stands for the file, to which names of other files in it are relative."""
        return Experiment._make((source, text), Experiment._choose(trial))

    @staticmethod
    def from_urdf(
        path: PathLike,
        *,
        base: str = "fixed",
        parameters: Sequence[str] = (),
        joints: Sequence[str] = (),
        stops: bool = False,
        strict: bool = False,
    ) -> "Experiment":
        """The experiment that `twinmap import` makes of a robot (docs/how-to/bring-a-robot.md).

        base: "fixed", or "free" to let the first link fly. parameters: of "inertia", "friction", "armature", "damping".
        joints: that move, all if none is named. stops: at the joints' limits. What of the file is not carried over is a
        warning; strict: raises ExperimentError instead.
        """
        if base not in ("fixed", "free"):
            raise ValueError(f"base: is 'fixed' or 'free', not {base!r}")
        name = os.fspath(path)
        text, left_out = _twinmap.import_urdf(name, base == "free", list(parameters), list(joints), stops)
        if left_out and strict:
            raise ExperimentError(f"{name}: is not carried over as a whole: " + "; ".join(left_out), file=name)
        if left_out:
            warnings.warn("not carried over:\n" + "\n".join(left_out), stacklevel=2)
        return Experiment.from_yaml(text, os.path.basename(name) + ".yaml")

    @staticmethod
    def _choose(trial: Optional[str]) -> List[str]:
        return [] if trial is None else [f"trial={trial}"]

    @staticmethod
    def _make(source: Tuple[str, Optional[str]], overrides: List[str]) -> "Experiment":
        name, text = source
        made = (
            _twinmap.Experiment.load(name, overrides)
            if text is None
            else _twinmap.Experiment.parse(text, name, overrides)
        )
        return Experiment(made, source, overrides)

    def override(self, *overrides: Union[str, Mapping[str, Any]], **keys: Any) -> "Experiment":
        """The experiment with other values: override("noise.scale=2", {"design.train.samples": 100}, seed=3).

        In keywords "__" stands for the dot of a key path: noise__scale=2. Lists and ranges make a sweep:
        "seed=1..10". Raises ExperimentError, whose file is "command line".
        """
        return Experiment._make(self._source, self._overrides + list_overrides(overrides, keys))

    @property
    def name(self) -> str:
        return self._experiment.name

    @property
    def description(self) -> str:
        return self._experiment.description

    @property
    def seed(self) -> int:
        return self._experiment.seed

    @property
    def is_sweep(self) -> bool:
        return self._experiment.is_sweep

    @property
    def parameters(self) -> List[Quantity]:
        """The updating parameters, to be inferred: name, unit, bounds, description."""
        return self._experiment.parameters

    @property
    def sampled(self) -> List[Quantity]:
        """The columns of a point: the updating parameters, then nuisance parameters, then known inputs."""
        return self._experiment.sampled

    @property
    def inputs(self) -> List[Quantity]:
        """The known inputs of the set-up."""
        return self._experiment.inputs

    @property
    def outputs(self) -> List[Quantity]:
        return self._experiment.outputs

    @property
    def features(self) -> List[Quantity]:
        """The columns of extract()."""
        return self._experiment.features

    @property
    def times(self) -> np.ndarray:
        """At which simulate() gives the outputs, s; those of the features."""
        return self._experiment.times

    def to_yaml(self) -> str:
        """The experiment with all defaults written out, as `twinmap check` prints it."""
        return self._experiment.write_yaml()

    def simulate(
        self, points: Points, noise: bool = False, seed: Optional[int] = None, threads: Optional[int] = None
    ) -> Responses:
        """Simulates parameter points: an array (n, len(sampled)), or a mapping or DataFrame from names to values,
        where what is not named is at the centre of its bounds.

        noise: with the experiment's measurement noise, drawn by `seed` (the experiment's if None). A sample that fails
        is NaN and says why. The result does not depend on the number of threads (all cores,
        or OMP_NUM_THREADS, if None).
        """
        array = make_points(points, self.sampled, "points")
        rows, reasons = self._experiment.simulate(array, choose_threads(threads))
        if noise:
            rows = self._experiment.add_noise(rows, self.seed if seed is None else seed)
        return Responses(rows, reasons, self.times, self.outputs, self._experiment.modes)

    def extract(self, responses: Union[Responses, np.ndarray]) -> np.ndarray:
        """The features (n, d) of responses, which Map.predict() takes. NaN where a response has no such feature."""
        return self._experiment.extract(responses.rows if isinstance(responses, Responses) else responses)

    def view(self, values: Union[Estimate, Points, None] = None) -> View:
        """The mechanism, moving, as a notebook shows it: at the centre of the bounds ("nominal") and, beside that, at an
        estimate or values, as simulate() takes them."""
        points, names = make_points({}, self.sampled, "values"), ["nominal"]
        if isinstance(values, Estimate):
            values = dict(zip(values.names, values.mean))
        if values is not None:
            more = make_points(values, self.sampled, "values")
            points = np.vstack([points, more])
            names += ["updated"] if len(more) == 1 else [f"sample {i}" for i in range(len(more))]
        return View(*_twinmap.view(self._experiment, points, names))

    def infer(
        self,
        measurement: Measurement,
        *,
        known: Optional[Mapping[str, float]] = None,
        start: Optional[float] = None,
        draws: int = 512,
        profiles: bool = False,
    ) -> Estimate:
        """Infers the parameters of one measurement without a run: its posterior, sampled on the simulator
        (docs/how-to/sample-the-posterior.md), by so many draws a round. profiles: profile likelihoods as well.

        measurement, known, start: as Map.infer() takes them. Cost: some thousand simulations. Raises MeasurementError
        for a measurement that cannot be used, ExperimentError where a feature has no noise.
        """
        request = _twinmap.InferRequest(list_known(known), start, None, draws, "", profiles)
        return infer(self._get_inferring(), measurement, request)

    def infer_segments(
        self,
        recording: Recording,
        length: float,
        *,
        known: Optional[Mapping[str, float]] = None,
        start: Optional[float] = None,
        draws: int = 2048,
    ) -> Estimate:
        """Infers the parameters of a recording that is cut into segments of `length` s, each from an initial state of
        its own, with the excitation that the recording has (docs/how-to/combine-recordings.md): for what is unstable or
        chaotic.

        recording: a file (CSV, MATLAB, HDF5), or a DataFrame or mapping from columns to samples. known, start, draws,
        errors: as infer() has them. The posterior's draws are of the parameters alone.
        """
        if not length > 0.0:
            raise ValueError(f"length: must be above 0 (s), not {length!r}")
        request = _twinmap.InferRequest(list_known(known), start, None, draws, "", False)
        inferring = self._get_inferring()
        name, columns = read_recording(recording, 1)
        return Estimate(inferring.infer_segments(name, columns, length, request), inferring, inferring.parameters)

    def diagnose(
        self,
        recordings: Union[Recording, Sequence[Recording]],
        *,
        starts: Sequence[float] = (),
        known: Optional[Mapping[str, float]] = None,
        accept: Sequence[str] = (),
        page: Optional[PathLike] = None,
    ) -> Diagnosis:
        """Says what the model lacks to explain recordings (docs/how-to/find-what-a-model-lacks.md).

        recordings: one or several, as infer() takes them. starts: times in each (s) that are the model's 0. accept: terms
        to take whatever the tests say. page: file (HTML) for pictures of the residuals and the unknown forces. Cost: two
        posteriors, and one for each term that is tied. Raises MeasurementError and ExperimentError as infer() does.
        """
        return diagnose(self._get_inferring(), recordings, starts, known, accept, page)

    def find_blind_spots(self, *, known: Optional[Mapping[str, float]] = None) -> DataFrame:
        """Before any measurement: of each term that the model may lack its unit, the size that is noticed in 95 % of
        measurements (`noticed_from`), and by how many standard deviations it has moved each parameter by then."""
        spots = json.loads(_twinmap.find_blind_spots(self._get_inferring(), list_known(known))[0])["blind_spots"]
        rows = [
            {"unit": spot["unit"], "noticed_from": spot["noticed_from"], **spot.get("shifts", {})} for spot in spots
        ]
        columns = list(dict.fromkeys(name for row in rows for name in row))
        return make_frame_of_rows(rows, columns, [spot["term"] for spot in spots], "term")

    def _get_inferring(self) -> _twinmap.Map:
        if self._inferring is None:
            self._inferring = _twinmap.Map.of_experiment(self._experiment)
        return self._inferring

    def run(
        self,
        out: Optional[PathLike] = None,
        *,
        threads: Optional[int] = None,
        progress: ProgressChoice = False,
        store: Optional[PathLike] = None,
    ) -> Results:
        """Simulates, trains, evaluates and writes the folder `out` (results/NAME if None), as `twinmap run` does.

        A run that was interrupted continues, one that is complete is trained again from its stored simulations.
        progress: True for a line on stderr, or a function that takes a Progress. store: a folder of simulated samples
        that other runs share. Ctrl-C stops within about a second and raises KeyboardInterrupt; what was simulated is
        kept. Runs of one process take turns. Raises ExperimentError for a sweep (see sweep()) and for a folder that
        holds another experiment, RuntimeError where the run fails.
        """
        if self.is_sweep:
            raise ExperimentError(f"{self._source[0]}: is a sweep; twinmap.sweep() runs it", file=self._source[0])
        request = self._make_request(out, threads, store)
        with ProgressReport(progress) as callback:
            _twinmap.run(self._experiment, request, callback)
        return Results.load(request.folder)

    def _make_request(
        self, out: Optional[PathLike], threads: Optional[int], store: Optional[PathLike]
    ) -> _twinmap.RunRequest:
        request = _twinmap.RunRequest()
        request.folder = os.path.join("results", self.name) if out is None else os.fspath(out)
        request.store = "" if store is None else os.fspath(store)
        request.threads = choose_threads(threads)
        words = ["twinmap", "run", self._source[0], *self._overrides, "--out", request.folder]
        request.command = shlex.join(words)
        return request

    def _repr_html_(self) -> str:
        rows = "".join(
            f"<tr><td>{q.name}</td><td>{q.lower:g} .. {q.upper:g}</td><td>{q.unit}</td>"
            f"<td>{q.description}</td></tr>"
            for q in self.sampled
        )
        return (
            f"<b>{self.name}</b> {self.description}<table><tr><th>parameter</th><th>bounds</th><th>unit</th>"
            f"<th></th></tr>{rows}</table>"
        )

    def __repr__(self) -> str:
        return f"<twinmap.Experiment '{self.name}': {', '.join(q.name for q in self.parameters)}>"


def sweep(
    file: Union[PathLike, Experiment],
    *overrides: Union[str, Mapping[str, Any]],
    out: Optional[PathLike] = None,
    threads: Optional[int] = None,
    progress: ProgressChoice = False,
    store: Optional[PathLike] = None,
    memory: float = 0.0,
) -> DataFrame:
    """Runs a sweep, as `twinmap run` does, and gives its sweep.csv: a row for each case and parameter, with a column for
    each swept key, then those of Results.metrics.

    file: an experiment file, or an Experiment; overrides as of Experiment.override(). out: results/NAME if None; cases
    that are complete there are not run again. memory: GiB that cases may take together; 0: half of the machine's.
    Raises RuntimeError with the reasons of the cases that failed; the others are complete then.
    """
    experiment = file if isinstance(file, Experiment) else Experiment.from_file(file)
    experiment = experiment.override(*overrides) if overrides else experiment
    if not experiment.is_sweep:
        raise ExperimentError(f"{experiment.name}: sweeps nothing; Experiment.run() runs it")
    request = experiment._make_request(out, threads, store)
    request.memory = memory
    with ProgressReport(progress) as callback:
        cases, complete, failures = _twinmap.sweep(experiment._experiment, request, callback)
    if failures:
        reasons = "; ".join(f"{name}: {reason}" for name, reason in failures)
        raise RuntimeError(f"{len(failures)} of {cases} cases failed ({complete} are complete): {reasons}")
    return read_csv(os.path.join(request.folder, "sweep.csv"))
