"""Elements of alignments against closed forms, Fresnel integrals and integrals by SciPy."""

import math

import numpy as np
import pytest
from scipy.integrate import cumulative_simpson, quad
from scipy.special import fresnel

import tinsmith as ts

LAWS = ("clothoid", "bloss", "cosine", "sinusoid", "biquadratic")
ORDINATES = ("cubic parabola", "sine half-wave")
CURVATURES = {
    "clothoid": lambda u: u,
    "bloss": lambda u: 3 * u**2 - 2 * u**3,
    "cosine": lambda u: (1 - math.cos(math.pi * u)) / 2,
    "sinusoid": lambda u: u - math.sin(2 * math.pi * u) / (2 * math.pi),
    "biquadratic": lambda u: 2 * u * u if u < 0.5 else 4 * u - 2 * u * u - 1,
}


def rotate(places, angle):
    cos, sin = math.cos(angle), math.sin(angle)
    return places @ np.array([[cos, sin], [-sin, cos]])


@pytest.mark.parametrize("radius", [40.0, -250.0, 1e5])
@pytest.mark.parametrize("length", [10.0, 120.0])
def test_clothoids_are_fresnel_integrals(radius, length):
    start, direction = (500.0, -200.0), 2.1
    curve = ts.Element("clothoid", start, direction, length, 0.0, 1.0 / radius)
    at = np.linspace(0.0, length, 23)
    size = math.sqrt(math.pi * abs(radius) * length)
    sine, cosine = fresnel(at / size)
    local = size * np.column_stack([cosine, math.copysign(1.0, radius) * sine])
    np.testing.assert_allclose(curve.places(at), rotate(local, direction) + start, atol=1e-11)
    assert curve.end_direction == pytest.approx(direction + length / (2 * radius), abs=1e-14)


@pytest.mark.parametrize("kind", LAWS)
def test_transitions_are_the_integrals_of_their_curvature(kind):
    first, last, length = 1 / 300, -1 / 80, 60.0
    curve = ts.Element(kind, (0.0, 0.0), 0.4, length, first, last)

    at = np.linspace(0.0, length, 4001)  # whose middle is where a law may change
    curvature = first + (last - first) * np.array([CURVATURES[kind](u) for u in at / length])
    direction = 0.4 + _integrate(curvature, at)
    places = np.column_stack([_integrate(f(direction), at) for f in (np.cos, np.sin)])
    np.testing.assert_allclose(curve.curvatures(at), curvature, atol=1e-15)
    np.testing.assert_allclose(curve.directions(at), direction, atol=1e-12)
    np.testing.assert_allclose(curve.places(at), places, atol=1e-11)


def _integrate(values, at):
    """Integrate each half by itself, by Simpson's rule in steps of a 4000th."""
    half = len(at) // 2
    first = cumulative_simpson(values[: half + 1], x=at[: half + 1], initial=0.0)
    rest = cumulative_simpson(values[half:], x=at[half:], initial=0.0)
    return np.append(first[:-1], first[-1] + rest)


@pytest.mark.parametrize("kind", ORDINATES)
def test_transitions_by_ordinates_have_their_formula(kind):
    radius, length = 150.0, 90.0
    curve = ts.Element(kind, (0.0, 0.0), 0.0, length, 0.0, 1.0 / radius)
    at = np.linspace(0.0, length, 31)
    x, y = curve.places(at).T
    tangent = x[-1]
    if kind == "cubic parabola":
        expected = x**3 / (6 * radius * tangent)
    else:
        wave = (1 - np.cos(np.pi * x / tangent)) / (2 * np.pi**2)
        expected = tangent**2 / radius * ((x / tangent) ** 2 / 4 - wave)
    np.testing.assert_allclose(y, expected, atol=1e-12)
    steps = np.linspace(0.0, length, 2001)
    chords = np.hypot(*np.diff(curve.places(steps), axis=0).T)
    assert chords.sum() == pytest.approx(length, abs=1e-5)
    slopes = np.gradient(y, x, edge_order=2)
    np.testing.assert_allclose(np.tan(curve.directions(at)), slopes, atol=2e-3)


@pytest.mark.parametrize("kind", [*LAWS, *ORDINATES])
def test_a_curve_read_from_its_end_is_the_same(kind):
    first = 0.0 if kind in ORDINATES else 1 / 400
    curve = ts.Element(kind, (7.0, 3.0), -0.7, 80.0, first, 1 / 90)
    back = ts.Element(kind, curve.end, curve.end_direction + math.pi, 80.0, -1 / 90, -first)
    at = np.linspace(0.0, 80.0, 17)
    np.testing.assert_allclose(back.places(80.0 - at), curve.places(at), atol=1e-12)
    np.testing.assert_allclose(back.curvatures(80.0 - at), -curve.curvatures(at), atol=1e-14)
    turned = back.directions(80.0 - at) - math.pi
    np.testing.assert_allclose(turned, curve.directions(at), atol=1e-13)


@pytest.mark.parametrize("curvature", [1e-13, -1e-7, 0.02, -0.5])
def test_arcs_lie_on_their_circle(curvature):
    arc = ts.Element("arc", (10.0, 20.0), 1.0, 12.0, curvature, curvature)
    at = np.linspace(0.0, 12.0, 9)
    turned = 1.0 + curvature * at
    np.testing.assert_allclose(arc.directions(at), turned, atol=1e-15)
    x = [quad(lambda t: math.cos(1.0 + curvature * t), 0, s)[0] for s in at]
    y = [quad(lambda t: math.sin(1.0 + curvature * t), 0, s)[0] for s in at]
    np.testing.assert_allclose(
        arc.places(at), np.column_stack([x, y]) + np.array([10, 20]), atol=1e-11
    )


@pytest.mark.parametrize(
    ("given", "words"),
    [
        (("line", (0, 0), 0.0, 5.0, 0.1, 0.1), "0 at both ends of a line"),
        (("arc", (0, 0), 0.0, 5.0, 0.1, 0.2), "the same at both ends of an arc"),
        (("arc", (0, 0), 0.0, 5.0, 0.0, 0.0), "not 0"),
        (("cubic parabola", (0, 0), 0.0, 5.0, 0.1, 0.2), "0 at one end"),
        (("arc", (0, 0), 0.0, 5000.0, 1.0, 1.0), "50 full turns"),
        (("arc", (0, 0), 0.0, -5.0, 1.0, 1.0), "length"),
        (("bow", (0, 0), 0.0, 5.0), "kind"),
        (("line", (0, math.nan), 0.0, 5.0), "start"),
    ],
)
def test_elements_that_are_none_are_refused(given, words):
    with pytest.raises(ts.OptionError, match=words.replace("(", r"\(")):
        ts.Element(*given)
