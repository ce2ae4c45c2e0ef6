"""The package in its process: programs, signals, threads, and what an import costs."""

import signal
import subprocess
import sys
import threading
import time

import paracosm as pc
import pytest


def test_the_programs_are_the_same_programs(fuzz, cover):
    listed = fuzz("list", "scenarios")
    assert listed.returncode == 0 and "pedestrian-crossing" in listed.stdout
    assert "Usage: paracosm-cover" in cover("--help")


def test_the_programs_have_the_exit_status_of_a_gate(fuzz, tmp_path):
    ran = fuzz("pedestrian-crossing", "--budget", "20", "--fail-on-violation", "-q")
    assert ran.returncode == 1, ran.stderr
    assert "paracosm-fuzz replay" in ran.stdout
    assert (tmp_path / "paracosm-out" / "campaign.json").exists()
    wrong = fuzz("pedestrian-crosing")
    assert wrong.returncode == 2 and "did you mean `pedestrian-crossing`?" in wrong.stderr


def test_help_in_a_closed_pipe_is_no_error():
    script = "import sys; from paracosm._core import fuzz; sys.exit(fuzz(['paracosm-fuzz', 'list', '--format', 'json']))"
    both = f'"{sys.executable}" -c "{script}" | head -c 10 >/dev/null; exit ${{PIPESTATUS[0]}}'
    assert subprocess.run(["bash", "-c", both]).returncode == 0


@pytest.mark.parametrize("work", ["pc.star_discrepancy(pc.sample(9, 2000), time_limit=600)", "pc.sample(6, 50000, method='greedy')"])
def test_ctrl_c_ends_long_work(work):
    script = f"import paracosm as pc; print('begun', flush=True); {work}"
    running = subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    assert running.stdout is not None and running.stdout.readline() == "begun\n"
    time.sleep(1.0)
    running.send_signal(signal.SIGINT)
    _, errors = running.communicate(timeout=60)
    assert "KeyboardInterrupt" in errors and running.returncode != 0


def test_other_threads_run_while_a_measure_runs():
    ticks = []
    done = threading.Event()

    def tick():
        while not done.is_set():
            ticks.append(time.monotonic())
            time.sleep(0.001)

    thread = threading.Thread(target=tick)
    thread.start()
    pc.star_discrepancy(pc.sample(6, 400), time_limit=1.0)
    done.set()
    thread.join()
    assert len(ticks) > 20


def test_a_driver_needs_no_compiled_core():
    script = "import sys, paracosm; paracosm.Driver; paracosm.Control; assert 'paracosm._core' not in sys.modules"
    assert subprocess.run([sys.executable, "-c", script]).returncode == 0
