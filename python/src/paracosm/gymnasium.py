"""Scenarios as environments of Gymnasium. It needs gymnasium.

    >>> import gymnasium
    >>> import paracosm.gymnasium
    >>> environment = gymnasium.make("paracosm/CutIn-v0")

`paracosm/CutIn-v0`: the agent drives the car in the scenario `cut-in`. `paracosm/CutIn-Adversary-v0`: the agent chooses tests, and looks for one in which
the driver under test fails. There are both for every scenario, and `make(.., scenario=..)` takes a scenario of your own.

The reward is the progress of the online robustness. At each step, the worst robustness of the requirements has bounds that hold for every continuation of the
test. Both bounds are divided by the scale of the requirement and clipped to [-1, 1]. The reward is the change of their middle, which is 0 at the beginning. So
the sum of the rewards is the robustness of the test in multiples of its scale, clipped to [-1, 1].
"""

from collections.abc import Mapping, Sequence
from typing import Any

import gymnasium
import numpy as np
from gymnasium import spaces
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space
from numpy.typing import NDArray

from ._core import Episode, Error, Program, Space, Study, scenarios
from .driver import Driver
from .observation import Control, Observation
from .sensors import Camera

__all__ = ["AdversaryEnv", "DrivingEnv", "DrivingVectorEnv", "register"]

_Array = NDArray[np.float32]
_Scenario = str | Program

# A random test may be impossible; so many in a row mean that the scenario is.
_MOST_INVALID = 1000
# So many random tests may break a constraint in a row.
_MOST_DRAWS = 100_000
# The numbers of each body in an observation: present, x, y, velocity in x and y, heading, length, width.
_OF_BODY = 8


# The choices of a study that say what the world is and what is required, and the choices of the driver under test.
_OF_WORLD = ("open", "fix", "vehicle", "vehicle_settings", "spec", "dense", "requirements")
_OF_DRIVER = ("driver", "driver_command", "driver_settings", "timeout")


def _check_choices(choices: Mapping[str, Any], known: Sequence[str]) -> None:
    for name in choices:
        if name not in known:
            raise Error(f"the environment has no choice `{name}`; the choices of a study that it has are {', '.join(known)}")


def _check_count(name: str, value: object, least: int) -> None:
    if isinstance(value, bool) or not isinstance(value, int) or value < least:
        raise Error(f"{name} is {value!r}, expected a whole number from {least} on")


class _Seat(Driver):
    """The sensors of an agent. The agent answers in its place."""

    def __init__(self, period: float, cameras: Mapping[str, Camera], look: str) -> None:
        self.period = period
        self.others = True
        self.cameras = dict(cameras)
        self.look = look

    def step(self, observation: Observation) -> Control:
        raise NotImplementedError


class _Course:
    """What the environments of a scenario share: tests, observations and episodes."""

    def __init__(
        self,
        scenario: _Scenario,
        *,
        period: float = 0.1,
        others: int = 8,
        points: int = 10,
        cameras: Mapping[str, Camera] | None = None,
        look: str = "flat",
        **choices: Any,
    ) -> None:
        _check_count("others", others, 0)
        _check_count("points", points, 0)
        _check_choices(choices, _OF_WORLD)
        if "state" in (cameras or {}):
            raise Error("a camera is called `state`, which is the name of the array: give the camera another name")
        if look != "flat" and not cameras:
            raise Error(f"look is {look!r}, but there are no cameras whose images could have this look: give `cameras`")
        self.study = Study(scenario, budget=1, **choices)
        self.seat = _Seat(period, cameras or {}, look)
        self.others, self.points = others, points
        state = spaces.Box(-np.inf, np.inf, (4 + 3 * points + _OF_BODY * others,), np.float32)
        images = {name: spaces.Box(0, 255, (camera.height, camera.width, 3), np.uint8) for name, camera in self.seat.cameras.items()}
        self.observations = spaces.Dict({"state": state, **images}) if images else state
        self.actions = spaces.Box(-1.0, 1.0, (2,), np.float32)

    def begun(self, random: np.random.Generator, test: Mapping[str, Any] | None) -> tuple[Episode, dict[str, Any], Observation]:
        """Begins an episode with a test, or with a random one."""
        outcome: dict[str, Any] | None = None
        for _ in range(_MOST_INVALID):
            chosen = dict(test) if test is not None else self.random_test(random)
            episode = Episode(self.study, chosen, self.seat, int(random.integers(2**32)))
            observation = episode.asked()
            if observation is not None:
                return episode, chosen, observation
            outcome = episode.outcome
            assert outcome is not None
            if test is not None or outcome["verdict"] != "invalid":
                raise Error(f"the test {chosen} does not begin: {outcome['error'] or outcome['verdict']}")
        assert outcome is not None
        raise Error(f"{_MOST_INVALID} random tests in a row were impossible: {outcome['error']}")

    def random_test(self, random: np.random.Generator) -> dict[str, Any]:
        """Draws a test that keeps the constraints, uniformly."""
        space = self.study.space
        for _ in range(_MOST_DRAWS):
            test = space._test(random.random(space._coordinates).tolist())
            if test is not None:
                return test
        raise Error(f"{_MOST_DRAWS} random tests in a row broke a constraint: give the tests with `options`")

    def written(self, observation: Observation) -> Any:
        """Returns an observation as arrays."""
        state = np.zeros(4 + 3 * self.points + _OF_BODY * self.others, np.float32)
        state[:4] = observation.time, observation.speed, observation.way.offset, observation.way.heading
        ahead = observation.way.ahead[: self.points]
        if len(ahead):
            # Beyond the end of the way, its last point stands again.
            ahead = np.concatenate([ahead, np.repeat(ahead[-1:], self.points - len(ahead), axis=0)])
            state[4 : 4 + 3 * self.points] = ahead.ravel()
        bodies = sorted(observation.others, key=lambda body: float(body.position @ body.position))[: self.others]
        for i, body in enumerate(bodies):
            at = 4 + 3 * self.points + _OF_BODY * i
            state[at : at + _OF_BODY] = 1.0, *body.position, *body.velocity, body.heading, body.length, body.width
        if not self.seat.cameras:
            return state
        # Before the first image of a camera has arrived, the image is black.
        black = {name: np.zeros((camera.height, camera.width, 3), np.uint8) for name, camera in self.seat.cameras.items()}
        return {"state": state, **{name: np.array(observation.images.get(name, black[name])) for name in black}}


