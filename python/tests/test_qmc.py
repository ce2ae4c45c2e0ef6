"""The engines of `paracosm.qmc`: they are those of scipy, with the points of this package."""

import copy
import pickle
import warnings

import numpy as np
import paracosm as pc
import pytest
from paracosm import qmc
from scipy.stats import qmc as scipy_qmc

ENGINES = [getattr(qmc, name) for name in qmc.__all__]
# They make a set of exactly as many points as are drawn.
SETS = {"best", "fibonacci", "hammersley", "lattice", "lhs", "lhs-centred", "lhs-discrepancy", "lhs-maximin"}


def test_every_strategy_without_a_memory_has_an_engine():
    assert [engine.method for engine in ENGINES] == sorted(name for name, _, is_adaptive in pc.strategies() if not is_adaptive)


@pytest.mark.parametrize("engine", ENGINES, ids=lambda engine: engine.method)
@pytest.mark.parametrize("seed", [None, 0, 7])
def test_an_engine_draws_the_points_of_sample_also_in_parts(engine, seed):
    expected = pc.sample(2, n=12, method=engine.method, seed=seed)
    drawn = engine(2, rng=seed)
    if engine.method in SETS:
        assert (drawn.random(12) == expected).all()
        with pytest.raises(pc.Error, match="exactly as many points as its first draw, 12"):
            drawn.random(1)
        assert (drawn.reset().random(12) == expected).all()
        return
    parts = np.vstack([drawn.random(5), drawn.random(1), drawn.random(6)])
    assert (parts == expected).all() and drawn.num_generated == 12
    assert (drawn.reset().random(12) == expected).all()
    assert (engine(2, rng=seed).fast_forward(5).random(7) == expected[5:]).all()
    half = engine(2, rng=seed)
    half.random(5)
    assert (copy.deepcopy(half).random(7) == expected[5:]).all()


def test_copies_and_pickles_go_on_where_the_engine_is_also_with_an_optimization():
    engine = qmc.Halton(2, rng=1, optimization="random-cd")
    engine.random(20)
    for other in (copy.deepcopy(engine), pickle.loads(pickle.dumps(engine))):
        again = copy.deepcopy(engine)
        assert (other.random(12) == again.random(12)).all()
    assert qmc.Lhs(2).random(0).shape == (0, 2)
    with pytest.raises(TypeError):
        qmc.Halton(2).random(2.5)


def test_scipy_takes_the_engines_for_its_own():
    engine = qmc.Halton(3, rng=2)
    assert isinstance(engine, scipy_qmc.QMCEngine)
    points = engine.random(64)
    assert scipy_qmc.discrepancy(points) < scipy_qmc.discrepancy(qmc.Random(3, rng=2).random(64))
    whole = engine.integers([0, 10, 100], u_bounds=[1, 11, 103], n=20)
    assert whole.shape == (20, 3) and set(whole[:, 2]) <= {100, 101, 102}
    normal = scipy_qmc.MultivariateNormalQMC(mean=[0.0, 0.0], engine=qmc.SobolOwen(2, rng=1))
    assert normal.random(16).shape == (16, 2)
    optimised = qmc.Lhs(2, optimization="random-cd", rng=1).random(20)
    assert scipy_qmc.discrepancy(optimised) <= scipy_qmc.discrepancy(pc.sample(2, n=20, method="lhs", seed=1))


def test_a_generator_of_numpy_chooses_the_seed():
    both = [qmc.Random(2, rng=np.random.default_rng(seed)).random(3) for seed in (3, 3)]
    assert (both[0] == both[1]).all()
    assert (both[0] != qmc.Random(2, rng=np.random.default_rng(4)).random(3)).all()
    assert qmc.Random(2, rng=np.random.RandomState(3)).random(3).shape == (3, 2)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: qmc.Halton(2, rng=-1), "expected a seed from 0 on"),
        (lambda: qmc.Fibonacci(3).random(4), "exactly 2"),
        (lambda: qmc.Halton(0).random(4), "dimension|1 on|at least"),
        (lambda: qmc.Halton(2.5), "d must be|integer"),
    ],
)
def test_an_engine_that_cannot_be_is_an_error(make, message):
    with warnings.catch_warnings(), pytest.raises((pc.Error, ValueError, TypeError), match=message):
        warnings.simplefilter("error")
        make()
