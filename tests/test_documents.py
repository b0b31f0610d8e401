"""The README's script and the pages of docs/ are run, not only read."""

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent


def blocks(path: Path, language: str) -> list[str]:
    return re.findall(rf"^```{language}\n(.*?)^```", path.read_text(), re.M | re.S)


def run(command, folder, **environment):
    return subprocess.run(
        command,
        cwd=folder,
        env=os.environ | environment,
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )


@pytest.mark.slow
def test_the_readme_script_runs_and_makes_a_film(tmp_path):
    scripts = [b for b in blocks(ROOT / "README.md", "python") if "Film" in b]
    assert len(scripts) == 1
    lines = [line for line in scripts[0].splitlines() if line.strip()]
    assert len(lines) <= 24, "the README promises a script of about twenty lines"
    script = tmp_path / "script.py"
    script.write_text(scripts[0])
    done = run([sys.executable, str(script)], tmp_path)
    assert done.returncode == 0, done.stderr
    (film,) = tmp_path.glob("*.mp4")
    import av

    with av.open(str(film)) as container:
        stream = container.streams.video[0]
        assert stream.codec_context.name == "h264"
        assert stream.frames >= 5 * 30


def write_files(page, folder):
    """Write every Python block of a page to the file it names."""
    for block in blocks(page, "python"):
        name = re.match(r"# file: (\S+)\n", block)
        assert name, "every Python block of this page is a file"
        path = folder / name[1]
        path.parent.mkdir(exist_ok=True)
        path.write_text(block)


