# MuJoCo's bindings are compiled and carry no types: everything of theirs is Any.
from typing import Any

def __getattr__(name: str) -> Any: ...
