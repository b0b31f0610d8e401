"""The laws one by one, on points that move exactly as commanded."""

import numpy as np
import pytest

from controllers.perimeter import PerimeterConfig
from controllers.perimeter.approach import Edge, acquire, approach, way_off
from controllers.perimeter.avoidance import Avoidance, Neighbours
from controllers.perimeter.config import even_factor, tracked_radius
from controllers.perimeter.doubt import Doubt
from controllers.perimeter.estimate import TrackedCircles, circle
from controllers.perimeter.percepts import foot_of_edge, nearest_of_kind, room_to_turn
from controllers.perimeter.spiral import Boundary, Spiral
from controllers.perimeter.states import ACQUIRE, MOVING, TRACKING
from controllers.perimeter.tracking import Zigzag, bang_bang, spacing
from controllers.perimeter.vision import inside, red_mask
from mjmr.errors import InvalidInputError, UnknownNameError

BOUNDS = (-50.0, -50.0, 50.0, 50.0)
CONFIG = PerimeterConfig(bounds=BOUNDS)
NO_EDGE = np.full(2, np.nan)


def drive(pose, command, period=0.1):
    forward, turn = command.T
    middle = pose[:, 2] + turn * period / 2
    step = np.column_stack([forward * np.cos(middle), forward * np.sin(middle), turn])
    return pose + step * period


def test_the_spiral_unwinds_and_goes_on_after_an_interruption():
    spiral = Spiral(1, CONFIG, np.random.default_rng(0))
    everyone, nobody = np.array([True]), np.array([False])
    turns = [abs(spiral.command(t * 0.1, everyone)[0, 1]) for t in range(2000)]
    assert turns[0] == pytest.approx(0.3)
    assert np.all(np.diff(turns) < 0)
    # 1.87 times the radius after a whole turn: e^(0.1 x 2 pi)
    wound = np.cumsum(turns) * 0.1
    lap = int(np.searchsorted(wound, 2 * np.pi))
    assert turns[0] / turns[lap] == pytest.approx(1.87, abs=0.02)
    before = spiral.wound.copy()
    for t in range(100):
        spiral.command(200.0 + t, nobody)
    assert spiral.wound == before
    assert abs(spiral.command(0.0, everyone)[0, 0]) == 0.0  # v = v_s (1 - e^-t)


YAWS = np.linspace(-np.pi, np.pi, 17)
PERIOD, LOCK, WHEELBASE = 0.1, np.radians(28.0), 0.31  # s, rad, m: of a truck


def nearest_to_the_boundary(at, yaw):
    """Distance of a truck that drives on, at full speed at first, and heeds the boundary [m]."""
    boundary = Boundary(1, CONFIG)
    pose, nearest, speed = np.array([[*at, yaw]]), np.inf, 1.0
    for _ in range(600):
        command = boundary.command(pose)
        wanted, turn = command[0] if boundary.active[0] else (1.0, 0.0)
        speed += np.clip(wanted - speed, -PERIOD, PERIOD)  # brakes at 1 m/s^2
        turn = np.clip(turn, -speed * np.tan(LOCK) / WHEELBASE, speed * np.tan(LOCK) / WHEELBASE)
        pose = drive(pose, np.array([[speed, turn]]))
        nearest = min(nearest, 50.0 - np.abs(pose[0, :2]).max())
    return nearest


@pytest.mark.parametrize("yaw", YAWS)
@pytest.mark.parametrize("at", [(43.0, 3.0), (43.0, 43.0), (-43.0, 43.0)])
def test_nobody_reaches_the_boundary_from_anywhere_beside_it(at, yaw):
    assert nearest_to_the_boundary(at, yaw) > 1.5


@pytest.mark.parametrize("yaw", YAWS)
@pytest.mark.parametrize(
    "at",
    [(-41.5, -43.9), (41.0, 41.0), (-41.5, 43.5), (39.5, 39.5), (-43.9, -39.5), (45.0, -45.0)],
)
def test_nobody_touches_the_boundary_from_deeper_in_a_corner(at, yaw):
    assert nearest_to_the_boundary(at, yaw) > 0.6  # a truck reaches 0.43 m from its rear axle


