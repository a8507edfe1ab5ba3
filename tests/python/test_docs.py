"""What documentation says in Python runs, and the commands of the tutorial do."""

import os
import re
import subprocess
from pathlib import Path

import pytest
from conftest import ROOT


def snippets(page, language):
    text = (ROOT / page).read_text()
    return re.findall(rf"^```{language}\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)


def run_python(page):
    names = {}
    assert snippets(page, "python")
    for snippet in snippets(page, "python"):
        exec(compile(snippet, page, "exec"), names)


@pytest.mark.parametrize("page", ["README.md", "docs/python.md"])
def test_snippets_run(page, city, tmp_path, monkeypatch):
    city[0].write(tmp_path / "map.g2o")
    monkeypatch.chdir(tmp_path)
    run_python(page)


def test_the_tutorial_runs(tmp_path, monkeypatch):
    command = os.environ.get("ISOTHERM_COMMAND")
    if not command:
        pytest.skip("ISOTHERM_COMMAND names no command")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("PATH", f"{Path(command).parent}:{os.environ['PATH']}")
    script = "\n".join(snippets("docs/tutorial.md", "sh"))
    subprocess.run(["bash", "-ec", script], check=True)
    assert (tmp_path / "report.html").stat().st_size > 10**5
    run_python("docs/tutorial.md")
