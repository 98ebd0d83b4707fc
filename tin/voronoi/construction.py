"""The Voronoi diagram of a TIN."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from ...base.checks import require_tin
from ...base.products import product
from .diagram import Voronoi, divide_plane

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from ...base.types import Bounds
    from ..surface import TIN


@product
def voronoi(
    tin: TIN, *, boundary: Bounds | ArrayLike | None = None, pad: float | None = None
) -> Voronoi:
    """Build the Voronoi diagram of the vertices of a TIN: for each the places nearest to it.

    Two vertices are joined by an edge of the Delaunay triangulation where their cells share
    a side [1]_.

    Parameters
    ----------
    tin : TIN
    boundary : Bounds or (k, 2) array, optional
        What the cells are clipped to: a rectangle, or the corners of a ring, convex or not,
        CRS units.
    pad : float, optional
        Without a boundary, the bounds of the vertices are taken, this far outwards on every
        side, CRS units. Default: a tenth of their longer side.

    Returns
    -------
    Voronoi
        One cell for each vertex, in their order; of vertices at one place the first has it.

    Raises
    ------
    OptionError
        If ``pad`` is no distance, or given together with a boundary.
    LinesError
        If the boundary has fewer than three corners, coordinates that are not finite, no
        area, or touches itself.

    Notes
    -----
    The diagram is that of the vertices alone, the dual of their Delaunay triangulation, which
    is built anew: constraints, clipping and other triangles of the TIN have no part in it.
    Where more than three cells meet (as in every raster), exact predicates tell, and the
    corner is the same in all of them; there are no sides of length zero. Corners are rounded
    to coordinates, circumcentres far outside the boundary never enter. Time and memory grow
    as n log n; a ring, other than bounds that hold all vertices, takes shapely.

    References
    ----------
    .. [1] R. Sibson, "Locally equiangular triangulations", The Computer Journal 21 (1978),
       243-245. https://doi.org/10.1093/comjnl/21.3.243

    Examples
    --------
    >>> from tinsmith import TIN
    >>> tin = TIN.from_triangles([[0, 0, 1], [4, 0, 2], [0, 4, 3]], [[0, 1, 2]])
    >>> voronoi(tin, pad=0).areas
    array([4., 6., 6.])
    """
    require_tin(tin)
    return replace(divide_plane(tin.points, boundary=boundary, pad=pad), crs=tin.crs)
