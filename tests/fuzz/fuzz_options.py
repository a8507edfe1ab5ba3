#!/usr/bin/env python3
"""Runs the command with random options on tiny graphs: it must end by itself or within moments
of Ctrl-C, with an exit code of its contract, and leave no output where it failed.

usage: fuzz_options.py COMMAND [--seconds S] [--runs N] [--seed K]

Options, their kinds and their ranges are those that --help states. A find is printed as the line
of shell that makes it; the exit code is then 1.
"""
import argparse
import json
import math
import os
import random
import re
import shlex
import signal
import subprocess
import sys
import tempfile
import time

OK, FAILURE, USAGE, BAD_INPUT, NOT_CONVERGED, INTERRUPTED = 0, 1, 2, 3, 4, 130
LONGEST_RUN = 5.0  # seconds until Ctrl-C
LONGEST_STOP = 3.0  # seconds it may take then; the promise is 2

METHODS = "consensus heat chi2 lap-line rrr pcm sc dcs cauchy gnc".split()
VERBS = {  # the verb and its positional arguments, and what it may write
    **{f"prune --method {m}": ["GRAPH"] for m in METHODS},
    "optimize": ["GRAPH"],
    "label --ground-truth truth.g2o": ["GRAPH"],
    "corrupt": ["GRAPH"],
    "candidates --odometry truth.g2o": ["list.csv"],
    "edges": ["PLAIN"],
    "embed": ["PLAIN"],
    "localize": ["RANGES"],
    "simulate city": [],
    "simulate ring": [],
    "simulate sphere": [],
    "simulate grid3d": [],
    "simulate network": [],
    "eval rpe": ["GRAPH", "truth.g2o"],
    "eval ate": ["GRAPH", "truth.g2o"],
    "info": ["GRAPH"],
    "follow": ["GRAPH"],
}
FILES = {"GRAPH": ["city.g2o", "sphere.g2o", "pair.g2o"], "PLAIN": ["graph.csv", "cloud.csv"],
         "RANGES": ["ranges.csv"]}
SUFFIXES = {"-o": [".g2o", ".csv"], "--verdicts": [".csv"], "--labels": [".csv"],
            "--json": [".json"], "--report": [".html", ".json"], "--svg": [".svg"]}
NEVER = {"--help", "--dump-config", "--config", "--trusted", "--timestamps", "--positions",
         "--anchors", "--method", "--preset", "--ground-truth", "--anchor-file", "--json"}
ODD = ["nan", "inf", "-inf", "", "x", "1e999", "-1", "0", "-0.0", "1e-320", "4294967297",
       "18446744073709551617", "-9223372036854775809", "0x10", "1,2", "1.5", "1e3", " 1", "+1", "--"]


class Option:
    """One option as help states it."""

    def __init__(self, flag, kind, text):
        self.flag, self.kind = flag, kind
        found = re.search(r"in ([\[(])([-+.e\d]+), ([-+.e\d]+)([\])])",
                          text.replace("2^64", str(2 ** 64)))
        self.range = (float(found[2]), float(found[3]), found[1], found[4]) if found else None

    def inside(self, rng):
        low, high, opening, closing = self.range
        whole = self.kind.startswith(("INT", "UINT"))
        value = rng.choice([low, high, rng.uniform(low, high), low + rng.random(),
                            low + rng.expovariate(0.1), min(high, 10 ** rng.uniform(-12, 12))])
        value = min(max(value, low), high)
        if value == low and opening == "(":
            value = low + (high - low) * 10 ** rng.uniform(-15, -1)
        if value == high and closing == ")":
            value = high - (high - low) * 10 ** rng.uniform(-15, -1)
        return int(value) if whole else value

    def outside(self, rng):
        low, high, opening, closing = self.range
        values = [low - 1, high + 1, high * 10 + 1, -1e300, 1e300]
        values += [low] if opening == "(" else []
        values += [high] if closing == ")" else []
        value = rng.choice(values)
        whole = self.kind.startswith(("INT", "UINT")) and abs(value) < 1e18
        return int(value) if whole else value