class _Drive:
    """An episode of an environment."""

    def __init__(self, course: _Course, random: np.random.Generator, test: Mapping[str, Any] | None) -> None:
        self.course = course
        self.episode, self.test, observation = course.begun(random, test)
        self.potential = 0.0
        self.is_over = False
        self.last = course.written(observation)

    def asked(self) -> tuple[Any, float, bool, bool, dict[str, Any]]:
        try:
            observation = self.episode.asked()
        except BaseException:
            # The car has the control already, so the step cannot be taken again.
            self.is_over = True
            raise
        before, self.potential = self.potential, self.episode.potential
        reward = self.potential - before
        if observation is not None:
            self.last = self.course.written(observation)
            return self.last, reward, False, False, {}
        outcome = self.episode.outcome
        assert outcome is not None
        self.is_over = True
        if outcome["verdict"] == "error":
            raise Error(f"the test {self.test} broke: {outcome['error']}")
        is_at_end = outcome["ticks"] >= self.episode.ticks
        return self.last, reward, not is_at_end, is_at_end, {"test": self.test, **outcome}


def _control(action: Any) -> Control:
    """Reads an action."""
    numbers = np.asarray(action, dtype=float)
    if numbers.shape != (2,) or not np.isfinite(numbers).all():
        raise Error(f"the action is {action!r}, expected two numbers: the throttle and the steering, from -1 to 1")
    throttle, steering = np.clip(numbers, -1.0, 1.0)
    return Control(float(throttle), float(steering))


def _test_of(options: Mapping[str, Any] | None) -> Mapping[str, Any] | None:
    wrong = set(options or ()) - {"test"}
    if wrong:
        raise Error(f"found the options {sorted(wrong)}, expected only `test`, a dictionary with a value for each open parameter")
    test = None if options is None else options.get("test")
    if test is not None and not isinstance(test, Mapping):
        raise Error(f"the test is {test!r}, expected a dictionary with a value for each open parameter")
    return test