@pytest.mark.parametrize("at", [(41.0, 41.0), (-41.5, 41.5), (42.0, -40.5), (-43.0, 45.0)])
def test_who_turns_away_from_a_corner_does_so_until_clear_of_it(at):
    boundary = Boundary(1, CONFIG)
    pose, was = np.array([[*at, np.arctan2(at[1], at[0])]]), []
    for _ in range(600):
        command = boundary.command(pose)
        was.append(boundary.active[0])
        pose = drive(pose, np.where(boundary.active[:, None], command, [[1.0, 0.0]]))
    assert np.count_nonzero(np.diff(np.array(was).astype(int)) > 0) <= 1  # begun once
    left = was.index(False, was.index(True))
    assert not any(was[left : left + 100])


def test_the_potential_field_turns_the_short_way():
    pose = np.array([[0, 0, 3.0], [0, 0, -3.0]])
    command = approach(way_off(pose, np.array([[-5.0, -0.5], [-5.0, 0.5]])), CONFIG)
    assert command[0, 1] > 0 > command[1, 1]
    k = 0.3 / (2 * np.pi)
    assert command[0, 1] == pytest.approx(k * (np.arctan2(-0.5, -5.0) + 2 * np.pi - 3.0))


def edge_of(pose, radius):
    """Nearest point of a disc around the origin in the robots' frames."""
    off = np.hypot(*pose[:, :2].T) - radius
    way = np.arctan2(-pose[:, 1], -pose[:, 0]) - pose[:, 2]
    return off[:, None] * np.column_stack([np.cos(way), np.sin(way)])


@pytest.mark.parametrize("turn", np.linspace(-1.2, 1.2, 7))
def test_acquire_ends_on_the_edge_anticlockwise_and_never_gets_inside(turn):
    pose, least = np.array([[13.0, 0.0, np.pi + turn]]), np.inf
    for _ in range(400):
        edge = edge_of(pose, 10.0)
        pose = drive(pose, acquire(Edge(edge, CONFIG), CONFIG))
        least = min(least, np.hypot(*pose[0, :2]) - 10.0)
    found = Edge(edge_of(pose, 10.0), CONFIG)
    error, tangent = found.error, found.tangent
    # on a circle a proportional law lags
    assert abs(error[0]) < 0.1
    assert abs(tangent[0]) < 0.15
    assert least > 0.4


@pytest.mark.parametrize("heading", np.linspace(-np.pi, np.pi, 25))
@pytest.mark.parametrize("off", [1.9, 2.3, 3.0])
def test_who_acquires_touches_nothing_from_whatever_heading(off, heading):
    pose, least = np.array([[10.0 + off, 0.0, heading]]), np.inf
    for _ in range(600):
        pose = drive(pose, acquire(Edge(edge_of(pose, 10.0), CONFIG), CONFIG))
        least = min(least, np.hypot(*pose[0, :2]) - 10.0)
    assert least > 0.43  # what a truck reaches from its rear axle
    assert abs(Edge(edge_of(pose, 10.0), CONFIG).error[0]) < 0.1


@pytest.mark.parametrize(("radius", "holds"), [(10.0, True), (20.0, True), (3.0, False)])
def test_bang_bang_follows_discs_above_four_metres(radius, holds):
    way = tracked_radius(radius)
    pose, worst = np.array([[way, 0.0, np.pi / 2]]), 0.0
    for _ in range(3000):
        c, s = np.cos(pose[:, 2]), np.sin(pose[:, 2])
        spot = pose[:, :2] + np.column_stack([0.5 * c - 0.6 * s, 0.5 * s + 0.6 * c])
        depth = radius - np.hypot(*spot.T)
        worst = max(worst, abs(depth[0]))
        forward = np.array([0.4])
        turn = bang_bang((depth > 0).astype(float), forward, CONFIG)
        pose = drive(pose, np.column_stack([forward, turn]))
    assert (worst < 0.1) == holds


