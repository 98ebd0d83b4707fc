"""How elevations of a surface err: independently, correlated over a distance, all alike."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, get_args

import numpy as np

from ...base.checks import as_floats, as_number, is_finite_number
from ...base.errors import OptionError
from ...base.policies import CorrelationModel
from ...base.sentences import counted, suggest

if TYPE_CHECKING:
    from ...base.arrays import BoolArray, Float64Array
    from ...tin import TIN

_COLUMN = "a number >= 0 in the unit of elevations, or the name of a column of the vertices"
_FALL = 3.0
"""At the practical range the correlation is exp(-3), 5 %."""
_REACHES = {"exponential": 4.0, "spherical": 1.0, "gaussian": 2.25}
"""Of the range: farther apart the correlation is 0, or below 7e-6."""


@dataclass(frozen=True, slots=True)
class ErrorModel:
    """Errors of the elevations of a surface, for standard errors of volumes.

    Parameters
    ----------
    standard_error : float or str
        Standard error of each vertex, in the unit of elevations, or the column of the vertices
        (``tin.attributes``) that has it.
    systematic : float, optional
        Standard error of a shift that all elevations of the surface have in common, such as that
        of its benchmark.
    correlation_range : float, optional
        Distance, in CRS units, over which the errors of vertices are correlated; default 0,
        independent.
    correlation : {"exponential", "spherical", "gaussian"}, optional
        How the correlation falls with the distance d and the range a: exp(-3 d / a), 1 - 1.5 d / a
        + 0.5 (d / a)³ up to a and none beyond, or exp(-3 (d / a)²). So the range is the practical
        one, at which 5 % or nothing is left.
    nugget : float, optional
        Share of the variance, from 0 to 1, that is independent from vertex to vertex all the same.

    Raises
    ------
    OptionError
        If a number is negative or not finite, a word is none of those, or the nugget is above 1.

    References
    ----------
    J.-P. Chilès, P. Delfiner: Geostatistics, 2nd ed. (2012), chapter 2, doi:10.1002/9781118136188.

    Examples
    --------
    >>> import tinsmith as ts
    >>> pile = ts.triangulate([[0, 0, 5], [4, 0, 5], [4, 3, 8], [0, 3, 8]])
    >>> lidar = ts.ErrorModel(0.02, systematic=0.03, correlation_range=20.0)
    >>> ts.volume(pile, base=5.0, standard_error=lidar)["net_error"].round(3)
    array([0.41])
    """

    standard_error: float | str
    systematic: float = 0.0
    correlation_range: float = 0.0
    correlation: CorrelationModel = "exponential"
    nugget: float = 0.0

    def __post_init__(self) -> None:
        if not isinstance(self.standard_error, str):
            _require_error("standard_error", self.standard_error)
        as_number("systematic", self.systematic, least=0, unit="in the unit of elevations")
        as_number("correlation_range", self.correlation_range, "a distance", least=0)
        as_number("nugget", self.nugget, "a share", least=0, most=1)
        if self.correlation not in get_args(CorrelationModel):
            raise OptionError("correlation", self.correlation, get_args(CorrelationModel))

    @property
    def reach(self) -> float:
        """Distance within which errors are correlated, CRS units."""
        return _REACHES[self.correlation] * self.correlation_range

    def correlate(self, distances: Float64Array) -> Float64Array:
        """Return the correlations of errors some distances apart, but for the nugget.

        Parameters
        ----------
        distances : (n,) float64 array
            In CRS units.

        Returns
        -------
        (n,) float64 array

        Examples
        --------
        >>> import numpy as np
        >>> import tinsmith as ts
        >>> model = ts.ErrorModel(0.02, correlation_range=20.0, correlation="spherical")
        >>> model.correlate(np.array([0.0, 10.0, 20.0]))
        array([1.    , 0.3125, 0.    ])
        """
        share = distances / self.correlation_range
        if self.correlation == "exponential":
            return np.exp(-_FALL * share)
        if self.correlation == "gaussian":
            return np.exp(-_FALL * share * share)
        share = np.minimum(share, 1.0)
        return 1.0 - share * (1.5 - 0.5 * share * share)


def find_errors(model: ErrorModel, tin: TIN, option: str) -> float | Float64Array:
    """Return the standard error of all vertices, or of each, (n,); NaN where it is not known.

    Raises OptionError, which names the ``option``, if there is no such column, or what it holds
    are no numbers from 0 on.
    """
    if not isinstance(model.standard_error, str):
        return float(model.standard_error)
    name, columns = model.standard_error, tin.attributes
    if name not in columns:
        known = f"one of the columns of the vertices ({', '.join(columns) or 'there is none'})"
        raise OptionError(option, name, f"{known}{suggest(name, columns).rstrip('?')}")
    errors = as_floats(columns[name])
    if errors is None or errors.ndim != 1:
        raise OptionError(option, name, "a column of numbers")
    is_bad: BoolArray = (errors < 0) | np.isinf(errors)
    if is_bad.any():
        count = int(np.count_nonzero(is_bad))
        what = f"{errors[is_bad][0]:g} in {counted(count, 'row')} of '{name}'"
        raise OptionError(option, what, "a number >= 0")
    return errors


def as_error_model(given: Any, option: str) -> ErrorModel | None:
    """Return the errors that a number, the name of a column, or a model stands for."""
    if given is None or isinstance(given, ErrorModel):
        return given
    if not isinstance(given, str):
        _require_error(option, given)
    return ErrorModel(given)


def _require_error(option: str, value: Any) -> None:
    if not is_finite_number(value) or value < 0:
        raise OptionError(option, value, _COLUMN)