class DrivingEnv(gymnasium.Env[Any, _Array]):
    """The agent drives the car of a scenario, in a random test, or in the test of `reset(options={"test": {..}})`.

    An action is the throttle (below 0 the brake) and the steering (positive to the left), both from -1 to 1. They hold for `period` seconds (0.1).

    An observation is an array with these numbers, for `points` (10) points of the way and `others` (8) bodies:

    - 0: the time in seconds; 1: the speed in m/s
    - 2, 3: the offset of the car from its way in metres, and its heading in radians; both are positive to the left
    - 3 for each point of the way ahead: x and y in metres as seen from the car, and the curvature in 1/m
    - 8 for each of the nearest bodies, the nearest first: 1, or 0 if there are fewer bodies; position (x, y) as seen from the car; velocity (x, y)
      over the ground in the same axes; heading; length; width

    With `cameras`, a dictionary of names and `Camera`s, an observation is a dictionary with this array as `state` and an image for each camera.
    `look` is the look of the images: `"flat"` or `"textured"`.

    An episode is terminated if a contact or an event of the scenario ends the test, and truncated when the time of the test is over. The observation
    after the last step is that of the step before, because a test that is over asks no driver. The last `info` has the test and its result, as
    `Study.test` returns it.

    Other keywords are choices of a `Study`: `open`, `fix`, `vehicle`, `vehicle_settings`, `spec`, `dense` and `requirements`.
    `environment.unwrapped.space` has the open parameters.
    """

    metadata: dict[str, Any] = {"render_modes": []}

    def __init__(
        self,
        scenario: _Scenario = "pedestrian-crossing",
        *,
        render_mode: None = None,
        **keywords: Any,
    ) -> None:
        self._course = _Course(scenario, **keywords)
        self.observation_space = self._course.observations
        self.action_space = self._course.actions
        self.render_mode = render_mode
        self._drive: _Drive | None = None

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Any, dict[str, Any]]:
        super().reset(seed=seed)
        self._drive = _Drive(self._course, self.np_random, _test_of(options))
        return self._drive.last, {"test": self._drive.test}

    def step(self, action: _Array) -> tuple[Any, float, bool, bool, dict[str, Any]]:
        if self._drive is None or self._drive.is_over:
            raise Error("the environment has no episode that goes on: call `reset` first")
        self._drive.episode.answer(_control(action))
        return self._drive.asked()

    @property
    def space(self) -> Space:
        """The space of the tests."""
        return self._course.study.space

    def close(self) -> None:
        self._drive = None


class DrivingVectorEnv(VectorEnv[Any, _Array, Any]):
    """Several `DrivingEnv`s at once, whose tests run at the same time. The keywords are those of `DrivingEnv`.

    After the end of an episode, the next step ignores the action and begins a new random test (`AutoresetMode.NEXT_STEP`). `reset` with a test gives it to all
    environments.
    """

    metadata: dict[str, Any] = {"render_modes": [], "autoreset_mode": AutoresetMode.NEXT_STEP}

    def __init__(
        self,
        num_envs: int = 1,
        scenario: _Scenario = "pedestrian-crossing",
        *,
        render_mode: None = None,
        **keywords: Any,
    ) -> None:
        _check_count("num_envs", num_envs, 1)
        self._course = _Course(scenario, **keywords)
        self.num_envs = num_envs
        self.single_observation_space = self._course.observations
        self.single_action_space = self._course.actions
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self.action_space = batch_space(self.single_action_space, num_envs)
        self.render_mode = render_mode
        self._randoms: list[np.random.Generator] = []
        self._drives: list[_Drive] = []
        self._is_over = np.zeros(num_envs, dtype=bool)

    def reset(self, *, seed: int | Sequence[int | None] | None = None, options: dict[str, Any] | None = None) -> tuple[Any, dict[str, Any]]:
        seeds = [int(seed) + i for i in range(self.num_envs)] if isinstance(seed, (int, np.integer)) else seed
        if seeds is not None and len(seeds) != self.num_envs:
            raise Error(f"found {len(seeds)} seeds, expected {self.num_envs}, one for each environment")
        if seeds is not None or not self._randoms:
            self._randoms = [np.random.default_rng(one) for one in seeds or [None] * self.num_envs]
        test = _test_of(options)
        self._drives = [_Drive(self._course, random, test) for random in self._randoms]
        self._is_over[:] = False
        return self._joined(), {"test": np.array([drive.test for drive in self._drives], dtype=object), "_test": np.ones(self.num_envs, dtype=bool)}

    def step(self, actions: _Array) -> tuple[Any, NDArray[np.float64], NDArray[np.bool_], NDArray[np.bool_], dict[str, Any]]:
        if not self._drives:
            raise Error("the environment has no episodes: call `reset` first")
        if np.shape(actions) != (self.num_envs, 2):
            raise Error(f"the actions have the shape {np.shape(actions)}, expected ({self.num_envs}, 2): a row for each environment")
        going = [i for i in range(self.num_envs) if not self._is_over[i]]
        if any(self._drives[i].is_over for i in going):
            raise Error("an episode was interrupted: call `reset` first")
        # All actions are read before the first car gets one.
        controls = {i: _control(actions[i]) for i in going}
        for i in going:
            self._drives[i].episode.answer(controls[i])
        rewards, terminated, truncated = np.zeros(self.num_envs), np.zeros(self.num_envs, dtype=bool), np.zeros(self.num_envs, dtype=bool)
        infos: dict[str, Any] = {}
        for i in range(self.num_envs):
            if i in going:
                _, rewards[i], terminated[i], truncated[i], info = self._drives[i].asked()
            else:
                self._drives[i] = _Drive(self._course, self._randoms[i], None)
                info = {"test": self._drives[i].test}
            infos = self._add_info(infos, info, i)
        self._is_over = terminated | truncated
        return self._joined(), rewards, terminated, truncated, infos

    def _joined(self) -> Any:
        last = [drive.last for drive in self._drives]
        return {name: np.stack([one[name] for one in last]) for name in last[0]} if isinstance(last[0], dict) else np.stack(last)

    def close_extras(self, **kwargs: Any) -> None:
        self._drives = []


