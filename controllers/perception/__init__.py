"""Perception: what a controller makes of images; knows no simulator."""

from controllers.perception.blobs import BlobFinder, Blobs
from controllers.perception.patterns import PatternFinder, PatternLayout

__all__ = ["BlobFinder", "Blobs", "PatternFinder", "PatternLayout"]