def run_shell(text, folder):
    done = run(
        ["bash", "-euo", "pipefail", "-c", text],
        folder,
        PATH=f"{Path(sys.executable).parent}:{os.environ['PATH']}",
        COLUMNS="120",  # wherever the tests run, the width the page was written at
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


@pytest.mark.slow
def test_the_script_on_cameras_prints_what_it_says(tmp_path):
    (script,) = blocks(ROOT / "docs" / "cameras.md", "python")
    (tmp_path / "eyes.py").write_text(script)
    done = run([sys.executable, "eyes.py"], tmp_path)
    assert done.returncode == 0, done.stderr
    assert done.stdout.splitlines() == ["(4, 120, 160, 3) 0.9", "True"]


@pytest.mark.slow
def test_the_three_lines_of_the_safety_filter_print_what_they_say(tmp_path):
    page = ROOT / "docs" / "safety-filter.md"
    write_files(page, tmp_path)
    done = run([sys.executable, "three_lines.py"], tmp_path)
    assert done.returncode == 0, done.stderr
    assert done.stdout == blocks(page, "text")[0]


@pytest.mark.slow
def test_the_barrier_takes_other_studies_roles_and_another_filter_takes_its(tmp_path):
    page = ROOT / "docs" / "safety-filter.md"
    write_files(page, tmp_path)
    for shell in blocks(page, "sh"):
        run_shell(shell, tmp_path)
    folders = {p.name for p in (tmp_path / "renders").glob("*/*")}
    assert folders == {"quick+navigator=BarrierNavigator", "quick", "quick+filter=Timid"}


@pytest.mark.slow
def test_the_page_on_consensus_finds_its_mean_and_swaps_its_gains(tmp_path):
    page = ROOT / "docs" / "consensus.md"
    write_files(page, tmp_path)
    done = run([sys.executable, "mean.py"], tmp_path)
    assert done.returncode == 0, done.stderr
    assert done.stdout == blocks(page, "text")[0]
    (shell,) = [b for b in blocks(page, "sh") if "--with" in b]
    run_shell(f"{shell.rstrip()} --out found.json", tmp_path)
    found = json.loads((tmp_path / "found.json").read_text())
    assert found["pairs"] == 8
    (near,) = found["metrics"]
    assert near["a"] == pytest.approx(63, abs=0.6)
    assert near["b"] == pytest.approx(23, abs=0.6)
    lines = [line for line in (tmp_path / "half.py").read_text().splitlines() if line.strip()]
    assert len(lines) <= 15


@pytest.mark.slow
def test_the_page_on_adding_a_system_runs(tmp_path):
    page = ROOT / "docs" / "add-a-system.md"
    write_files(page, tmp_path)
    commands = [b for b in blocks(page, "sh") if "mjmr run" in b]
    assert len(commands) == 1
    run_shell(
        commands[0].replace("--size standard --only gain=2.0", "--seeds 1 --out again"), tmp_path
    )
    claims = (tmp_path / "renders" / "rendezvous" / "quick" / "claims.json").read_text()
    assert '"verdict": "holds"' in claims


@pytest.mark.slow
def test_the_page_on_swapping_a_part_runs_and_the_swapped_part_loses(tmp_path):
    page = ROOT / "docs" / "swap-a-part.md"
    write_files(page, tmp_path)
    (shell,) = blocks(page, "sh")
    out = run_shell(f"{shell.rstrip()} --out found.json", tmp_path)
    found = json.loads((tmp_path / "found.json").read_text())
    assert found["pairs"] == 12
    assert (found["a"]["failed"], found["b"]["failed"]) == (0, 0)
    (overlap,) = [row for row in found["metrics"] if row["metric"] == "overlap_mm_s"]
    assert overlap["a"] == 0.0
    assert overlap["low"] > 50.0
    assert overlap["p"] < 0.01
    assert found["verdicts_changed"]["zero-cross4"] == {"a": "holds", "b": "fails"}
    printed = {tuple(line.split()[:2]) for line in out.splitlines()}
    for line in blocks(page, "text")[0].splitlines():
        assert tuple(line.split()[:2]) in printed, line


def test_every_committed_picture_the_readme_shows_is_there():
    for target in re.findall(r"!\[[^]]*\]\(([^)]+)\)", (ROOT / "README.md").read_text()):
        assert (ROOT / target).is_file(), target


def test_every_page_a_document_links_to_is_there():
    for page in [ROOT / "README.md", *ROOT.glob("docs/*.md")]:
        for target in re.findall(r"(?<!!)\[[^]]*\]\(([^)#]+)\)", page.read_text()):
            if not target.startswith("http"):
                assert (page.parent / target).exists(), f"{page.name} links to {target}"


def test_the_readme_counts_the_committed_verdicts():
    """The table of systems says for each study how its claims stand at size standard."""
    from mjmr.registry import load_study, study_references

    readme = (ROOT / "README.md").read_text()
    for name in study_references():
        study = load_study(name)
        verdicts = study.committed_verdicts()["standard"]
        counts = [
            f"{sum(v == verdict for v in verdicts.values())} {verdict}"
            for verdict in ("holds", "fails", "inconclusive", "not testable")
            if verdict in verdicts.values()
        ]
        (row,) = [line for line in readme.splitlines() if line.startswith(f"| `{name}`")]
        assert ", ".join(counts) in row


@pytest.mark.slow
@pytest.mark.parametrize(
    ("script", "said"),
    [("lidars.py", "clear"), ("dogs.py", "True"), ("laps.py", "3"), ("pushers.py", "True")],
)
def test_the_scripts_on_robots_print_what_they_say(tmp_path, script, said):
    write_files(ROOT / "docs" / "robots.md", tmp_path)
    done = run([sys.executable, script], tmp_path)
    assert done.returncode == 0, done.stderr
    assert done.stdout.split() == [said]


@pytest.mark.slow
def test_the_page_on_schemas_runs_and_prints_its_diagram(tmp_path):
    page = ROOT / "docs" / "schemas.md"
    write_files(page, tmp_path)
    done = run([sys.executable, "wallflowers.py"], tmp_path)
    assert done.returncode == 0, done.stderr
    assert done.stdout == blocks(page, "mermaid")[0]
    script = (tmp_path / "wallflowers.py").read_text()
    composed = script[script.index("away,") : script.index("world =")].strip()
    assert len(composed.splitlines()) <= 10, "the page promises ten lines"
    assert (tmp_path / "wallflowers.mp4").stat().st_size > 50_000


def test_every_schema_is_on_its_page():
    import controllers.schemas as library

    page = (ROOT / "docs" / "schemas.md").read_text()
    for name in library.__all__:
        kind = getattr(library, name)
        if isinstance(kind, type) and issubclass(kind, library.Schema | library.Cue):
            assert kind in (library.Schema, library.Cue) or f"`{name}(" in page, name
