"""The paper's tables 1 and 2: average steps a target, and deviation over five tasks in percent.

A set of 200 targets cannot take 201 steps in all, so "average number of motion steps" is read as
steps a target, averaged over a task. The potential field alone has no entry: it cannot finish.
"""

PUBLISHED: dict[str, dict[str, dict[int, tuple[float, float]]]] = {
    "world1": {
        "avoid-past": {1: (554.2, 11.7), 2: (426.2, 8.1), 3: (302.0, 14.2), 4: (257.2, 5.6)},
        "visbug": {1: (840.6, 7.6), 2: (294.0, 6.6), 3: (255.4, 6.1), 4: (201.2, 3.7)},
        "potential-field": {2: (618.6, 3.6), 3: (310.0, 10.0), 4: (235.2, 5.4)},
    },
    "world2": {
        "avoid-past": {1: (1132.2, 4.5), 2: (953.6, 6.4), 3: (731.8, 7.9), 4: (682.6, 6.9)},
        "visbug": {1: (513.6, 10.5), 2: (441.8, 12.0), 3: (397.4, 9.0), 4: (373.4, 10.3)},
        "potential-field": {2: (1246.4, 5.9), 3: (1130.4, 6.7), 4: (913.6, 4.7)},
    },
}
