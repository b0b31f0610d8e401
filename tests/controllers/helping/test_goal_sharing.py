import numpy as np
import pytest

from controllers.helping.goal_sharing import (
    CHAIN,
    LITERAL,
    check_goal,
    goal_number,
    memory,
    new_goal,
    offers,
    reflect,
    share_goals,
)


class Crew:
    """Robots at world places, frames aligned with the world, talking where told."""

    def __init__(self, places, ghosts):
        self.at = np.array(places, dtype=float)
        n = len(self.at)
        self.known, self.offered = memory(n, ghosts), offers(n, ghosts)
        self.heard = np.zeros((n, n), dtype=bool)

    def link(self, *pairs):
        self.heard[:] = False
        for i, j in pairs:
            self.heard[i, j] = self.heard[j, i] = True

    def talk(self, sees_goal=(), sees_ghost=()):
        away = self.at[None] - self.at[:, None]
        distance = np.hypot(away[..., 0], away[..., 1])
        bearing = np.arctan2(away[..., 1], away[..., 0])
        share_goals(self.known, self.at, self.heard, distance, bearing)
        for i in range(1, len(self.at)):
            if self.known.number[i, 0]:
                check_goal(self.known, self.at, i, 0, i in sees_goal, i in sees_ghost)
        reflect(self.known, self.offered, self.at, self.heard, distance, bearing, False)
        self.known.last[:] = self.at


def test_a_relay_counts_down_and_the_direct_word_beats_it():
    crew = Crew([[0, 0], [2, 0], [4, 0]], LITERAL)
    new_goal(crew.known, crew.offered, 0, 5.0, 5.0)
    crew.link((0, 1), (1, 2))
    crew.talk()
    assert crew.known.number[:, 0].tolist() == [3, 3, 2]
    np.testing.assert_allclose(crew.known.goal[2, 0], [5, 5], atol=1e-12)
    crew.link((0, 2), (1, 2))
    crew.talk()
    assert crew.known.number[2, 0] == 3
    crew.link((1, 2))  # a relay of the same goal is refused now
    crew.known.goal[1, 0] = [9, 9]
    crew.talk()
    np.testing.assert_allclose(crew.known.goal[2, 0], [5, 5], atol=1e-12)


def test_a_newer_goal_beats_an_older_one_and_forgets_its_ghosts():
    crew = Crew([[0, 0], [2, 0], [4, 0]], LITERAL)
    crew.link((0, 1))
    new_goal(crew.known, crew.offered, 0, 5.0, 5.0)
    crew.talk(sees_goal={1})
    assert crew.known.distance[1, 0] == pytest.approx(np.hypot(3, 5))
    new_goal(crew.known, crew.offered, 0, -5.0, 0.0)
    assert goal_number(crew.known.number[0, 0], 3) == 2
    crew.talk()
    assert np.isinf(crew.known.distance[1, 0])
    assert not crew.offered.active[0]


def test_mirrors_sum_distances_and_the_shortest_wins():
    # figure 3: the goal is seen by R3 alone, R2 relays; R4 offers a longer way
    crew = Crew([[0, 0], [3, 0], [3, 4], [0, 9]], LITERAL)
    crew.link((0, 1), (1, 2), (0, 3), (3, 2))
    new_goal(crew.known, crew.offered, 0, 6.0, 8.0)
    for _ in range(3):
        crew.talk(sees_goal={2})
    assert crew.known.distance[2, 0] == pytest.approx(5.0)
    assert crew.known.distance[1, 0] == pytest.approx(9.0)
    assert crew.offered.giver[0] == 1
    assert crew.offered.promise[0] == pytest.approx(12.0)
    np.testing.assert_allclose(crew.offered.points[0, 0], [3, 0], atol=1e-12)


@pytest.mark.parametrize("ghosts", [LITERAL, CHAIN])
def test_ghosts_leave_a_polyline_back_to_the_goal(ghosts):
    # figure 8: R2 goes round two corners; D is the length of the polyline over its ghosts
    crew = Crew([[0.0, 0.0], [0.0, 2.0]], ghosts)
    new_goal(crew.known, crew.offered, 0, 0.0, 5.0)
    crew.link((0, 1))
    crew.talk(sees_goal={1})  # at (0, 2): 3 m
    crew.link()
    crew.at[1] = [1.0, 2.0]
    crew.talk(sees_ghost={1})
    assert crew.known.distance[1, 0] == pytest.approx(3 + 1)
    crew.at[1] = [1.0, 1.0]  # the ghost is lost: another where it was last seen from
    crew.talk()
    assert crew.known.distance[1, 0] == pytest.approx(3 + 1 + 1)
    assert crew.known.ghosts[1, 0] == (1 if ghosts == LITERAL else 2)
    np.testing.assert_allclose(crew.known.path[1, 0, crew.known.ghosts[1, 0] - 1], [1, 2])
    crew.at[0] = [3.0, 1.0]
    crew.offered.promise[0], crew.offered.active[0] = np.inf, False  # as if not offered before
    crew.link((0, 1))
    crew.talk(sees_ghost={1})
    points = crew.offered.points[0, : crew.offered.length[0]]
    chain = [[1, 1], [1, 2], [0, 2]]
    np.testing.assert_allclose(points, chain[:1] if ghosts == LITERAL else chain, atol=1e-12)
    assert crew.offered.rest[0, 0] == pytest.approx(5.0)
    assert crew.offered.promise[0] == pytest.approx(7.0)


def test_only_a_shorter_promise_is_taken():
    crew = Crew([[0, 0], [2, 0], [0, 3]], LITERAL)
    new_goal(crew.known, crew.offered, 0, 4.0, 0.0)
    crew.link((0, 1))
    crew.talk(sees_goal={1})
    crew.link((0, 2))
    crew.talk(sees_goal={2})  # 3 + 5 m against 4
    assert crew.offered.giver[0] == 1
    assert crew.offered.taken[0] == 1
