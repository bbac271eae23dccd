"""What users may give, brought to one form."""
import json
import os
from typing import Any, List, Mapping, Optional, Sequence, Tuple, Union

import numpy as np

from ._errors import ExperimentError
from ._tables import DataFrame, Table, make_frame_of_rows
from ._twinmap import Quantity, get_default_threads

PathLike = Union[str, "os.PathLike[str]"]
Points = Union[np.ndarray, DataFrame, Mapping[str, Any], Sequence[Any]]


def choose_threads(threads: Optional[int]) -> int:
    """All cores that this process may use, or OMP_NUM_THREADS, unless told otherwise."""
    if threads is None:
        return get_default_threads()
    if threads < 1:
        raise ValueError("threads: must be at least 1")
    return threads


def _write_value(value: Any) -> str:
    """As an override on the command line has it; JSON is YAML."""
    if isinstance(value, str):
        return value
    if isinstance(value, np.ndarray):
        value = value.tolist()
    elif isinstance(value, np.generic):
        value = value.item()
    return json.dumps(value)


def list_overrides(texts: Sequence[Union[str, Mapping[str, Any]]], keys: Mapping[str, Any]) -> List[str]:
    """ "key.path=value" for texts, mappings and keywords; in keywords "__" stands for "."."""
    overrides: List[str] = []
    for text in texts:
        if isinstance(text, str):
            overrides.append(text)
        else:
            overrides.extend(f"{key}={_write_value(value)}" for key, value in text.items())
    overrides.extend(f"{key.replace('__', '.')}={_write_value(value)}" for key, value in keys.items())
    return overrides


def _fill_columns(values: Mapping[str, Any], quantities: Sequence[Quantity], what: str) -> np.ndarray:
    names = [quantity.name for quantity in quantities]
    unknown = [name for name in values if name not in names]
    if unknown:
        raise ExperimentError(f"{what}: '{unknown[0]}' is none of {', '.join(names)}")
    columns = [
        np.atleast_1d(np.asarray(values[q.name], dtype=float))
        if q.name in values
        else np.array([0.5 * (q.lower + q.upper)])
        for q in quantities
    ]
    return np.column_stack(np.broadcast_arrays(*columns)) if columns else np.empty((1, 0))


def make_points(points: Points, quantities: Sequence[Quantity], what: str) -> np.ndarray:
    """An array (n, len(quantities)); of a mapping or DataFrame, what is not named is at the centre of its bounds."""
    if isinstance(points, DataFrame) and not isinstance(points, Table):
        points = {str(name): points[name].to_numpy() for name in points.columns}
    if isinstance(points, Mapping):
        return _fill_columns(points, quantities, what)
    array = np.asarray(points, dtype=float)
    return array[np.newaxis, :] if array.ndim == 1 else array


def list_columns(measurement: Union[DataFrame, Mapping[str, Any]]) -> List[Tuple[str, np.ndarray]]:
    """Name and values of each column of numbers; a DataFrame's index, where it has a name, is a column as well."""
    if isinstance(measurement, DataFrame) and not isinstance(measurement, Table):
        if measurement.index.name is not None:
            measurement = measurement.reset_index()
        measurement = measurement.select_dtypes("number")
        return [(str(name), measurement[name].to_numpy(dtype=float)) for name in measurement.columns]
    return [(str(name), np.asarray(values, dtype=float)) for name, values in measurement.items()]


def list_known(known: Optional[Mapping[str, float]]) -> List[Tuple[str, float]]:
    return [(name, float(value)) for name, value in (known or {}).items()]


def describe_quantities(quantities: Sequence[Quantity]) -> DataFrame:
    """A row for each."""
    columns = ["unit", "lower", "upper", "description"]
    rows = [{name: getattr(quantity, name) for name in columns} for quantity in quantities]
    return make_frame_of_rows(rows, columns, [quantity.name for quantity in quantities])