def stray(wrong, heeds, n=60, seconds=120.0):
    """Distances from a disc of 10 m (t, n) of robots each alone there by readings 0.1 s old."""
    rng = np.random.default_rng(1000)
    doubt, everybody = Doubt(n, CONFIG), np.ones(n, dtype=bool)
    pose = np.tile([tracked_radius(10.0), 0.0, np.pi / 2], (n, 1))
    forward, reading, off = np.zeros(n), np.zeros(n), []
    for _ in range(round(seconds / 0.1)):
        c, s = np.cos(pose[:, 2]), np.sin(pose[:, 2])
        spot = pose[:, :2] + np.column_stack([0.5 * c - 0.6 * s, 0.5 * s + 0.6 * c])
        depth = 10.0 - np.hypot(*spot.T)
        inside, reading = reading, ((depth > 0) ^ (rng.random(n) < wrong)) * 1.0
        believed = doubt.believed(inside, forward, everybody)
        if not heeds:
            believed = inside
        forward = doubt.limit(np.full(n, 0.4)) if heeds else np.full(n, 0.4)
        pose = drive(pose, np.column_stack([forward, bang_bang(believed, forward, CONFIG)]))
        off.append(depth)
    return np.array(off[300:]), doubt


def test_a_fifth_of_readings_wrong_is_noticed_and_strays_no_more():
    literal, _ = stray(0.2, heeds=False)
    mended, doubt = stray(0.2, heeds=True)
    assert np.sqrt((literal**2).mean(axis=0)).max() > 0.1
    assert np.sqrt((mended**2).mean(axis=0)).max() < 0.05
    assert doubt.doubts.mean() > 0.9


def test_readings_that_are_right_change_nothing():
    literal, _ = stray(0.0, heeds=False)
    mended, doubt = stray(0.0, heeds=True)
    assert literal.tobytes() == mended.tobytes()
    assert not doubt.doubts.any()


def test_who_stands_notices_wrong_readings_takes_the_majority_and_forgets_when_it_leaves():
    doubt, yes, no = Doubt(1, CONFIG), np.array([True]), np.array([False])
    still, told = np.zeros(1), []
    for k in range(60):
        seen = np.array([float(k % 5 != 2)])  # every fifth says outside
        told.append(doubt.believed(seen, still, yes)[0])
    assert not all(told[:15])
    assert all(told[30:])
    assert np.isnan(doubt.believed(np.full(1, np.nan), still, yes)[0])
    assert doubt.limit(np.array([0.4])).tolist() == [0.2]
    doubt.believed(np.zeros(1), still, no)
    assert doubt.limit(np.array([0.4])).tolist() == [0.4]


def ring(angles, radius, config, desired, seconds):
    """Robots that follow a circle exactly, at the speeds of the spacing rule."""
    speed = np.zeros(len(angles))
    for _ in range(round(seconds / 0.1)):
        at = radius * np.column_stack([np.cos(angles), np.sin(angles)])
        way = at[None] - at[:, None]
        apart = np.hypot(way[..., 0], way[..., 1])
        np.fill_diagonal(apart, np.nan)
        bearing = np.arctan2(way[..., 1], way[..., 0]) - (angles + np.pi / 2)[:, None]
        bearing = np.arctan2(np.sin(bearing), np.cos(bearing))
        speed = spacing(apart, bearing, np.full(len(angles), desired), config)
        angles = angles + speed * 0.1 / radius
    gaps = np.diff(np.append(np.sort(angles % (2 * np.pi)), np.sort(angles % (2 * np.pi))[0]
                             + 2 * np.pi))  # fmt: skip
    return gaps * len(angles) / (2 * np.pi), speed


@pytest.mark.parametrize(
    ("factor", "even", "stops"), [(even_factor(5), True, True), (1.2, True, False),
                                  (0.8, False, True)]
)  # fmt: skip
def test_the_repaired_rule_reproduces_the_three_statements(factor, even, stops):
    chord = 2 * 10.6 * np.sin(np.pi / 5)
    start = np.array([0.0, 0.35, 0.75, 1.1, 1.5])
    gaps, speed = ring(start, 10.6, CONFIG, factor * chord, 900.0)
    assert (gaps.max() <= 1.1 and gaps.min() >= 0.9) == even
    assert (speed.max() < 0.005) == stops


