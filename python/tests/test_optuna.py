"""The sampler for Optuna: the proposals of a strategy of this package, for every kind of parameter."""

import copy
import pickle
import warnings

import numpy as np
import paracosm as pc
import pytest

optuna = pytest.importorskip("optuna")
from paracosm.optuna import Sampler  # noqa: E402

optuna.logging.set_verbosity(optuna.logging.WARNING)

SQUARE = {"x": optuna.distributions.FloatDistribution(-1.0, 1.0), "y": optuna.distributions.FloatDistribution(-1.0, 1.0)}


def bowl(trial):
    x, y = trial.suggest_float("x", -1.0, 1.0), trial.suggest_float("y", -1.0, 1.0)
    return (x - 0.5) ** 2 + (y + 0.25) ** 2 - 0.01


@pytest.mark.parametrize("method", ["halton", "cmaes", "bayes"])
def test_a_study_gets_the_proposals_of_the_strategy(method):
    study = optuna.create_study(sampler=Sampler(method, seed=3, budget=30, search_space=SQUARE))
    study.optimize(bowl, n_trials=30)
    space = pc.Space({"x": pc.Interval(0.0, 1.0), "y": pc.Interval(0.0, 1.0)})
    generator = pc.Generator(space, method, budget=30, seed=3)
    for trial in study.trials:
        test = generator.ask(1)
        assert trial.params["x"] == -1.0 + 2.0 * test[0]["x"] and trial.params["y"] == -1.0 + 2.0 * test[0]["y"]
        generator.tell(test, [trial.value])


def test_the_search_space_of_the_first_trial_counts_if_none_is_given():
    study = optuna.create_study(sampler=Sampler("halton"))
    study.optimize(bowl, n_trials=9)
    given = optuna.create_study(sampler=Sampler("halton", search_space=SQUARE))
    given.optimize(bowl, n_trials=8)
    assert [trial.params for trial in study.trials[1:]] == [trial.params for trial in given.trials]


def test_a_search_finds_what_random_trials_hardly_find():
    def best(sampler):
        study = optuna.create_study(sampler=sampler)
        study.optimize(bowl, n_trials=60)
        return study.best_value

    ours = [best(Sampler("bayes", seed=seed, search_space=SQUARE)) for seed in range(3)]
    assert max(ours) < -0.005 and np.mean(ours) < np.mean([best(optuna.samplers.RandomSampler(seed=seed)) for seed in range(3)])


def everything(trial):
    kind = trial.suggest_categorical("kind", ["a", "b", None])
    rate = trial.suggest_float("rate", 1e-5, 1e-1, log=True)
    count = trial.suggest_int("count", 1, 5)
    many = trial.suggest_int("many", 0, 10_000)
    step = trial.suggest_float("step", 0.0, 1.0, step=0.25)
    wide = trial.suggest_int("wide", 1, 10_000, log=True)
    only = trial.suggest_int("only", 7, 7)
    extra = trial.suggest_float("extra", 0.0, 1.0) if kind == "a" else 0.0
    return (kind == "b") + rate + count + many + step + wide + only + extra


@pytest.mark.parametrize("method", ["sobol-owen", "auto", "greedy"])
def test_every_kind_of_parameter_gets_all_of_its_values(method):
    study = optuna.create_study(sampler=Sampler(method, seed=1, budget=200))
    study.optimize(everything, n_trials=120)
    values = {name: [trial.params[name] for trial in study.trials] for name in study.trials[0].params if name != "extra"}
    assert set(values["kind"]) == {"a", "b", None} and set(values["count"]) == {1, 2, 3, 4, 5}
    assert set(values["step"]) == {0.0, 0.25, 0.5, 0.75, 1.0} and set(values["only"]) == {7}
    assert all(isinstance(value, int) for name in ("count", "many", "wide") for value in values[name])
    if method == "sobol-owen":
        assert 0.3 < np.mean(np.array(values["rate"]) < 1e-3) < 0.7 and 0.3 < np.mean(np.array(values["wide"]) < 100) < 0.7


def test_a_study_that_maximises_looks_for_large_values():
    study = optuna.create_study(direction="maximize", sampler=Sampler("cmaes", seed=2, search_space=SQUARE))
    study.optimize(lambda trial: -bowl(trial), n_trials=100)
    assert study.best_value > 0.0


