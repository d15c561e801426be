"""Effects that a scene leaves out: the numbers that tell whether they would have mattered, in closed form.

Plain functions of numbers; they know no mesh and no scene. An effect is one file; ``Assumed`` holds what no scene says.
"""

from ngwear.absent.assumed import Assumed
from ngwear.absent.verdict import Verdict, onset

__all__ = ["Assumed", "Verdict", "onset"]
