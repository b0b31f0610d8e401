import json
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mjmr.claims import Bound, Claim, Evidence, Row, Table, judge, judge_all
from mjmr.conditions import Parameter, complete
from mjmr.errors import InvalidInputError, UnknownNameError
from mjmr.reports import undecided_line, verdict_table, verdicts_json, verdicts_markdown
from mjmr.statistics import proportion
from mjmr.table import NoTrialsError

PARAMETERS = (
    Parameter("scene", "", "A", values=("A", "B", "C")),
    Parameter("sigma", "", 0.0),
    Parameter("mode", "", "metric"),
)


def row(seed, status="ok", metrics=None, **condition):
    metrics = {"x": float(seed)} if metrics is None else metrics
    kept = metrics if status == "ok" else {}
    return Row(complete(PARAMETERS, condition), seed, status, kept)


def table(*rows):
    return Table(rows, PARAMETERS)


def claim(evaluate=None, **changes):
    fields = {
        "id": "c",
        "text": "words",
        "how": "by measuring",
        "bound": Bound("<=", 10.0),
        "evaluate": evaluate or (lambda t: Evidence(t.values("x").mean(), n=len(t))),
        "sizes": ("standard",),
    }
    return Claim(**{**fields, **changes})


PLENTY = table(*(row(s, scene=c) for c in "AB" for s in range(4)))


@pytest.mark.parametrize(
    ("bound", "interval", "verdict"),
    [
        (Bound("<=", 1.0), (0.0, 1.0), "holds"),
        (Bound("<=", 1.0), (0.5, 1.5), "inconclusive"),
        (Bound("<=", 1.0), (1.0, 1.5), "inconclusive"),
        (Bound("<=", 1.0), (1.1, 1.5), "fails"),
        (Bound("<", 1.0), (0.0, 1.0), "inconclusive"),
        (Bound("<", 1.0), (1.0, 1.0), "fails"),
        (Bound("<", 1.0), (1.0, 2.0), "fails"),
        (Bound("<", 1.0), (0.0, 0.9), "holds"),
        (Bound(">=", 1.0), (1.0, 9.0), "holds"),
        (Bound(">=", 1.0), (0.0, 1.0), "inconclusive"),
        (Bound(">=", 1.0), (0.0, 0.5), "fails"),
        (Bound(">", 0.0), (0.0, 0.0), "fails"),
        (Bound(">", 0.0), (0.0, 1.0), "inconclusive"),
        (Bound(">", 0.0), (-1.0, 0.0), "fails"),
        (Bound(">", 0.0), (1e-9, math.inf), "holds"),
        (Bound("==", 0.0, 1e-6), (0.0, 1e-6), "holds"),
        (Bound("==", 0.0, 1e-6), (0.0, 1e-5), "inconclusive"),
        (Bound("==", 0.0), (0.1, 0.2), "fails"),
        (Bound.within(1.0, 2.0), (1.0, 2.0), "holds"),
        (Bound.within(1.0, 2.0), (0.0, 3.0), "inconclusive"),
        (Bound.within(1.0, 2.0), (2.0, 3.0), "inconclusive"),
        (Bound.within(1.0, 2.0), (2.1, 3.0), "fails"),
        (Bound("<=", 1.0), (-math.inf, math.inf), "inconclusive"),
    ],
)
def test_bounds(bound, interval, verdict):
    assert bound.judge(*interval) == verdict
    c = claim(lambda t: Evidence(sum(interval) / 2 if math.isfinite(sum(interval)) else 0.0,
                                 interval, len(t.values("x"))), bound=bound)  # fmt: skip
    assert judge(c, PLENTY, "standard").verdict == verdict


@settings(deadline=None)
@given(
    st.sampled_from(("<=", "<", ">=", ">")),
    st.integers(-3, 3),
    st.lists(st.integers(-4, 4), min_size=2, max_size=2).map(sorted),
)
def test_a_verdict_is_what_every_point_of_the_interval_says(op, value, ends):
    compare = {"<=": np.less_equal, "<": np.less, ">=": np.greater_equal, ">": np.greater}[op]
    says = compare(np.linspace(ends[0], ends[1], 8 * 20 + 1), value)
    expected = "holds" if says.all() else "fails" if not says.any() else "inconclusive"
    assert Bound(op, value).judge(*ends) == expected


@pytest.mark.parametrize(
    "build",
    [
        lambda: Bound("=<", 1.0),
        lambda: Bound("in", 1.0),
        lambda: Bound("<", (1.0, 2.0)),
        lambda: Bound.within(2.0, 1.0),
        lambda: Bound("<", math.nan),
        lambda: claim(bound_source="theirs"),
        lambda: claim(sizes=()),
        lambda: claim(sizes="standard"),
    ],
)
def test_bad_declarations_are_refused(build):
    with pytest.raises(InvalidInputError):
        build()


