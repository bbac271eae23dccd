"""Tables: pandas' DataFrames where pandas is, else a small one that has the same face for what this package does."""
import csv
import html
import io
import os
from typing import TYPE_CHECKING, Any, Callable, Dict, Iterator, List, Mapping, Optional, Sequence, Tuple, Union

import numpy as np


class Table(Mapping[str, np.ndarray]):
    """Named columns of one length, and a name for each row. What stands for a DataFrame where pandas is not installed.

    `table["sd_pct"]`: a column (n). `table[["unit", "sd_pct"]]`: a table of some. `table.loc["k_y", "sd_pct"]`: a value.
    `columns`, `index`: the names. As a measurement it is a mapping from columns to samples.
    """

    def __init__(self, columns: Mapping[str, Any], index: Optional[Sequence[Any]] = None, index_name: str = "") -> None:
        self._values = {name: np.asarray(values) for name, values in columns.items()}
        rows = len(next(iter(self._values.values()))) if self._values else 0
        self.columns = list(self._values)
        self.index: List[Any] = list(range(rows)) if index is None else list(index)
        self._index_name = index_name

    def __getitem__(self, name: Any) -> Any:
        if isinstance(name, list):
            return Table({one: self._values[one] for one in name}, self.index, self._index_name)
        return self._values[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self.columns)

    def __len__(self) -> int:
        return len(self.columns)

    @property
    def loc(self) -> Dict[Tuple[Any, str], Any]:
        """The value of each (row, column)."""
        return {(row, name): of[i] for name, of in self._values.items() for i, row in enumerate(self.index)}

    def round(self, decimals: int = 0) -> "Table":
        """Numbers with so many decimals."""
        rounded = {k: np.round(v, decimals) if v.dtype.kind == "f" else v for k, v in self._values.items()}
        return Table(rounded, self.index, self._index_name)

    def to_csv(self, path: Union[str, "os.PathLike[str]"], index: bool = True) -> None:
        """Writes all of it, with a header; the names of rows as the first column, unless index is False."""
        with open(path, "w", encoding="utf-8", newline="") as file:
            rows = self._list_rows(repr)
            csv.writer(file).writerows(rows if index else [row[1:] for row in rows])

    def to_html(self) -> str:
        cells = ["".join(f"<td>{html.escape(cell)}</td>" for cell in row) for row in self._list_rows("{:.6g}".format)]
        return f"<table>{''.join(f'<tr>{row}</tr>' for row in cells)}</table>"

    _repr_html_ = to_html

    def __repr__(self) -> str:
        rows = self._list_rows("{:.6g}".format)
        widths = [max(map(len, column)) for column in zip(*rows)]
        return "\n".join("  ".join(cell.rjust(width) for cell, width in zip(row, widths)) for row in rows)

    def _list_rows(self, write: Callable[[float], str]) -> List[List[str]]:
        """The header and a row each, as text."""
        written = [
            [write(float(value)) if of.dtype.kind == "f" else str(value) for value in of]
            for of in self._values.values()
        ]
        header = [self._index_name, *self.columns]
        return [header, *([str(name), *cells] for name, *cells in zip(self.index, *written))]


if TYPE_CHECKING:
    from pandas import DataFrame
else:
    try:
        from pandas import DataFrame
    except ImportError:
        DataFrame = Table


def make_frame(
    columns: Mapping[str, Any], index: Optional[Sequence[Any]] = None, index_name: Optional[str] = None
) -> DataFrame:
    """Columns side by side, with a name for each row."""
    if DataFrame is Table:
        return DataFrame(columns, index, index_name or "")
    frame = DataFrame(dict(columns)) if index is None else DataFrame(dict(columns), index=list(index))
    frame.index.name = index_name
    return frame


def make_frame_of_rows(
    rows: Sequence[Mapping[str, Any]],
    columns: Sequence[str],
    index: Optional[Sequence[Any]] = None,
    index_name: Optional[str] = None,
) -> DataFrame:
    """A row each; None where a row lacks a column."""
    return make_frame({name: [row.get(name) for row in rows] for name in columns}, index, index_name)


def make_series(values: Mapping[str, Any]) -> Any:
    """A pandas Series of what is called so; where pandas is not, the mapping."""
    if DataFrame is Table:
        return dict(values)
    import pandas

    return pandas.Series(dict(values), dtype=object)


def _read_column(cells: Sequence[str]) -> np.ndarray:
    for kind in (int, float):
        try:
            return np.array([kind(cell) if cell else np.nan for cell in cells])
        except ValueError:
            continue
    return np.array(cells, dtype=object)


def read_csv(source: Union[str, "os.PathLike[str]", io.StringIO], index: Optional[str] = None) -> DataFrame:
    """A file, or a text, with a header; index: the column that names the rows."""
    if DataFrame is not Table:
        import pandas

        table = pandas.read_csv(source)
        return table.set_index(index) if index else table
    if isinstance(source, io.StringIO):
        header, *rows = list(csv.reader(source))
    else:
        with open(source, encoding="utf-8", newline="") as file:
            header, *rows = list(csv.reader(file))
    columns = {name: _read_column([row[i] for row in rows]) for i, name in enumerate(header)}
    names = list(columns.pop(index)) if index else None
    return make_frame(columns, names, index)
