"""Options as keywords, made from the fields that flags are made from."""

import inspect
import json
import re

import numpy as np
import pytest
from isotherm import InvalidArgument, network, slam, spectral

METHODS = list(slam.prune_methods())


@pytest.mark.parametrize("method", METHODS)
def test_keywords_are_the_options_of_the_command(method, run_command):
    shown = json.loads(run_command("prune", "-", "--method", method, "--dump-config"))
    assert shown.pop("method") == method
    assert set(shown) == set(slam.prune_methods()[method])


@pytest.mark.parametrize("method", METHODS)
def test_the_commands_defaults_change_nothing(method, run_command, city):
    options = json.loads(run_command("prune", "-", "--method", method, "--dump-config"))
    plain = slam.prune(city[0], method)
    stated = slam.prune(city[0], **options)
    assert plain.method == stated.method == method
    assert np.array_equal(plain.verdicts.score, stated.verdicts.score, equal_nan=True)


@pytest.mark.parametrize("method", METHODS)
def test_documentation_has_every_option(method):
    for name, help in slam.prune_methods()[method].items():
        assert f"    {name}: " in slam.prune.__doc__
        assert help


@pytest.mark.parametrize(
    "function, verb",
    [
        (spectral.judge_edges, ["edges", "-"]),
        (spectral.embed, ["embed", "-", "-o", "-"]),
        (network.localize, ["localize", "-"]),
        (slam.optimize, ["optimize", "-", "-o", "-"]),
        (slam.densify, ["densify", "-", "-o", "-"]),
    ],
)
def test_documentation_has_every_flag(function, verb, run_command):
    shown = json.loads(run_command(*verb, "--dump-config"))
    named = set(re.findall(r"^    (\w+): ", function.__doc__, re.MULTILINE))
    # Robots that move among beacons are located by the command alone.
    of_robots = {"start", "bias", "calibrate", "doubt", "max_steps"}
    assert set(shown) - (of_robots if function is network.localize else set()) <= named


def test_an_unknown_keyword_is_told(city):
    with pytest.raises(TypeError, match=r"prune\(\) has no keyword 'significanse'; did you mean 'significance'"):
        slam.prune(city[0], significanse=0.1)
    with pytest.raises(TypeError, match=r"optimize\(\) has no keyword 'speed'"):
        slam.optimize(city[0], speed="high")


def test_an_option_of_another_method_is_told(city):
    with pytest.raises(TypeError, match="scales: is an option of heat, not of method chi2"):
        slam.prune(city[0], "chi2", scales=[1.0])


@pytest.mark.parametrize("value", ["0.1", None.__class__, [0.1], True, {}])
def test_a_number_is_a_number(city, value):
    with pytest.raises(TypeError, match="significance: expected a number, got"):
        slam.prune(city[0], "chi2", significance=value)


@pytest.mark.parametrize("value", [20.5, "20", True, 20.0])
def test_a_whole_number_is_whole(city, value):
    with pytest.raises(TypeError, match="window: expected an integer, got"):
        slam.prune(city[0], "consensus", window=value)


@pytest.mark.parametrize("value", [1, 0, "yes", np.int64(1)])
def test_a_switch_is_true_or_false(city, value):
    with pytest.raises(TypeError, match="calibrate: expected True or False, got"):
        slam.prune(city[0], "consensus", calibrate=value)


@pytest.mark.parametrize("value", [np.float32(0.25), np.float64(0.25), np.int8(0), np.array(0.25)])
def test_numbers_of_numpy_are_numbers(city, value):
    assert slam.prune(city[0], "lap-line", curve_threshold=value).method == "lap-line"


def test_switches_and_whole_numbers_of_numpy(city):
    slam.prune(city[0], "consensus", calibrate=np.False_, window=np.int16(20))


def test_names_are_strings(city):
    with pytest.raises(TypeError, match="kernel: expected a string, got 3"):
        slam.optimize(city[0], kernel=3)
    with pytest.raises(InvalidArgument, match=r"unknown value 'hubert', expected one of none\|huber") as raised:
        slam.optimize(city[0], kernel="hubert")
    assert raised.value.option == "kernel"


@pytest.mark.parametrize("value", [[1.0, 0.1], (1, 0.1), np.array([1.0, 0.1]), np.array([1, 0])])
def test_lists_are_sequences_or_arrays(city, value):
    assert slam.prune(city[0], "heat", scales=value).method == "heat"


@pytest.mark.parametrize("value", ["1,2", 3.0, [[1.0]], ["a"]])
def test_other_things_are_no_lists(city, value):
    with pytest.raises((TypeError, ValueError), match="scales: expected"):
        slam.prune(city[0], "heat", scales=value)


@pytest.mark.parametrize(
    "call",
    [
        lambda g: slam.prune(g, "chi2", significance=1.5),
        lambda g: slam.prune(g, "chi2", significance=float("nan")),
        lambda g: slam.prune(g, "consensus", window=0),
        lambda g: slam.prune(g, "consensus", window=2**40),
        lambda g: slam.prune(g, threads=-1),
        lambda g: slam.optimize(g, max_iterations=-1),
        lambda g: slam.corrupt(g, count=-7),
        lambda g: slam.densify(g, copies=0),
        lambda g: slam.simulate_city(poses=0),
        lambda g: network.simulate_network(dimension=4),
    ],
)
def test_what_is_out_of_range_is_told(city, call):
    with pytest.raises(InvalidArgument) as raised:
        call(city[0])
    assert raised.value.option
    assert raised.value.option in str(raised.value)


def test_none_is_the_default(city):
    plain = slam.prune(city[0], "chi2")
    assert np.array_equal(slam.prune(city[0], "chi2", significance=None).verdicts.score, plain.verdicts.score)


def test_progress_is_a_function(city):
    with pytest.raises(TypeError, match="progress: expected a function, got 7"):
        slam.prune(city[0], progress=7)


def test_signatures_state_types_and_defaults():
    assert "kernel: typing.Literal['none', 'huber'" in slam.optimize.__nb_signature__[0][0]
    assert "max_iterations: int = 100" in slam.optimize.__nb_signature__[0][0]
    assert "Find the poses that fit a pose graph best." in inspect.getdoc(slam.optimize)
