"""Types of the package; the modules have the documentation."""
from .errors import (DivergedError as DivergedError, EngineError as EngineError, InputError as InputError, Interrupted as Interrupted, RigorError as RigorError, RigorWarning as RigorWarning, UnsupportedError as UnsupportedError)
from .case import (Case as Case, load as load)
from .engines import (Engine as Engine, World as World)
from .motion import (Closeness as Closeness, Trajectory as Trajectory, close as close, trace as trace, truth as truth)
from .results import (Cell as Cell, Metric as Metric, Results as Results)
from .answers import (Conformance as Conformance, Diagnosis as Diagnosis, Divergence as Divergence, Printed as Printed, Repeats as Repeats, Tuned as Tuned)
from .fitted import (FitError as FitError, Fitted as Fitted, FittedValue as FittedValue)
from .runs import (Sweep as Sweep, command as command, conform as conform, diagnose as diagnose, diverge as diverge, fit as fit, gate as gate, repeat as repeat, run as run, sweep as sweep, tune as tune)
from .scene import (Body as Body, Scene as Scene)

__version__: str
