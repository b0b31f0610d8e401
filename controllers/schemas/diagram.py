"""Diagrams of state machines, drawn from the object that runs: Mermaid and Graphviz."""

import re

from controllers.schemas.base import Blend
from controllers.schemas.machine import StateMachine


def mermaid(machine: StateMachine) -> str:
    """Mermaid ``stateDiagram-v2`` text: states with their schemas and weights, arrows with cues.

    Markdown on GitHub and most documentation sites draw it inside a fence marked ``mermaid``.
    """
    ids = {name: _identifier(name) for name in machine.states}
    lines = ["stateDiagram-v2", f"    [*] --> {ids[machine.initial]}"]
    for name, blend in machine.states.items():
        lines.append(f'    state "{name}" as {ids[name]}')
        lines += [f"    {ids[name]} : {term}" for term in _terms(blend)]
    lines += [f"    {ids[t.source]} --> {ids[t.target]} : {t.when}" for t in machine.transitions]
    return "\n".join(lines) + "\n"


def dot(machine: StateMachine) -> str:
    """Graphviz text of the same diagram."""
    lines = ["digraph {", "    rankdir=LR;", "    node [shape=box, style=rounded];",
             "    start [shape=point];"]  # fmt: skip
    for name, blend in machine.states.items():
        text = r"\n".join([name, "", *_terms(blend)])
        lines.append(f'    "{name}" [label="{text}"];')
    lines.append(f'    start -> "{machine.initial}";')
    lines += [f'    "{t.source}" -> "{t.target}" [label="{t.when}"];' for t in machine.transitions]
    return "\n".join([*lines, "}"]) + "\n"


def _terms(blend: Blend) -> list[str]:
    terms = [f"{weight:g} {schema.label}" for weight, schema in blend]
    return terms or ["stand still"]


def _identifier(name: str) -> str:
    return re.sub(r"\W", "_", name)
