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


def main(words: list[str]) -> None:
    """Print a line a case while it runs, then the table."""
    families: dict[str, list[tuple[Case, str, list[Finding]]]] = {}
    for case in CASES:
        if words and not any(w in f"{case.family}: {case.label}" for w in words):
            continue
        start = time.process_time()
        try:
            outcome, findings = case.judge()
        except Exception as error:
            outcome, findings = "fails" if case.fails else f"FAILS: {error}", []
        seconds = time.process_time() - start
        print(
            f"{case.family}: {case.label}: {outcome} ({seconds:.1f} s)  "
            + "; ".join(map(str, worst(findings).values())),
            file=sys.stderr,
        )
        families.setdefault(case.family, []).append((case, outcome, findings))
    print("| hard case | how hard | outcome | worst measured |\n|---|---|---|---|")
    for family, rows in families.items():
        labels = "; ".join(case.label for case, *_ in rows)
        counts = [f"{sum(o == kind for _, o, _ in rows)} {kind}" for kind in dict.fromkeys(o for _, o, _ in rows)]
        values = worst([f for *_, found in rows for f in found]).values()
        print(f"| {family} | {labels} | {', '.join(counts)} | {'; '.join(f'{f.what} {f.value:.1g}' for f in values)} |")


if __name__ == "__main__":
    main(sys.argv[1:])