def options_of(command, verb):
    """All options of a verb that take no file."""
    text = subprocess.run([command, *shlex.split(verb), "--help"], capture_output=True, text=True,
                          check=True).stdout
    entries = re.split(r"\n  (?=-)", text)[1:]
    options = []
    for entry in entries:
        entry = re.split(r"\n\n", entry)[0]
        words = entry.split()
        flag = [name for name in words[0].split(",") if name.startswith("--")]
        if not flag or flag[0] in NEVER:
            continue
        kind = words[1] if len(words) > 1 else ""
        if kind == "FILE":
            continue
        if "{false}" in words[0]:
            kind = "SWITCH"
        options.append(Option(flag[0].split("{")[0], kind, " ".join(words)))
    return options


def value_of(option, rng):
    """A value, and whether it is certain to be refused."""
    kind = option.kind
    if "|" in kind:
        return (rng.choice(kind.split("|")), False) if rng.random() < 0.9 else ("magic", True)
    if option.range is None:
        return rng.choice(["0", "1", "2", "7"]), False
    if rng.random() < 0.1:
        return rng.choice(ODD), False
    if rng.random() < 0.15:
        return repr(option.outside(rng)), True
    if kind.endswith(",..."):
        values = sorted((option.inside(rng) for _ in range(rng.randint(1, 3))), reverse=True)
        return ",".join(map(repr, values)), False
    return repr(option.inside(rng)), False


def arguments_of(verb, options, rng):
    """A random command line, and whether it is certain to be refused."""
    line, refused = shlex.split(verb), False
    for name in VERBS[verb]:
        line.append(rng.choice(FILES.get(name, [name])))
    config = {}
    for option in rng.sample(options, min(len(options), rng.randint(1, 4))):
        if option.kind == "SWITCH":
            line.append(option.flag if rng.random() < 0.5 else "--no-" + option.flag[2:])
            continue
        if not option.range and "|" not in option.kind and option.kind not in ("UINT", "INT:{0,2,3}"):
            if option.flag not in ("--align",):
                line.append(option.flag)
            continue
        value, wrong = value_of(option, rng)
        common = option.flag in ("--threads", "--seed", "--max-gap", "--neighbours", "--radius",
                                 "--dimension", "--align")
        if rng.random() < 0.2 and not common and "|" not in option.kind and "," not in value:
            try:
                number = json.loads(value)
            except ValueError:
                continue
            if not isinstance(number, (int, float)) or not math.isfinite(number):
                continue
            config[option.flag[2:].replace("-", "_")] = number
        else:
            line.append(f"{option.flag}={value}")
        refused = refused or wrong
    if config:
        with open("config.json", "w", encoding="utf-8") as file:
            json.dump(config, file)
        line += ["--config", "config.json"]
    return line, refused


def make_inputs(command):
    """Tiny graphs, in the current folder."""
    def run(*arguments):
        subprocess.run([command, *arguments, "-q"], check=True)
    run("simulate", "city", "--poses", "40", "--loops", "12", "-o", "city.g2o",
        "--ground-truth", "truth.g2o")
    run("simulate", "sphere", "--poses", "30", "--loops", "8", "-o", "sphere.g2o")
    run("simulate", "network", "--nodes", "20", "--anchors", "4", "-o", "ranges.csv")
    with open("pair.g2o", "w", encoding="utf-8") as file:
        file.write("EDGE_SE2 0 1 1 0 0 1 0 0 1 0 1\nEDGE_SE2 0 1 1 0 0 1 0 0 1 0 1\n")
    with open("graph.csv", "w", encoding="utf-8") as file:
        file.writelines(f"{v},{(v + step) % 25},1\n" for v in range(25) for step in (1, 2))
    with open("list.csv", "w", encoding="utf-8") as file:
        file.writelines(["from,to\n", *(f"{v},{v + 20}\n" for v in range(0, 20, 3))])
    with open("cloud.csv", "w", encoding="utf-8") as file:
        file.writelines(f"{v % 5},{v // 5}\n" for v in range(25))


