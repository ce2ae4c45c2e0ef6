"""The searches that are compared: strategies of PARACOSM, and searches of other packages.

A search is a function of a requirement, a run and a seed. It calls the run with points of the unit cube until the run raises `Ended`.
"""

import random
import warnings
from collections.abc import Callable

import numpy as np
import paracosm
from problems import Requirement, Run

Search = Callable[[Requirement, Run, int], None]

#: The strategies of PARACOSM.
OURS = ["auto", "cmaes", "gp-cmaes", "bayes", "pso", "nelder-mead", "anneal", "boundary", "halton"]
#: The controls, which search for nothing.
CONTROLS = ["random", "random-corners"]


def ours(strategy: str) -> Search:
    """A strategy of PARACOSM, which is asked for one test at a time and knows the names, ends and pieces of the inputs."""

    def search(requirement: Requirement, run: Run, seed: int) -> None:
        space = paracosm.Space.read(requirement.space_file)
        generator = paracosm.Generator(space, strategy, budget=run.budget, seed=seed)
        lows, spans = np.array([(low, high - low) for _, low, high, pieces in requirement.inputs() for _ in range(pieces)]).T
        while True:
            tests = generator.ask(1)
            values = np.array([tests[0][name] for name in tests.columns])
            generator.tell(tests, [run((values - lows) / spans)])

    return search


def tpe(requirement: Requirement, run: Run, seed: int) -> None:
    """The tree-structured Parzen estimator of Optuna, with its defaults."""
    import optuna

    optuna.logging.set_verbosity(optuna.logging.ERROR)
    study = optuna.create_study(sampler=optuna.samplers.TPESampler(seed=seed))
    names = [f"x{i}" for i in range(requirement.dims())]
    while True:
        trial = study.ask()
        study.tell(trial, run([trial.suggest_float(name, 0.0, 1.0) for name in names]))


def pycma(requirement: Requirement, run: Run, seed: int) -> None:
    """CMA-ES of pycma in the unit box, from a random point with a step of 0.3; restarted with twice the population whenever it stops."""
    import cma

    random_state = np.random.RandomState(seed)
    size = 4 + int(3 * np.log(requirement.dims()))
    while True:
        options = {"bounds": [0, 1], "verbose": -9, "seed": random_state.randint(1, 2**31), "popsize": size}
        search = cma.CMAEvolutionStrategy(random_state.rand(requirement.dims()), 0.3, options)
        while not search.stop():
            points = search.ask()
            search.tell(points, [run(point) for point in points])
        size *= 2


def differential_evolution(requirement: Requirement, run: Run, seed: int) -> None:
    """Differential evolution of SciPy with a population of 30, and with a new population whenever it stops. The default population of 15 d would use
    all tests for its first generation in 20 and more dimensions."""
    from scipy.optimize import differential_evolution as search

    rng = np.random.default_rng(seed)
    while True:
        first = rng.random((30, requirement.dims()))
        search(run, [(0.0, 1.0)] * requirement.dims(), init=first, rng=rng, polish=False, maxiter=1000)


def dual_annealing(requirement: Requirement, run: Run, seed: int) -> None:
    """Dual annealing of SciPy, with its defaults."""
    from scipy.optimize import dual_annealing as search

    while True:
        search(run, [(0.0, 1.0)] * requirement.dims(), rng=seed)
        seed += 10_000


def verifai(sampler: str) -> Search:
    """A sampler of VerifAI, with its defaults. It learns from results below 0, which are failures, so that it is told by how much a robustness is
    above the lowest fifth of the robustness so far."""

    def search(requirement: Requirement, run: Run, seed: int) -> None:
        from verifai.features import Box, Feature, FeatureSpace
        from verifai.samplers import FeatureSampler

        random.seed(seed)
        np.random.seed(seed)
        box = Box(*[(0.0, 1.0)] * requirement.dims())
        space = FeatureSpace({"x": Feature(box)})
        made = getattr(FeatureSampler, sampler)(space)
        told: list[float] = []
        while True:
            sample, info = made.getSample()
            told.append(run(sample.x))
            made.update(sample, info, told[-1] - float(np.quantile(told, 0.2)))

    return search


def bayesian_optimization(requirement: Requirement, run: Run, seed: int) -> None:
    """Gaussian processes with an upper confidence bound of the package bayesian-optimization, after five random tests. The bound is maximised over
    1,000 random points and by one local search, because the defaults of 10,000 and 10 take several times as long."""
    from bayes_opt import BayesianOptimization
    from bayes_opt.acquisition import UpperConfidenceBound

    warnings.filterwarnings("ignore")
    names = [f"x{i:02}" for i in range(requirement.dims())]
    bound = UpperConfidenceBound(kappa=2.576)
    search = BayesianOptimization(
        f=None, acquisition_function=bound, pbounds=dict.fromkeys(names, (0.0, 1.0)), random_state=seed, verbose=0, allow_duplicate_points=True
    )
    state = np.random.default_rng(seed)
    local = np.random.RandomState(seed)
    for tests in range(run.budget + 1):
        if tests < 5:
            point = state.random(len(names))
        else:
            point = bound.suggest(search._gp, search._space, n_random=1000, n_smart=1, random_state=local)
        search.register(params=dict(zip(names, point, strict=True)), target=-run(point))


#: The searches of other packages.
OUTSIDE: dict[str, Search] = {
    "optuna-tpe": tpe,
    "pycma": pycma,
    "scipy-de": differential_evolution,
    "scipy-dual-annealing": dual_annealing,
    "verifai-ce": verifai("crossEntropySamplerFor"),
    "verifai-mab": verifai("multiArmedBanditSamplerFor"),
    "bayes-opt": bayesian_optimization,
}

#: Searches that take minutes for a run in many dimensions, and are only made if they are named.
SLOW = ["bayes-opt"]

#: All searches by their names.
SEARCHES: dict[str, Search] = {name: ours(name) for name in OURS + CONTROLS} | OUTSIDE
