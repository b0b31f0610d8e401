import json
import os
import subprocess
import sys
from pathlib import Path

_MODULE = """
from mjmr.jit import njit

@njit
def twice(x):
    return x + x
"""
# Between numba's look at what is saved and its own saving there is time for another process.
_COMPILE = """
import os, sys, time
from pathlib import Path
from numba.core.caching import IndexDataCacheFile
load = IndexDataCacheFile._load_index
def slowly(self):
    found = load(self)
    time.sleep(0.5)
    return found
from summing import twice
Path(sys.argv[1] + ".ready").touch()
while len(list(Path(".").glob("*.ready"))) < 2:
    time.sleep(0.01)
IndexDataCacheFile._load_index = slowly
twice(eval(sys.argv[2]))
"""
_READ = """
import json
from summing import twice
told = [repr(twice(3)), repr(twice(0.25))]
print(json.dumps([told, sum(twice.stats.cache_hits.values())]))
"""
_KILL = """
import os, signal
from numba.core.caching import IndexDataCacheFile
def killed(self, name, data):
    open(self._data_path(name) + ".tmp.half", "wb").write(b"half")
    os.kill(os.getpid(), signal.SIGKILL)
IndexDataCacheFile._save_data = killed
from summing import twice
twice(3)
"""


def start(tmp_path, code, *arguments):
    (tmp_path / "summing.py").write_text(_MODULE)
    paths = os.pathsep.join([str(tmp_path), os.getcwd()])
    environment = {
        **os.environ, "PYTHONPATH": paths, "NUMBA_CACHE_DIR": str(tmp_path / "cache")
    }  # fmt: skip
    return subprocess.Popen(
        [sys.executable, "-c", code, *arguments],
        cwd=tmp_path,
        env=environment,
        stdout=subprocess.PIPE,
        text=True,
    )


def test_processes_that_compile_at_once_do_not_mix_up_their_code(tmp_path):
    both = [start(tmp_path, _COMPILE, "a", "3"), start(tmp_path, _COMPILE, "b", "0.25")]
    assert [p.wait(timeout=60) for p in both] == [0, 0]
    out, _ = start(tmp_path, _READ).communicate(timeout=60)
    assert json.loads(out) == [["6", "0.5"], 2]


def test_a_kill_while_saving_leaves_a_cache_that_works(tmp_path):
    assert start(tmp_path, _KILL).wait(timeout=60) == -9
    assert list(Path(tmp_path / "cache").rglob("*.tmp.*"))
    out, _ = start(tmp_path, _READ).communicate(timeout=60)
    assert json.loads(out)[0] == ["6", "0.5"]
    assert not list(Path(tmp_path / "cache").rglob("*.tmp.*"))
    out, _ = start(tmp_path, _READ).communicate(timeout=60)
    assert json.loads(out) == [["6", "0.5"], 2]