def heed_interrupts():
    """What a shell starts in the background ignores Ctrl-C, and so does all that it starts."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)


def limit_memory():
    import resource
    resource.setrlimit(resource.RLIMIT_AS, (4 << 30, 4 << 30))
    heed_interrupts()


def run_once(command, line, limit):
    """Exit code, what was said, and whether Ctrl-C was needed."""
    with open("stderr.txt", "wb") as err:
        process = subprocess.Popen([command, *line], stdout=subprocess.DEVNULL, stderr=err,
                                   stdin=subprocess.DEVNULL, preexec_fn=limit)
        stopped = False
        try:
            process.wait(LONGEST_RUN)
        except subprocess.TimeoutExpired:
            stopped = True
            process.send_signal(signal.SIGINT)
            try:
                process.wait(LONGEST_STOP)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()
    with open("stderr.txt", encoding="utf-8", errors="replace") as err:
        return process.returncode, err.read(), stopped


def problem_of(code, said, stopped, refused, outputs):
    """What is wrong with a run, or None."""
    left = [name for name in outputs if os.path.exists(name)]
    if code == FAILURE and "out of memory" in said:
        return f"out of memory leaves {left}" if left else None
    if code == INTERRUPTED and stopped:
        return f"an interrupted run leaves {left}" if left else None
    if code not in (OK, USAGE, BAD_INPUT, NOT_CONVERGED):  # done before it heeded Ctrl-C
        return f"exit code {code}"
    if refused and code != USAGE:
        return f"a value out of range is taken: {code}"
    if code in (USAGE, BAD_INPUT) and left:
        return f"exit code {code} leaves {left}"
    if code in (USAGE, BAD_INPUT) and not said.strip():
        return f"exit code {code} without a word"
    return None


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("command")
    parser.add_argument("--seconds", type=float, default=600.0)
    parser.add_argument("--runs", type=int, default=sys.maxsize)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--no-memory-limit", action="store_true", help="sanitizers need it")
    given = parser.parse_args()
    command = os.path.abspath(given.command)
    rng = random.Random(given.seed)
    finds, runs, codes = 0, 0, {}
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        make_inputs(command)
        known = {verb: options_of(command, verb) for verb in VERBS}
        end = time.monotonic() + given.seconds
        while runs < given.runs and time.monotonic() < end:
            runs += 1
            verb = rng.choice(list(VERBS))
            line, refused = arguments_of(verb, known[verb], rng)
            outputs = []
            if not verb.startswith(("eval", "info")):
                graph = verb.startswith(("prune", "optimize", "corrupt", "candidates",
                                          "simulate"))
                plain = verb == "simulate network"
                outputs = ["out.csv" if plain or not graph else "out.g2o"]
                line += ["-o", outputs[0]]
            limit = heed_interrupts if given.no_memory_limit else limit_memory
            code, said, stopped = run_once(command, line, limit)
            codes[code] = codes.get(code, 0) + 1
            problem = problem_of(code, said, stopped, refused, outputs)
            if problem:
                finds += 1
                shown = open("config.json", encoding="utf-8").read() if "--config" in line else ""
                print(f"{problem}\n  isotherm {shlex.join(line)} {shown}\n  {said[:300]}", flush=True)
            for name in outputs:
                if os.path.exists(name):
                    os.remove(name)
        os.chdir("/")
    by_code = ", ".join(f"{code}: {count}" for code, count in sorted(codes.items()))
    print(f"{runs} runs, {finds} finds; exit codes {by_code}")
    return 1 if finds else 0


if __name__ == "__main__":
    sys.exit(main())
