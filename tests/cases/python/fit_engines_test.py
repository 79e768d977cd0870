"""`fit` of engines that are classes. Each set of values starts the engine anew, so these take longest."""
import pytest
from free_bodies import FreeBodies, broken

import rigor

BOTH = pytest.mark.parametrize("in_process", [False, True], ids=["own-process", "in-process"])


class Falls(FreeBodies):
    name = "falls"


@BOTH
def test_an_engine_of_ones_own_is_fitted(fall, in_process):
    """Semi-implicit Euler falls (n + 1) / n times as far in n steps, so less gravity fits best: less than the case's 10 m/s^2."""
    with open(fall, encoding="utf-8") as file:
        case = rigor.Case.from_toml(file.read(), name="fall").replace(**{"run.duration": 0.5, "run.dt": ["1/10"]})
    words = {"vary": {"scene.gravity[2]": (-12, -6)}, "progress": False}
    mine, core = (rigor.fit(case, engine=engine, in_process=in_process, **words) for engine in (Falls, "core:semi-implicit-euler"))
    assert mine and mine.engine == "falls" and mine.json["cases"] == [{"case": "fall", "dt": "1/10"}]
    assert mine["scene.gravity[2]"].unit == "m/s²" and -10 < mine["scene.gravity[2]"] < -7
    # Both move alike but for roundings, and the search ends within 1e-4 of the range of 6 m/s^2.
    assert mine["scene.gravity[2]"] == pytest.approx(core["scene.gravity[2]"], abs=6e-4)


@BOTH
def test_an_engine_that_fails_is_not_fitted(fall, in_process):
    with pytest.raises(rigor.InputError, match="at none of 16 points do most of the runs reach their end"):
        rigor.fit(fall, engine=broken("step", "1 / 0"), vary={"scene.gravity[2]": (-12, -8)}, dt="1/50", duration=0.5, in_process=in_process, progress=False)
