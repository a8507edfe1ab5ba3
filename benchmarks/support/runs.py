"""Runs the command, and keeps every result so that a run can be resumed."""

import concurrent.futures
import csv
import json
import os
import pathlib
import subprocess
import sys
import time


class Command:
    """The isotherm command, on one thread so that several may run at once."""

    OK = (0, 4)  # 4: finished without converging, which is a result
    TIMED_OUT = 124

    def __init__(self, path, time_limit=3600):
        self.path, self.time_limit = path, time_limit  # seconds

    def run(self, *arguments):
        """Runs the command; returns what resources it used (os.wait4)."""
        line = ["timeout", str(self.time_limit), self.path, *map(str, arguments), "--threads", "1",
                "--quiet"]
        process = subprocess.Popen(line, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
        message = process.stderr.read().decode()
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        if process.returncode == self.TIMED_OUT:
            raise TimeoutError(f"stopped after {self.time_limit} s")
        if process.returncode not in self.OK:
            raise RuntimeError(f"{' '.join(line)}: exit {process.returncode}: {message}")
        return usage

    def json(self, work, *arguments):
        """Runs the command with --json; returns the document."""
        path = work / "result.json"
        self.run(*arguments, "--json", path)
        return json.loads(path.read_text(encoding="utf-8"))


class Results:
    """A JSON document a key, each written at once or not at all."""

    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        self.folder.mkdir(parents=True, exist_ok=True)

    def path(self, key):
        return self.folder / (key.replace("/", "__") + ".json")

    def get(self, key):
        path = self.path(key)
        return json.loads(path.read_text(encoding="utf-8")) if path.exists() else None

    def put(self, key, value):
        path = self.path(key)
        part = path.with_suffix(".part")
        part.write_text(json.dumps(value), encoding="utf-8")
        part.replace(path)


def run_all(tasks, results, jobs):
    """Runs what is not there yet of `tasks`, a dictionary of key to function."""
    missing = {key: task for key, task in tasks.items() if results.get(key) is None}
    start, done = time.monotonic(), len(tasks) - len(missing)
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        running = {pool.submit(task): key for key, task in missing.items()}
        try:
            for future in concurrent.futures.as_completed(running):
                results.put(running[future], outcome(future))
                done += 1
                elapsed = time.monotonic() - start
                print(f"{done} of {len(tasks)}, {elapsed:.0f} s: {running[future]}",
                      file=sys.stderr, flush=True)
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
            raise


def outcome(future):
    """What a task gave, or that it ran out of time, which is a result too."""
    try:
        return future.result()
    except TimeoutError as error:
        return {"failed": str(error)}


def write_csv(path, columns, rows):
    """Rows, dictionaries, as a CSV file."""
    with open(path, "w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, columns, lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


def read_csv(path):
    """The rows of a CSV file as dictionaries."""
    with open(path, encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))