def test_the_literal_rule_never_spreads_pairs():
    literal = PerimeterConfig(bounds=BOUNDS, spacing="literal")
    start = np.array([0.0, 0.35, 0.75, 1.1, 1.5])
    gaps, _ = ring(start, 10.6, literal, even_factor(5) * 2 * 10.6 * np.sin(np.pi / 5), 3000.0)
    assert gaps.max() > 1.5


def test_who_is_alone_keeps_moving():
    nobody = np.full((2, 2), np.nan)
    assert spacing(nobody, nobody, np.full(2, 5.0), CONFIG) == pytest.approx([0.4, 0.4])


def test_a_stopped_robot_makes_one_zigzag_when_the_edge_is_deep_inside():
    zigzag = Zigzag(1, CONFIG)
    still, tracks = np.zeros(1), np.array([True])

    def speed(error, is_inside):
        return zigzag.speeds(still, np.array([error]), np.array([is_inside]), tracks, ~tracks)[0]

    assert speed(-0.1, 1.0) == 0.0
    assert speed(-0.16, 1.0) == 0.4
    assert speed(-0.05, 1.0) == 0.4  # not yet outside
    assert speed(0.01, 0.0) == 0.4
    assert speed(-0.01, 1.0) == 0.0
    assert speed(-0.01, 0.0) == 0.0


def test_a_stopped_robot_makes_one_zigzag_when_the_edge_has_gone_from_it():
    zigzag = Zigzag(1, CONFIG)
    still, tracks = np.zeros(1), np.array([True])

    def speed(error, is_inside):
        return zigzag.speeds(still, np.array([error]), np.array([is_inside]), tracks, ~tracks)[0]

    assert speed(0.1, 0.0) == 0.0
    assert speed(0.16, 1.0) == 0.0  # a wrong reading
    assert speed(0.16, 0.0) == 0.4
    assert speed(0.0, 1.0) == 0.4  # in, out, in
    assert speed(0.01, 0.0) == 0.4
    assert speed(-0.01, 1.0) == 0.0


def test_nobody_stops_off_the_edge_because_readings_were_wrong():
    zigzag = Zigzag(1, CONFIG)
    yes, still = np.array([True]), np.zeros(1)
    told = []
    for k, error in enumerate([0.1] * 8 + [0.04] * 2):
        seen = np.array([float(k % 2)])
        told.append(zigzag.speeds(still, np.array([error]), seen, yes, np.array([k == 0]))[0])
    assert told == [0.4] * 9 + [0.0]


def neighbours(pose, state, speed=None):
    n = len(pose)
    told = np.column_stack([pose, state, np.zeros(n) if speed is None else speed])
    heard = np.tile(told[None], (n, 1, 1))
    return Neighbours(pose, heard, ~np.eye(n, dtype=bool))


@pytest.mark.parametrize("heading", [-2.0, 2.0])
def test_who_stands_ahead_does_not_stop_one_for_ever_who_turns_elsewhere(heading):
    avoidance, nobody = Avoidance(2, CONFIG), np.full((2, 2), np.nan)
    pose, state = np.array([[0.0, 0.0, 0.0], [2.5, 0.0, np.pi / 2]]), np.array([ACQUIRE, TRACKING])
    known, wanted = neighbours(pose, state), np.array([[0.4, np.sign(heading) * 0.3], [0.0, 0.0]])
    ways = np.array([heading, 0.0])
    told = [avoidance.apply(wanted, ways, NO_EDGE, state, known, nobody)[0] for _ in range(60)]
    assert told[0].tolist() == [0.0, 0.0]
    assert told[-1].tolist() == [0.2, np.sign(heading) * 0.3]


@pytest.mark.parametrize("way", [-1, 1])
def test_who_passes_another_turns_away_from_the_perimeter(way):
    avoidance, nobody = Avoidance(2, CONFIG), np.full((2, 2), np.nan)
    pose, state = np.array([[0.0, 0.0, 0.0], [3.0, 0.0, np.pi]]), np.array([ACQUIRE, TRACKING])
    known, edge = neighbours(pose, state), np.array([way * np.pi / 2, np.nan])
    command = avoidance.apply(np.full((2, 2), 0.3), np.zeros(2), edge, state, known, nobody)
    assert command[0].tolist() == [0.3, -way * 0.3]
    assert command[1].tolist() == [0.0, 0.0]


