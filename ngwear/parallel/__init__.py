"""Worker processes, and evaluation of a function at many points in parallel."""
