"""Parameters of digital twins from measured responses: the batch-experiment framework twinmap in Python.

    import twinmap

    experiment = twinmap.Experiment.from_file("experiments/two_beam/best.yaml")
    results = experiment.run(progress=True)         # simulate, train, evaluate: results.metrics is a DataFrame
    map_ = twinmap.Map.load(results.folder)
    estimate = map_.infer("measured.csv")           # mean, stddev, interval, covariance, statuses

Arrays have a row for each sample: points are (n, parameters), features (n, d). All values are in the units that the
experiment states. Everything may be used from several threads at once; runs take turns.
"""
import os
import sys

from . import _twinmap
from ._errors import ExperimentError, MeasurementError
from ._experiment import Experiment, Responses, sweep
from ._map import Estimate, Map, Posterior
from ._recordings import Diagnosis, JointEstimate, infer_together
from ._results import Results
from ._track import Track
from ._twinmap import Progress, Quantity
from ._view import View

__version__ = _twinmap.__version__
__all__ = [
    "Diagnosis",
    "Experiment",
    "ExperimentError",
    "Estimate",
    "JointEstimate",
    "Map",
    "MeasurementError",
    "Posterior",
    "Progress",
    "Quantity",
    "Responses",
    "Results",
    "Track",
    "View",
    "infer_together",
    "sweep",
]

# FMUs are simulated in processes of their own, so that one that crashes takes nothing with it.
_WORKER = (
    "import importlib.util as util\n"
    "spec = util.spec_from_file_location('twinmap._twinmap', {path!r})\n"
    "module = util.module_from_spec(spec)\n"
    "spec.loader.exec_module(module)\n"
    "module.run_worker()\n"
)

if sys.executable:
    _twinmap.set_worker_program(sys.executable, ["-I", "-c", _WORKER.format(path=os.path.abspath(_twinmap.__file__))])
