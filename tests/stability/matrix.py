"""The stability matrix: every hard case. ``python tests/stability/matrix.py`` runs it and prints README's table."""

import sys
import time

import pressing
import remembering
import sealing
import wearing
from case import Case
from physics import Finding

CASES = [*pressing.cases(), *wearing.cases(), *remembering.cases(), *sealing.cases()]


def worst(findings: list[Finding]) -> dict[str, Finding]:
    """The finding nearest to its bound, or farthest beyond, of each kind."""
    found: dict[str, Finding] = {}
    for f in findings:
        if f.what not in found or (f.value < found[f.what].value) == f.least:
            found[f.what] = f
    return found


def row(family: str, judged: list[tuple[Case, str, list[Finding]]]) -> str:
    """One line of README's table."""
    labels = "; ".join(case.label for case, *_ in judged)
    kinds = [outcome for _, outcome, _ in judged]
    outcome = ", ".join(f"{kinds.count(kind)} {kind}" for kind in dict.fromkeys(kinds))
    found = worst([f for *_, findings in judged for f in findings])
    main = [f"{found[what].value:.1g}" if what in found else "" for what in ("residual", "roughness")]
    least = f"{found['min J'].value:.2f}" if "min J" in found else ""
    errors = [f.value for f in found.values() if f.what.startswith(("error of", "area"))]
    furthest = f"{max(errors):.1g}" if errors else ""
    return f"| {family} | {labels} | {outcome} | {main[0]} | {least} | {main[1]} | {furthest} |"


def main(words: list[str]) -> None:
    """Print a line a case while it runs, then the table."""
    families: dict[str, list[tuple[Case, str, list[Finding]]]] = {}
    for case in CASES:
        if words and not any(w in f"{case.family}: {case.label}" for w in words):
            continue
        start = time.process_time()
        try:
            outcome, findings = case.judge()
        except AssertionError as error:
            outcome, findings = f"FAILS: {error}", []
        seconds = time.process_time() - start
        numbers = "; ".join(map(str, worst(findings).values()))
        print(f"{case.family}: {case.label}: {outcome} ({seconds:.1f} s)  {numbers}", file=sys.stderr)
        families.setdefault(case.family, []).append((case, outcome, findings))
    print("| hard case | how hard | outcome | residual | min J | roughness | errors |\n|---|---|---|---|---|---|---|")
    for family, judged in families.items():
        print(row(family, judged))


if __name__ == "__main__":
    main(sys.argv[1:])