@pytest.mark.parametrize("offset", [-1.8, -0.8, 0.0, 0.5, 1.8])
def test_two_who_meet_head_on_do_not_touch(offset):
    avoidance = Avoidance(2, CONFIG)
    pose, least = np.array([[-10.0, 0.0, 0.0], [10.0, offset, np.pi]]), np.inf
    nobody, state = np.full((2, 2), np.nan), np.array([MOVING, MOVING])
    speed = np.ones(2)
    for _ in range(400):
        wanted = np.array([[1.0, 0.0], [1.0, 0.0]])
        command = avoidance.apply(
            wanted, np.zeros(2), NO_EDGE, state, neighbours(pose, state, speed), nobody
        )
        speed = speed + np.clip(command[:, 0] - speed, -0.1, 0.1)  # as a truck brakes
        turn = np.clip(command[:, 1], -1.7 * speed, 1.7 * speed)
        pose = drive(pose, np.column_stack([speed, turn]))
        least = min(least, np.hypot(*(pose[0, :2] - pose[1, :2])))
    assert least > 1.2
    assert speed == pytest.approx([1.0, 1.0])  # nobody waits for ever
    assert np.hypot(*(pose[0, :2] - pose[1, :2])) > 10.0


def test_on_the_perimeter_one_waits_for_who_cuts_in():
    avoidance = Avoidance(2, CONFIG)
    pose = np.array([[0.0, 0.0, 0.0], [2.0, 0.5, np.pi]])
    state = np.array([TRACKING, MOVING])
    wanted = np.array([[0.4, 0.1], [1.0, 0.0]])
    nobody = np.full((2, 2), np.nan)
    command = avoidance.apply(wanted, np.zeros(2), NO_EDGE, state, neighbours(pose, state), nobody)
    assert command[0].tolist() == [0.0, 0.0]
    assert command[1].tolist() == [0.3, -0.3]


def test_somebody_seen_whom_no_radio_tells_of_is_waited_for():
    avoidance = Avoidance(1, CONFIG)
    pose, state = np.zeros((1, 3)), np.array([MOVING])
    alone = neighbours(pose, state)
    body = np.array([[2.5, 0.0]])
    command = avoidance.apply(np.array([[1.0, 0.0]]), np.zeros(1), NO_EDGE[:1], state, alone, body)
    assert command[0, 0] == 0.0
    for _ in range(60):
        command = avoidance.apply(
            np.array([[1.0, 0.0]]), np.zeros(1), NO_EDGE[:1], state, alone, body
        )
    assert command[0].tolist() == [0.2, -0.3]  # not for ever, and sharply to the right


@pytest.mark.parametrize("turn", [-1.2, -0.6, 0.0, 0.6, 1.2])
@pytest.mark.parametrize("angle", [-0.5, -0.4, -0.3, 0.5])
def test_who_acquires_gets_past_one_who_stands_on_the_perimeter_for_ever(angle, turn):
    avoidance, state = Avoidance(2, CONFIG), np.array([ACQUIRE, TRACKING])
    way, least, deepest = tracked_radius(10.0), np.inf, -np.inf
    at = 13.0 * np.array([np.cos(angle), np.sin(angle)])
    pose = np.array([[*at, angle + np.pi + turn], [way, 0.0, np.pi / 2]])
    nobody, speed = np.full((2, 2), np.nan), np.zeros(2)
    for _ in range(900):
        edge = edge_of(pose, 10.0)
        known, ways = neighbours(pose, state, speed), np.arctan2(edge[:, 1], edge[:, 0])
        seen = Edge(edge, CONFIG)
        wanted, heading = acquire(seen, CONFIG), seen.onto
        command = avoidance.apply(wanted, heading, ways, state, known, nobody)
        command[1] = 0.0
        speed = command[:, 0]
        pose = drive(pose, command)
        least = min(least, np.hypot(*(pose[0, :2] - pose[1, :2])))
        deepest = max(deepest, 10.0 - np.hypot(*pose[0, :2]))
    assert least > 2.0
    assert deepest < -0.43
    # nothing keeps it from the edge any more
    assert Edge(edge_of(pose, 10.0), CONFIG).error[0] == pytest.approx(0.0, abs=0.15)


