"""How long calls run: other threads, progress, interrupts."""

import signal
import subprocess
import sys
import textwrap
import threading
import time
from concurrent.futures import ThreadPoolExecutor

import isotherm
import numpy as np
import pytest
from isotherm import geometry, slam, spectral


def test_the_number_of_threads_changes_nothing(cloud):
    one = spectral.judge_edges(cloud, threads=1).verdicts
    two = spectral.judge_edges(cloud, threads=2).verdicts
    assert np.array_equal(one.score, two.score)


def test_calls_of_several_threads_give_the_same(city):
    graph = city[0]
    expected = slam.prune(graph).verdicts.score
    with ThreadPoolExecutor(4) as pool:
        found = list(pool.map(lambda _: slam.prune(graph).verdicts.score, range(8)))
    for scores in found:
        assert np.array_equal(scores, expected)


def test_other_threads_run_meanwhile():
    points = np.random.default_rng(1).uniform(size=(30000, 2))
    graph = geometry.nearest_neighbour_graph(points, 8)
    ticks = []
    done = threading.Event()

    def tick():
        while not done.wait(0.001):
            ticks.append(None)

    clock = threading.Thread(target=tick)
    clock.start()
    begin = time.perf_counter()
    spectral.effective_resistances(graph)
    seconds = time.perf_counter() - begin
    done.set()
    clock.join()
    assert len(ticks) > 20 * seconds


def test_progress_is_told_by_stage_and_count(city):
    told = []
    slam.prune(city[0], progress=lambda stage, done, total: told.append((stage, done, total)))
    assert told
    for stage, done, total in told:
        assert stage and 0 <= done and (total == 0 or done <= total)


def test_progress_is_told_on_the_calling_thread(city):
    threads = set()
    slam.prune(city[0], progress=lambda *_: threads.add(threading.get_ident()))
    assert threads == {threading.get_ident()}


def test_false_cancels(city):
    with pytest.raises(isotherm.Cancelled):
        slam.prune(city[0], progress=lambda *_: False)


@pytest.mark.parametrize("value", [None, 0, True, "", []])
def test_nothing_but_false_cancels(city, value):
    assert slam.prune(city[0], progress=lambda *_: value).verdicts


def test_what_progress_raises_comes_through(city):
    def fail(*_):
        raise KeyError("mine")

    with pytest.raises(KeyError, match="mine"):
        slam.prune(city[0], progress=fail)
    assert slam.prune(city[0]).verdicts  # and nothing is left behind


def test_progress_may_call_the_library(city):
    graph = city[0]
    inner = []
    slam.prune(graph, progress=lambda *_: inner.append(slam.prune(graph, "chi2")) and None)
    assert inner


def test_bars_of_tqdm(city, capfd):
    pytest.importorskip("tqdm")
    with isotherm.tqdm_progress(leave=True) as progress:
        slam.prune(city[0], progress=progress)
    assert f"/{len(city[1])} [" in capfd.readouterr().err


INTERRUPTED = """
    import os, signal, sys, threading, time
    from isotherm import slam
    clean, truth = slam.simulate_city(poses={poses}, loops={poses} // 2, seed=1)
    graph, _ = slam.corrupt(clean, truth, count={poses}, type="{type}", seed=1)
    asked = []
    def interrupt():
        asked.append(time.perf_counter())
        os.kill(os.getpid(), signal.SIGINT)
    threading.Timer({delay}, interrupt).start()
    try:
        {call}
        sys.exit("was not interrupted")
    except KeyboardInterrupt:
        print(time.perf_counter() - asked[0])
"""


def interrupted(call, type="random-grouped", poses=20000, delay=0.4, then="pass"):
    """What a program prints that is interrupted in `call`, and the whole time that it took."""
    program = textwrap.dedent(INTERRUPTED).format(call=call, type=type, poses=poses, delay=delay)
    begin = time.perf_counter()
    done = subprocess.run(
        [sys.executable, "-c", program + then], capture_output=True, text=True, timeout=120
    )
    assert done.returncode == 0, done.stderr
    assert done.stderr == ""
    return done.stdout.split(), time.perf_counter() - begin


@pytest.mark.parametrize(
    "call",
    [
        "slam.prune(graph)",
        "slam.prune(graph, progress=lambda *_: None)",
        "slam.optimize(graph, kernel='gnc')",
    ],
)
def test_an_interrupt_stops_the_work(call):
    (seconds,), _ = interrupted(call)
    assert float(seconds) < 2


# Random loops make a graph whose factor fills in: each factorisation takes many seconds, and the
# library that does it cannot be stopped.
@pytest.mark.parametrize("method", ["sc", "dcs", "cauchy", "gnc"])
def test_an_interrupt_does_not_wait_for_a_factorisation(method):
    (seconds,), whole = interrupted(f"slam.prune(graph, '{method}')", type="random", poses=10000)
    assert float(seconds) < 2
    assert whole < 10  # neither does the program's end


def test_the_next_call_waits_for_what_was_left_behind():
    then = "print(slam.prune(clean, 'chi2').verdicts.edge.size)"
    found, _ = interrupted("slam.prune(graph, 'sc')", type="random", poses=6000, then=then)
    assert int(found[1]) == 3000


def test_a_thread_that_waits_for_its_turn_can_be_interrupted():
    program = """
    import os, signal, sys, threading, time
    from isotherm import slam
    clean, truth = slam.simulate_city(poses=200, loops=100, seed=1)
    inside, leave = threading.Event(), threading.Event()
    def hold(*_):
        inside.set()
        leave.wait(60)
    other = threading.Thread(target=lambda: slam.prune(clean, progress=hold))
    other.start()
    inside.wait(60)
    threading.Timer(0.3, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
    try:
        slam.prune(clean)
        sys.exit("was not interrupted")
    except KeyboardInterrupt:
        print("interrupted")
    finally:
        leave.set()
        other.join()
    """
    done = subprocess.run(
        [sys.executable, "-c", textwrap.dedent(program)], capture_output=True, text=True, timeout=120
    )
    assert done.stdout == "interrupted\n", done.stderr


def test_signals_of_ones_own_are_handled(city):
    heard = []
    before = signal.signal(signal.SIGALRM, lambda *_: heard.append(None))
    try:
        signal.setitimer(signal.ITIMER_REAL, 0.01)
        while not heard:
            slam.prune(city[0], "chi2")
    finally:
        signal.signal(signal.SIGALRM, before)
