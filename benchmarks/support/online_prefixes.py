"""Verdicts on the way beside those of the batch on the same edges, run again from nothing."""

import functools
import json
import pathlib
import statistics
import tempfile

from support.online_peers import labelled, precision_recall
from support.runs import read_csv
from support.streams import prepare

ROWS = [("ringCity", "local-grouped", 0.5), ("B25b_0.600", "local-grouped", 0.5),
        ("B25b_0.600", "random-grouped", 0.5), ("Bovisa04", "random-grouped", 0.5),
        ("Bovisa04", "clean", 0.0), ("intel", "random", 0.9)]
POINTS = 12


def kept_at(events, count):
    """The loops that were kept when so many edges had come."""
    verdicts = {event["edge"]: event["verdict"] for event in events if event["at"] < count}
    return {edge for edge, verdict in verdicts.items() if verdict == "keep"}


def kept_by_batch(command, work, lines):
    (work / "part.g2o").write_text("".join(lines), encoding="utf-8")
    command.run("prune", work / "part.g2o", "--verdicts", work / "part.csv")
    return {int(row["edge"]) for row in read_csv(work / "part.csv") if row["verdict"] == "keep"}


def measure(command, data, graph, kind, fraction):
    with tempfile.TemporaryDirectory() as folder:
        work = pathlib.Path(folder)
        stream = prepare(command, data, work, graph, kind, fraction)
        true, ignored = labelled(stream, "correct"), labelled(stream, "ignore")
        command.run("follow", stream.graph, "--events", work / "e.jsonl")
        events = [event for event in map(json.loads, (work / "e.jsonl").read_text(
            encoding="utf-8").splitlines()) if "edge" in event]
        lines = [line for line in stream.graph.read_text(encoding="utf-8").splitlines(keepends=True)
                 if line.startswith("EDGE")]
        marks = []
        for count in (len(lines) * k // (POINTS + 1) for k in range(1, POINTS + 1)):
            known = {edge for edge in true if edge < count}
            if known:
                marks.append([precision_recall(kept - ignored, known)
                              for kept in (kept_at(events, count),
                                           kept_by_batch(command, work, lines[:count]))])
    means = [[statistics.mean(mark[who][what] for mark in marks) for what in (0, 1)] for who in (0, 1)]
    return {"graph": graph, "type": kind, "fraction": fraction, "online": means[0],
            "batch": means[1], "same": sum(online[0] >= batch[0] for online, batch in marks),
            "points": len(marks)}


def tasks(command, data):
    return {f"prefixes {graph} {kind} {fraction}": functools.partial(measure, command, data, graph,
                                                                     kind, fraction)
            for graph, kind, fraction in ROWS}


def section(rows):
    lines = ["## What could be known then", "",
             "Precision and recall of kept loops when a thirteenth, two, ... of all edges had come, as means: of",
             "`follow` then, and of `prune` on the same edges from nothing. Where false loops come before any",
             "true one that contradicts them, the batch keeps them, too. Where only `follow` keeps them, it has",
             "not searched from every start since. *as right* counts the points at which `follow` is no",
             "less precise.", "",
             "| graph | false loops | follow | prune | as right |", "|---|---|---|---|---|"]
    for row in rows:
        kind = "none" if row["type"] == "clean" else f"{row['fraction']:.0%} {row['type']}"
        online, batch = (f"{mark[0]:.3f}, {mark[1]:.3f}" for mark in (row["online"], row["batch"]))
        lines.append(f"| {row['graph']} | {kind} | {online} | {batch} | "
                     f"{row['same']} of {row['points']} |")
    return lines + [""]