def test_circles_are_found_from_tracks():
    angle = np.linspace(0.0, 2.0, 40)
    points = np.column_stack([3 + 12 * np.cos(angle), -4 + 12 * np.sin(angle)])
    assert circle(points) == pytest.approx(12.0)
    tracked = TrackedCircles(1)
    assert np.isnan(tracked.radius[0])
    for x, y in points:
        tracked.add(np.array([[x, y, 0.0]]), np.array([True]))
    assert tracked.radius[0] == pytest.approx(12.0, abs=1e-6)
    tracked.add(np.array([[0.0, 0.0, 0.0]]), np.array([False]))
    assert np.isnan(tracked.radius[0])


def test_the_edge_is_found_from_rays_with_noise():
    rng = np.random.default_rng(0)
    angles = np.linspace(-np.pi, np.pi, 73)[:-1] + np.pi / 72
    mount, looks = np.array([0.24, 0.0, 0.0]), np.zeros((200, 72, 2))
    looks[..., 0] = np.inf
    for way in range(200):
        along = np.cos(angles - 0.9)
        met = along > 0.3
        looks[way, met, 0] = 1.0 / along[met] + rng.normal(0, 0.01, met.sum())
        looks[way, met, 1] = 4
    foot = foot_of_edge(looks, angles, 4, mount, 3.0)
    true = (1.0 + 0.24 * np.cos(0.9)) * np.array([np.cos(0.9), np.sin(0.9)])
    assert np.hypot(*(foot - true).T).max() < 0.06
    point = nearest_of_kind(looks, angles, 4, mount, 3.0)
    spread = [np.std(np.arctan2(*p.T[::-1])) for p in (foot, point)]
    assert spread[0] < 0.5 * spread[1]
    assert np.isnan(foot_of_edge(looks, angles, 4, mount, 0.5)).all()


@pytest.mark.parametrize(("ahead", "room"), [(1.5, 0.31), (1.1, 0.14), (0.5, -0.43)])
def test_room_to_turn_is_what_a_wall_ahead_leaves_of_the_sharpest_turn(ahead, room):
    """On a straight edge 0.6 m to the left, with another across it ahead."""
    angles = np.radians(np.arange(-180.0, 180.0, 2.0))
    with np.errstate(divide="ignore"):
        left = np.where(np.sin(angles) > 1e-9, 0.6 / np.sin(angles), np.inf)
        across = np.where(np.cos(angles) > 1e-9, ahead / np.cos(angles), np.inf)
    kind, mount, nose = 4, np.zeros(3), np.array([0.4, 0.2])
    alone = np.stack([left, np.where(np.isfinite(left), kind, 0)], axis=-1)
    assert room_to_turn(alone[None], angles, kind, mount, 0.67, nose)[0] == pytest.approx(
        0.6 + 0.67 - np.hypot(0.4, 0.87), abs=0.02
    )
    ranges = np.minimum(left, across)
    looks = np.stack([ranges, np.where(np.isfinite(ranges), kind, 0)], axis=-1)
    found = room_to_turn(looks[None], angles, kind, mount, 0.67, nose)[0]
    assert found == pytest.approx(room, abs=0.02)
    others = np.stack([ranges, np.full(len(angles), 1)], axis=-1)
    assert room_to_turn(others[None], angles, kind, mount, 0.67, nose)[0] == np.inf


def test_red_is_told_from_grey_and_other_colours():
    image = np.full((120, 160, 3), 130, dtype=np.uint8)
    red, green = image.copy(), image.copy()
    red[:, :85] = (200, 20, 20)
    green[:, :85] = (20, 200, 20)
    lost = np.zeros_like(image)
    few = image.copy()
    few[:, :75] = (200, 20, 20)
    found = inside(np.stack([image, red, green, lost, few]))
    assert found[:3].tolist() == [0.0, 1.0, 0.0]
    assert np.isnan(found[3])
    assert found[4] == 0.0
    assert np.count_nonzero(red_mask(red)) == 120 * 85


