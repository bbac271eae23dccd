"""What a run left in its folder, as tables."""
import html
import json
import os
from pathlib import Path
from typing import Any, Dict, List, Optional


from ._arguments import PathLike
from ._map import Map
from ._tables import DataFrame, read_csv

# Tables that have a row for each of these are indexed by it.
_INDEXES = {"metrics": "parameter"}


class Results:
    """The folder of a finished run (docs/reference/files.md).

    Each of its CSV files is a DataFrame under the file's name: results.metrics, results.predictions, results.methods,
    results.tables["cross_validation"]. Files are read when asked for. In a notebook the report is shown.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self._read: Dict[str, DataFrame] = {}

    @staticmethod
    def load(folder: PathLike) -> "Results":
        """Raises FileNotFoundError where there is no folder of a finished run."""
        path = Path(folder)
        if not (path / "metrics.csv").is_file() and not (path / "sweep.csv").is_file():
            raise FileNotFoundError(f"{path}: is not a folder of a finished run: it has no metrics.csv")
        return Results(path)

    def list_tables(self) -> List[str]:
        """The names of the tables that there are."""
        return sorted(file.stem for file in self.folder.glob("*.csv"))

    def table(self, name: str) -> DataFrame:
        """The table of NAME.csv. Raises KeyError where the run has left none."""
        if name not in self._read:
            file = self.folder / f"{name}.csv"
            if not file.is_file():
                raise KeyError(f"{name}: this run has {', '.join(self.list_tables())}")
            self._read[name] = read_csv(file, _INDEXES.get(name))
        return self._read[name]

    def __getattr__(self, name: str) -> DataFrame:
        if name.startswith("_"):
            raise AttributeError(name)
        try:
            return self.table(name)
        except KeyError as error:
            raise AttributeError(error.args[0]) from None

    def __dir__(self) -> List[str]:
        return [*super().__dir__(), *self.list_tables()]

    @property
    def map(self) -> Map:
        """The trained map."""
        return Map.load(self.folder)

    @property
    def provenance(self) -> Dict[str, Any]:
        """Version, compiler, libraries, machine, threads, seed, command, warnings, times, digests."""
        return json.loads((self.folder / "provenance.json").read_text())

    @property
    def warnings(self) -> List[str]:
        """What to know before relying on the run, the most severe first."""
        return list(self.provenance["warnings"])

    @property
    def report(self) -> Path:
        """The report: one page for a browser."""
        return self.folder / "report.html"

    def to_markdown(self) -> str:
        """The main table, human-readable."""
        return (self.folder / "table.md").read_text()

    def _repr_html_(self) -> Optional[str]:
        if not self.report.is_file():
            return None
        page = html.escape(self.report.read_text(encoding="utf-8"), quote=True)
        return (
            f'<iframe srcdoc="{page}" title="{html.escape(os.fspath(self.folder))}" '
            'style="width: 100%; height: 80vh; border: 1px solid #ccc"></iframe>'
        )

    def __repr__(self) -> str:
        return f"<twinmap.Results '{self.folder}': {', '.join(self.list_tables())}>"
