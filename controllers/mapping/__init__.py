"""Maps that robots make for themselves, from what their own rangers return."""

from controllers.mapping.scan_map import ScanMap
from controllers.mapping.scan_sight import free_ranges, way_is_clear

__all__ = ["ScanMap", "free_ranges", "way_is_clear"]
