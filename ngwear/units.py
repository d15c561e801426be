"""The one system of units: mm, N, MPa, s, t, K, and hence mJ for energy.

These are the consistent units in which a seal drawing, a rubber data sheet and a rod speed need no
conversion. Forces of a plane strain scene are N per mm of thickness. Wear rates are often quoted in
mm³/(N m); ngwear takes them in mm²/N (= mm³/(N mm)): divide by 1000.
"""

UNITS = {
    "length": "mm",
    "force": "N",
    "stress": "MPa",
    "time": "s",
    "mass": "t",
    "temperature": "K",
    "energy": "mJ",
    "specific wear rate": "mm^2/N",
}


def force_unit(axisymmetric: bool) -> str:
    """Return the unit of a resultant force: ``N``, or ``N/mm`` of thickness in plane strain."""
    return "N" if axisymmetric else "N/mm"


def energy_unit(axisymmetric: bool) -> str:
    """Return the unit of an energy: ``mJ``, or ``mJ/mm`` of thickness in plane strain."""
    return "mJ" if axisymmetric else "mJ/mm"
