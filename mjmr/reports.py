"""Verdicts as a terminal table, Markdown and JSON."""

import json
import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from mjmr.claims import FAILS, HOLDS, INCONCLUSIVE, NOT_TESTABLE, Verdict

if TYPE_CHECKING:
    from rich.table import Table as RichTable

_COLOURS = {HOLDS: "green", FAILS: "red", INCONCLUSIVE: "yellow", NOT_TESTABLE: "dim"}


def verdict_table(verdicts: Sequence[Verdict], title: str) -> "RichTable":
    """Table for the terminal: claim, published, measured, bound, verdict."""
    from rich.table import Table
    from rich.text import Text

    table = Table(title=title, title_justify="left", show_lines=True)
    widest = max((len(v.claim.id) for v in verdicts), default=0)
    table.add_column("claim", ratio=4, min_width=widest, overflow="fold")
    for header, ratio in (("published", 2), ("measured", 3), ("bound", 2)):
        table.add_column(header, ratio=ratio, overflow="fold")
    table.add_column("verdict", ratio=3, overflow="fold")
    for v in verdicts:
        claim = Text(v.claim.id, "bold").append(f"\n{v.claim.text}", "not bold")
        verdict = Text(v.verdict, _COLOURS[v.verdict])
        if v.why:
            verdict.append(f"\n{v.why}", "dim")
        table.add_row(
            claim,
            Text(v.claim.published),
            Text(_measured(v)),
            Text(_bound(v)),
            verdict,
        )
    return table


def verdicts_markdown(verdicts: Sequence[Verdict], title: str) -> str:
    """The same table as Markdown, with how each claim is measured and in which simulation."""
    lines = [
        f"# {title}",
        "",
        "| claim | the paper's words | published | how measured | measured | bound | verdict |",
        "|---|---|---|---|---|---|---|",
    ]
    for v in verdicts:
        how = v.claim.how + (f" (simulation: {v.simulation})" if v.simulation else "")
        verdict = v.verdict + (f": {v.why}" if v.why else "")
        cells = (v.claim.id, v.claim.text, v.claim.published, how, _measured(v), _bound(v), verdict)
        lines.append("| " + " | ".join(_cell(c) for c in cells) + " |")
    return "\n".join(lines) + "\n"


def verdicts_json(verdicts: Sequence[Verdict]) -> str:
    """The verdicts as a JSON list; numbers that are not finite are the texts nan, inf and -inf."""
    return to_json(
        [
            {
                "id": v.claim.id,
                "text": v.claim.text,
                "published": v.claim.published,
                "how": v.claim.how,
                "simulation": v.simulation,
                "measured": v.measured,
                "interval": v.interval,
                "n": v.n,
                "unit": v.claim.unit,
                "bound": str(v.claim.bound),
                "bound_source": v.claim.bound_source,
                "sizes": v.claim.sizes,
                "timing": v.claim.timing,
                "verdict": v.verdict,
                "why": v.why,
            }
            for v in verdicts
        ]
    )


def to_json(value: Any) -> str:
    """Indented strict JSON with a line end."""
    return json.dumps(_strict(value), indent=2, ensure_ascii=False, allow_nan=False) + "\n"


def _strict(value: Any) -> Any:
    if isinstance(value, float) and not math.isfinite(value):
        return repr(value)
    if isinstance(value, dict):
        return {str(k): _strict(v) for k, v in value.items()}
    if isinstance(value, list | tuple):
        return [_strict(v) for v in value]
    return value


def _measured(v: Verdict) -> str:
    if v.measured is None:
        return "-"
    unit = f" {v.claim.unit}" if v.claim.unit else ""
    text = f"{v.measured:.4g}{unit}"
    if v.interval is not None:
        text += f" [{v.interval[0]:.4g}, {v.interval[1]:.4g}]"
    return text + (f" (n = {v.n})" if v.n else "")


def _bound(v: Verdict) -> str:
    unit = f" {v.claim.unit}" if v.claim.unit else ""
    return f"{v.claim.bound}{unit} ({v.claim.bound_source})"


def _cell(text: str) -> str:
    return " ".join(text.replace("|", "\\|").split())