def test_wrong_numbers_are_refused():
    with pytest.raises(UnknownNameError, match="repaired"):
        PerimeterConfig(bounds=BOUNDS, spacing="other")
    with pytest.raises(InvalidInputError, match="boundary"):
        PerimeterConfig(bounds=(0.0, 0.0, 10.0, 50.0))
    with pytest.raises(InvalidInputError, match="desired"):
        PerimeterConfig(bounds=BOUNDS, desired=-1.0)
    with pytest.raises(InvalidInputError, match="disc"):
        tracked_radius(0.4)


def test_who_joins_crosses_the_edge_four_times_before_it_may_stop():
    zigzag = Zigzag(1, CONFIG)
    yes, no, still = np.array([True]), np.array([False]), np.zeros(1)
    told = []
    for k, inside_now in enumerate([0, 0, 1, 1, 0, 1, 0, 0, 1, 1]):
        seen = np.array([float(inside_now)])
        told.append(zigzag.speeds(still, np.zeros(1), seen, yes, yes if k == 0 else no)[0])
    assert told == [0.4] * 5 + [0.4] * 3 + [0.0] * 2


@pytest.mark.parametrize(("doubt", "seen", "goes"), [(np.inf, 0, 0), (2.0, 0, 1), (2.0, 1, 0)])
def test_who_is_told_of_ahead_and_is_not_seen_there_is_doubted_if_poses_drift(doubt, seen, goes):
    config = PerimeterConfig(bounds=BOUNDS, doubt=doubt)
    avoidance = Avoidance(2, config)
    pose = np.array([[0.0, 0.0, 0.0], [0.8, 0.0, np.pi / 2]])
    body = np.full((2, 2), np.nan)
    if seen:
        body[0] = [0.5, 0.0]
    state, wanted = np.array([ACQUIRE, TRACKING]), np.array([[0.4, 0.0], [0.0, 0.0]])
    for _ in range(100):
        told = avoidance.apply(wanted, np.zeros(2), NO_EDGE, state, neighbours(pose, state), body)
    assert (told[0, 0] > 0.0) == bool(goes)


def test_who_is_seen_is_where_it_is_seen_if_poses_drift():
    """Told to be 2.2 m to the left, seen ahead: one does not drive into it."""
    pose = np.array([[0.0, 0.0, 0.0], [0.5, 2.2, 1.0]])
    body, state = np.array([[0.9, 0.0], [np.nan, np.nan]]), np.array([ACQUIRE, TRACKING])
    wanted = np.array([[0.4, 0.0], [0.0, 0.0]])
    drifts = PerimeterConfig(bounds=BOUNDS, same=3.0, doubt=10.0)
    for config in (drifts, PerimeterConfig(bounds=BOUNDS)):
        avoidance = Avoidance(2, config)
        known = neighbours(pose, state)
        told = avoidance.apply(wanted, np.zeros(2), NO_EDGE, state, known, body)
        assert told[0].tolist() == [0.0, 0.0]
        if config is drifts:
            assert known.apart[0, 1] == pytest.approx(1.3)
            assert known.bearing[0, 1] == 0.0
        else:
            assert known.apart[0, 1] == pytest.approx(np.hypot(0.5, 2.2))


def test_who_stands_behind_somebody_nearer_is_not_disbelieved():
    # rear, middle and front: the middle one sees the nearest alone, behind it
    config = PerimeterConfig(bounds=(-50, -50, 50, 50), doubt=10.0)
    pose = np.array([[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [5.0, 0.0, 0.0]])
    told = np.column_stack([pose, np.full(3, TRACKING), np.zeros(3)])
    body = np.array([[1.5, 0.0], [-1.5, 0.0], [-2.5, 0.0]])
    avoidance, found = Avoidance(3, config), np.zeros((3, 2))
    for _ in range(200):
        near = Neighbours(pose, np.tile(told, (3, 1, 1)), ~np.eye(3, dtype=bool))
        command = np.tile([0.4, 0.0], (3, 1))
        found = avoidance.apply(
            command, np.zeros(3), np.full(3, np.nan), np.full(3, TRACKING), near, body
        )
    assert found[1, 0] == 0.0
