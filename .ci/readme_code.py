"""Print README's Python, for the type checker."""

import re
from pathlib import Path

print(re.search(r"```python\n(.*?)```", Path("README.md").read_text(encoding="utf-8"), re.DOTALL).group(1))
