import csv
import math
import os
import struct
import subprocess
import sys

import pyarrow
import pytest
from pyarrow import parquet

from mjmr.conditions import Condition
from mjmr.errors import InvalidInputError, MjmrError
from mjmr.export import export
from mjmr.store import Outcome, Store

META = {"digest": "d" * 64}
A, B = Condition({"x": 1.0, "on": True}), Condition({"x": 2.0, "on": False})
AWKWARD = [math.nan, math.inf, -math.inf, -0.0, 5e-324, 0.1 + 0.2, 1.7976931348623157e308]


@pytest.fixture
def folder(tmp_path):
    with Store(tmp_path / "r", META) as store:
        for seed, value in enumerate(AWKWARD):
            metrics = {"v": value, "n": seed, "hit": seed > 2, "side": "ä,\n", "none": None}
            metrics |= {"both": 1 if seed else 0.5, "huge": 2**70, "large": 2**53 + 1}
            store.record(Outcome(A, seed, "ok", metrics, {"wall_trial": 0.1 * seed}))
        store.record(Outcome(B, 3, "failed", error="E: no"))
    return tmp_path / "r"


def bits(value):
    return None if value is None else struct.pack("<d", value)


def test_parquet_reads_back_bit_for_bit_with_types(folder, tmp_path):
    path = tmp_path / "t.parquet"
    assert export(folder, path) == 8
    table = parquet.read_table(path)
    kinds = {field.name: field.type for field in table.schema}
    assert kinds["x"] == kinds["v"] == kinds["both"] == kinds["wall_trial"] == pyarrow.float64()
    assert kinds["seed"] == kinds["n"] == kinds["large"] == pyarrow.int64()
    assert kinds["on"] == kinds["hit"] == pyarrow.bool_()
    assert kinds["status"] == kinds["side"] == kinds["error"] == kinds["huge"] == pyarrow.string()
    found = table.to_pydict()
    assert [bits(v) for v in found["v"]] == [bits(v) for v in [None, *AWKWARD]]
    assert table["v"].null_count == 1  # what is missing; nan is a value
    assert found["n"] == [None, *range(7)]
    assert found["hit"] == [None] + [False] * 3 + [True] * 4
    assert found["both"] == [None, 0.5] + [1.0] * 6
    assert found["large"][1] == 2**53 + 1
    assert found["huge"][1] == str(2**70)
    assert found["none"] == [None] * 8
    assert found["status"] == ["failed"] + ["ok"] * 7


def test_both_formats_have_the_same_columns_and_rows(folder, tmp_path):
    for name in ("t.csv", "t.PARQUET"):
        export(folder, tmp_path / name)
    with (tmp_path / "t.csv").open(newline="") as file:
        names, *rows = list(csv.reader(file))
    table = parquet.read_table(tmp_path / "t.PARQUET")
    assert table.column_names == names
    columns = table.to_pydict()
    told = [
        ["" if v is None else str(v) for v in row] for row in zip(*columns.values(), strict=True)
    ]
    both = names.index("both")
    for row in rows:  # CSV keeps the mixture of whole numbers and others
        row[both] = str(float(row[both])) if row[both] else ""
    assert told == rows


def test_another_ending_lists_what_is_allowed(folder, tmp_path):
    for name in ("t.xlsx", "t", ".csv"):
        with pytest.raises(InvalidInputError, match=r"ends in \.csv or \.parquet"):
            export(folder, tmp_path / name)
    assert [p.name for p in tmp_path.iterdir()] == ["r"]


def test_without_pyarrow_it_says_what_to_install(folder, tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    with pytest.raises(MjmrError, match=r'pip install "mjmr\[parquet\]"'):
        export(folder, tmp_path / "t.parquet")
    assert [p.name for p in tmp_path.iterdir()] == ["r"]


def test_what_a_killed_writer_left_is_cleared_and_what_is_in_use_is_not(tmp_path):
    from mjmr.files import temporary_folder, write_atomically

    code = (
        "import os, signal, sys\nfrom pathlib import Path\nfrom mjmr import files\n"
        "with files.temporary_folder(Path(sys.argv[1]), 'film') as f:\n"
        "    (f / 'half.mp4').write_bytes(b'x')\n"
        "    os.replace = lambda *a: os.kill(os.getpid(), signal.SIGKILL)\n"
        "    files.write_atomically(Path(sys.argv[1]) / 'claims.json', 'x')\n"
    )
    done = subprocess.run([sys.executable, "-c", code, str(tmp_path)], env=os.environ)
    assert done.returncode == -9
    assert len(list(tmp_path.iterdir())) == 2
    (tmp_path / ".tmp-of-another-program").touch()
    with temporary_folder(tmp_path, "plots") as folder:
        (folder / "plot.svg").touch()
        write_atomically(tmp_path / "claims.json", "whole")
        assert (folder / "plot.svg").exists()
    assert {p.name for p in tmp_path.iterdir()} == {"claims.json", ".tmp-of-another-program"}
