"""Several recordings of one machine: what they say together, and what a model lacks to explain them."""
import json
import os
from typing import Any, Dict, List, Mapping, Optional, Sequence, Tuple, Union

import numpy as np

from . import _twinmap
from ._arguments import PathLike, list_columns, list_known
from ._tables import DataFrame, make_frame, make_frame_of_rows, make_series

Recording = Union[PathLike, DataFrame, Mapping[str, Any]]
_Columns = Optional[List[Tuple[str, np.ndarray]]]


def read_recording(recording: Recording, number: int) -> Tuple[str, _Columns]:
    """What it is called, and its columns unless it is a file."""
    if isinstance(recording, (str, os.PathLike)):
        return os.fspath(recording), None
    return f"recording {number}", list_columns(recording)


def list_recordings(recordings: Union[Recording, Sequence[Recording]]) -> List[Tuple[str, _Columns]]:
    """Of one recording or several."""
    if isinstance(recordings, (str, os.PathLike, DataFrame, Mapping)):
        recordings = [recordings]
    return [read_recording(recording, number) for number, recording in enumerate(recordings, start=1)]


def list_trials(
    recordings: Union[Sequence[Recording], Mapping[str, Union[Recording, Sequence[Recording]]]],
) -> List[Tuple[str, str, _Columns]]:
    """Trial, name and columns of each recording; the trial is "" where none is named."""
    if not isinstance(recordings, Mapping):
        return [("", name, columns) for name, columns in list_recordings(recordings)]
    return [(trial, name, columns) for trial, of in recordings.items() for name, columns in list_recordings(of)]


def _tabulate(parameters: Mapping[str, Mapping[str, Any]]) -> DataFrame:
    columns = {"unit": "unit", "mean": "mean", "stddev": "sd", "lower": "lower", "upper": "upper"}
    return make_frame(
        {column: [value.get(key) for value in parameters.values()] for column, key in columns.items()},
        list(parameters),
        "parameter",
    )


class JointEstimate:
    """What several recordings say of one machine.

    `statuses`: ["ok"], or what is to be said against the estimate, the most severe first. `agrees`, `p_value`: of the
    test whether the recordings agree; None where it was not made. `contradictions`: a row for each parameter in which
    two of them differ. `alone`: the status of each recording by itself. `draws`: joint draws, a column for each
    parameter; `weights` (n): theirs. `details`: all of it, as the JSON of `twinmap infer --joint` has it.
    """

    def __init__(self, text: str, table: str, draws: np.ndarray, weights: np.ndarray) -> None:
        self.details: Dict[str, Any] = json.loads(text)
        self._table = table
        self.statuses: List[str] = self.details["statuses"]
        agreement = self.details.get("agreement", {})
        self.agrees: Optional[bool] = agreement.get("agrees")
        self.p_value: Optional[float] = agreement.get("p_value")
        self.contradictions = make_frame_of_rows(
            agreement.get("contradictions", []), ["parameter", "first", "second", "distance"]
        )
        self.alone = make_series({trial["label"]: trial["status"] for trial in self.details["trials"]})
        names = list(self.details.get("parameters", {}))
        self.draws = make_frame(dict(zip(names, draws.T if len(draws) else np.empty((len(names), 0)))))
        self.weights = weights

    @property
    def status(self) -> str:
        """The most severe of the statuses."""
        return self.statuses[0]

    @property
    def covariance(self) -> np.ndarray:
        """Of the parameters (p, p); empty where there is no estimate."""
        return np.array(self.details.get("covariance", np.empty((0, 0))))

    def to_frame(self) -> DataFrame:
        """A row for each parameter: unit, mean, stddev, lower, upper; none where there is no estimate."""
        return _tabulate(self.details.get("parameters", {}))

    def __getitem__(self, parameter: str) -> Tuple[float, float]:
        """Mean and standard deviation of one parameter."""
        value = self.details["parameters"][parameter]
        return value["mean"], value["sd"]

    def __repr__(self) -> str:
        return self._table.rstrip("\n")


def infer_together(
    path: PathLike,
    recordings: Union[Sequence[Recording], Mapping[str, Union[Recording, Sequence[Recording]]]],
    *,
    starts: Sequence[float] = (),
    windows: Optional[float] = None,
    known: Optional[Mapping[str, float]] = None,
    draws: Optional[int] = None,
) -> JointEstimate:
    """One estimate from several recordings of one machine, by simulation alone (docs/how-to/combine-recordings.md).

    path: the experiment's file, with trials or without. recordings: files, DataFrames or mappings from columns to
    samples, as Map.infer() takes them; of a file with trials a mapping from their names to one or several. starts: times
    in each recording (s) that are the model's 0. windows: one every so many seconds over each recording. known: values of
    the known inputs. draws: a round; None: 512, and 256 of more than sixteen parameters. Raises MeasurementError for a
    recording that cannot be used, ExperimentError for an unknown trial.
    """
    found = _twinmap.infer_together(
        os.fspath(path), list_trials(recordings), list(starts), windows, list_known(known), draws
    )
    return JointEstimate(*found)


class Diagnosis:
    """What a model lacks to explain recordings.

    `terms`: those that were found, the first one first. `complete`: whether noise explains what is left. `corrected`: the
    YAML of the experiment with them, as Experiment.from_yaml() takes it. `details`: all of it, as
    `twinmap diagnose --json` prints it.
    """

    def __init__(self, text: str, table: str, corrected: str) -> None:
        self.details: Dict[str, Any] = json.loads(text)
        self._table, self.corrected = table, corrected
        self.terms: List[str] = self.details["found"]
        self.complete: bool = self.details["complete"]

    def to_frame(self) -> DataFrame:
        """A row for each candidate of each step: step, term, size, stddev, unit, z, log_evidence, share of the misfit."""
        columns = {"term": "term", "size": "size", "stddev": "sd", "unit": "unit", "z": "z"}
        columns.update({"log_evidence": "log_evidence", "share": "share"})
        rows = [
            {"step": number, **{column: candidate[key] for column, key in columns.items()}}
            for number, step in enumerate(self.details["steps"], start=1)
            for candidate in step["candidates"]
        ]
        return make_frame_of_rows(rows, ["step", *columns])

    def before(self) -> DataFrame:
        """The parameters by the model as it is: unit, mean, stddev, lower, upper."""
        return _tabulate(self.details["before"].get("parameters", {}))

    def after(self) -> DataFrame:
        """The parameters, and the sizes of the terms, by the corrected model."""
        return _tabulate(self.details["after"].get("parameters", {}))

    def __repr__(self) -> str:
        return self._table.rstrip("\n")


def diagnose(
    map_: _twinmap.Map,
    recordings: Union[Recording, Sequence[Recording]],
    starts: Sequence[float],
    known: Optional[Mapping[str, float]],
    accept: Sequence[str],
    page: Optional[PathLike],
) -> Diagnosis:
    """By a map or an experiment alone (Experiment.diagnose)."""
    found = _twinmap.diagnose(
        map_,
        list_recordings(recordings),
        list(starts),
        list_known(known),
        list(accept),
        os.fspath(page) if page is not None else "",
    )
    return Diagnosis(*found)
