"""Memory and time of 10^5 poses with 10^5 loops."""

import functools
import json
import pathlib
import tempfile


def measure(command):
    with tempfile.TemporaryDirectory() as folder:
        work = pathlib.Path(folder)
        command.run("simulate", "city", "--poses", 100000, "--loops", 70000, "--seed", 5, "-o",
                    work / "c.g2o")
        command.run("corrupt", work / "c.g2o", "--fraction", 0.3, "-o", work / "f.g2o")
        command.run("convert", work / "f.g2o", "--in-time-order", "-o", work / "s.g2o")
        usage = command.run("follow", work / "s.g2o", "--events", work / "e.jsonl", "--json",
                            work / "s.json")
        run = json.loads((work / "s.json").read_text(encoding="utf-8"))
    return {"loops": run["loops"], "cpu_ms": run["cpu_ms"],
            "megabytes": usage.ru_maxrss / 1024, "seconds": usage.ru_utime + usage.ru_stime}


def tasks(command, _):
    return {"memory": functools.partial(measure, command)}


def section(rows):
    lines = []
    for row in rows:
        cpu = row["cpu_ms"]
        lines += ["## A hundred thousand poses", "",
                  f"A simulated city of 100,000 poses with {row['loops']:,} loops, 30 % of them false, at random:",
                  f"`follow` takes {row['megabytes']:.0f} MB at most and {row['seconds']:.0f} s of CPU time; a call "
                  f"{cpu['median']:.2f} ms",
                  f"(median), {cpu['p99']:.0f} ms (99 %) and {cpu['worst']:.0f} ms (worst).", ""]
    return lines
