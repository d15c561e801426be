"""Wear a steel cylinder and a flat by 10,000 fretting cycles and draw both scars: ``fretting.png``.

The case is ``ngwear.verify.fretting``. About half a minute: ``python geometries/fretting/make_figure.py``.
"""

from pathlib import Path

from ngwear.plots.fretting import draw_scars
from ngwear.verify.fretting import worn


def main() -> None:
    """Run the cycles, and draw."""
    _, scars = worn()
    draw_scars(scars).savefig(Path(__file__).with_name("fretting.png"), dpi=150)


if __name__ == "__main__":
    main()
