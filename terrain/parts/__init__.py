"""Products of a surface that is never in memory as a whole: computed part by part, and joined.

A part is what :func:`tinsmith.tin.tiling.local_triangulation.triangulate_box` returns: all
triangles that meet a box. Each module has ``compute_part``, which needs nothing but a part, a box
and options, and ``join``, which makes the product of what it returned for boxes that tile the
plane. It equals the product of the whole surface to the last bit, whatever the boxes are and in
whatever order their parts are computed.
"""

from ...base.lazy import lazy_names

__getattr__, __dir__, __all__ = lazy_names(__name__)
