"""A twin in time: a belief over the parameters that measurements update."""
import csv
import datetime
import io
import json
import os
from types import TracebackType
from typing import Any, Dict, Mapping, Optional, Sequence, Type, Union

import numpy as np

from . import _twinmap
from ._arguments import PathLike, list_known
from ._experiment import Experiment
from ._recordings import Recording
from ._tables import DataFrame, Table, make_frame_of_rows, read_csv

Time = Union[str, float, datetime.datetime]


def _write_cell(value: Any) -> str:
    """As a file has it: numbers read back as the same bits, times as ISO 8601."""
    if isinstance(value, np.datetime64):
        return np.datetime_as_string(value, unit="us")
    return repr(value.item()) if isinstance(value, np.generic) else str(value)


def _write_table(measurement: Union[DataFrame, Mapping[str, Any]]) -> str:
    if isinstance(measurement, DataFrame) and not isinstance(measurement, Table):
        return measurement.to_csv(index=measurement.index.name is not None, date_format="%Y-%m-%dT%H:%M:%S.%f%z")
    columns = {str(name): np.asarray(values) for name, values in measurement.items()}
    if len({len(values) for values in columns.values()}) > 1:
        raise ValueError("measurement: all columns must have as many samples")
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(columns)
    writer.writerows([_write_cell(value) for value in row] for row in zip(*columns.values()))
    return text.getvalue()


def _write_time(at: Optional[Time]) -> str:
    if at is None:
        return ""
    return at.isoformat() if isinstance(at, datetime.datetime) else str(at)


class Track:
    """A twin in time: each measurement updates a belief over the parameters (docs/how-to/track-a-machine.md).

    What infers, `run_or_experiment`, is the folder of a run, its maps.h5, an experiment file, or an Experiment. The belief is
    in the file `state`: begun by the first measurement, gone on with from then. One process at a time has it, until close()
    or the end of `with`. How parameters move is `tracking`: a file with a section `tracking`, or that section as a mapping.
    Left out, it is the experiment's own; without one all walk at unknown rates. Statuses in `use` let their measurements
    update although they do not by themselves. Known inputs have their values in `known`. As of Map.infer() is `refine`.
    A late measurement may be `lag` measurements back. Raises ExperimentError for what is wrong of these. Raises RuntimeError
    for a state file that is damaged, in use, or of another experiment.
    """

    def __init__(
        self,
        run_or_experiment: Union[PathLike, Experiment],
        state: PathLike,
        *,
        tracking: Union[PathLike, Mapping[str, Any], None] = None,
        use: Sequence[str] = (),
        known: Optional[Mapping[str, float]] = None,
        refine: Optional[bool] = None,
        lag: int = 100,
    ) -> None:
        text = json.dumps({"tracking": tracking}) if isinstance(tracking, Mapping) else ""
        file = "" if tracking is None or text else os.fspath(tracking)  # type: ignore[arg-type]
        request = _twinmap.TrackRequest(file, text, list(use), list_known(known), refine, lag)
        name = os.fspath(state)
        if isinstance(run_or_experiment, Experiment):
            self._track = _twinmap.Track.open_experiment(run_or_experiment._experiment, name, request)
        else:
            self._track = _twinmap.Track.open_run(os.fspath(run_or_experiment), name, request)

    def update(
        self,
        measurement: Recording,
        *,
        at: Optional[Time] = None,
        start: Optional[float] = None,
        trial: Optional[str] = None,
    ) -> Dict[str, Any]:
        """Infers a measurement and updates the belief by it: the answer of `twinmap track`, which is on the disk then.

        The measurement is as of Map.infer(). Its time is `at`, else by its table (`tracking.time`), else its number. The model's
        0 is at `start` in it (s). Which of the experiment's trials it records is `trial`. The same again is answered, not
        counted. Raises MeasurementError where it cannot be used: nothing has changed then.
        """
        when, of = _write_time(at), trial or ""
        if isinstance(measurement, (str, os.PathLike)):
            answer = self._track.update_file(os.fspath(measurement), when, start, of)
        else:
            answer = self._track.update_text(_write_table(measurement), "measurement", when, start, of)
        return json.loads(answer)

    @property
    def state(self) -> Dict[str, Any]:
        """The belief now, as the `track` of an answer has it, with the last alarms."""
        return json.loads(self._track.get_state())

    @property
    def parameters(self) -> DataFrame:
        """The belief now, a row for each parameter: unit, mean, stddev, lower, upper (of 95 %), walk. The last is how far it
        walks from one measurement to the next, a standard deviation."""
        found = self.state["parameters"]
        rows = [
            {
                "unit": one["unit"],
                "mean": one["mean"],
                "stddev": one["sd"],
                "lower": one["lower"],
                "upper": one["upper"],
                "walk": one["walk"]["sd"],
            }
            for one in found.values()
        ]
        return make_frame_of_rows(rows, ["unit", "mean", "stddev", "lower", "upper", "walk"], list(found), "parameter")

    @property
    def covariance(self) -> np.ndarray:
        """Of the parameters now (p, p)."""
        return np.array(self.state["covariance"])

    @property
    def alarms(self) -> DataFrame:
        """The last changes that were announced, a row each: announced, parameter, time, size, stddev, unit, probability, rivals.
        The parameter is None of several at once. Rivals explain it as well: a missing term, too."""
        rows = [
            {
                "announced": one["announced"],
                "parameter": one["parameter"],
                "time": one.get("time"),
                "size": one.get("size"),
                "stddev": one.get("sd"),
                "unit": one.get("unit"),
                "probability": one.get("probability"),
                "rivals": ", ".join(one.get("drift_or_model", {}).get("rivals", [])),
            }
            for one in self.state["alarms"]
        ]
        names = ["announced", "parameter", "time", "size", "stddev", "unit", "probability", "rivals"]
        return make_frame_of_rows(rows, names)

    @property
    def forecast(self) -> DataFrame:
        """When limits (`tracking.limits`) are crossed, a row each: parameter, side ("min", "max"), limit, median, lower, upper.
        The last three are of the time (95 %), where None is never."""
        rows = [
            {
                "parameter": one["parameter"],
                "side": "min" if "min" in one else "max",
                "limit": one.get("min", one.get("max")),
                "median": one["median"],
                "lower": one["lower"],
                "upper": one["upper"],
            }
            for one in self.state.get("forecast", [])
        ]
        return make_frame_of_rows(rows, ["parameter", "side", "limit", "median", "lower", "upper"])

    def history(self) -> DataFrame:
        """All measurements so far in the order of their times, a row for each and each parameter. What was believed then is mean,
        sd, lower, upper. What all of them say of that time is smoothed_mean, smoothed_sd, smoothed_lower, smoothed_upper.
        Beside them stand time, source, status, used, parameter, unit."""
        return read_csv(io.StringIO(self._track.make_history()))

    def write_page(self, path: PathLike) -> None:
        """The page of `twinmap track --page`: parameters over time, alarms, limits, forecast."""
        self._track.write_page(os.fspath(path))

    def close(self) -> None:
        """Lets go of the state file, for others."""
        self._track.close()

    def __enter__(self) -> "Track":
        return self

    def __exit__(
        self,
        kind: Optional[Type[BaseException]],
        error: Optional[BaseException],
        trace: Optional[TracebackType],
    ) -> None:
        self.close()

    def __repr__(self) -> str:
        state = self.state
        return (
            f"<twinmap.Track: {state['measurements']} measurements, {state['alarm_count']} alarms, {state['status']}>"
        )