class AdversaryEnv(gymnasium.Env[_Array, _Array]):
    """The agent chooses tests, and looks for one in which the driver under test fails.

    An action is a point of the unit cube with a coordinate for each coordinate of the space of the tests. An observation is the point with the smallest
    robustness so far, the last point, and the robustness of both, in multiples of its scale and clipped to [-1, 1]. The reward is the decrease of the
    smallest robustness, which is 1 before the first test. An episode is terminated with the first failing test, and truncated after `tests` tests.
    The driver and other choices of a `Study` are keywords.
    """

    metadata: dict[str, Any] = {"render_modes": []}

    def __init__(self, scenario: _Scenario = "pedestrian-crossing", *, tests: int = 50, render_mode: None = None, **choices: Any) -> None:
        _check_count("tests", tests, 1)
        _check_choices(choices, (*_OF_WORLD, *_OF_DRIVER))
        self._study = Study(scenario, budget=1, **choices)
        coordinates = self._study.space._coordinates
        if coordinates == 0:
            raise Error("the study has no open parameter, so there is nothing to choose: open one, such as open=[\"friction\"]")
        self._tests = tests
        self.action_space = spaces.Box(0.0, 1.0, (coordinates,), np.float32)
        low = np.concatenate([np.zeros(2 * coordinates), -np.ones(2)]).astype(np.float32)
        self.observation_space = spaces.Box(low, np.ones(2 * coordinates + 2, np.float32), dtype=np.float32)
        self.render_mode = render_mode
        self._begin()
        # An episode begins with `reset`.
        self._is_over = True

    def _begin(self) -> None:
        middle = np.full(self._study.space._coordinates, 0.5, np.float32)
        self._best, self._last, self._done, self._is_over = (1.0, middle), (1.0, middle), 0, False

    def _seen(self) -> _Array:
        return np.concatenate([self._best[1], self._last[1], [self._best[0], self._last[0]]]).astype(np.float32)

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[_Array, dict[str, Any]]:
        super().reset(seed=seed)
        if options:
            raise Error(f"found the options {sorted(options)}, expected none: the agent chooses the tests")
        self._begin()
        return self._seen(), {}

    def step(self, action: _Array) -> tuple[_Array, float, bool, bool, dict[str, Any]]:
        if self._is_over:
            raise Error("the episode is over: call `reset` first")
        point = np.clip(np.asarray(action, np.float32), 0.0, 1.0)
        if point.shape != self.action_space.shape or not np.isfinite(point).all():
            raise Error(f"the action is {action!r}, expected {self.space._coordinates} numbers from 0 to 1")
        test = self._study.space._test(point.tolist())
        outcome: dict[str, Any] = {"verdict": "invalid", "worst": None} if test is None else self._study.test(test)
        if outcome["verdict"] == "error":
            raise Error(f"the test {test} broke: {outcome['error']}")
        # A test without a robustness, such as an impossible one, is as good as a test that passes by far.
        worst = 1.0 if outcome["worst"] is None else float(np.clip(outcome["worst"], -1.0, 1.0))
        self._last = (worst, point)
        before = self._best[0]
        self._best = min(self._best, self._last, key=lambda one: one[0])
        self._done += 1
        failed = outcome["verdict"] == "fail"
        truncated = not failed and self._done >= self._tests
        self._is_over = failed or truncated
        return self._seen(), before - self._best[0], failed, truncated, {"test": test, **outcome}

    @property
    def space(self) -> Space:
        """The space of the tests."""
        return self._study.space


def register() -> None:
    """Registers the environments of all scenarios, as an import of this module does."""
    for name, _ in scenarios():
        title = "".join(part.capitalize() for part in name.split("-"))
        for kind, entry in [("", "DrivingEnv"), ("-Adversary", "AdversaryEnv")]:
            identity = f"paracosm/{title}{kind}-v0"
            if identity not in gymnasium.registry:
                vector = None if kind else "paracosm.gymnasium:DrivingVectorEnv"
                gymnasium.register(identity, entry_point=f"paracosm.gymnasium:{entry}", vector_entry_point=vector, kwargs={"scenario": name})


register()
