"""Where a result came from: digests of the sources and the versions of what computed it."""

import functools
import hashlib
import importlib.metadata
import importlib.util
import platform
import subprocess
from pathlib import Path

_NUMERIC_PACKAGES = ("mujoco", "numpy", "scipy", "numba", "opencv-python-headless")


@functools.cache
def source_digest(*packages: str, containing: str = "") -> str:
    """SHA-256 over every ``.py`` and ``.xml`` file below the named packages, as hex.

    Args:
        packages: Importable package names; one that cannot be found adds its name alone.
        containing: Count only files in which this text occurs.
    """
    digest = hashlib.sha256()
    for package in packages:
        digest.update(package.encode())
        for folder in _folders(package):
            for path in sorted(p for p in folder.rglob("*") if p.suffix in {".py", ".xml"}):
                content = path.read_bytes()
                if containing.encode() in content:
                    digest.update(str(path.relative_to(folder)).encode())
                    digest.update(content)
    return digest.hexdigest()


def _folders(package: str) -> list[Path]:
    spec = importlib.util.find_spec(package)
    if spec is None:
        return []
    if spec.submodule_search_locations:
        return [Path(p) for p in spec.submodule_search_locations]
    return [Path(spec.origin).parent] if spec.origin else []


def versions() -> dict[str, str]:
    """Versions of Python, mjmr and the packages whose numbers enter a result."""
    found = {"python": platform.python_version(), "mjmr": _version("mjmr")}
    return found | {name: _version(name) for name in _NUMERIC_PACKAGES}


def _version(package: str) -> str:
    try:
        return importlib.metadata.version(package)
    except importlib.metadata.PackageNotFoundError:
        return "not installed"


def git_revision() -> str | None:
    """Revision of the checkout mjmr runs from, with ``+changed`` if it differs; None outside."""
    here = Path(__file__).resolve().parent
    try:
        revision = _git(here, "rev-parse", "HEAD")
        changed = _git(here, "status", "--porcelain", "--untracked-files=no")
    except (OSError, subprocess.SubprocessError):
        return None
    return revision + ("+changed" if changed else "")


def _git(folder: Path, *arguments: str) -> str:
    done = subprocess.run(
        ["git", "-C", str(folder), *arguments],
        capture_output=True,
        text=True,
        check=True,
        timeout=10,
    )
    return done.stdout.strip()
