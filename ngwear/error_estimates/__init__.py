"""Error estimates: from coarser runs, runs to a given error, and the cost of accuracy."""
