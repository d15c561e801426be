"""What errors say, and what they keep when words are added."""

from ngwear.equilibrium.newton import Outcome, Report
from ngwear.errors import ConvergenceError


def test_words_stand_around_the_sentences_and_the_report_stays_at_the_end():
    report = Report(Outcome.ROLLED)
    error = ConvergenceError("no equilibrium", report, cause="it rolls")
    told = error.with_words("in stroke 'inward': ", "; add a wall")
    assert str(told) == f"in stroke 'inward': no equilibrium; add a wall\n{report}"
    assert (told.report, told.cause) == (report, "it rolls")


def test_without_a_report_there_is_none_at_the_end():
    assert str(ConvergenceError("none").with_words("here: ")) == "here: none"