def test_trials_that_fail_and_values_of_the_user_are_told():
    def sometimes(trial):
        value = bowl(trial)
        if trial.number % 3 == 1:
            raise ValueError("it broke")
        if trial.number % 3 == 2:
            raise optuna.TrialPruned
        return value

    study = optuna.create_study(sampler=Sampler("bayes", seed=1, search_space=SQUARE))
    study.enqueue_trial({"x": 0.5, "y": -0.25})
    study.optimize(sometimes, n_trials=20, catch=(ValueError,))
    assert study.trials[0].params == {"x": 0.5, "y": -0.25} and len(study.trials) == 20


def test_a_study_goes_on_with_what_it_knows():
    study = optuna.create_study(sampler=optuna.samplers.RandomSampler(seed=1))
    study.optimize(bowl, n_trials=30)
    study.sampler = Sampler("bayes", seed=1, search_space=SQUARE)
    study.optimize(bowl, n_trials=25)
    fresh = optuna.create_study(sampler=Sampler("bayes", seed=1, search_space=SQUARE))
    fresh.optimize(bowl, n_trials=25)
    assert [trial.params for trial in study.trials[30:]] != [trial.params for trial in fresh.trials]
    assert study.best_value < -0.005


def test_trials_with_other_distributions_are_left_out():
    study = optuna.create_study(sampler=Sampler("bayes", seed=1))
    study.optimize(lambda trial: float(trial.suggest_int("x", *((0, 1) if trial.number < 2 else (5, 9)))), n_trials=6)
    assert len(study.trials) == 6 and all(trial.state == optuna.trial.TrialState.COMPLETE for trial in study.trials)


def test_a_study_that_is_loaded_again_gets_new_points():
    storage = optuna.storages.InMemoryStorage()
    for _ in range(2):
        study = optuna.create_study(storage=storage, study_name="s", load_if_exists=True, sampler=Sampler("halton", search_space=SQUARE))
        study.optimize(bowl, n_trials=10)
    whole = optuna.create_study(sampler=Sampler("halton", search_space=SQUARE))
    whole.optimize(bowl, n_trials=20)
    assert [trial.params for trial in study.trials] == [trial.params for trial in whole.trials]


def test_a_sampler_belongs_to_one_study():
    sampler = Sampler("halton", search_space=SQUARE)
    optuna.create_study(sampler=sampler).optimize(bowl, n_trials=2)
    with pytest.raises(pc.Error, match="make another sampler"):
        optuna.create_study(sampler=sampler).optimize(bowl, n_trials=2)
    plane = optuna.create_study(sampler=Sampler("fibonacci", budget=8, search_space=SQUARE))
    plane.optimize(bowl, n_trials=8)
    assert len({tuple(trial.params.values()) for trial in plane.trials}) == 8


def test_threads_copies_and_pickles_work():
    sampler = Sampler("halton", search_space=SQUARE)
    study = optuna.create_study(sampler=sampler)
    study.optimize(bowl, n_trials=24, n_jobs=3)
    assert len({tuple(trial.params.values()) for trial in study.trials}) == 24
    for other in (copy.deepcopy(sampler), pickle.loads(pickle.dumps(sampler))):
        optuna.create_study(sampler=other).optimize(bowl, n_trials=2)


def test_mistakes_are_errors_at_once():
    with pytest.raises(pc.Error, match="did you mean `halton`"):
        Sampler("haltn")
    study = optuna.create_study(directions=["minimize", "minimize"], sampler=Sampler("halton", search_space=SQUARE))
    with pytest.raises(pc.Error, match="2 objectives, expected one"):
        study.optimize(lambda trial: (bowl(trial), 0.0), n_trials=1)
    ends = {"kind": optuna.distributions.CategoricalDistribution(["a", "b"])}
    study = optuna.create_study(sampler=Sampler("halton", search_space=ends))
    with warnings.catch_warnings(record=True) as seen:
        warnings.simplefilter("always")
        study.optimize(lambda trial: float(trial.suggest_categorical("kind", ["a", "b"]) == "a"), n_trials=4)
    assert any("has no more tests" in str(warning.message) for warning in seen)


def test_a_class_of_samplers_is_a_strategy():
    space = pc.Space({"x": (0, 1), "y": (0, 1)})
    for sampler in (optuna.samplers.RandomSampler, optuna.samplers.TPESampler, optuna.samplers.NSGAIISampler):
        report = pc.falsify(lambda test: test["x"] + 0.1, space, strategy=sampler, budget=5, seed=3)
        again = pc.falsify(lambda test: test["x"] + 0.1, space, strategy=sampler(seed=3), budget=5, seed=3)
        assert list(report.trials["x"]) == list(again.trials["x"]), sampler
