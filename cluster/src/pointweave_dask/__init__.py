"""Pointweave on many machines, by Dask: `tiles`, `catalogue` and `reduce_many` on a `distributed.Client`."""

from .batch import reduce_many
from .catalogue import catalogue
from .errors import PointweaveError
from .tiles import tiles

__all__ = ["PointweaveError", "catalogue", "reduce_many", "tiles"]
