"""The package in its process: programs, signals, threads, and what an import costs."""

import os
import signal
import subprocess
import sys
import textwrap
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


@pytest.mark.parametrize("what", ["driver", "function"])
def test_a_program_may_end_while_another_thread_runs_a_campaign(tmp_path, what):
    program = """
        import sys, threading
        import paracosm as pc

        begun = threading.Event()

        class Slow(pc.Driver):
            def step(self, observation):
                begun.set()
                while True:
                    sum(range(1000))

        def slow(x):
            begun.set()
            return float(sum(range(100_000)))

        def run():
            if sys.argv[1] == "driver":
                pc.Study("cut-in", driver=Slow(), budget=20).run("out", executor=2)
            else:
                pc.falsify(slow, pc.Space({"x": pc.Interval(0, 1)}), strategy="halton", budget=10_000)

        threading.Thread(target=run, daemon=True).start()
        begun.wait(60)
        print("over")
    """
    (tmp_path / "ends.py").write_text(textwrap.dedent(program))
    ran = subprocess.run([sys.executable, "ends.py", what], cwd=tmp_path, capture_output=True, text=True, timeout=60)
    assert (ran.returncode, ran.stdout, ran.stderr) == (0, "over\n", "")


def test_a_terminal_shows_the_progress_and_a_pipe_does_not(tmp_path):
    pty = pytest.importorskip("pty")
    program = "import paracosm as pc; pc.Study('cut-in', budget=250).run('{}', executor=1{})"

    def shown(folder, choice):
        import os

        own, theirs = pty.openpty()
        ran = subprocess.Popen([sys.executable, "-c", program.format(folder, choice)], cwd=tmp_path, stdout=subprocess.DEVNULL, stderr=theirs)
        os.close(theirs)
        text = b""
        while True:
            try:
                part = os.read(own, 4096)
            except OSError:
                break
            if not part:
                break
            text += part
        os.close(own)
        assert ran.wait(60) == 0
        return text.decode()

    told = shown("terminal", "")
    assert "/250, " in told and "s remaining" in told and told.endswith("\r\x1b[K")
    assert shown("silent", ", progress=False") == ""
    piped = subprocess.run([sys.executable, "-c", program.format("piped", "")], cwd=tmp_path, capture_output=True, text=True)
    assert (piped.returncode, piped.stderr) == (0, "")
    with pytest.raises(pc.Error, match="progress is 3, expected a function"):
        pc.Study("cut-in", budget=2).run(tmp_path / "never", progress=3)


def test_a_stream_that_is_no_terminal_ends_no_campaign(monkeypatch, tmp_path):
    class Log:
        def write(self, text):
            raise AssertionError("nothing is written")

    monkeypatch.setattr(sys, "stderr", Log())
    assert len(pc.Study("cut-in", budget=3).run(tmp_path / "out")) == 3


def test_progress_counts_the_tests_of_the_campaign_before(tmp_path):
    study, told = pc.Study("cut-in", budget=400), []

    def stops(done, budget):
        if done > 50:
            raise RuntimeError("enough")

    with pytest.raises(RuntimeError):
        study.run(tmp_path / "out", progress=stops, executor=1)
    study.run(tmp_path / "out", resume=True, progress=lambda done, budget: told.append(done))
    assert told[-1] == 400 and told == sorted(told)


def test_the_package_says_its_version():
    from importlib.metadata import version

    assert pc.__version__ == version("paracosm")


@pytest.mark.skipif(not hasattr(os, "fork"), reason="this system forks no processes")
def test_a_process_that_was_forked_after_a_campaign_runs_campaigns(tmp_path):
    script = """
        import multiprocessing
        import paracosm as pc
        def study(out):
            report = pc.Study("pedestrian-crossing", budget=20).run(f"out-{out}", executor=1)
            return [report.verdicts, pc.load(report.folder).verdicts, float(pc.dispersion(pc.sample(3, 40)))]
        first = study(0)
        with multiprocessing.get_context("fork").Pool(2) as pool:
            assert pool.map(study, [1, 2]) == [first, study(3)]
            print(first[0]["pass"] + first[0]["fail"])
    """
    (tmp_path / "script.py").write_text(textwrap.dedent(script))
    ran = subprocess.run([sys.executable, "script.py"], cwd=tmp_path, capture_output=True, text=True, timeout=120)
    assert ran.returncode == 0 and ran.stdout == "20\n", ran.stderr
