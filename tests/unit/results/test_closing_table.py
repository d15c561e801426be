from ngwear.results.closing_table import closing_table

SUMMARY = {
    "scene": "cup",
    "status": "completed",
    "message": "all strokes done",
    "first outward rod peak pressure [MPa]": 5.0,
    "last outward rod peak pressure [MPa]": 5.0,
    "last inward rod peak pressure [MPa]": 20.0,
    "last inward wall peak pressure [MPa]": 0.0,
    "peak pressure [MPa]": 20.0,
    "error estimates": {"peak pressure [-]": 0.1},
}


def shown(name):
    (line,) = [line for line in closing_table(SUMMARY).splitlines() if line.strip().startswith(name)]
    return line.partition("±")[2].strip()


def test_the_error_of_a_peak_pressure_is_shown_relative_to_its_own():
    """It is known relative to the highest one: 10 % of 20 MPa are 40 % of 5 MPa."""
    assert shown("peak pressure") == shown("last inward rod") == "10 %"
    assert shown("last outward rod") == "40 %"


def test_values_without_an_error_are_shown_without():
    assert shown("first outward rod") == ""
