"""Masks of hues on both sides of red."""

import numpy as np

from controllers.perception.hues import hue_mask


def test_a_range_over_hue_0_takes_both_sides_of_it_and_one_elsewhere_does_not():
    hues = np.array([0, 9, 10, 90, 170, 171, 179], dtype=np.uint8)
    hsv = np.full((1, len(hues), 3), 200, dtype=np.uint8)
    hsv[0, :, 0] = hues
    red = hue_mask(hsv, -9, 9, 100, 100)[0] > 0
    assert red.tolist() == [True, True, False, False, False, True, True]
    beyond = hue_mask(hsv, 171, 189, 100, 100)[0] > 0
    assert beyond.tolist() == red.tolist()
    assert (hue_mask(hsv, 80, 100, 100, 100)[0] > 0).tolist() == (hues == 90).tolist()
    assert not hue_mask(hsv, -9, 9, 201, 100).any()
    assert not hue_mask(hsv, -9, 9, 100, 201).any()
