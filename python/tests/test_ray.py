"""Campaigns on a Ray cluster: two real nodes, one of which dies."""

import os
import socket
import subprocess
import sys
import time
from pathlib import Path

os.environ.setdefault("RAY_AUTH_MODE", "disabled")
os.environ.setdefault("RAY_USAGE_STATS_ENABLED", "0")

import example_drivers
import paracosm as pc
import pytest
from test_executors import crossing, files

ray = pytest.importorskip("ray")
from paracosm.ray import Executor  # noqa: E402
from ray.cluster_utils import Cluster  # noqa: E402


@pytest.fixture(scope="module")
def one_node():
    """A cluster of a node with a CPU, to which this process is connected."""
    cluster = Cluster(initialize_head=True, head_node_args={"num_cpus": 1, "include_dashboard": False})
    ray.init(address=cluster.address, log_to_driver=False)
    yield cluster
    ray.shutdown()
    cluster.shutdown()


@pytest.fixture
def cluster(one_node):
    """The cluster with a second node."""
    one_node.second = one_node.add_node(num_cpus=1)
    yield one_node
    for node in one_node.worker_nodes.copy():
        one_node.remove_node(node, allow_graceful=False)


def test_campaigns_on_two_nodes_are_campaigns_on_one_machine(cluster, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("rules.toml").write_text('[[requirement]]\nid = "slow"\nformula = "always (car.speed < 30)"\n')
    studies = {
        "open-loop": pc.Study("cut-in", requirements="rules.toml", strategy="sobol", budget=60),
        "adaptive": pc.Study(crossing, driver=example_drivers.Cautious(), strategy="auto", budget=60),
        "cameras": pc.Study("pedestrian-crossing", driver=example_drivers.Sensing(), budget=3),
    }
    with Executor() as executor:
        assert executor.workers == 2
        for name, study in studies.items():
            study.run(f"{name}-local", executor=2)
            study.run(f"{name}-ray", executor=executor)
            assert files(f"{name}-local") == files(f"{name}-ray"), name
    assert ray.is_initialized(), "the executor has not connected this process, and does not disconnect it"


@pytest.mark.parametrize("strategy", ["halton", "cmaes"])
def test_a_node_that_dies_costs_its_tests_a_retry_and_nothing_else(cluster, strategy, tmp_path):
    notes = tmp_path / "notes"
    notes.mkdir()

    def slope(test):
        node = ray.get_runtime_context().get_node_id() if ray.is_initialized() else "local"
        (notes / f"{node}-{time.time_ns()}").write_text(f"{test['x']} {test['y']}")
        # Both nodes have run a test before one of them dies.
        begun = time.monotonic()
        while node != "local" and len({note.name.partition("-")[0] for note in notes.iterdir()}) < 2 and time.monotonic() - begun < 60:
            time.sleep(0.05)
        time.sleep(0.02)
        return test["x"] + test["y"] - 0.4

    space = pc.Space({"x": pc.Interval(0, 1), "y": pc.Interval(0, 1)})
    study = pc.Study.of_function(slope, space, strategy=strategy, budget=80)
    died = []

    def kill(done, _):
        if done >= 20 and not died:
            died.append(cluster.second.node_id)
            cluster.remove_node(cluster.second, allow_graceful=False)

    with Executor() as executor:
        study.run(tmp_path / "ray", executor=executor, progress=kill)
    nodes = {}
    for note in notes.iterdir():
        nodes.setdefault(note.name.partition("-")[0], []).append(note.read_text())
    assert len(died) == 1 and len(nodes) == 2, "both nodes have run tests"
    study.run(tmp_path / "local", executor=2)
    assert files(tmp_path / "ray") == files(tmp_path / "local")


def test_a_node_that_comes_later_runs_tests(cluster, tmp_path):
    def where(test):
        (tmp_path / ray.get_runtime_context().get_node_id()).touch()
        time.sleep(0.03)
        # The last tests wait for the node that comes.
        begun = time.monotonic()
        while test["x"] > 0.6 and len(list(tmp_path.iterdir())) < 4 and time.monotonic() - begun < 60:
            time.sleep(0.05)
        return test["x"]

    def add(done, _):
        if done >= 2 and len(cluster.worker_nodes) == 1:
            cluster.add_node(num_cpus=1)

    study = pc.Study.of_function(where, pc.Space({"x": pc.Interval(0, 1)}), strategy="halton", budget=200)
    with Executor() as executor:
        study.run(tmp_path / "out", executor=executor, progress=add)
    assert len([path for path in tmp_path.iterdir() if path.name != "out"]) == 3


def test_a_test_that_kills_each_worker_ends_the_campaign_after_its_retries(cluster, tmp_path):
    def deadly(test):
        if test["x"] > 0.9:
            os._exit(1)
        return test["x"]

    study = pc.Study.of_function(deadly, pc.Space({"x": pc.Interval(0, 1)}), strategy="halton", budget=60)
    with Executor(retries=1) as executor, pytest.raises(pc.Error, match="tests? .*: the executor failed: the worker died 2 times in these tests; does a test end its process"):
        study.run(tmp_path / "out", executor=executor)
    assert (tmp_path / "out" / "trials.jsonl").read_text().count("\n") > 0


def test_an_executor_calls_functions_as_any_other(cluster):
    with Executor() as executor:
        assert list(executor.map(lambda x, y: x * y, range(5), range(5))) == [0, 1, 4, 9, 16]
        failing = executor.submit(int, "three")
        with pytest.raises(ValueError, match="invalid literal"):
            failing.result(timeout=60)
        unpicklable = executor.submit(print, iter([__import__("threading").Lock()]))
        with pytest.raises(TypeError):
            unpicklable.result(timeout=60)
    with pytest.raises(RuntimeError, match="the executor was shut down"):
        executor.submit(int)


def test_two_executors_share_a_connection_that_they_did_not_make(cluster):
    one, other = Executor(), Executor()
    for executor in (one, other):
        assert executor.submit(len, "abc").result(timeout=60) == 3
        executor.shutdown()
    assert ray.is_initialized()
    with pytest.raises(pc.Error, match="address is 192.0.2.1:1, but this process is connected to a cluster already"):
        Executor("192.0.2.1:1")


def test_a_shutdown_waits_for_calls_unless_it_cancels_them(cluster):
    with Executor() as executor:
        calls = [executor.submit(time.sleep, 0.2) for _ in range(8)]
    assert all(call.done() and call.exception() is None for call in calls)
    executor = Executor()
    calls = [executor.submit(time.sleep, 0.2) for _ in range(20)]
    calls[0].result(timeout=60)
    executor.shutdown(cancel_futures=True)
    assert all(call.done() for call in calls) and any(call.cancelled() for call in calls)


def test_an_executor_that_nobody_holds_gives_its_workers_back(cluster):
    for _ in range(3):
        assert Executor().submit(sum, [1, 2]).result(timeout=60) == 3
    with Executor() as last:
        assert last.submit(sum, [1, 2]).result(timeout=60) == 3


def test_a_worker_that_no_machine_has_room_for_is_told_of(cluster):
    with pytest.warns(RuntimeWarning, match="a worker takes 8 CPUs, the largest machine has 1 CPUs.*Give a smaller `cpus`"):
        Executor(cpus=8).shutdown()


def test_a_script_connects_by_the_client_of_ray(tmp_path):
    """The threads of the client that tell of results may not wait for the cluster."""
    with socket.socket() as found:
        found.bind(("127.0.0.1", 0))
        port = found.getsockname()[1]
    server = [sys.executable, "-m", "ray.util.client.server", "--host=127.0.0.1", f"--port={port}", "--mode=proxy"]
    script = f"""
import paracosm as pc
study = pc.Study("cut-in", strategy="halton", budget=30)
with pc.ray.Executor("ray://127.0.0.1:{port}") as executor:
    study.run("client", executor=executor)
study.run("local")
"""
    head = Cluster(initialize_head=True, head_node_args={"num_cpus": 1, "include_dashboard": False}, shutdown_at_exit=False)
    running = subprocess.Popen([*server, f"--address={head.address}"], stderr=subprocess.DEVNULL)
    try:
        done = subprocess.run([sys.executable, "-c", script], cwd=tmp_path, capture_output=True, text=True, timeout=120)
    finally:
        running.kill()
        running.wait()
        head.shutdown()
    if "Starting Ray client server failed" in done.stderr:
        pytest.skip("another server of Ray has the port")
    assert done.returncode == 0, done.stderr
    assert files(tmp_path / "client") == files(tmp_path / "local")


@pytest.mark.parametrize(("choices", "says"), [({"cpus": 0}, "cpus"), ({"cpus": float("nan")}, "cpus"), ({"cpus": "2"}, "cpus"), ({"gpus": -1}, "gpus"), ({"retries": -1}, "retries")])
def test_choices_that_make_no_sense_are_errors(choices, says):
    with pytest.raises(pc.Error, match=f"{says} is .*, expected a"):
        Executor(**choices)
