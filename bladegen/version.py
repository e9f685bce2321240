"""The version of bladegen."""

__all__ = ["__version__"]

__version__ = "2.0.0rc1"