def test_without_interval_the_measured_value_decides():
    found = judge(claim(), PLENTY, "standard")
    assert (found.verdict, found.measured, found.n) == ("holds", 1.5, 8)


def test_other_sizes_show_the_value_and_say_where_it_is_decided():
    found = judge(claim(sizes=("standard", "full")), PLENTY, "quick")
    assert (found.verdict, found.measured) == ("not testable", 1.5)
    assert found.why == "decided at size standard, full"


def test_a_failed_trial_that_is_read_makes_the_claim_not_testable():
    spoiled = table(*PLENTY.rows, row(9, "failed", scene="A"))
    found = judge(claim(), spoiled, "standard")
    assert (found.verdict, found.why, found.measured) == ("not testable", "1 of 9 failed", None)


def test_a_failed_trial_that_is_not_read_does_no_harm():
    spoiled = table(*PLENTY.rows, row(9, "failed", scene="A"))
    only_b = claim(lambda t: Evidence(t.where(scene="B").values("x").mean()))
    assert judge(only_b, spoiled, "standard").verdict == "holds"
    assert judge(claim(needs={"scene": "B"}), spoiled, "standard").verdict == "holds"
    assert judge(claim(needs={"scene": ["A", "B"]}), spoiled, "standard").why == "1 of 9 failed"


def test_failure_explains_a_mistake_that_follows_from_it():
    spoiled = table(row(0), row(1, "failed"), row(0, scene="B"), row(1, scene="B"))
    paired = claim(
        lambda t: Evidence(np.subtract(*t.where(scene="A").pair(t.where(scene="B"), "x")).mean())
    )
    found = judge(paired, spoiled, "standard")
    assert (found.why, found.error) == ("1 of 4 failed", "")


@pytest.mark.parametrize(
    ("status", "why"), [("missing", "1 of 2 not run"), ("no-gl", "1 of 2 need off-screen OpenGL")]
)
def test_trials_that_are_not_there_are_told_apart(status, why):
    found = judge(claim(), table(row(0), row(1, status)), "standard")
    assert found.verdict == "not testable"
    assert found.why.startswith(why)


def test_what_was_measured_is_shown_beside_trials_not_run_but_not_beside_failed_ones():
    found = judge(claim(), table(row(0), row(4), row(1, "missing")), "standard")
    assert (found.verdict, found.why, found.measured) == ("not testable", "1 of 3 not run", 2.0)
    spoiled = table(row(0), row(1, "missing"), row(2, "failed"))
    found = judge(claim(), spoiled, "standard")
    assert (found.why, found.measured) == ("1 of 3 failed", None)
    nan = judge(claim(lambda t: Evidence(t.values("x")[0] * math.nan)), table(row(0)), "standard")
    assert nan.measured is None


def test_no_trials_of_the_condition():
    found = judge(claim(needs={"scene": "C"}), PLENTY, "standard")
    assert (found.verdict, found.why) == ("not testable", "no trials with scene=C at size standard")
    assert found.error == ""


@pytest.mark.parametrize(
    ("evidence", "why"),
    [
        (Evidence(math.nan), "the measured value is not a number"),
        (Evidence(1.0, (0.0, math.nan)), "the interval is not a number"),
        (Evidence.untestable("no such robot"), "no such robot"),
    ],
)
def test_no_number_no_verdict(evidence, why):
    found = judge(claim(lambda t: evidence), PLENTY, "standard")
    assert (found.verdict, found.why, found.measured) == ("not testable", why, None)


def test_a_mistake_in_evaluate_is_told_and_kept():
    found = judge(claim(lambda t: t.values("y")), PLENTY, "standard")
    assert found.verdict == "not testable"
    assert "unknown metric 'y'; valid: x" in found.why
    assert "\n" not in found.why
    assert "Traceback" in found.error
    assert "Evidence" in judge(claim(lambda t: 3.0), PLENTY, "standard").why


def test_reading_in_one_claim_does_not_touch_the_next():
    spoiled = table(*PLENTY.rows, row(9, "failed", scene="A"))
    first, second = judge_all([claim(), claim(needs={"scene": "B"})], spoiled, "standard")
    assert (first.verdict, second.verdict) == ("not testable", "holds")


def test_estimates_become_evidence():
    estimate = proportion(9, 10)
    evidence = Evidence.of(estimate)
    assert (evidence.measured, evidence.interval, evidence.n) == (0.9, estimate.interval, 10)


