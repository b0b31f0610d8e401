"""Perception: what a controller makes of images and arcs; knows no simulator."""

from controllers.perception.arc_objects import ArcObjects, Objects
from controllers.perception.blobs import BlobFinder, Blobs
from controllers.perception.floor_columns import FloorColumns, Paint
from controllers.perception.patterns import PatternFinder, PatternLayout

__all__ = [
    "ArcObjects",
    "BlobFinder",
    "Blobs",
    "FloorColumns",
    "Objects",
    "Paint",
    "PatternFinder",
    "PatternLayout",
]
