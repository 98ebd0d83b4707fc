"""Peers in C++, each compiled when it is needed."""

from .build import PeerMissingError, build_harness

__all__ = ["PeerMissingError", "build_harness"]