def test_where_refuses_unknown_names_and_values():
    with pytest.raises(UnknownNameError, match="valid: sigma"):
        PLENTY.where(sgima=1.0)
    with pytest.raises(UnknownNameError, match="value of scene"):
        PLENTY.where(scene="D")


def test_where_takes_lists_and_arrays_and_narrows():
    t = table(*(row(s, sigma=g) for g in (0.0, 1.0, 2.0) for s in range(2)))
    assert len(t.where(sigma=[0, 2])) == 4
    assert len(t.where(sigma=np.array([0.0, 1.0])).where(sigma=1)) == 2
    assert [(v, len(sub)) for v, sub in t.split("sigma")] == [(0.0, 2), (1.0, 2), (2.0, 2)]
    with pytest.raises(NoTrialsError):
        t.where(sigma=5.0).values("x")


def test_values_by_kind():
    metrics = ({"b": True, "n": 1, "s": "u", "m": None}, {"b": False, "n": None, "s": "v", "m": 2})
    t = table(*(row(i, metrics=m) for i, m in enumerate(metrics)))
    assert t.values("b").dtype == bool
    np.testing.assert_array_equal(t.values("n"), [1.0, np.nan])
    assert t.values("s").tolist() == ["u", "v"]
    np.testing.assert_array_equal(t.values("m"), [np.nan, 2.0])
    assert t.metrics == ["b", "n", "s", "m"]


def test_pairing_goes_by_seed_and_by_what_else_varies():
    def rows(scene, offset, sigmas, seeds):
        return [
            row(s, metrics={"x": 10 * g + s + offset}, scene=scene, sigma=g)
            for g in sigmas
            for s in seeds
        ]

    a, b = rows("A", 0.0, (0.0, 1.0), (0, 1)), rows("B", 100.0, (1.0, 0.0), (1, 0))
    t = table(*a, *b)
    x, y = t.where(scene="A").pair(t.where(scene="B"), "x")
    np.testing.assert_array_equal(y - x, [100.0] * 4)
    with pytest.raises(InvalidInputError, match="partner"):
        t.where(scene="A", sigma=0.0).pair(t.where(scene="B"), "x")
    assert t.where(scene="A", sigma=1.0).by_seed("x") == {0: 10.0, 1: 11.0}
    with pytest.raises(InvalidInputError, match="one condition"):
        t.by_seed("x")


def test_reports_say_the_same_in_every_form():
    spoiled = table(*PLENTY.rows, row(9, "failed", scene="A"))
    claims = [
        claim(id="one", needs={"scene": "B"}, unit="mm s", bound_source="paper"),
        claim(id="two", text="with | a bar"),
        claim(lambda t: Evidence(1.0, (-math.inf, 2.0), 3), id="three"),
    ]
    verdicts = judge_all(claims, spoiled, "standard")
    found = json.loads(verdicts_json(verdicts))
    assert [f["verdict"] for f in found] == ["holds", "not testable", "holds"]
    assert found[0]["measured"] == 1.5
    assert found[0]["simulation"] == "metric"
    assert found[1]["why"] == "1 of 9 failed"
    assert found[2]["interval"] == ["-inf", 2.0]
    markdown = verdicts_markdown(verdicts, "title").splitlines()
    assert len(markdown) == 2 + 2 + 3
    assert len({line.replace("\\|", "").count("|") for line in markdown[2:]}) == 1
    assert "1.5 mm s" in markdown[4]
    assert "(simulation: metric)" in markdown[4]
    assert verdict_table(verdicts, "t", "standard").row_count == 3
    assert undecided_line(verdicts, "standard") == ""
    assert verdict_table(verdicts, "t", "quick").row_count == 0
    assert undecided_line(verdicts, "quick").endswith("not at quick: one, two, three")


def test_a_tolerance_is_for_equality_alone():
    assert Bound("==", 2.0, tolerance=0.005).judge(2.004, 2.004) == "holds"
    for op in ("<=", "<", ">=", ">"):
        with pytest.raises(InvalidInputError, match="tolerance with == alone"):
            Bound(op, 2.0, tolerance=0.005)
    with pytest.raises(InvalidInputError, match="tolerance with == alone"):
        Bound("in", (1.0, 2.0), tolerance=0.005)


def test_a_table_can_be_narrowed_to_seeds():
    whole = table(*(row(seed) for seed in range(6)))
    assert whole.where_seed(least=4).values("x").tolist() == [4.0, 5.0]
    assert whole.where_seed(below=2).values("x").tolist() == [0.0, 1.0]
    assert whole.where_seed(least=2, below=3).seeds.tolist() == [2]
    with pytest.raises(NoTrialsError, match="seed >= 6"):
        whole.where_seed(least=6).values("x")
