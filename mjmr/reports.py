"""Verdicts as a terminal table, Markdown and JSON."""

import json
import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from mjmr.claims import FAILS, HOLDS, INCONCLUSIVE, NOT_TESTABLE, Verdict

if TYPE_CHECKING:
    from rich.table import Table as RichTable

_COLOURS = {HOLDS: "green", FAILS: "red", INCONCLUSIVE: "yellow", NOT_TESTABLE: "dim"}


def verdict_table(verdicts: Sequence[Verdict], title: str, size: str) -> "RichTable":
    """Table for the terminal of the claims this size decides; ``claims.md`` has them all.

    Args:
        verdicts: The verdicts.
        title: Above the table.
        size: Whose claims to show.
    """
    from rich.table import Table
    from rich.text import Text

    table = Table(title=title, title_justify="left")
    table.add_column("claim", no_wrap=True)
    for header in ("published", "measured", "bound", "verdict"):
        table.add_column(header, overflow="fold")
    for v in verdicts:
        if size in v.claim.sizes:
            verdict = Text(v.verdict, _COLOURS[v.verdict])
            if v.why:
                verdict.append(f": {v.why}", "dim")
            row = v.claim.published, _measured(v), _bound(v)
            table.add_row(Text(v.claim.id, "bold"), *map(Text, row), verdict)
    return table


def undecided_line(verdicts: Sequence[Verdict], size: str) -> str:
    """Names the claims that other sizes decide; empty if there are none."""
    others = [v for v in verdicts if size not in v.claim.sizes]
    if not others:
        return ""
    sizes = list(dict.fromkeys(s for v in others for s in v.claim.sizes))
    names = ", ".join(v.claim.id for v in others)
    return f"decided at size {' or '.join(sizes)}, not at {size}: {names}"


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
